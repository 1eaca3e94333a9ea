//! What an encounter costs in the engine, and what its part costs on the way to disk and back:
//! `cargo run --config .cargo/optimised.toml -p campaign --example part_cost -- FILE.toml N`
//!
//! One worker runs the first N encounters (at most a part) of every stratum for the file's first
//! planner, as an engine process does; then the parts are written, and read and added up as a merge
//! does. Milliseconds and microseconds of this thread's processor for each encounter.
#![forbid(unsafe_code)]

mod common;

use campaign::folder::Opened;
use campaign::inflight::InFlight;
use campaign::part::{self, PART_ENCOUNTERS};
use campaign::worker::{Shop, Worker, run_part};
use campaign::{Error, Folder, Overrides, PartRead, RowSink, finish, pipeline};
use std::path::Path;

/// Reading is fast, and the clock of a thread moves with the scheduler's ticks.
const READINGS: u64 = 50;

/// Takes rows and keeps none.
struct Counted(u64);

impl RowSink for Counted {
    fn push(&mut self, part: PartRead) -> Result<(), Error> {
        self.0 += part.rows.len() as u64;
        Ok(())
    }
}

fn main() -> Result<(), Error> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let usage = || Error::input("usage: part_cost CAMPAIGN.toml PER_STRATUM");
    let [file, n] = &words[..] else { return Err(usage()) };
    let n = n.parse().ok().filter(|n| (1..=PART_ENCOUNTERS).contains(n)).ok_or_else(usage)?;
    let registry = planners::registry();
    let overrides = Overrides { encounters: Some(n), ..Overrides::default() };
    let plan = common::plans(file, &overrides, &registry, |_| ())?.remove(0);
    let made = tempfile::tempdir().map_err(Error::io("make", Path::new("a folder")))?;
    let (Opened::Ready(folder) | Opened::Finished(folder)) =
        Folder::open(made.path(), &plan, false, false)?;

    let inflight = InFlight::create(&folder.inflight(), 1)?;
    let shop = Shop::new(&plan, &registry)?;
    let mut worker = Worker::new(&shop)?;
    let (mut run_s, mut write_s) = (0.0, 0.0);
    for key in pipeline::shard_keys(&plan, (1, 1)) {
        let before_s = clock_s();
        let part = run_part(&mut worker, key, (&inflight, 0), &|_, _| None)?;
        let run_until_s = clock_s();
        part::write(&folder.parts(), folder.plan_hash(), key, &part)?;
        run_s += run_until_s - before_s;
        write_s += clock_s() - run_until_s;
    }
    let before_s = clock_s();
    let mut counted = Counted(0);
    let mut root_digest = String::new();
    for _ in 0..READINGS {
        root_digest = finish(&plan, &folder, &mut counted)?.root_digest;
    }
    let read_s = (clock_s() - before_s) / READINGS as f64;
    let encounters = plan.encounters();
    assert_eq!(counted.0, READINGS * encounters);
    let each = |seconds: f64, unit: f64| seconds * unit / encounters as f64;
    println!(
        "{encounters} encounters of {} with {}: run {:.3} ms, part written {:.2} us, read and \
         added up {:.2} us each; root digest {root_digest}",
        plan.campaign,
        plan.planner.name,
        each(run_s, 1e3),
        each(write_s, 1e6),
        each(read_s, 1e6),
    );
    Ok(())
}

/// Time that this thread had a processor; the machine may be busy with other work.
fn clock_s() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let ns: f64 = text.split(' ').next().and_then(|ns| ns.parse().ok()).unwrap_or(f64::NAN);
    ns * 1e-9
}
