//! One pass over the rows of a result: all that a pack and its verifier take from them.

use crate::EvidenceError;
use crate::claims::Claims;
use campaign::Plan;
use campaign::cases::Cases;
use record::{EncounterId, RootDigest, RunRow, Status};
use std::path::Path;
use summary::{Findings, Tallies};

/// Longer tables go into the pack as Parquet alone.
const CSV_ROWS_MAX: u64 = 100_000;

/// Rows behind each entry of the list of chunks.
pub(crate) const CHUNK_ROWS: u64 = 4096;

/// What the rows add up to.
#[derive(Debug, Default)]
pub struct Gathered {
    /// One tally for each stratum, draws included.
    pub tallies: Tallies,
    /// BLAKE3 over the digests of all runs.
    pub root_digest: String,
    /// The same over each [`CHUNK_ROWS`] of them, so that a damaged stretch can be told.
    pub chunk_digests: Vec<String>,
    /// What went wrong, clustered.
    pub findings: Findings,
    /// Ids of the runs on which the judges disagree, as many as the summary lists.
    pub disagreements: Vec<String>,
    /// The encounters that a report shows.
    pub cases: Cases,
    /// Rows.
    pub rows: u64,
    /// Encounters with a contact, an unknown outcome, a broken safety radius or a failed check.
    pub failures: Vec<EncounterId>,
    pub(crate) claims: Claims,
    /// The table as text; absent for a long one.
    pub(crate) csv: Option<String>,
}

impl Gathered {
    /// Reads a table. Rejected draws stand in no row: every encounter is drawn again from the
    /// plan, which also shows that the rows are those of the plan, in its order.
    ///
    /// # Errors
    /// The table is damaged, or holds other encounters than the plan asks for.
    pub fn read(table: &Path, plan: &Plan) -> Result<Self, EvidenceError> {
        let rows = table::read_rows(table)?;
        let short = rows.total() <= CSV_ROWS_MAX;
        let mut found = Self { csv: short.then(table::csv_head), ..Self::default() };
        let mut root = RootDigest::new();
        let mut chunk = RootDigest::new();
        let source = plan.encounters_source()?;
        let mut wanted = (0..plan.strata.len() as u32)
            .flat_map(|stratum| (0..plan.encounters_per_stratum).map(move |j| (stratum, j)));
        for row in rows {
            let row = row?;
            let Some((stratum, j)) = wanted.next().filter(|&(s, j)| plan.id(s, j) == row.id) else {
                return Err(other_rows(format!("row {} is not in the plan's order", row.id)));
            };
            let rejected = source.draw(stratum, j)?.rejected;
            found.tallies.stratum_mut(&row.id.stratum).add_draws(1 + rejected, rejected);
            root.push(row.digest);
            chunk.push(row.digest);
            found.offer(&row);
            if found.rows.is_multiple_of(CHUNK_ROWS) {
                found.chunk_digests.push(std::mem::take(&mut chunk).hex());
            }
        }
        if !found.rows.is_multiple_of(CHUNK_ROWS) {
            found.chunk_digests.push(chunk.hex());
        }
        if let Some((stratum, j)) = wanted.next() {
            return Err(other_rows(format!("{} has no row", plan.id(stratum, j))));
        }
        found.root_digest = root.hex();
        Ok(found)
    }

    fn offer(&mut self, row: &RunRow) {
        self.rows += 1;
        self.tallies.add(row);
        self.findings.offer(row);
        summary::list_disagreement(&mut self.disagreements, row);
        self.cases.offer(row);
        self.claims.offer(row);
        let failed = row.checks.iter().any(|cell| cell.status == Status::Fail);
        if row.collided() || row.unknown || row.safety_radius_broken || failed {
            self.failures.push(row.id.clone());
        }
        if let Some(csv) = &mut self.csv {
            csv.push_str(&table::csv_line(row));
        }
    }
}

fn other_rows(problem: String) -> EvidenceError {
    EvidenceError::Form { path: "runs.parquet".to_owned(), problem }
}
