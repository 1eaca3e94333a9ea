//! Whether a pack is whole: every file there, none too many, none changed.

use crate::pack::Files;
use crate::seal::{MANIFEST, Manifest, STATEMENT, VOLATILE, statement};
use crate::sha256_hex;
use crate::signature::SIGNATURE;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// Something wrong with one file of a pack.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Problem {
    /// Inside the pack.
    pub path: String,
    /// What is wrong with it.
    pub what: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path, self.what)
    }
}

impl Problem {
    fn new(path: &str, what: impl Into<String>) -> Self {
        Self { path: path.to_owned(), what: what.into() }
    }
}

/// A pack without these is not complete.
const REQUIRED: [&str; 12] = [
    MANIFEST,
    STATEMENT,
    "result/runs.parquet",
    "result/summary.json",
    "result/report.html",
    "result/manifest.json",
    "plan/plan.json",
    "sbom.cdx.json",
    "ro-crate-metadata.json",
    "trace-table.csv",
    "argument.svg",
    "evidence.html",
];

#[derive(Deserialize)]
struct Statement {
    subject: Vec<Subject>,
}

#[derive(Deserialize)]
struct Subject {
    name: String,
    digest: BTreeMap<String, String>,
}

/// Everything wrong with the files of a pack; and its manifest, where that can be read.
pub fn inspect(files: &Files) -> (Vec<Problem>, Option<Manifest>) {
    let mut problems: Vec<Problem> = REQUIRED
        .iter()
        .filter(|path| !files.contains_key(**path))
        .map(|path| Problem::new(path, "is missing"))
        .collect();
    let manifest = parse::<Manifest>(files, MANIFEST, &mut problems);
    let stated = parse::<Statement>(files, STATEMENT, &mut problems);
    let actual: BTreeMap<String, String> =
        files.iter().map(|(path, bytes)| (path.clone(), sha256_hex(bytes))).collect();
    if let (Some(stated), Some(manifest)) = (&stated, &manifest) {
        let stated: BTreeMap<String, String> = (stated.subject.iter())
            .map(|s| (s.name.clone(), s.digest.get("sha256").cloned().unwrap_or_default()))
            .collect();
        // made again from its own hashes: nothing else in it may differ
        let again = statement(&stated, manifest);
        if files.get(STATEMENT) != Some(&again) {
            problems.push(Problem::new(
                STATEMENT,
                "was changed: it is not the one made of its own hashes",
            ));
        }
        against_statement(&actual, &stated, manifest, &mut problems);
    }
    if let Some(manifest) = &manifest {
        against_manifest(&actual, manifest, &mut problems);
    }
    problems.sort();
    problems.dedup();
    (problems, manifest)
}

/// The manifest decides who is right about a file that it knows. Of the others (the volatile ones
/// and the manifest) the statement has the only hash, so either may have been changed: both are
/// named.
fn against_statement(
    actual: &BTreeMap<String, String>,
    stated: &BTreeMap<String, String>,
    manifest: &Manifest,
    problems: &mut Vec<Problem>,
) {
    let paths: BTreeSet<&String> = actual.keys().chain(stated.keys()).collect();
    for path in paths {
        if path == STATEMENT || path == SIGNATURE || actual.get(path) == stated.get(path) {
            continue;
        }
        let what = match (actual.get(path), stated.get(path)) {
            (Some(_), Some(_)) => "was changed: its SHA-256 is another",
            (Some(_), None) => "does not belong to the pack",
            (None, _) => "is missing",
        };
        let unknown = path == MANIFEST || VOLATILE.contains(&path.as_str());
        let kept = manifest.files_sha256.get(path) == actual.get(path);
        if unknown || !kept {
            problems.push(Problem::new(path, what));
        }
        if unknown || kept {
            let what = format!("was changed, or {path} was: its hash of {path} is another");
            problems.push(Problem::new(STATEMENT, what));
        }
    }
}

fn against_manifest(
    actual: &BTreeMap<String, String>,
    manifest: &Manifest,
    problems: &mut Vec<Problem>,
) {
    for (path, said) in &manifest.files_sha256 {
        match actual.get(path) {
            None => problems.push(Problem::new(path, "is missing")),
            Some(sha256) if sha256 == said => {}
            Some(_) => problems.push(Problem::new(path, "was changed: its SHA-256 is another")),
        }
    }
    let volatile = |path: &String| path == MANIFEST || VOLATILE.contains(&path.as_str());
    for path in actual.keys().filter(|p| !volatile(p) && !manifest.files_sha256.contains_key(*p)) {
        problems.push(Problem::new(path, "does not belong to the pack"));
    }
}

fn parse<T: for<'a> Deserialize<'a>>(
    files: &Files,
    path: &str,
    problems: &mut Vec<Problem>,
) -> Option<T> {
    let bytes = files.get(path)?;
    match serde_json::from_slice(bytes) {
        Ok(value) => Some(value),
        Err(error) => {
            problems.push(Problem::new(path, format!("was changed: {error}")));
            None
        }
    }
}

/// Files made again against those of the pack.
pub fn compare(files: &Files, again: &Files) -> Vec<Problem> {
    again
        .iter()
        .filter_map(|(path, bytes)| match files.get(path) {
            None => Some(Problem::new(path, "is missing: made again, there is such a file")),
            Some(there) if there == bytes => None,
            Some(there) => {
                let at = there.iter().zip(bytes).position(|(a, b)| a != b);
                let at = at.unwrap_or(there.len().min(bytes.len()));
                Some(Problem::new(path, format!("made again, it differs from byte {at} on")))
            }
        })
        .collect()
}
