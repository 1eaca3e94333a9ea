//! `speed`: encounters per second, the floor under them, and the share of each stage.
//!
//! Each encounter is 20 simulated minutes of two 3-DOF vessels under the seed planner with every
//! verdict, in the laboratory. The floor integrates the same vessels at the same step in a bare
//! loop: no planner, no hulls, no verdicts. The same encounters are then run in the default world
//! (sensors, weather, intents) and compared with the laboratory, turn about. Ratios come from one
//! run; absolute numbers depend on the machine.

use crate::embedded;
use crate::exit::Ended;
use crate::say::say;
use campaign::{CampaignFile, Error, Overrides};
use geom::HullOutline;
use planner_api::Registry;
use record::{Digest, Encounter, Judgement, RunUntil, Trace, Vessel};
use std::hint::black_box;
use std::sync::atomic::AtomicU64;
use std::time::Instant;

const DURATION_S: f64 = 1200.0;
const VESSEL: &str = "viknes";
/// The campaign whose world is compared with the laboratory.
const HONEST: &str = "quick";
/// Rounds of the comparison of one thread with several.
const ROUNDS: usize = 5;
/// Encounters of one world before it is the other's turn: enough that neither pays for the caches
/// that the other left behind, few enough that drift of the machine's speed falls on both alike.
const TURN: usize = 20;

pub(super) fn run(encounters: u64, registry: &Registry) -> Result<Ended, Error> {
    if encounters == 0 {
        return Err(Error::input("--encounters 0 measures nothing; ask for at least 1"));
    }
    let bench = Bench::new("laboratory", encounters, registry)?;
    let (floor_s, stages) = bench.stages(Floor::Measured)?;
    let total_s = sum(&stages);
    let per_s = |seconds: f64| encounters as f64 / seconds;
    say!(
        "{encounters} encounters of 20 simulated minutes, two 3-DOF vessels, step {} s",
        bench.step_s
    );
    say!("one core       {:>8.0} encounters/s", per_s(total_s));
    say!("floor          {:>8.0} encounters/s (the same vessels in a bare loop)", per_s(floor_s));
    say!("cost           {:>8.2} times the floor's", total_s / floor_s);
    for (stage, seconds) in &stages {
        say!("  {stage:12} {:>8.1} %", 100.0 * seconds / total_s);
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let (one_s, all_s) = bench.scaling(cores)?;
    say!(
        "{cores} threads      {:>8.0} encounters/s, {:.2} times one thread's {:.0}",
        cores as f64 * per_s(all_s),
        cores as f64 * one_s / all_s,
        per_s(one_s)
    );
    let (plain_s, honest) = Bench::new(HONEST, encounters, registry)?.against(&bench)?;
    let honest_s = sum(&honest);
    say!("world `{HONEST}` {:>6.0} encounters/s", per_s(honest_s));
    say!("cost           {:>8.2} times the laboratory's", honest_s / plain_s);
    for (stage, seconds) in &honest {
        say!("  {stage:12} {:>8.1} %", 100.0 * seconds / honest_s);
    }
    Ok(Ended::Done)
}

fn sum(stages: &Stages) -> f64 {
    stages.iter().map(|(_, seconds)| seconds).sum()
}

/// Whether the bare loop is run beside each encounter.
#[derive(Clone, Copy, PartialEq)]
enum Floor {
    Measured,
    LeftOut,
}

/// Name and seconds of each stage.
type Stages = Vec<(&'static str, f64)>;

struct Bench<'a> {
    encounters: Vec<Encounter>,
    entry: &'a planner_api::PlannerEntry,
    rules: rules::RuleSet,
    step_s: f64,
}

impl<'a> Bench<'a> {
    /// A campaign's encounters, with two 3-DOF vessels and 20 minutes each.
    fn new(campaign: &str, count: u64, registry: &'a Registry) -> Result<Self, Error> {
        let file = CampaignFile::parse(&embedded::campaign_text(campaign)?, campaign)?;
        let build = crate::build::build();
        let plans =
            file.resolve(&Overrides::default(), None, registry, &embedded::rules_text, &build)?;
        let plan = &plans[0];
        let source = plan.encounters_source()?;
        let strata = plan.strata.len() as u64;
        let encounters: Result<Vec<Encounter>, Error> = (0..count)
            .map(|i| {
                let mut encounter = source.draw((i % strata) as u32, i / strata)?.encounter;
                for target in &mut encounter.targets {
                    target.vessel = Vessel::Model(VESSEL.to_owned());
                    target.hull = HullOutline { ..encounter.own.hull };
                }
                encounter.run.duration_s_max = DURATION_S;
                encounter.run.until = RunUntil::TimeIsUp;
                Ok(encounter)
            })
            .collect();
        let entry = registry.get(&plan.planner.name).map_err(|e| Error::input(e.to_string()))?;
        let rules =
            rules::RuleSet::parse(&plan.rules.text).map_err(|e| Error::input(e.to_string()))?;
        Ok(Self { encounters: encounters?, entry, rules, step_s: plan.run.step_s })
    }

    /// Seconds of the floor and of each stage over all encounters on one core.
    fn stages(&self, floor: Floor) -> Result<(f64, Stages), Error> {
        self.stages_of(&self.encounters, floor)
    }

    /// Seconds of `other` in all, and of each stage of this world, both over all encounters, turn
    /// about.
    fn against(&self, other: &Self) -> Result<(f64, Stages), Error> {
        let (mut other_s, mut own): (f64, Stages) = (0.0, Vec::new());
        for (theirs, ours) in other.encounters.chunks(TURN).zip(self.encounters.chunks(TURN)) {
            other_s += sum(&other.stages_of(theirs, Floor::LeftOut)?.1);
            let (_, stages) = self.stages_of(ours, Floor::LeftOut)?;
            if own.is_empty() {
                own = stages;
            } else {
                own.iter_mut().zip(stages).for_each(|(sum, (_, seconds))| sum.1 += seconds);
            }
        }
        Ok((other_s, own))
    }

    fn stages_of(&self, encounters: &[Encounter], floor: Floor) -> Result<(f64, Stages), Error> {
        let mut planner =
            (self.entry.make)(&self.entry.options).map_err(|e| Error::input(e.to_string()))?;
        let mut scratch = sim::Scratch::default();
        let mut judge = rules::Judge::new(self.rules.clone());
        let beat = AtomicU64::new(0);
        let (mut floor_s, mut spent) = (0.0, [0.0; 7]);
        for encounter in encounters {
            // every stage of one encounter, then the next, so that drift of the machine's speed
            // falls on all of them alike
            if floor == Floor::Measured {
                floor_s += timed(|| black_box(sim::floor(encounter))).0;
            }
            let none = &mut |_: &str| None;
            let (run_s, voyage) =
                timed(|| sim::voyage(encounter, planner.as_mut(), none, &mut scratch, &beat));
            let (nominal_s, mut trace) = timed(|| voyage.into_trace(encounter));
            let (digest_s, digest) = timed(|| Digest::of_trace(&trace));
            let (judge_s, first): (f64, Judgement) = timed(|| judge.judge(&trace));
            let (forks_s, found) = timed(|| fork(encounter, &mut trace, &first, judge.rules()));
            let (again_s, judged): (f64, Judgement) =
                timed(|| if found { judge.judge(&trace) } else { first });
            let (row_s, row) = timed(|| campaign::row::of_run(encounter, &trace, digest, &judged));
            black_box::<(Trace, _)>((trace, row));
            let seconds = [run_s, nominal_s, digest_s, judge_s, forks_s, again_s, row_s];
            spent.iter_mut().zip(seconds).for_each(|(sum, seconds)| *sum += seconds);
        }
        let names = ["run", "nominal", "digest", "verdicts", "last minute", "again", "row"];
        Ok((floor_s, names.into_iter().zip(spent).collect()))
    }

    /// Wall-clock seconds of one thread, and of each of `threads` at once, for all encounters:
    /// the least of some rounds that take turns, since other work only ever adds to a time.
    fn scaling(&self, threads: usize) -> Result<(f64, f64), Error> {
        let mut least = (f64::INFINITY, f64::INFINITY);
        for _ in 0..ROUNDS {
            least = (least.0.min(self.wall(1)?), least.1.min(self.wall(threads)?));
        }
        Ok(least)
    }

    /// Wall-clock seconds in which each of `threads` threads does all encounters.
    fn wall(&self, threads: usize) -> Result<f64, Error> {
        let started = now();
        std::thread::scope(|scope| {
            let workers: Vec<_> = (0..threads)
                .map(|_| scope.spawn(|| self.stages(Floor::LeftOut).map(drop)))
                .collect();
            workers.into_iter().try_for_each(|worker| match worker.join() {
                Ok(ended) => ended,
                Err(_) => Err(Error::Fault("a measuring thread panicked".to_owned())),
            })
        })?;
        Ok(started.elapsed().as_secs_f64())
    }
}

/// The last safe instants of the pairs that reached stage 3, for the second look of the judge.
/// Whether there are any.
fn fork(
    encounter: &Encounter,
    trace: &mut Trace,
    first: &Judgement,
    rules: &rules::RuleSet,
) -> bool {
    let near_miss_m = rules.distance.r_nm_m;
    let found = trace.nominal.as_ref().and_then(|nominal| {
        campaign::last_minute::find(encounter, nominal, &first.pairs, near_miss_m)
    });
    let Some(found) = found else { return false };
    let again = found.iter().any(Option::is_some);
    trace.last_minute = Some(found);
    again
}

#[expect(clippy::disallowed_methods, reason = "this command measures wall-clock time")]
fn now() -> Instant {
    Instant::now()
}

fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let started = now();
    let result = work();
    (started.elapsed().as_secs_f64(), result)
}
