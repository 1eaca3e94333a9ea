//! What a gate leaves behind: `gate.json`.

use crate::run::Clocked;
use crate::serve::Identity;
use crate::{Event, FreshKey};
use campaign::Plan;
use record::{EncounterId, Outcome};
use serde::{Deserialize, Serialize};
use stats::{CorpusResult, Feasibility, GatePlan, GateResult, GateVerdict};

/// The whole answer and everything needed to ask again.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GateReport {
    /// 1.
    pub schema: u32,
    /// The answer.
    pub verdict: GateVerdict,
    /// Title of the campaign.
    pub title: String,
    /// Hash of the campaign.
    pub campaign_hash: String,
    /// Key of the fresh set.
    pub key: FreshKey,
    /// The change series.
    pub series: String,
    /// The planner of today.
    pub baseline: ArmIdentity,
    /// The planner that wants to replace it.
    pub candidate: ArmIdentity,
    /// The ratchet's planners.
    pub ratchets: Vec<ArmIdentity>,
    /// a_F + a_abs: how often a change that is no worse is blocked at most.
    pub false_alarm_budget: f64,
    /// What was declared.
    pub declared: GatePlan,
    /// What it needed, said before the run.
    pub feasibility: Feasibility,
    /// The rule's numbers.
    pub result: GateResult,
    /// Layer 1.
    pub corpus: CorpusResult,
    /// Pairs that were run and differ in any bit, also behind the look that decided.
    pub different: u64,
    /// Runs that the wall clock ended, which make the verdict one of this machine.
    pub ended_by_wall_clock: Clocked,
    /// The worst encounters that only the candidate fails, worst first.
    pub new_failures: Vec<NewFailure>,
}

/// One planner of a gate.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ArmIdentity {
    /// As it was named on the command line.
    pub asked: String,
    /// Who the process said it is.
    pub identity: Identity,
    /// The plan that it ran.
    pub plan: Plan,
}

/// An encounter that only the candidate fails.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NewFailure {
    /// Which.
    pub encounter: EncounterId,
    /// How.
    pub event: Event,
    /// How the run ended.
    pub outcome: Outcome,
    /// Smallest distance, metres.
    pub cpa_m: Option<f64>,
}

impl NewFailure {
    /// Worse event first, then the closer one, then the smaller id.
    pub fn is_worse_than(&self, other: &Self) -> bool {
        let distance_m = |failure: &Self| failure.cpa_m.unwrap_or(f64::INFINITY);
        self.event
            .cmp(&other.event)
            .then(distance_m(self).total_cmp(&distance_m(other)))
            .then_with(|| self.encounter.cmp(&other.encounter))
            .is_lt()
    }

    /// One line for a human reader.
    pub fn sentence(&self) -> String {
        let distance = self.cpa_m.map_or(String::new(), |cpa_m| format!(", closest {cpa_m:.0} m"));
        format!(
            "{}: {} ({}{distance})",
            self.encounter,
            self.event.title(),
            self.outcome.name().replace('_', " ")
        )
    }
}
