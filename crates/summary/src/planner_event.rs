//! What a planner says of itself that a reader should know of.

use record::PlannerEvents;

/// One kind of the events that a planner counts. Passes of inner loops are work and no event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PlannerEvent {
    /// An inner loop met its cap.
    InnerLoopCap,
    /// Inside a safety circle, and called that safe.
    InsideCalledSafe,
    /// A receding target was treated as a danger.
    RecedingFlagged,
    /// Its class of a target differed from the beat before.
    ClassChanged,
    /// A limit of its own cut its order.
    Limited,
}

impl PlannerEvent {
    /// All of them, the gravest first.
    pub const ALL: [Self; 5] = [
        Self::InnerLoopCap,
        Self::InsideCalledSafe,
        Self::RecedingFlagged,
        Self::ClassChanged,
        Self::Limited,
    ];

    /// Beats of a run at which it happened.
    pub fn beats(self, events: &PlannerEvents) -> u32 {
        match self {
            Self::InnerLoopCap => events.inner_loop_cap,
            Self::InsideCalledSafe => events.inside_called_safe,
            Self::RecedingFlagged => events.receding_flagged,
            Self::ClassChanged => events.class_changes,
            Self::Limited => events.limited,
        }
    }

    /// What a reader sees.
    pub const fn title(self) -> &'static str {
        match self {
            Self::InnerLoopCap => "inner loop at its cap",
            Self::InsideCalledSafe => "inside the safety circle called safe",
            Self::RecedingFlagged => "receding target taken for a danger",
            Self::ClassChanged => "class of a target changed",
            Self::Limited => "a limit cut the order",
        }
    }
}
