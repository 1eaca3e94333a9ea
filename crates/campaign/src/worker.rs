//! One worker: draws an encounter, runs it, judges it, makes its row.

use crate::inflight::InFlight;
use crate::judges::{Disagreement, Judges};
use crate::plan::EncounterSource;
use crate::supervisor::Lost;
use crate::{Error, Plan, avoidable, row};
use planner_api::{Planner, PlannerEntry, Registry};
use record::verdict::Judgement;
use record::{Encounter, EncounterId, RunRow, Trace};
use std::collections::BTreeMap;
use std::sync::atomic::AtomicU64;

/// Everything that is made once for a campaign and shared by all workers.
#[derive(Debug)]
pub struct Shop<'a> {
    plan: &'a Plan,
    registry: &'a Registry,
    entry: &'a PlannerEntry,
    source: EncounterSource,
    rules: BTreeMap<String, rules::RuleSet>,
}

impl<'a> Shop<'a> {
    /// Looks up the planner and parses the rule set.
    pub fn new(plan: &'a Plan, registry: &'a Registry) -> Result<Self, Error> {
        Ok(Self {
            plan,
            registry,
            entry: registry.get(&plan.planner.name).map_err(|e| Error::input(e.to_string()))?,
            source: plan.encounters_source()?,
            rules: plan.rules.rule_sets()?,
        })
    }

    /// Encounter `j` of a stratum and the rejections on the way to it.
    pub fn draw(&self, stratum: u32, j: u64) -> Result<(Encounter, u64), Error> {
        let drawn = self.source.draw(stratum, j)?;
        Ok((drawn.encounter, drawn.rejected))
    }

    /// The planner of a target: the one under test with its options, any other with its own.
    fn peer(&self, name: &str) -> Option<Box<dyn Planner>> {
        let entry = self.registry.get(name).ok()?;
        let own = entry.name == self.entry.name;
        (entry.make)(if own { &self.plan.planner.options } else { &entry.options }).ok()
    }

    fn planner(&self) -> Result<Box<dyn Planner>, Error> {
        (self.entry.make)(&self.plan.planner.options).map_err(|e| Error::input(e.to_string()))
    }
}

/// One run with everything that was found.
#[derive(Debug)]
pub struct Run {
    /// What was run.
    pub encounter: Encounter,
    /// What happened.
    pub trace: Trace,
    /// What the judge says of it.
    pub judgement: Judgement,
    /// Where the second judge disagrees; absent where it was not asked.
    pub disagreements: Option<Vec<Disagreement>>,
    /// The row.
    pub row: RunRow,
    /// Draws that were rejected on the way.
    pub rejected: u64,
}

/// A worker's own planner, judge and scratch space.
pub struct Worker<'a> {
    shop: &'a Shop<'a>,
    planner: Box<dyn Planner>,
    judges: BTreeMap<String, Judges>,
    scratch: sim::Scratch,
}

impl std::fmt::Debug for Worker<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Worker").finish_non_exhaustive()
    }
}

impl<'a> Worker<'a> {
    /// A worker with a planner of its own.
    pub fn new(shop: &'a Shop<'a>) -> Result<Self, Error> {
        Ok(Self {
            shop,
            planner: shop.planner()?,
            judges: shop
                .rules
                .iter()
                .map(|(name, rules)| {
                    let judges = Judges::new(rules.clone(), &shop.plan.run)?;
                    Ok((name.clone(), judges))
                })
                .collect::<Result<_, Error>>()?,
            scratch: sim::Scratch::default(),
        })
    }

    /// Runs encounter `j` of a stratum, and again if its turn for the twice-run check has come.
    pub fn run(&mut self, stratum: u32, j: u64, beat: &AtomicU64) -> Result<Run, Error> {
        let (encounter, rejected) = self.shop.draw(stratum, j)?;
        let run = self.run_encounter(encounter, rejected, beat)?;
        if is_run_twice(self.shop.plan, &run.row.id) {
            // a fresh planner, so that one which forgets to forget is found too
            self.planner = self.shop.planner()?;
            let again = self.run_encounter(run.encounter.clone(), rejected, beat)?;
            // a limit on the wall clock may end one of two equal runs and not the other
            let clocked = [&run, &again].iter().any(|one| one.row.outcome.is_wall_clock());
            if !clocked && again.row.digest != run.row.digest {
                return Err(Error::Fault(format!(
                    "{} gave digest {} and then {}; a planner that remembers the encounter \
                     before, or reads a clock or a random generator of its own, does this \
                     (see the conformance kit)",
                    run.row.id, run.row.digest, again.row.digest
                )));
            }
        }
        Ok(run)
    }

    fn run_encounter(
        &mut self,
        encounter: Encounter,
        rejected: u64,
        beat: &AtomicU64,
    ) -> Result<Run, Error> {
        let peers = &mut |name: &str| self.shop.peer(name);
        let (planner, scratch) = (self.planner.as_mut(), &mut self.scratch);
        let voyage = sim::voyage(&encounter, planner, peers, scratch, beat);
        let mut trace = voyage.into_trace(&encounter);
        if trace.outcome.is_planner_failure() {
            self.planner = self.shop.planner()?;
        }
        if self.shop.plan.run.last_minute {
            let means = (&mut *scratch, beat);
            trace.unavoidable = avoidable::unavoidable(&encounter, &trace, peers, means);
        }
        let key = self.shop.plan.rules.key(encounter.own.hull.length_m);
        let judges = self.judges.get_mut(key).expect("the plan found a profile for every length");
        let judged = judges.judge(&encounter, &mut trace);
        let row = judged.row(&encounter, &trace);
        let (judgement, disagreements) = (judged.judgement, judged.disagreements);
        Ok(Run { encounter, trace, judgement, disagreements, row, rejected })
    }
}

/// Runs one encounter of a plan alone, outside any campaign.
pub fn run_alone(plan: &Plan, registry: &Registry, id: &EncounterId) -> Result<Run, Error> {
    let stratum = plan.stratum_of(id).ok_or_else(|| {
        Error::input(format!(
            "there is no encounter {id} in this campaign; its strata are {}, each from 000000 \
             to {:06}",
            plan.strata.join(", "),
            plan.encounters_per_stratum - 1
        ))
    })?;
    let shop = Shop::new(plan, registry)?;
    Worker::new(&shop)?.run(stratum, id.j, &AtomicU64::new(0))
}

/// Whether the twice-run check takes this encounter: a function of seed and id alone.
fn is_run_twice(plan: &Plan, id: &EncounterId) -> bool {
    let mut hasher = blake3::Hasher::new();
    hasher.update(b"seatrial twice v1");
    hasher.update(&plan.seed.0.to_le_bytes());
    hasher.update(id.stratum.as_bytes());
    hasher.update(&id.j.to_le_bytes());
    let hash = hasher.finalize();
    let word = hash.as_bytes()[..4].iter().fold(0u32, |sum, &byte| sum << 8 | u32::from(byte));
    f64::from(word) < plan.run.twice_run_share * 4_294_967_296.0
}

/// Runs the encounters of one part, in order.
///
/// `lost` tells of an encounter that is known to take the process with it.
pub fn run_part<'a>(
    worker: &mut Worker<'_>,
    key: crate::part::PartKey,
    slot: (&InFlight, usize),
    lost: &dyn Fn(u32, u64) -> Option<&'a Lost>,
) -> Result<crate::part::Part, Error> {
    let range = key.range(worker.shop.plan.encounters_per_stratum);
    let mut part = crate::part::Part { rows: Vec::new(), tally: summary::Tally::default() };
    let (inflight, index) = slot;
    for j in range {
        let (row, rejected) = match lost(key.stratum, j) {
            Some(lost) => {
                let (encounter, rejected) = worker.shop.draw(key.stratum, j)?;
                let detail = Some(lost.detail.clone());
                (row::of_lost_run(&encounter, lost.outcome, detail), rejected)
            }
            None => {
                inflight.begin(index, key.stratum, j);
                let run = worker.run(key.stratum, j, &inflight.slot(index).beat)?;
                (run.row, run.rejected)
            }
        };
        part.tally.add(&row);
        part.tally.add_draws(1 + rejected, rejected);
        part.rows.push(row);
    }
    inflight.end(index);
    Ok(part)
}
