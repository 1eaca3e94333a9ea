//! `verify`, its last part: failures and a random sample of the encounters are run again.

use super::verify::Wanted;
use super::verify_lost;
use crate::rendering::takes_process;
use crate::say::say;
use campaign::worker::{Shop, Worker};
use campaign::{Error, Plan};
use evidence::{Gathered, Problem};
use planner_api::Registry;
use record::{EncounterId, RunRow};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicU64;

/// Failures run again at most; a sample of the others is run again whatever their number.
const FAILURES_MAX: usize = 10_000;
/// Confidence of the bound on the share that could differ.
const CONFIDENCE: f64 = 0.95;

/// Runs failures and a random sample again, on all processors, and compares digests.
pub(super) fn run_again(
    wanted: &Wanted<'_>,
    plan: &Plan,
    registry: &Registry,
    table: &Path,
    gathered: &Gathered,
) -> Result<Vec<Problem>, Error> {
    let seed = match wanted.seed {
        Some(seed) => seed,
        None => entropy()?,
    };
    let mut sample: BTreeSet<u64> = BTreeSet::new();
    let n = wanted.sample.min(gathered.rows);
    let mut draws = 0;
    // distinct rows; each draw is a hash of seed and count, so the printed seed gives them again
    while (sample.len() as u64) < n {
        sample.insert(draw(seed, draws) % gathered.rows);
        draws += 1;
    }
    let failures: BTreeSet<&EncounterId> = gathered.failures.iter().take(FAILURES_MAX).collect();
    let mut rows: Vec<Chosen> = Vec::new();
    for (index, row) in
        table::read_rows(table).map_err(|e| Error::input(e.to_string()))?.enumerate()
    {
        let row = row.map_err(|e| Error::input(e.to_string()))?;
        let sampled = sample.contains(&(index as u64));
        if sampled || failures.contains(&row.id) {
            rows.push((row, sampled));
        }
    }
    campaign::engine::quiet_planner_panics();
    let (lost, rows): (Vec<_>, Vec<_>) =
        rows.into_iter().partition(|(row, _)| takes_process(row.outcome));
    let mut differing = differing(plan, registry, &rows)?;
    let run = rows.iter().filter(|(_, sampled)| *sampled).count();
    say!(
        "run again: {} encounters, {} failures of {} and a sample of {run} (seed {seed}); \
         {} differ",
        rows.len(),
        failures.len(),
        gathered.failures.len(),
        differing.len()
    );
    let lost = verify_lost::run_again(plan, &lost)?;
    differing.extend(lost.differing);
    let bad = differing.iter().filter(|found| found.sampled).count() as u64;
    say_bound((bad, lost.unknown, n), gathered.rows)?;
    let problem =
        |found: Differing| Problem { path: "result/runs.parquet".to_owned(), what: found.what };
    Ok(differing.into_iter().map(problem).collect())
}

/// What a sample says of all rows: `bad` of `n` differ, `unknown` were not run again and may.
fn say_bound((bad, unknown, n): (u64, u64, u64), rows: u64) -> Result<(), Error> {
    if n == 0 {
        return Ok(());
    }
    let most = bad + unknown;
    let upper = stats::clopper_pearson_upper(most, n, 1.0 - CONFIDENCE)
        .map_err(|e| Error::Fault(e.to_string()))?;
    say!(
        "  at {:.0} % confidence at most {:.3} % of all {rows} encounters could differ",
        100.0 * CONFIDENCE,
        100.0 * if n == rows { most as f64 / n as f64 } else { upper }
    );
    if unknown > 0 {
        say!("  ({unknown} of the sample were not run again and count as differing)");
    }
    Ok(())
}

/// A row that is to be made again, and whether it is one of the sample.
pub(super) type Chosen = (RunRow, bool);

/// An encounter that gave another row.
pub(super) struct Differing {
    pub(super) sampled: bool,
    pub(super) what: String,
}

impl Differing {
    fn new(stored: &RunRow, again: &RunRow, sampled: bool) -> Self {
        let mut what = format!("{} run again gives another row", stored.id);
        if stored.outcome != again.outcome {
            what += &format!(": {}, not {}", again.outcome.name(), stored.outcome.name());
            // a planner that does not even start on this machine says so here
            if let Some(words) = &again.planner_detail {
                what += &format!(" (the planner's last words: {words})");
            }
        } else if stored.digest == again.digest {
            what += ", by the same track: its verdicts or numbers are others";
        }
        Self { sampled, what }
    }
}

/// The encounters whose row is another when they are run again, in the order of the rows.
fn differing(plan: &Plan, registry: &Registry, rows: &[Chosen]) -> Result<Vec<Differing>, Error> {
    let shop = Shop::new(plan, registry)?;
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let share = rows.len().div_ceil(threads).max(1);
    let work = |rows: &[Chosen]| -> Result<Vec<Differing>, Error> {
        let mut worker = Worker::new(&shop)?;
        let mut found = Vec::new();
        for (row, sampled) in rows {
            let stratum = plan
                .stratum_of(&row.id)
                .ok_or_else(|| Error::input(format!("{} is no encounter of the plan", row.id)))?;
            let again = worker.run(stratum, row.id.j, &AtomicU64::new(0))?;
            // the digest is of the trace; the row holds the verdicts too
            if again.row != *row {
                found.push(Differing::new(row, &again.row, *sampled));
            }
        }
        Ok(found)
    };
    std::thread::scope(|scope| {
        let handles: Vec<_> =
            rows.chunks(share).map(|rows| scope.spawn(move || work(rows))).collect();
        let mut found = Vec::new();
        for handle in handles {
            let part = handle.join().map_err(|_| Error::Fault("a worker panicked".to_owned()))?;
            found.extend(part?);
        }
        Ok(found)
    })
}

/// Fresh entropy from the system, the only place of this tool that asks for it: who made the pack
/// must not know which encounters will be looked at.
fn entropy() -> Result<u64, Error> {
    let path = Path::new("/dev/urandom");
    let mut file = fs::File::open(path).map_err(Error::io("read", path))?;
    let mut bytes = [0; 8];
    std::io::Read::read_exact(&mut file, &mut bytes).map_err(Error::io("read", path))?;
    Ok(u64::from_le_bytes(bytes))
}

fn draw(seed: u64, count: u64) -> u64 {
    let text = format!("seatrial verify v1 {seed} {count}");
    let hash = evidence::sha256_hex(text.as_bytes());
    u64::from_str_radix(&hash[..16], 16).unwrap_or_default()
}
