//! How a run ended. Every run is a row, whatever its outcome.

use serde::{Deserialize, Serialize};

/// The end of a run. The numbers go into digests: never renumber, only add.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum Outcome {
    /// Past and clear of every target.
    Completed = 0,
    /// Own ship's hull touched a target's.
    Collision = 1,
    /// Own ship's hull touched a hazard.
    Grounding = 2,
    /// The longest simulated time passed first.
    Truncated = 3,
    /// The planner panicked.
    PlannerPanicked = 4,
    /// The planner ordered NaN or an infinity.
    PlannerNonFinite = 5,
    /// The planner ordered a course or speed outside the declared range.
    PlannerOutOfRange = 6,
    /// The planner did not return from a beat.
    PlannerHung = 7,
    /// The planner took its process with it.
    PlannerCrashed = 8,
    /// An outside planner broke the protocol.
    PlannerProtocol = 9,
    /// The bench could not run this encounter.
    Invalid = 10,
}

impl Outcome {
    /// Every outcome, in the order of reports.
    pub const ALL: [Self; 11] = [
        Self::Completed,
        Self::Collision,
        Self::Grounding,
        Self::Truncated,
        Self::PlannerPanicked,
        Self::PlannerNonFinite,
        Self::PlannerOutOfRange,
        Self::PlannerHung,
        Self::PlannerCrashed,
        Self::PlannerProtocol,
        Self::Invalid,
    ];

    /// The word used in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Completed => "completed",
            Self::Collision => "collision",
            Self::Grounding => "grounding",
            Self::Truncated => "truncated",
            Self::PlannerPanicked => "planner_panicked",
            Self::PlannerNonFinite => "planner_non_finite",
            Self::PlannerOutOfRange => "planner_out_of_range",
            Self::PlannerHung => "planner_hung",
            Self::PlannerCrashed => "planner_crashed",
            Self::PlannerProtocol => "planner_protocol",
            Self::Invalid => "invalid",
        }
    }

    /// The outcome with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|outcome| outcome.name() == name)
    }

    /// Whether the planner, and nobody else, ended the run.
    pub const fn is_planner_failure(self) -> bool {
        matches!(
            self,
            Self::PlannerPanicked
                | Self::PlannerNonFinite
                | Self::PlannerOutOfRange
                | Self::PlannerHung
                | Self::PlannerCrashed
                | Self::PlannerProtocol
        )
    }

    /// Whether a limit on the wall clock ended the run: a faster machine might not have, and its
    /// digest would then be another.
    pub const fn is_wall_clock(self) -> bool {
        matches!(self, Self::PlannerHung)
    }
}
