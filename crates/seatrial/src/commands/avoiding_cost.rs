//! What avoiding costs: time of a planner's call, distance and time of the way sailed.
//!
//! A comparison runs the first encounters of each stratum again, on one thread and with a clock
//! around every call. The wall clock's number goes to `timing.json` and to one line of the
//! comparison, which says what it is; reports are the same bytes wherever they are made.

use crate::files;
use crate::say::say;
use campaign::worker::{Run, Shop, Worker};
use campaign::{Error, Plan};
use planner_api::{Command, Mission, Planner, PlannerEntry, PlannerEvents, Registry, Situation};
use report::{Cost, Extra};
use serde::Serialize;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

/// Encounters of each stratum that are run again.
const SAMPLE: u64 = 50;

/// One planner's cost.
#[derive(Debug)]
pub(super) struct PlannerCost {
    pub(super) planner: String,
    pub(super) cost: Cost,
    calls: u64,
}

#[derive(Serialize)]
struct Timing<'a> {
    schema: u32,
    threads: u32,
    planners: Vec<PlannerTiming<'a>>,
}

#[derive(Serialize)]
struct PlannerTiming<'a> {
    planner: &'a str,
    encounters: u64,
    calls: u64,
    planning_us_per_call: f64,
    extra_distance_m_mean: f64,
    extra_time_s_mean: f64,
}

/// Measures the plans (of planners that do not take their process with them), writes `timing.json`
/// and prints it.
pub(super) fn measure(
    plans: &[&Plan],
    registry: Registry,
    out: &Path,
    quiet: bool,
    interrupted: &AtomicBool,
) -> Result<Vec<PlannerCost>, Error> {
    let registry = Arc::new(registry);
    let stop = || match interrupted.load(Ordering::Relaxed) {
        true => Err(Error::stopped(out, "go on with the same command")),
        false => Ok(()),
    };
    let costs: Vec<PlannerCost> =
        plans.iter().map(|plan| cost(plan, &registry, &stop)).collect::<Result<_, Error>>()?;
    let planners = costs.iter().map(|c| PlannerTiming {
        planner: &c.planner,
        encounters: c.cost.whole.encounters,
        calls: c.calls,
        planning_us_per_call: c.cost.planning_us_per_call,
        extra_distance_m_mean: c.cost.whole.distance_m,
        extra_time_s_mean: c.cost.whole.time_s,
    });
    let timing = Timing { schema: 1, threads: 1, planners: planners.collect() };
    let mut text = serde_json::to_string_pretty(&timing)
        .map_err(|e| Error::Fault(format!("failed to write timing.json: {e}")))?;
    text.push('\n');
    files::write(&out.join("timing.json"), text.as_bytes())?;
    if !quiet {
        say!("{:20} {:>12} {:>18} {:>14}", "", "us per call", "extra distance, m", "time, s");
        for PlannerCost { planner, cost, .. } in &costs {
            let Extra { distance_m, time_s, .. } = cost.whole;
            let us = cost.planning_us_per_call;
            say!("{planner:20} {us:>12.2} {distance_m:>18.0} {time_s:>14.1}");
        }
    }
    Ok(costs)
}

fn cost(
    plan: &Plan,
    registry: &Arc<Registry>,
    stop: &dyn Fn() -> Result<(), Error>,
) -> Result<PlannerCost, Error> {
    let clock = Arc::new(Clock::default());
    let clocked = Registry::new().with(clocked(plan, registry, &clock)?);
    let shop = Shop::new(plan, &clocked)?;
    let mut worker = Worker::new(&shop)?;
    let mut whole = Extra::default();
    let mut strata = Vec::new();
    for (stratum, name) in (0..).zip(&plan.strata) {
        let mut extra = Extra::default();
        for j in 0..SAMPLE.min(plan.encounters_per_stratum) {
            stop()?;
            let run = worker.run(stratum, j, &AtomicU64::new(0))?;
            if let (Some(extra_m), false) = (run.row.extra_distance_m, run.row.unknown) {
                add(&mut extra, extra_m, extra_time_s(&run));
                add(&mut whole, extra_m, extra_time_s(&run));
            }
        }
        strata.push((name.to_string(), mean(extra)));
    }
    let calls = clock.calls.load(Ordering::Relaxed);
    let spent_us = clock.spent_ns.load(Ordering::Relaxed) as f64 / 1000.0;
    let planning_us_per_call = spent_us / calls.max(1) as f64;
    let cost = Cost { planning_us_per_call, whole: mean(whole), strata };
    Ok(PlannerCost { planner: plan.planner.name.clone(), cost, calls })
}

/// Adds a run to a sum.
fn add(sum: &mut Extra, distance_m: f64, time_s: f64) {
    sum.encounters += 1;
    sum.distance_m += distance_m;
    sum.time_s += time_s;
}

fn mean(sum: Extra) -> Extra {
    let n = sum.encounters.max(1) as f64;
    Extra { distance_m: sum.distance_m / n, time_s: sum.time_s / n, ..sum }
}

/// Time to the passage of the goal, and from there or from the end of the run to it at planned
/// speed, less the whole way at planned speed, seconds. The goal is passed where own ship is
/// nearest to it.
fn extra_time_s(run: &Run) -> f64 {
    let (own, trace) = (&run.trace.own, &run.trace);
    let mut planned_m = 0.0;
    let mut goal_m = run.encounter.own.start.position_m;
    for waypoint in &run.encounter.own.route {
        planned_m += (waypoint.position_m - goal_m).norm();
        goal_m = waypoint.position_m;
    }
    let to_go_m = |k: usize| (goal_m - own.position_m(k)).norm();
    let last = own.len() - 1;
    let nearest = (0..=last).min_by(|&a, &b| to_go_m(a).total_cmp(&to_go_m(b))).unwrap_or(last);
    let at_s = if nearest == last { trace.end_s } else { nearest as f64 * trace.sample_s };
    at_s + (to_go_m(nearest) - planned_m) / trace.cruise_mps
}

#[derive(Debug, Default)]
struct Clock {
    calls: AtomicU64,
    spent_ns: AtomicU64,
}

/// A planner with a clock around every call.
struct Clocked {
    planner: Box<dyn Planner>,
    clock: Arc<Clock>,
}

impl Planner for Clocked {
    fn reset(&mut self, mission: &Mission) {
        self.planner.reset(mission);
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let started = now();
        let command = self.planner.plan(situation);
        let spent_ns = u64::try_from(started.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.clock.spent_ns.fetch_add(spent_ns, Ordering::Relaxed);
        self.clock.calls.fetch_add(1, Ordering::Relaxed);
        command
    }

    fn events(&self) -> PlannerEvents {
        self.planner.events()
    }
}

#[expect(clippy::disallowed_methods, reason = "planning time is a wall-clock fact")]
fn now() -> Instant {
    Instant::now()
}

/// The plan's planner in a registry of its own, under the clock.
fn clocked(
    plan: &Plan,
    registry: &Arc<Registry>,
    clock: &Arc<Clock>,
) -> Result<PlannerEntry, Error> {
    let name = plan.planner.name.clone();
    let entry = registry.get(&name).map_err(|e| Error::input(e.to_string()))?;
    let (summary, options) = (entry.summary.clone(), entry.options.clone());
    let (registry, clock) = (Arc::clone(registry), Arc::clone(clock));
    let inner = name.clone();
    let make = move |options: &planner_api::Options| {
        let planner = (registry.get(&inner)?.make)(options)?;
        let clocked = Clocked { planner, clock: Arc::clone(&clock) };
        Ok(Box::new(clocked) as Box<dyn Planner>)
    };
    Ok(PlannerEntry { name, summary, caught_by: None, options, make: Box::new(make) })
}
