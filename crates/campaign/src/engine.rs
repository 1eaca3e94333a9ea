//! The engine process: workers that run parts, and a watchdog.
//!
//! It is the same binary as the supervisor's, so that a planner which aborts, overflows its stack
//! or never returns takes only this process with it. What it says on standard output is one line
//! for each finished part; what it knows survives in files.

use crate::inflight::InFlight;
use crate::part::{self, PartKey};
use crate::supervisor::Lost;
use crate::worker::{Shop, Worker, run_part};
use crate::{Error, Folder, Plan, supervisor};
use planner_api::Registry;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Exit code of an engine that found a planner call which does not return.
pub const EXIT_HUNG: u8 = 75;

/// How often the watchdog looks.
const WATCH_EVERY: Duration = Duration::from_millis(100);

/// Runs the missing parts among `keys` in this process.
///
/// # Errors
/// The first error of any worker; parts that were finished stay.
pub fn run(
    plan: &Plan,
    folder: &Folder,
    registry: &Registry,
    keys: &[PartKey],
    threads: usize,
) -> Result<(), Error> {
    let lost = read_lost(folder)?;
    let lost = |stratum, j| lost.get(&(stratum, j));
    let inflight = InFlight::create(&folder.inflight(), threads)?;
    let shop = Shop::new(plan, registry)?;
    let next = AtomicUsize::new(0);
    let stop = AtomicBool::new(false);
    let failed: Mutex<Option<Error>> = Mutex::new(None);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|e| Error::Fault(format!("failed to start {threads} workers: {e}")))?;
    let work = |slot: usize| -> Result<(), Error> {
        watch_for_panics(&inflight.slot(slot).beat);
        let mut worker = Worker::new(&shop)?;
        while !stop.load(Ordering::Relaxed) {
            let Some(&key) = keys.get(next.fetch_add(1, Ordering::Relaxed)) else { break };
            let part = run_part(&mut worker, key, (&inflight, slot), &lost)?;
            part::write(&folder.parts(), folder.plan_hash(), key, &part)?;
            report_part(key, part.rows.len());
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        scope.spawn(|| watch(&inflight, plan.run.planner_hang_limit_s, &stop));
        pool.broadcast(|context| {
            if let Err(error) = work(context.index()) {
                stop.store(true, Ordering::Relaxed);
                failed.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            }
        });
        stop.store(true, Ordering::Relaxed);
    });
    failed.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
}

/// Runs one encounter alone and stores nothing: the supervisor wants to know how it ends.
pub fn run_suspect(
    plan: &Plan,
    registry: &Registry,
    scratch: &std::path::Path,
    suspect: (u32, u64),
) -> Result<(), Error> {
    let inflight = InFlight::create(scratch, 1)?;
    let shop = Shop::new(plan, registry)?;
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| watch(&inflight, plan.run.planner_hang_limit_s, &stop));
        watch_for_panics(&inflight.slot(0).beat);
        let ended = Worker::new(&shop)
            .and_then(|mut worker| worker.run(suspect.0, suspect.1, &inflight.slot(0).beat));
        stop.store(true, Ordering::Relaxed);
        ended.map(drop)
    })
}

/// Ends the process when a planner call lasts too long: a thread cannot be killed.
fn watch(inflight: &InFlight, limit_s: f64, stop: &AtomicBool) {
    let looks_max = (limit_s / WATCH_EVERY.as_secs_f64()).ceil() as u64;
    let mut seen: Vec<(u64, u64)> = vec![(0, 0); inflight.slots().len()];
    while !stop.load(Ordering::Relaxed) {
        std::thread::sleep(WATCH_EVERY);
        for (slot, (beat, looks)) in inflight.slots().iter().zip(&mut seen) {
            let now = slot.beat.load(Ordering::Relaxed);
            let in_planner = now % 2 == 1;
            *looks = if in_planner && now == *beat { *looks + 1 } else { 0 };
            *beat = now;
            if *looks >= looks_max {
                std::process::exit(i32::from(EXIT_HUNG));
            }
        }
    }
}

/// Ends this process when the supervisor is gone: its end of our standard input closes.
pub fn die_with_supervisor() {
    std::thread::spawn(|| {
        let mut byte = [0];
        while matches!(std::io::stdin().read(&mut byte), Ok(1)) {}
        std::process::exit(1);
    });
}

thread_local! {
    /// The beat counter of the worker on this thread: odd while its planner is thinking.
    static BEAT: RefCell<Option<Arc<AtomicU64>>> = const { RefCell::new(None) };
}

pub(crate) fn watch_for_panics(beat: &Arc<AtomicU64>) {
    BEAT.with_borrow_mut(|mine| *mine = Some(Arc::clone(beat)));
}

/// Keeps panics of planners off the terminal: they are data. Panics of the bench itself are shown.
pub fn quiet_planner_panics() {
    let show = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        let in_planner = BEAT.with_borrow(|beat| {
            beat.as_ref().is_some_and(|beat| beat.load(Ordering::Relaxed) % 2 == 1)
        });
        if !in_planner {
            show(info);
        }
    }));
}

/// What an engine says last when it ends of its own will.
pub(crate) const FAREWELL: &str = "engine ends";

/// Says so. A library that calls `exit` would otherwise pass for an engine that has done its work.
pub fn say_farewell() {
    // a supervisor that no longer listens is gone
    drop(std::io::stdout().lock().write_all(format!("\n{FAREWELL}\n").as_bytes()));
}

fn report_part(key: PartKey, rows: usize) {
    let line = format!("part {} {} {rows}\n", key.stratum, key.piece);
    // a supervisor that no longer listens is gone; the watch on standard input ends us then
    drop(std::io::stdout().lock().write_all(line.as_bytes()));
}

fn read_lost(folder: &Folder) -> Result<BTreeMap<(u32, u64), Lost>, Error> {
    let lost = supervisor::read_lost(folder)?;
    Ok(lost.into_iter().map(|lost| ((lost.stratum, lost.j), lost)).collect())
}
