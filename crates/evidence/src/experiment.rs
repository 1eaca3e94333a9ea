//! What the manifest says of the experiment itself: what was run, by which models, how it was to be
//! counted, and what was left without an outcome (statistics specification, section 6).

use crate::EvidenceError;
use crate::change::PREVIOUS;
use crate::gathered::{CHUNK_ROWS, Gathered};
use crate::pack::Files;
use crate::sections::BUILD;
use crate::sha256_hex;
use campaign::Plan;
use record::{Outcome, Status};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The part of the manifest that an assessor compares with the claim.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// Target, profile and flags that the tool was built with.
    pub built: BTreeMap<String, String>,
    /// SHA-256 of the planner's options as JSON.
    pub planner_options_sha256: String,
    /// SHA-256 of the files of a planner from outside, by the words of its name.
    pub planner_files_sha256: BTreeMap<String, String>,
    /// Rule set, and the BLAKE3 of its text.
    pub rules: (String, String),
    /// SHA-256 of the encounter model as JSON: strata, laws, vessels, sensing, weather, hazards.
    pub encounter_model_sha256: String,
    /// Encounters asked for of each stratum; ids count from 0.
    pub encounters_of_each: BTreeMap<String, u64>,
    /// Clock, limits and margins of every run.
    pub run: serde_json::Value,
    /// How rates are bounded and when the campaign ends.
    pub statistics: Statistics,
    /// Runs by outcome.
    pub outcomes: BTreeMap<Outcome, u64>,
    /// Runs without a known outcome; none is left out of a denominator.
    pub unknown: u64,
    /// Verdicts that could not be decided, by check.
    pub inconclusive: BTreeMap<record::Check, u64>,
    /// BLAKE3 over the digests of each so many rows.
    pub chunk_rows: u64,
    /// See `chunk_rows`.
    pub chunk_digests: Vec<String>,
    /// SHA-256 of the manifest of the pack before, where one was named.
    pub previous_manifest_sha256: Option<String>,
}

/// The statistical plan of a campaign, the same for all.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statistics {
    /// Kind of the intervals.
    pub interval: String,
    /// Confidence of each, two-sided.
    pub confidence: f64,
    /// Claims that are bounded, each by itself: no correction for their number.
    pub claims: usize,
    /// Looks at the data.
    pub looks: u32,
    /// When the campaign ends.
    pub stop_rule: String,
}

impl Experiment {
    pub(crate) fn new(
        plan: &Plan,
        gathered: &Gathered,
        files: &Files,
    ) -> Result<Self, EvidenceError> {
        let json = plan.json()?;
        let sha256 = |value: &serde_json::Value| sha256_hex(value.to_string().as_bytes());
        let built = files.get(BUILD).map(|bytes| serde_json::from_slice(bytes));
        let built = built
            .transpose()
            .map_err(|e| EvidenceError::Form { path: BUILD.to_owned(), problem: e.to_string() })?;
        let total = gathered.tallies.total();
        let each = |name: &String| (name.clone(), plan.encounters_per_stratum);
        let inconclusive = record::Check::ALL
            .map(|check| (check, total.check(check, Status::Inconclusive)))
            .into_iter()
            .filter(|(_, n)| *n > 0);
        let outcomes = Outcome::ALL
            .into_iter()
            .map(|outcome| (outcome, total.outcome(outcome)))
            .filter(|(_, n)| *n > 0);
        Ok(Self {
            built: built.unwrap_or_default(),
            planner_options_sha256: sha256(&json["planner"]["options"]),
            planner_files_sha256: plan.planner.files_sha256.clone(),
            rules: (plan.rules.name.clone(), plan.rules.hash.clone()),
            encounter_model_sha256: sha256(&json["source"]),
            encounters_of_each: plan.strata.iter().map(each).collect(),
            run: json["run"].clone(),
            statistics: Statistics {
                interval: "Clopper-Pearson, two-sided; unknown runs count as events in the upper \
                           bound and as none in the lower"
                    .to_owned(),
                confidence: 0.95,
                claims: gathered.claims.list().len(),
                looks: 1,
                stop_rule: "after the last encounter of the plan".to_owned(),
            },
            outcomes: outcomes.collect(),
            unknown: total.unknown,
            inconclusive: inconclusive.collect(),
            chunk_rows: CHUNK_ROWS,
            chunk_digests: gathered.chunk_digests.clone(),
            previous_manifest_sha256: files.get(PREVIOUS[0]).map(|bytes| sha256_hex(bytes)),
        })
    }
}
