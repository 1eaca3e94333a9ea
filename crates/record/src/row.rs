//! One flat row for every run, whatever its outcome: what the table stores and statistics read.

use crate::{Check, Digest, EncounterId, Outcome, PlannerEvents, Status, verdict::Reaction};
use geom::EncounterClass;
use serde::{Deserialize, Serialize};

/// What one check said of one run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckCell {
    /// Status of the worst pair.
    pub status: Status,
    /// Its margin, in the unit of the check.
    pub margin: Option<f64>,
}

/// One run. Absent numbers were never reached; none is invented.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunRow {
    /// Which encounter.
    pub id: EncounterId,
    /// How it ended.
    pub outcome: Outcome,
    /// Digest of the trace; of id and outcome alone where the process was lost.
    pub digest: Digest,
    /// Importance weight.
    pub weight: f64,
    /// Number of targets.
    pub targets: u8,
    /// Class that decides, found by the judge for the pair that came closest; absent if risk never
    /// opened.
    pub class: Option<EncounterClass>,
    /// Class of that pair by the head-on sector that the planner states; absent where it states
    /// none.
    pub class_by_planner: Option<EncounterClass>,
    /// Checks that fail under the planner's classes, joined by `+` (`none` where none
    /// fails), where one of these differs from the judge's; absent where none does.
    pub fails_by_planner_class: Option<String>,
    /// Another class was within 2 degrees.
    pub ambiguous: bool,
    /// What each target means to do, in their order, joined by `+`; empty without targets.
    pub intents: String,
    /// What the planner can perceive.
    pub sensing: String,

    /// Own speed at the start, m/s.
    pub own_speed_mps: f64,
    /// First target's speed at the start, m/s.
    pub target_speed_mps: Option<f64>,
    /// First target's length, metres.
    pub target_length_m: Option<f64>,
    /// Relative bearing of the first target at the start, radians.
    pub beta_rad: Option<f64>,
    /// Contact angle of the first target at the start, radians.
    pub alpha_rad: Option<f64>,
    /// Range of the first target at the start, metres.
    pub range_m: Option<f64>,
    /// Signed miss distance without avoidance, metres, as the generator promised.
    pub miss_m: Option<f64>,
    /// Time to CPA at the start, seconds, as the generator promised.
    pub tcpa_s: Option<f64>,

    /// When the run ended, seconds.
    pub end_s: f64,
    /// Smallest hull-to-hull distance to any target, metres.
    pub cpa_hull_m: Option<f64>,
    /// Smallest distance between reference points, metres.
    pub cpa_centre_m: Option<f64>,
    /// When the campaign's kind of distance was smallest, seconds.
    pub cpa_s: Option<f64>,
    /// The run was cut before CPA, or the planner failed: its distance is unknown.
    pub unknown: bool,
    /// The campaign's kind of distance came below the safety radius.
    pub safety_radius_broken: bool,
    /// Smallest hull-to-hull distance without avoidance, metres.
    pub nominal_cpa_hull_m: Option<f64>,
    /// The same in the campaign's kind of distance: was the safety radius broken.
    pub nominal_safety_radius_broken: Option<bool>,
    /// The run ended in a contact that no manoeuvre of own ship could have avoided: hard over to
    /// either side by 90 or 180 degrees, full astern, both, or nothing, begun at any beat from the
    /// first track of the target that she hit (from the start where she ran aground or her planner
    /// failed), the other ships being as they are, clears neither all targets nor all hazards.
    /// False where the run ended without a contact; absent where it was not computed.
    pub unavoidable: Option<bool>,

    /// Onset of risk of the first pair at risk, seconds.
    pub risk_s: Option<f64>,
    /// Reaction to it.
    pub reaction: Reaction,
    /// Readily apparent reaction to it.
    pub apparent: Reaction,
    /// Signed size of the first alteration, radians.
    pub first_turn_rad: Option<f64>,
    /// Distance sailed up to the passage of the goal, and still to sail to it, less the planned
    /// one, metres.
    pub extra_distance_m: Option<f64>,
    /// The last waypoint was reached, by the condition that ends a run which goes on to it.
    pub goal_reached: bool,

    /// Impact speed, m/s.
    pub impact_mps: Option<f64>,
    /// Impulse, newton seconds.
    pub impulse_ns: Option<f64>,
    /// Kinetic energy lost, joules.
    pub energy_lost_j: Option<f64>,
    /// What the planner counted.
    pub events: PlannerEvents,
    /// The last words of a planner that failed; absent where it did not, or said nothing.
    pub planner_detail: Option<String>,
    /// One cell for each check, in the order of `Check::ALL`.
    pub checks: Vec<CheckCell>,
    /// The second judge disagrees with the first; absent where it was not asked.
    pub judges_disagree: Option<bool>,
}

impl RunRow {
    /// The cell of a check; `not_evaluated` where the judge did not run.
    pub fn check(&self, check: Check) -> CheckCell {
        let none = CheckCell { status: Status::NotEvaluated, margin: None };
        self.checks.get(check as usize).copied().unwrap_or(none)
    }

    /// Whether own ship hit a target.
    pub fn collided(&self) -> bool {
        self.outcome == Outcome::Collision
    }
}
