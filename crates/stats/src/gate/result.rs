//! What a gate says, with the numbers behind every word.

use serde::{Deserialize, Serialize};

use crate::{Estimate, Forecast, PairedCounts};

/// The three answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GateVerdict {
    /// May be merged.
    Pass,
    /// Must not be merged.
    Fail,
    /// Not shown either way within the cap: not merged, and not a false alarm.
    Inconclusive,
}

/// The answer of one layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LayerVerdict {
    /// Everything that it asks is shown.
    Pass,
    /// The opposite of something that it asks is shown.
    Fail,
    /// Not shown either way.
    Inconclusive,
    /// The plan asks nothing of this layer.
    NotAsked,
}

/// Layer 1, decided by replaying the corpus: a rule, not a test.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CorpusResult {
    /// Cases replayed.
    pub cases: u64,
    /// Critical cases that the baseline passes and the candidate breaks.
    pub broken: Vec<BrokenCase>,
}

/// A newly broken case of the corpus.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct BrokenCase {
    /// The case.
    pub name: String,
    /// The signed reason for which it is waived, if it is; an empty one waives nothing.
    pub waived: Option<String>,
}

impl CorpusResult {
    /// FAIL when a case is newly broken and not waived.
    #[must_use]
    pub fn verdict(&self) -> LayerVerdict {
        let waived = |case: &BrokenCase| {
            case.waived.as_ref().is_some_and(|reason| !reason.trim().is_empty())
        };
        if self.broken.iter().any(|case| !waived(case)) {
            LayerVerdict::Fail
        } else if self.cases == 0 {
            LayerVerdict::NotAsked
        } else {
            LayerVerdict::Pass
        }
    }
}

/// The whole answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GateResult {
    /// The combination of the layers.
    pub verdict: GateVerdict,
    /// Pairs that the verdict rests on: those up to the last look.
    pub pairs: u64,
    /// Looks taken.
    pub looks: u64,
    /// The cap, in whole cycles.
    pub cap: u64,
    /// Attempt j of the change series.
    pub attempt: u32,
    /// The level at which this attempt passes.
    pub alpha_pass: f64,
    /// Layer 1.
    pub corpus: LayerVerdict,
    /// Layer 3: the comparison with the baseline.
    pub comparison: LayerVerdict,
    /// Layer 4: absolute requirements.
    pub absolute: LayerVerdict,
    /// Layer 5: the release and the anchor.
    pub ratchet: LayerVerdict,
    /// ln of the mean of E_harm over the metrics.
    pub ln_harm_mean: f64,
    /// By metric, in the plan's order.
    pub metrics: Vec<MetricResult>,
    /// By requirement, in the plan's order.
    pub absolutes: Vec<AbsoluteResult>,
    /// By arm and metric, in the plan's order.
    pub ratchets: Vec<RatchetResult>,
}

/// How a metric stands in a FAIL.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Harmed {
    /// Worse by itself: E_harm >= m / a_F.
    Alone,
    /// The largest of metrics that are worse only together.
    Joint,
}

/// One metric against the baseline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MetricResult {
    /// As in the plan.
    pub name: String,
    /// Counts of the PASS test: undetermined is an event for the candidate, none for the other.
    pub counts_pass: PairedCounts,
    /// Counts of the FAIL test: undetermined is none for the candidate, an event for the other.
    pub counts_fail: PairedCounts,
    /// Pairs in which either planner's outcome is undetermined.
    pub undetermined: u64,
    /// ln E_harm.
    pub ln_harm: f64,
    /// Set in a FAIL by layer 3.
    pub harmed: Option<Harmed>,
    /// ln E_ni (or E_rel) at the last look.
    pub ln_pass: f64,
    /// The largest over the looks, which the test may use.
    pub ln_pass_max: f64,
    /// The pairs at which it reached 1 / a_P.
    pub passed_at: Option<u64>,
    /// Confidence sequence of D at the pass level, undetermined counted against both ends.
    pub difference: Estimate,
    /// Passed, yet worse for certain: "worse within the declared margin", charged to the ratchet.
    pub worse_within_margin: bool,
    /// Pairs still needed at the observed rates.
    pub forecast: Forecast,
}

/// One absolute requirement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AbsoluteResult {
    /// As in the plan.
    pub name: String,
    /// Events with undetermined counted as events.
    pub events_demonstrated: u64,
    /// Events with undetermined counted as none.
    pub events_violated: u64,
    /// Encounters of the stratum.
    pub n: u64,
    /// ln E against p >= p0, its maximum over the looks.
    pub ln_demonstrated_max: f64,
    /// ln E against p <= p0, its maximum over the looks.
    pub ln_violated_max: f64,
    /// Pass: demonstrated. Fail: violated. Inconclusive: not demonstrated.
    pub verdict: LayerVerdict,
    /// Encounters of the stratum still needed at the observed rate.
    pub forecast: Forecast,
}

/// One metric against an older planner.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RatchetResult {
    /// The arm.
    pub arm: String,
    /// The metric.
    pub metric: String,
    /// Counts of the PASS test.
    pub counts: PairedCounts,
    /// The largest ln E over the looks.
    pub ln_pass_max: f64,
    /// The pairs at which it reached 1 / a_P.
    pub passed_at: Option<u64>,
    /// Pairs still needed at the observed rates.
    pub forecast: Forecast,
}
