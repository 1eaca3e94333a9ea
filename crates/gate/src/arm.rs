//! One planner of the gate, asked for the outcomes of encounters by their place in the campaign.
//!
//! Place i has stratum i mod S and number i div S, so that the places cycle through all strata in
//! a fixed pattern. Rows come back in the order of the places, whatever the order of completion.

use campaign::worker::{Shop, Worker};
use campaign::{Error, Plan};
use record::{Check, Digest, DistanceKind, EncounterId, Outcome, RunRow, Status};
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// What the gate needs of one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArmRow {
    /// Place in the campaign, from 0.
    pub id: u64,
    /// How it ended.
    pub outcome: Outcome,
    /// Digest of the trace.
    pub digest: Digest,
    /// The planner failed, or the run was cut before its closest point.
    pub unknown: bool,
    /// Closer than the safety radius.
    pub safety_radius_broken: bool,
    /// Smallest distance in the campaign's kind, metres.
    pub cpa_m: Option<f64>,
    /// One status for each check, in the order of `Check::ALL`; empty where nothing was judged.
    pub statuses: Vec<Status>,
}

impl ArmRow {
    /// Of a whole row.
    pub fn of(id: u64, row: &RunRow, distance: DistanceKind) -> Self {
        Self {
            id,
            outcome: row.outcome,
            digest: row.digest,
            unknown: row.unknown,
            safety_radius_broken: row.safety_radius_broken,
            cpa_m: match distance {
                DistanceKind::Hull => row.cpa_hull_m,
                DistanceKind::Centre => row.cpa_centre_m,
            },
            statuses: row.checks.iter().map(|cell| cell.status).collect(),
        }
    }

    /// Of a run that took its process with it.
    pub fn lost(id: u64, encounter: &EncounterId, outcome: Outcome) -> Self {
        Self {
            id,
            outcome,
            digest: Digest::of_lost_run(encounter, outcome),
            unknown: true,
            safety_radius_broken: false,
            cpa_m: None,
            statuses: Vec::new(),
        }
    }

    /// What a check said.
    pub fn status(&self, check: Check) -> Status {
        self.statuses.get(check as usize).copied().unwrap_or(Status::NotEvaluated)
    }
}

/// The stratum and the number of a place.
pub fn place(plan: &Plan, id: u64) -> (u32, u64) {
    let strata = plan.strata.len() as u64;
    ((id % strata) as u32, id / strata)
}

/// The encounter id of a place.
pub fn encounter_id(plan: &Plan, id: u64) -> EncounterId {
    let (stratum, j) = place(plan, id);
    plan.id(stratum, j)
}

/// One planner on the encounters of the gate.
pub trait Arm {
    /// The rows of these places, in their order.
    fn rows(&mut self, ids: &[u64]) -> Result<Vec<ArmRow>, Error>;
}

/// What a worker is about, as it happens.
#[derive(Debug)]
pub enum Step<'a> {
    /// An encounter begins.
    Begins(u64),
    /// It has ended.
    Ended(&'a ArmRow),
}

/// Runs a planner on the threads of this process.
pub struct InProcess<'a> {
    plan: &'a Plan,
    workers: Vec<(Worker<'a>, &'a AtomicU64)>,
}

impl std::fmt::Debug for InProcess<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("InProcess").field("workers", &self.workers.len()).finish_non_exhaustive()
    }
}

impl<'a> InProcess<'a> {
    /// One worker, with a planner of its own, for each beat counter.
    pub fn new(shop: &'a Shop<'a>, plan: &'a Plan, beats: &'a [AtomicU64]) -> Result<Self, Error> {
        let workers = beats
            .iter()
            .map(|beat| Ok((Worker::new(shop)?, beat)))
            .collect::<Result<_, Error>>()?;
        Ok(Self { plan, workers })
    }

    /// As [`Arm::rows`]; `tell` hears of every encounter as it begins and ends.
    pub fn rows_telling(
        &mut self,
        ids: &[u64],
        tell: &(dyn Fn(Step<'_>) + Sync),
    ) -> Result<Vec<ArmRow>, Error> {
        let plan = self.plan;
        let next = AtomicUsize::new(0);
        let stop = AtomicBool::new(false);
        let failed: Mutex<Option<Error>> = Mutex::new(None);
        let done: Vec<Mutex<Option<ArmRow>>> = ids.iter().map(|_| Mutex::new(None)).collect();
        std::thread::scope(|scope| {
            for (worker, beat) in &mut self.workers {
                let (next, stop, failed, done) = (&next, &stop, &failed, &done);
                scope.spawn(move || {
                    while !stop.load(Ordering::Relaxed) {
                        let index = next.fetch_add(1, Ordering::Relaxed);
                        let Some(&id) = ids.get(index) else { break };
                        tell(Step::Begins(id));
                        let (stratum, j) = place(plan, id);
                        match worker.run(stratum, j, beat) {
                            Ok(run) => {
                                let row = ArmRow::of(id, &run.row, plan.run.distance);
                                tell(Step::Ended(&row));
                                *lock(&done[index]) = Some(row);
                            }
                            Err(error) => {
                                stop.store(true, Ordering::Relaxed);
                                lock(failed).get_or_insert(error);
                            }
                        }
                    }
                });
            }
        });
        if let Some(error) = failed.into_inner().unwrap_or_else(PoisonError::into_inner) {
            return Err(error);
        }
        let rows =
            done.into_iter().map(|row| row.into_inner().unwrap_or_else(PoisonError::into_inner));
        rows.collect::<Option<_>>().ok_or_else(|| Error::Fault("an encounter has no row".into()))
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Arm for InProcess<'_> {
    fn rows(&mut self, ids: &[u64]) -> Result<Vec<ArmRow>, Error> {
        self.rows_telling(ids, &|_| {})
    }
}

/// A beat counter for each of `threads` workers.
pub fn beats(threads: usize) -> Vec<AtomicU64> {
    (0..threads.max(1)).map(|_| AtomicU64::new(0)).collect()
}
