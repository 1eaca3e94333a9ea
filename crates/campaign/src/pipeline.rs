//! The way of the data, in order; the first file to read.
//!
//! ```text
//! campaign file -> plan -> [ encounter -> trace -> verdicts -> row ] -> parts -> table, summary
//!    spec.rs      plan.rs   encounter     sim     rules    row.rs    part.rs   table, summary
//! ```
//!
//! The bracket is run once for every encounter, by the workers of an engine process
//! (`worker.rs`, `engine.rs`) that a supervisor keeps alive (`supervisor.rs`). Everything after
//! the parts reads them one by one in order, so memory does not grow with their number.

use crate::cases::Cases;
use crate::part::{self, PartKey};
use crate::supervisor::Supervisor;
use crate::{Error, Folder, Plan};
use record::{RootDigest, RunRow};
use std::path::PathBuf;
use summary::{Findings, Tallies};

/// A part that was read: where it lies, and its rows.
#[derive(Debug)]
pub struct PartRead {
    /// Which part.
    pub key: PartKey,
    /// The folder of its file.
    pub folder: PathBuf,
    /// BLAKE3 of its file, hexadecimal.
    pub blake3: String,
    /// Its rows, in the order of j.
    pub rows: Vec<RunRow>,
}

/// Where the rows of parts go, in order (stratum, j).
pub trait RowSink {
    /// The next part.
    fn push(&mut self, part: PartRead) -> Result<(), Error>;
}

/// What all parts of a result add up to.
#[derive(Debug)]
pub struct Finished {
    /// One tally for each stratum, by name.
    pub tallies: Tallies,
    /// BLAKE3 over the digests of all runs, in order.
    pub root_digest: String,
    /// Rows.
    pub encounters: u64,
    /// The encounters that a report shows.
    pub cases: Cases,
    /// What went wrong, clustered.
    pub findings: Findings,
    /// Ids of the runs on which the judges disagree, as many as the summary lists.
    pub disagreements: Vec<String>,
}

/// The parts of shard `index` (from 1) of `of`; `(1, 1)` is all of them.
pub fn shard_keys(plan: &Plan, (index, of): (u64, u64)) -> Vec<PartKey> {
    PartKey::all(plan.strata.len(), plan.encounters_per_stratum)
        .enumerate()
        .filter(|(i, _)| *i as u64 % of == index - 1)
        .map(|(_, key)| key)
        .collect()
}

/// Encounters to rows: runs the missing parts of a shard, under supervision.
pub fn run_parts(
    plan: &Plan,
    folder: &Folder,
    shard: (u64, u64),
    supervisor: &Supervisor<'_>,
) -> Result<(), Error> {
    supervisor.run(plan, folder, &shard_keys(plan, shard))
}

/// Parts to table, tallies and root digest: one pass in order.
pub fn finish(plan: &Plan, folder: &Folder, sink: &mut dyn RowSink) -> Result<Finished, Error> {
    let mut tallies = Tallies::new();
    let mut root = RootDigest::new();
    let mut cases = Cases::default();
    let mut findings = Findings::default();
    let mut disagreements = Vec::new();
    let mut encounters = 0;
    for key in shard_keys(plan, (1, 1)) {
        let place = folder.parts_of(key);
        let (part, blake3) = part::read(&place, folder.plan_hash(), key)?;
        for row in &part.rows {
            root.push(row.digest);
            cases.offer(row);
            findings.offer(row);
            summary::list_disagreement(&mut disagreements, row);
        }
        tallies.stratum_mut(&plan.strata[key.stratum as usize]).merge(&part.tally);
        encounters += part.rows.len() as u64;
        sink.push(PartRead { key, folder: place, blake3, rows: part.rows })?;
    }
    let root_digest = root.hex();
    Ok(Finished { tallies, root_digest, encounters, cases, findings, disagreements })
}
