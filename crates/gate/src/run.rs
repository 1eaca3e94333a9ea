//! The paired campaign: every planner of the gate on the same encounters, in id order.
//!
//! A block of places is run by each arm in turn; within a block the work is parallel, but rows
//! reach the rule in id order and in no other, and the rule takes no other. It stops as soon as
//! the rule has decided. Source: statistics specification, section 5, item 2.

use crate::Event;
use crate::arm::{self, Arm, ArmRow};
use crate::report::NewFailure;
use campaign::{Error, Plan};
use serde::{Deserialize, Serialize};
use stats::{CorpusResult, Gate, GatePlan, GateResult, GateVerdict, Observation, PairRow};

/// New failures that are kept for each event.
const KEPT_EACH: usize = 3;

/// What runs: the arms, and how their rows are read.
pub struct PairedRun<'a> {
    /// The rule's plan.
    pub gate: GatePlan,
    /// The plan of any arm: strata and radius, which all arms share.
    pub plan: &'a Plan,
    /// What is counted, in the order of the rule's metrics.
    pub events: &'a [Event],
    /// The distance below which a run is near, metres.
    pub near_m: f64,
    /// Layer 1.
    pub corpus: CorpusResult,
    /// The planner of today.
    pub baseline: &'a mut dyn Arm,
    /// The planner that wants to replace it.
    pub candidate: &'a mut dyn Arm,
    /// The ratchet, in the order of the rule's plan.
    pub ratchets: Vec<&'a mut dyn Arm>,
    /// Hears of pairs as they are looked at.
    pub progress: &'a dyn Fn(u64),
    /// Whether somebody wants it to end before a verdict.
    pub stop: &'a dyn Fn() -> bool,
}

impl std::fmt::Debug for PairedRun<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PairedRun").field("gate", &self.gate).finish_non_exhaustive()
    }
}

/// What came out.
#[derive(Clone, Debug)]
pub struct Paired {
    /// The verdict and its numbers.
    pub result: GateResult,
    /// Pairs whose two runs differ in any bit.
    pub different: u64,
    /// Runs that the wall clock ended.
    pub clocked: Clocked,
    /// The worst encounters that only the candidate fails, worst first.
    pub new_failures: Vec<NewFailure>,
}

/// Runs that a limit on the wall clock ended, those behind the look that decided too: another
/// machine might not end them, and its counts would then be others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Clocked {
    /// Of the baseline.
    pub baseline: u64,
    /// Of the candidate.
    pub candidate: u64,
    /// Of all older planners.
    pub ratchets: u64,
}

impl Clocked {
    /// What must be said beside the verdict, if anything.
    pub fn sentence(self) -> Option<String> {
        let Self { baseline, candidate, ratchets } = self;
        (baseline + candidate + ratchets > 0).then(|| {
            format!(
                "a limit on the wall clock ended {candidate} runs of the candidate, {baseline} of \
                 the baseline and {ratchets} of older planners: another machine might count others"
            )
        })
    }
}

/// How many of these rows the wall clock ended.
fn clocked(rows: &[ArmRow]) -> u64 {
    rows.iter().filter(|row| row.outcome.is_wall_clock()).count() as u64
}

impl PairedRun<'_> {
    /// Runs until the rule has decided.
    pub fn run(mut self) -> Result<Paired, Error> {
        let input = |e: stats::PlanError| Error::input(e.to_string());
        let mut gate = Gate::new(self.gate.clone(), self.corpus.clone()).map_err(input)?;
        let mut worst = Worst::default();
        let mut different = 0;
        let mut ended = Clocked::default();
        while gate.verdict().is_none() {
            let from = gate.next_id();
            if (self.stop)() {
                return Err(Error::Incomplete(format!(
                    "interrupted after {from} pairs without a verdict; the same command begins the \
                     same attempt again, on the same encounters"
                )));
            }
            let ids: Vec<u64> = (from..self.gate.next_look(from)).collect();
            let baseline = self.baseline.rows(&ids)?;
            let candidate = self.candidate.rows(&ids)?;
            let mut ratchets = Vec::new();
            for arm in &mut self.ratchets {
                ratchets.push(arm.rows(&ids)?);
            }
            ended.baseline += clocked(&baseline);
            ended.candidate += clocked(&candidate);
            ended.ratchets += ratchets.iter().map(|rows| clocked(rows)).sum::<u64>();
            let mut rows = Vec::with_capacity(ids.len());
            for (i, &id) in ids.iter().enumerate() {
                let others = ratchets.iter().map(|rows| &rows[i]);
                rows.push(self.pair(id, &candidate[i], &baseline[i], others)?);
                different += u64::from(candidate[i].digest != baseline[i].digest);
                worst.offer(self.plan, self.events, &rows[i], &candidate[i]);
            }
            gate.take(&rows).map_err(|e| Error::Fault(e.to_string()))?;
            (self.progress)(gate.next_id());
        }
        let result = gate.result().clone();
        Ok(Paired { result, different, clocked: ended, new_failures: worst.list() })
    }

    fn pair<'r>(
        &self,
        id: u64,
        candidate: &ArmRow,
        baseline: &ArmRow,
        ratchets: impl Iterator<Item = &'r ArmRow>,
    ) -> Result<PairRow, Error> {
        let see = |row: &ArmRow| -> Result<Vec<Observation>, Error> {
            if row.id != id {
                return Err(Error::Fault(format!("place {id} got the row of place {}", row.id)));
            }
            Ok(self.events.iter().map(|event| event.of(row, self.near_m)).collect())
        };
        Ok(PairRow {
            id,
            stratum: arm::place(self.plan, id).0 as usize,
            candidate: see(candidate)?,
            baseline: see(baseline)?,
            ratchets: ratchets.map(see).collect::<Result<_, _>>()?,
        })
    }
}

/// The worst new failures so far: by event in the order of [`Event`], then by distance.
#[derive(Default)]
struct Worst(Vec<NewFailure>);

impl Worst {
    fn offer(&mut self, plan: &Plan, events: &[Event], pair: &PairRow, candidate: &ArmRow) {
        let worst = events
            .iter()
            .zip(pair.candidate.iter().zip(&pair.baseline))
            .filter(|(_, (mine, was))| {
                **mine == Observation::Event && **was == Observation::NoEvent
            })
            .map(|(event, _)| *event);
        for event in worst {
            let failure = NewFailure {
                encounter: arm::encounter_id(plan, pair.id),
                event,
                outcome: candidate.outcome,
                cpa_m: candidate.cpa_m,
            };
            let at = self.0.partition_point(|kept| !failure.is_worse_than(kept));
            self.0.insert(at, failure);
        }
        let mut kept = std::collections::BTreeMap::<Event, usize>::new();
        self.0.retain(|failure| {
            let count = kept.entry(failure.event).or_default();
            *count += 1;
            *count <= KEPT_EACH
        });
    }

    /// Each encounter once, under its worst event.
    fn list(self) -> Vec<NewFailure> {
        let mut list: Vec<NewFailure> = Vec::new();
        for failure in self.0 {
            if list.iter().all(|kept| kept.encounter != failure.encounter) {
                list.push(failure);
            }
        }
        list
    }
}

/// What a verdict ends the command with: 0 pass, 1 fail, 3 inconclusive.
pub const fn exit_code(verdict: GateVerdict) -> u8 {
    match verdict {
        GateVerdict::Pass => 0,
        GateVerdict::Fail => 1,
        GateVerdict::Inconclusive => 3,
    }
}
