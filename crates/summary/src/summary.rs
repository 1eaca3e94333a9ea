//! `summary.json`, field by field.

use crate::{Tallies, Tally, WeightedSummary};
use record::{Check, EncounterClass, Outcome, RunRow, Seed, Status};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Version of the form of `summary.json`.
pub(crate) const SCHEMA: u32 = 1;

/// What stands above the strata.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SummaryHead {
    /// Name of the campaign.
    pub campaign: String,
    /// Name of the planner, options included.
    pub planner: String,
    /// Seed of the campaign.
    pub seed: Seed,
    /// BLAKE3 over the run digests, hexadecimal.
    pub root_digest: String,
}

/// `summary.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Summary {
    /// Version of this form.
    pub schema: u32,
    /// Name of the campaign.
    pub campaign: String,
    /// Name of the planner, options included.
    pub planner: String,
    /// Seed of the campaign.
    pub seed: Seed,
    /// Rows.
    pub encounters: u64,
    /// BLAKE3 over the run digests in order (stratum, j), hexadecimal.
    pub root_digest: String,
    /// Runs that a limit on the wall clock ended. Another machine might not end them, so with any
    /// of them `root_digest` may differ there; it holds their ids and outcomes alone.
    pub ended_by_wall_clock: u64,
    /// What the second judge said of the first.
    pub second_judge: SecondJudge,
    /// What would have failed under the planner's own classes.
    pub planner_class: PlannerClass,
    /// One entry for each stratum, in the order of the campaign.
    pub strata: Vec<StratumSummary>,
}

/// How often the second, independent judge was asked, and how often it disagreed.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SecondJudge {
    /// Runs that it was asked about.
    pub asked: u64,
    /// Those in which it contradicts a verdict of the first.
    pub disagree: u64,
    /// Their ids in order, the first of them where there are many; the table marks them all.
    pub ids: Vec<String>,
}

/// How often the planner's own class of an encounter is not the judge's, and what follows from it.
/// The table marks those runs (`fails_by_planner_class`). The judge's class decides.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannerClass {
    /// Runs at risk of a planner that states its head-on sector.
    pub stated: u64,
    /// Those in which the class of some target differs.
    pub disagree: u64,
    /// Checks whose number of failures differs, by name: under the judge's class, the planner's.
    pub fails: BTreeMap<String, [u64; 2]>,
}

/// Ids that `summary.json` lists.
const IDS_LISTED: usize = 200;

/// Adds a run to a list of disagreements, if it is one and the list is not full.
pub fn list_disagreement(ids: &mut Vec<String>, row: &RunRow) {
    if row.judges_disagree == Some(true) && ids.len() < IDS_LISTED {
        ids.push(row.id.to_string());
    }
}

impl Summary {
    /// The text of `summary.json`.
    pub fn to_json(&self) -> String {
        let mut text =
            serde_json::to_string_pretty(self).expect("a summary has only string-like keys");
        text.push('\n');
        text
    }

    /// With the ids of the runs on which the judges disagree (see [`list_disagreement`]).
    #[must_use]
    pub fn with_disagreements(mut self, ids: Vec<String>) -> Self {
        self.second_judge.ids = ids;
        self
    }

    /// With the rates of the population, where `weight_max` gives the largest weight that can be
    /// drawn of a stratum.
    #[must_use]
    pub fn with_weights(
        mut self,
        tallies: &Tallies,
        weight_max: impl Fn(&str) -> Option<f64>,
    ) -> Self {
        let empty = Tally::new();
        for stratum in &mut self.strata {
            stratum.weighted = weight_max(&stratum.name).map(|largest| {
                WeightedSummary::new(tallies.stratum(&stratum.name).unwrap_or(&empty), largest)
            });
        }
        self
    }

    /// All rows of a planner whose outcome is unknown.
    pub fn unknown(&self) -> u64 {
        self.strata.iter().map(|stratum| stratum.unknown).sum()
    }
}

/// One stratum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StratumSummary {
    /// Name, as in the campaign file.
    pub name: String,
    /// Rows; every rate has them all below the line.
    pub n: u64,
    /// Draws of the generator, rejected ones included.
    pub generated: u64,
    /// Draws that it rejected.
    pub rejected: u64,
    /// Own ship hit a target.
    pub collision: BoundedRate,
    /// The safety radius was broken.
    pub safety_radius: BoundedRate,
    /// Planner failures and runs cut before CPA.
    pub unknown: u64,
    /// Status of the turn direction check, runs.
    pub turn_direction: BTreeMap<Status, u64>,
    /// From the onset of risk to the first detectable alteration.
    pub reaction_time_s: TimeSummary,
    /// From the onset of risk to the first readily apparent alteration.
    pub apparent_manoeuvre_s: TimeSummary,
    /// Smallest hull-to-hull distance.
    pub min_cpa_m: CpaSummary,
    /// How the runs ended.
    pub outcomes: BTreeMap<Outcome, u64>,
    /// Class found by the judge; runs in which risk never opened are in none.
    pub classes: BTreeMap<EncounterClass, u64>,
    /// Status of every check, runs.
    pub checks: BTreeMap<Check, BTreeMap<Status, u64>>,
    /// Collisions without and with avoiding.
    pub collision_pairs: PairedRates,
    /// Breaches of the safety radius without and with avoiding.
    pub safety_radius_pairs: PairedRates,
    /// Runs that no manoeuvre of own ship could have cleared; absent where none was asked for.
    pub unavoidable: Option<u64>,
    /// The headline rates again without those runs; absent where none was asked for.
    pub without_unavoidable: Option<AvoidableRates>,
    /// What the runs are worth, (sum w)^2 / sum w^2; absent while all weights are 1. Where it is
    /// present the rates above, and their bounds, are shares of the draws, not of the population.
    pub n_effective: Option<f64>,
    /// The rates of the population that the weights stand for; no such key without weights.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weighted: Option<WeightedSummary>,
}

/// The headline rates of the runs that some manoeuvre of own ship could have cleared, and of those
/// that were not searched.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AvoidableRates {
    /// Own ship hit a target.
    pub collision: BoundedRate,
    /// The safety radius was broken.
    pub safety_radius: BoundedRate,
}

/// k events in n runs with exact two-sided 95 % bounds (Clopper-Pearson).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoundedRate {
    /// Events seen.
    pub k: u64,
    /// Runs, unknown ones included.
    pub n: u64,
    /// k / n; absent without runs.
    pub rate: Option<f64>,
    /// Lower bound: unknown runs count as none.
    pub lower_95: f64,
    /// Upper bound: unknown runs count as events.
    pub upper_95: f64,
}

/// A distribution of times, seconds. Runs that never acted count as infinite.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeSummary {
    /// Runs in which risk opened.
    pub n: u64,
    /// Half of the runs acted by then; null where that is never.
    pub median: Option<f64>,
    /// 95 in 100 did; null where that is never.
    pub p95: Option<f64>,
    /// All did; null where one never did.
    pub max: Option<f64>,
    /// Runs that never acted, or had not when they were cut short.
    pub censored: u64,
    /// Runs that acted before risk opened; they count as 0 s.
    pub early: u64,
}

/// Quantiles of the smallest hull-to-hull distance, metres, to 0.1 m. Runs in which it is unknown
/// rank below all others; null where the quantile falls there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CpaSummary {
    /// First percentile.
    pub p01: Option<f64>,
    /// Fifth percentile.
    pub p05: Option<f64>,
    /// Median.
    pub median: Option<f64>,
}

/// What avoiding changed, with exact two-sided 95 % bounds of the risk ratio.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairedRates {
    /// Events of the nominal track.
    pub nominal: u64,
    /// Events of the nominal track that avoiding removed.
    pub removed: u64,
    /// Events that it left.
    pub left: u64,
    /// Events that it caused.
    pub caused: u64,
    /// Neither.
    pub neither: u64,
    /// Runs of unknown outcome.
    pub unknown: u64,
    /// Runs without a nominal track; in none of the others.
    pub without_nominal: u64,
    /// Events with avoiding over events without; null where there was none without.
    pub risk_ratio: Option<f64>,
    /// Lower bound: unknown runs count as no event.
    pub lower_95: Option<f64>,
    /// Upper bound: unknown runs count as events.
    pub upper_95: Option<f64>,
}
