//! `verify`: a pack against itself, against what is made again from its rows, and against the
//! encounters run again.

use super::evidence::{failed, make};
use crate::build;
use crate::exit::Ended;
use crate::rendering::takes_process;
use crate::say::say;
use campaign::worker::{Shop, Worker};
use campaign::{Error, Plan};
use evidence::{
    Files, Gathered, Manifest, Problem, RESULT, SIGNATURE, STATEMENT, SignatureState, VOLATILE,
};
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

/// What was asked for.
#[derive(Debug)]
pub(super) struct Wanted<'a> {
    pub(super) pack: &'a Path,
    /// The line of a minisign public key.
    pub(super) key: Option<&'a str>,
    /// Encounters run again besides the failures.
    pub(super) sample: u64,
    /// Seed of the sample; fresh entropy without one.
    pub(super) seed: Option<u64>,
}

pub(super) fn run(wanted: &Wanted<'_>, registry: Registry) -> Result<Ended, Error> {
    let pack = evidence::read_all(wanted.pack).map_err(failed)?;
    let (mut problems, manifest) = evidence::inspect(&pack);
    say!("files: {} read, {} problems", pack.len(), problems.len());
    let signature = evidence::check_signature(
        pack.get(STATEMENT).map_or(&[], Vec::as_slice),
        pack.get(SIGNATURE).map(Vec::as_slice),
        wanted.key,
    );
    match signature {
        SignatureState::Good => say!("signature: good"),
        SignatureState::Unsigned => {
            say!("signature: none; who can write the folder could have made all of it anew")
        }
        SignatureState::NotChecked => {
            say!("signature: there, not checked; give the public key with --key");
        }
        SignatureState::Bad(why) => {
            problems.push(Problem { path: SIGNATURE.to_owned(), what: why });
        }
    }
    if let (true, Some(manifest)) = (problems.is_empty(), manifest) {
        problems = content(wanted, &pack, &manifest, registry)?;
    } else {
        say!("not made again, not run again: the files are not whole");
    }
    for problem in &problems {
        say!("  {problem}");
    }
    say!("verify: {}", if problems.is_empty() { "ok" } else { "FAILED" });
    Ok(if problems.is_empty() { Ended::Done } else { Ended::Failed })
}

/// Makes everything again from the rows, and runs encounters again.
fn content(
    wanted: &Wanted<'_>,
    pack: &Files,
    manifest: &Manifest,
    registry: Registry,
) -> Result<Vec<Problem>, Error> {
    let plan = pack.get("plan/plan.json").map_or(&[][..], Vec::as_slice);
    let plan: Plan = serde_json::from_slice(plan)
        .map_err(|e| Error::input(format!("plan/plan.json was made by another version: {e}")))?;
    let mut problems = Vec::new();
    let table = wanted.pack.join(RESULT).join("runs.parquet");
    let gathered = Gathered::read(&table, &plan).map_err(failed)?;
    let mut differs = |path: &str, what: &str| {
        problems.push(Problem { path: path.to_owned(), what: what.to_owned() });
    };
    if plan.hash()? != manifest.plan_hash {
        differs("plan/plan.json", "is not the plan whose hash the manifest has");
    }
    if gathered.root_digest != manifest.root_digest {
        differs("result/runs.parquet", "its rows do not have the root digest of the manifest");
    }
    if planner_host::outside(&plan.planner.name).is_some() {
        say!(
            "not run again: planner {} is a program from outside. These rest on the record alone: \
             every outcome, distance and verdict, and with them report, summary and findings",
            plan.planner.name
        );
        return Ok(problems);
    }
    if manifest.build.engine != build::build().engine
        || manifest.build.planners != build::build().planners
    {
        say!(
            "note: the pack was made by engine {} and planners {}; this tool has others, so \
             digests may differ for that reason alone",
            &manifest.build.engine[..12],
            &manifest.build.planners[..12]
        );
    }
    problems.extend(rendered(pack, manifest, &plan, &registry, &table)?);
    problems.extend(run_again(wanted, &plan, &registry, &table, &gathered)?);
    Ok(problems)
}

fn rendered(
    pack: &Files,
    manifest: &Manifest,
    plan: &Plan,
    registry: &Registry,
    table: &Path,
) -> Result<Vec<Problem>, Error> {
    if manifest.renderer != build::RENDERER {
        say!(
            "not rendered again: the pack was rendered by sources {}, this tool has {}; verify \
             with the build of the manifest",
            &manifest.renderer[..12.min(manifest.renderer.len())],
            &build::RENDERER[..12]
        );
        return Ok(Vec::new());
    }
    const TAKEN: [&str; 2] = ["result/runs.parquet", "result/manifest.json"];
    let given: Files = TAKEN
        .iter()
        .filter_map(|path| Some(((*path).to_owned(), pack.get(*path)?.clone())))
        .collect();
    let again = make(plan, registry, table, &given)?;
    let problems = evidence::compare(pack, &again);
    say!("made again from the rows: {} files, {} differ", again.len(), problems.len());
    let extra = pack.keys().filter(|p| !again.contains_key(*p) && !VOLATILE.contains(&p.as_str()));
    let extra = extra.map(|path| Problem {
        path: path.clone(),
        what: "does not belong to a pack of these rows".to_owned(),
    });
    Ok(problems.into_iter().chain(extra).collect())
}

/// Runs failures and a random sample again, on all processors, and compares digests.
fn run_again(
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
    let mut rows: Vec<(RunRow, bool)> = Vec::new();
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
    let lost = rows.iter().filter(|(row, _)| takes_process(row.outcome)).count();
    rows.retain(|(row, _)| !takes_process(row.outcome));
    let differing = differing(plan, registry, &rows)?;
    let sampled = rows.iter().filter(|(_, sampled)| *sampled).count() as u64;
    let bad = differing.iter().filter(|(_, sampled)| *sampled).count() as u64;
    say!(
        "run again: {} encounters, {} failures of {} and a sample of {sampled} (seed {seed}); \
         {} differ",
        rows.len(),
        failures.len(),
        gathered.failures.len(),
        differing.len()
    );
    if lost > 0 {
        say!("  not run again: {lost} in which the planner takes its process with it");
    }
    if sampled > 0 {
        let upper = stats::clopper_pearson_upper(bad, sampled, 1.0 - CONFIDENCE)
            .map_err(|e| Error::Fault(e.to_string()))?;
        say!(
            "  at {:.0} % confidence at most {:.3} % of all {} encounters could differ",
            100.0 * CONFIDENCE,
            100.0 * if sampled == gathered.rows { bad as f64 / sampled as f64 } else { upper },
            gathered.rows
        );
    }
    Ok(differing
        .into_iter()
        .map(|(id, _)| Problem {
            path: "result/runs.parquet".to_owned(),
            what: format!("{id} run again gives another row"),
        })
        .collect())
}

/// The encounters whose row is another when they are run again, in the order of the rows.
fn differing(
    plan: &Plan,
    registry: &Registry,
    rows: &[(RunRow, bool)],
) -> Result<Vec<(EncounterId, bool)>, Error> {
    let shop = Shop::new(plan, registry)?;
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let share = rows.len().div_ceil(threads).max(1);
    let work = |rows: &[(RunRow, bool)]| -> Result<Vec<(EncounterId, bool)>, Error> {
        let mut worker = Worker::new(&shop)?;
        let mut found = Vec::new();
        for (row, sampled) in rows {
            let stratum = plan
                .stratum_of(&row.id)
                .ok_or_else(|| Error::input(format!("{} is no encounter of the plan", row.id)))?;
            let again = worker.run(stratum, row.id.j, &AtomicU64::new(0))?;
            // the digest is of the trace; the row holds the verdicts too
            if again.row != *row {
                found.push((row.id.clone(), *sampled));
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
