//! The manifest and the statement: hashes of everything.
//!
//! `manifest.json` has the hash of every file that two packs of one result share.
//! `statement.intoto.json` (in-toto Statement v1) has the hash of every file, the manifest and the
//! [`VOLATILE`] ones included, and is what a signature covers. Both are functions of the files
//! alone, so a verifier makes them again and compares bytes.

use crate::experiment::Experiment;
use crate::gathered::Gathered;
use crate::pack::{Files, pretty};
use crate::signature::SIGNATURE;
use crate::{EvidenceError, sha256_hex};
use campaign::Plan;
use campaign::plan::Build;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::collections::BTreeMap;

/// The manifest, inside the pack.
pub const MANIFEST: &str = "manifest.json";
/// The statement, inside the pack.
pub const STATEMENT: &str = "statement.intoto.json";
/// RO-Crate metadata, inside the pack.
pub const RO_CRATE: &str = "ro-crate-metadata.json";
/// The wall clock of the campaign, inside the pack.
pub const TIMING: &str = "result/timing.json";
/// The only files that may differ between two packs of one campaign: the wall clock of the
/// campaign, its date in the RO-Crate metadata, the date that a browser writes into a PDF, and what
/// hashes or signs these.
pub const VOLATILE: [&str; 5] = [TIMING, "evidence.pdf", RO_CRATE, STATEMENT, SIGNATURE];

/// `manifest.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Version of this form.
    pub schema: u32,
    /// Name of the tool.
    pub tool: String,
    /// What made the result, and this pack.
    pub build: Build,
    /// Hash of the sources that render reports and packs: two builds that share it render alike.
    pub renderer: String,
    /// Name of the campaign.
    pub campaign: String,
    /// The planner.
    pub planner: String,
    /// Seed.
    pub seed: record::Seed,
    /// BLAKE3 of the plan, taken before the first encounter was run.
    pub plan_hash: String,
    /// BLAKE3 over the digests of all runs.
    pub root_digest: String,
    /// Rows.
    pub encounters: u64,
    /// What was run, and how it was to be counted.
    pub experiment: Experiment,
    /// Files that may differ between two packs of one result.
    pub declared_to_differ: Vec<String>,
    /// SHA-256 of every other file.
    pub files_sha256: BTreeMap<String, String>,
}

/// Adds the manifest to the files.
///
/// # Errors
/// The plan cannot be hashed.
pub fn seal(
    files: &mut Files,
    plan: &Plan,
    gathered: &Gathered,
    renderer: &str,
) -> Result<(), EvidenceError> {
    let stable = files.iter().filter(|(path, _)| !VOLATILE.contains(&path.as_str()));
    let manifest = Manifest {
        schema: 2,
        tool: "seatrial".to_owned(),
        build: plan.build.clone(),
        renderer: renderer.to_owned(),
        campaign: plan.campaign.clone(),
        planner: plan.planner.name.clone(),
        seed: plan.seed,
        plan_hash: plan.hash()?,
        root_digest: gathered.root_digest.clone(),
        encounters: gathered.rows,
        experiment: Experiment::new(plan, gathered, files)?,
        declared_to_differ: VOLATILE.map(str::to_owned).to_vec(),
        files_sha256: stable.map(|(path, bytes)| (path.clone(), sha256_hex(bytes))).collect(),
    };
    files.insert(MANIFEST.to_owned(), pretty(&manifest).into_bytes());
    Ok(())
}

/// The statement about these files, itself and its signature left out.
pub fn statement(hashes: &BTreeMap<String, String>, manifest: &Manifest) -> Vec<u8> {
    let subjects: Vec<serde_json::Value> = hashes
        .iter()
        .filter(|(path, _)| *path != STATEMENT && *path != SIGNATURE)
        .map(|(path, sha256)| json!({ "name": path, "digest": { "sha256": sha256 } }))
        .collect();
    let statement = json!({
        "_type": "https://in-toto.io/Statement/v1",
        "subject": subjects,
        "predicateType": "https://slsa.dev/provenance/v1",
        "predicate": {
            "buildDefinition": {
                "buildType": "seatrial campaign",
                "externalParameters": {
                    "campaign": manifest.campaign,
                    "planner": manifest.planner,
                    "seed": manifest.seed,
                    "plan_hash": manifest.plan_hash,
                },
                "resolvedDependencies": [{
                    "name": "seatrial",
                    "digest": { "gitCommit": manifest.build.git_commit },
                }],
            },
            "runDetails": { "builder": {
                "id": "seatrial",
                "version": { "seatrial": manifest.build.tool_version },
            }},
        },
    });
    pretty(&statement).into_bytes()
}
