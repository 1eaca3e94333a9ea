//! What changed since another pack: its manifest and summary, taken into this pack, beside ours.

use crate::pack::{Files, PackInput};
use crate::seal::Manifest;
use crate::{EvidenceError, sha256_hex};
use serde::Serialize;
use summary::{BoundedRate, Summary};

/// Manifest and summary of the pack before, inside this one.
pub const PREVIOUS: [&str; 2] = ["previous/manifest.json", "previous/summary.json"];

/// Two packs side by side.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Change {
    /// SHA-256 of the manifest of the pack before.
    pub(crate) manifest_sha256: String,
    /// What decides a number: name, before, now, and whether they are the same.
    pub(crate) identities: Vec<(&'static str, String, String, bool)>,
    /// Name, before, now.
    pub(crate) rates: Vec<(&'static str, String, String)>,
}

/// Absent where no pack before was named.
pub(crate) fn change(input: &PackInput<'_>) -> Result<Option<Change>, EvidenceError> {
    let Some(manifest) = input.given.get(PREVIOUS[0]) else { return Ok(None) };
    let manifest_sha256 = sha256_hex(manifest);
    let before: Manifest = parse(input.given, PREVIOUS[0])?;
    let (before_build, build) = (&before.build, &input.plan.build);
    let plan_hash = input.plan.hash()?;
    let pair =
        |name, before: &str, now: &str| (name, before.to_owned(), now.to_owned(), before == now);
    let identities = vec![
        pair("commit", &before_build.git_commit, &build.git_commit),
        pair("engine", &before_build.engine, &build.engine),
        pair("planners of the registry", &before_build.planners, &build.planners),
        pair("planner", &before.planner, &input.plan.planner.name),
        pair("campaign", &before.campaign, &input.plan.campaign),
        pair("seed", &before.seed.to_string(), &input.plan.seed.to_string()),
        pair("plan", &before.plan_hash, &plan_hash),
        pair("root digest", &before.root_digest, &input.gathered.root_digest),
    ];
    let before: Summary = parse(input.given, PREVIOUS[1])?;
    let now = input.report.summary;
    let whole = |summary: &Summary, of: fn(&summary::StratumSummary) -> BoundedRate| {
        let rates = summary.strata.iter().map(of);
        let (k, n) = rates.fold((0, 0), |(k, n), rate| (k + rate.k, n + rate.n));
        format!("{k} of {n}")
    };
    let rate = |name, of: fn(&summary::StratumSummary) -> BoundedRate| {
        (name, whole(&before, of), whole(now, of))
    };
    let rates = vec![
        rate("collisions", |s| s.collision),
        rate("safety radius broken", |s| s.safety_radius),
        ("outcome unknown", before.unknown().to_string(), now.unknown().to_string()),
    ];
    Ok(Some(Change { manifest_sha256, identities, rates }))
}

pub(crate) fn parse<T: for<'a> serde::Deserialize<'a>>(
    files: &Files,
    path: &str,
) -> Result<T, EvidenceError> {
    let bytes = files.get(path).map_or(&[][..], Vec::as_slice);
    serde_json::from_slice(bytes)
        .map_err(|e| EvidenceError::Form { path: path.to_owned(), problem: e.to_string() })
}
