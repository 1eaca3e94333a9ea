//! The key of the fresh set: encounters that nobody chose the candidate on.
//!
//! key = BLAKE3("gate-fresh" | campaign hash | hash of the candidate's build and configuration). A
//! commit id, a message or a time never enters, so that the same candidate always meets the same
//! encounters and a retry with nothing changed is no new chance. Source: statistics specification,
//! section 5, item 2.

use crate::spec::GateTable;
use campaign::{Error, Plan};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The key of one fresh set.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct FreshKey(String);

impl FreshKey {
    /// From the campaign's hash and the candidate's.
    pub fn new(campaign_hash: &str, candidate_hash: &str) -> Self {
        let mut hasher = blake3::Hasher::new();
        for part in ["gate-fresh", campaign_hash, candidate_hash] {
            hasher.update(&(part.len() as u64).to_le_bytes());
            hasher.update(part.as_bytes());
        }
        Self(hasher.finalize().to_hex().to_string())
    }

    /// The seed of the fresh encounters: the first 64 bits.
    pub fn seed(&self) -> u64 {
        u64::from_str_radix(&self.0[..16], 16).expect("a hash is hexadecimal")
    }
}

impl fmt::Display for FreshKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// Hash of what encounters are drawn from: the resolved tables and the clock, nothing of the
/// planner, the seed or the build.
pub fn encounter_model(plan: &Plan) -> Result<String, Error> {
    hash(&serde_json::json!({ "source": json(&plan.source)?, "run": json(&plan.run)? }))
}

/// Hash of a gate's campaign: encounters, rule set, and all that is declared but the cap. A larger
/// cap takes the next encounters of the same key.
pub fn campaign_hash(plan: &Plan, table: &GateTable) -> Result<String, Error> {
    let mut gate = json(table)?;
    if let Some(gate) = gate.as_object_mut() {
        gate.remove("cap_pairs");
    }
    hash(&serde_json::json!({
        "campaign": plan.campaign,
        "encounter_model": encounter_model(plan)?,
        "rule_set": plan.rules.hash,
        "gate": gate,
    }))
}

/// Hash of the candidate's build and configuration. `outside` is the content of a planner that
/// lives outside this binary, if it does.
pub fn candidate_hash(plan: &Plan, outside: Option<&[u8]>) -> Result<String, Error> {
    hash(&serde_json::json!({
        "engine": plan.build.engine,
        "planners": plan.build.planners,
        "planner": json(&plan.planner)?,
        "outside": outside.map(|bytes| blake3::hash(bytes).to_hex().to_string()),
    }))
}

fn json<T: Serialize>(value: &T) -> Result<serde_json::Value, Error> {
    serde_json::to_value(value).map_err(|e| Error::Fault(format!("failed to hash: {e}")))
}

fn hash(value: &serde_json::Value) -> Result<String, Error> {
    Ok(blake3::hash(value.to_string().as_bytes()).to_hex().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The border between the parts is part of the key.
    #[test]
    fn the_key_depends_on_each_part_and_on_where_it_ends() {
        let key = FreshKey::new("ab", "c");
        assert_eq!(key, FreshKey::new("ab", "c"));
        assert_ne!(key, FreshKey::new("a", "bc"));
        assert_ne!(key, FreshKey::new("ab", "d"));
        assert_ne!(key.seed(), FreshKey::new("ab", "d").seed());
    }
}
