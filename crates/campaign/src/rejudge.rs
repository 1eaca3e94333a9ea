//! Judging a finished campaign again, under other rule sets.
//!
//! Traces are not kept: each encounter is run again from its seed, once for all rule sets, and must
//! give the digest that is stored. Rows come out in the order of the stored ones, and memory holds
//! a bounded number of them. A planner that took its process with it is not asked again: such a row
//! says the same under every rule set.
//!
//! Known limit: nothing watches for a call that does not return. One that hung is stored as such,
//! and a planner that hangs now and did not then would not have given the same digest either.

use crate::judges::Judges;
use crate::worker::{Run, Shop, Worker};
use crate::{Error, Plan, engine, row};
use planner_api::Registry;
use record::{Digest, EncounterId, Outcome, RunRow};
use rules::RuleSet;
use std::collections::BTreeMap;
use std::sync::atomic::AtomicU64;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// What is to be judged again, and by what.
#[derive(Debug)]
pub struct Rejudge<'a> {
    /// The plan of the finished campaign.
    pub plan: &'a Plan,
    /// Where its planner is.
    pub registry: &'a Registry,
    /// The rule sets; each encounter is simulated once for all of them.
    pub rules: Vec<RuleSet>,
    /// Worker threads.
    pub threads: usize,
}

/// What the first judging left of a run.
#[derive(Clone, Debug)]
pub struct Stored {
    /// Which encounter.
    pub id: EncounterId,
    /// How it ended.
    pub outcome: Outcome,
    /// Digest of its trace.
    pub digest: Digest,
    /// How the planner failed, in words.
    pub planner_detail: Option<String>,
}

impl From<RunRow> for Stored {
    fn from(row: RunRow) -> Self {
        let RunRow { id, outcome, digest, planner_detail, .. } = row;
        Self { id, outcome, digest, planner_detail }
    }
}

/// One run, judged again.
#[derive(Debug)]
pub struct Again {
    /// A row for each rule set, in their order.
    pub rows: Vec<RunRow>,
    /// Draws that were rejected on the way to the encounter.
    pub rejected: u64,
}

/// Runs of one message between threads.
const CHUNK_RUNS: usize = 100;
/// Messages under way for each worker: enough to keep all busy, few enough to bound memory.
const CHUNKS_PER_WORKER: usize = 4;

type Chunk = (u64, Vec<Stored>);
type Done = (u64, Result<Vec<Again>, Error>);

impl Rejudge<'_> {
    /// Runs and judges every stored encounter again; `sink` gets them in the order of `stored`.
    ///
    /// # Errors
    /// `Fault` where a run does not give the stored digest.
    pub fn run(
        &self,
        stored: &mut dyn Iterator<Item = Result<Stored, Error>>,
        sink: &mut dyn FnMut(Again) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let shop = Shop::new(self.plan, self.registry)?;
        let (jobs_in, jobs) = channel::<Chunk>();
        let (done_in, done) = channel::<Done>();
        let jobs = Mutex::new(jobs);
        std::thread::scope(|scope| {
            for _ in 0..self.threads {
                let (done_in, jobs, shop) = (done_in.clone(), &jobs, &shop);
                scope.spawn(move || self.work(shop, jobs, &done_in));
            }
            drop(done_in);
            self.hand_out(stored, jobs_in, &done, sink)
        })
    }

    /// Keeps a bounded number of chunks under way, and hands on what comes back in order.
    fn hand_out(
        &self,
        stored: &mut dyn Iterator<Item = Result<Stored, Error>>,
        jobs: Sender<Chunk>,
        done: &Receiver<Done>,
        sink: &mut dyn FnMut(Again) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let mut early: BTreeMap<u64, Vec<Again>> = BTreeMap::new();
        let (mut sent, mut next) = (0, 0);
        loop {
            while sent - next < (self.threads * CHUNKS_PER_WORKER) as u64 {
                let chunk: Vec<Stored> =
                    (&mut *stored).take(CHUNK_RUNS).collect::<Result<_, Error>>()?;
                if chunk.is_empty() || jobs.send((sent, chunk)).is_err() {
                    break;
                }
                sent += 1;
            }
            if next == sent {
                return Ok(());
            }
            let (index, again) =
                done.recv().map_err(|_| Error::Fault("every worker has ended".to_owned()))?;
            early.insert(index, again?);
            while let Some(chunk) = early.remove(&next) {
                chunk.into_iter().try_for_each(&mut *sink)?;
                next += 1;
            }
        }
    }

    fn work(&self, shop: &Shop<'_>, jobs: &Mutex<Receiver<Chunk>>, done: &Sender<Done>) {
        let mut bench = Bench::new(self, shop);
        loop {
            let job = jobs.lock().unwrap_or_else(PoisonError::into_inner).recv();
            let Ok((index, chunk)) = job else { return };
            let again = match &mut bench {
                Ok(bench) => chunk.iter().map(|stored| bench.again(stored)).collect(),
                Err(error) => Err(Error::Input(error.to_string())),
            };
            // nobody listens any more after a first error
            if done.send((index, again)).is_err() {
                return;
            }
        }
    }
}

/// A worker with the judges of every rule set.
struct Bench<'a> {
    plan: &'a Plan,
    shop: &'a Shop<'a>,
    worker: Worker<'a>,
    judges: Vec<Judges>,
    beat: Arc<AtomicU64>,
}

impl<'a> Bench<'a> {
    fn new(job: &'a Rejudge<'a>, shop: &'a Shop<'a>) -> Result<Self, Error> {
        let beat = Arc::new(AtomicU64::new(0));
        engine::watch_for_panics(&beat);
        Ok(Self {
            plan: job.plan,
            shop,
            worker: Worker::new(shop)?,
            judges: job
                .rules
                .iter()
                .map(|rules| Judges::new(rules.clone(), &job.plan.run))
                .collect::<Result<_, _>>()?,
            beat,
        })
    }

    fn again(&mut self, stored: &Stored) -> Result<Again, Error> {
        let stratum = self.plan.stratum_of(&stored.id).ok_or_else(|| {
            Error::input(format!("the table has {}, which is not in its plan", stored.id))
        })?;
        if matches!(stored.outcome, Outcome::PlannerHung | Outcome::PlannerCrashed) {
            let (encounter, rejected) = self.shop.draw(stratum, stored.id.j)?;
            let detail = stored.planner_detail.clone();
            let row = row::of_lost_run(&encounter, stored.outcome, detail);
            return Ok(Again { rows: vec![row; self.judges.len()], rejected });
        }
        let run = self.worker.run(stratum, stored.id.j, &self.beat)?;
        if run.row.outcome.is_wall_clock() {
            return Err(Error::Incomplete(format!(
                "{} was ended by a limit on the wall clock now and not when it was stored: the \
                 machine is too busy for this planner; judge again when it is not",
                stored.id
            )));
        }
        if run.row.digest != stored.digest {
            return Err(Error::Fault(format!(
                "{} gives digest {} now and {} is stored: this binary, or its planner, is not the \
                 one that made the result",
                stored.id, run.row.digest, stored.digest
            )));
        }
        let Run { encounter, mut trace, rejected, .. } = run;
        let rows = self.judges.iter_mut().map(|judges| {
            let judged = judges.judge(&encounter, &mut trace);
            judged.row(&encounter, &trace)
        });
        Ok(Again { rows: rows.collect(), rejected })
    }
}
