//! What avoiding costs: time of a planner's call, distance and time of the way sailed.
//!
//! A comparison runs the first encounters of each stratum again, on one thread and with a clock
//! around every call. Wall-clock numbers are printed and go to `timing.json` alone: reports are the
//! same bytes wherever they are made.

use crate::files;
use crate::say::say;
use campaign::worker::{Run, Shop, Worker};
use campaign::{Error, Plan};
use planner_api::{Command, Mission, Planner, PlannerEntry, PlannerEvents, Registry, Situation};
use serde::Serialize;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Encounters of each stratum that are run again.
const SAMPLE: u64 = 20;

/// One planner's line.
#[derive(Debug, Serialize)]
pub(super) struct Cost {
    pub(super) planner: String,
    encounters: u64,
    calls: u64,
    planning_us_per_call: f64,
    extra_distance_m_mean: f64,
    extra_time_s_mean: f64,
}

impl Cost {
    /// What of it does not depend on the clock.
    pub(super) fn extra(&self) -> report::Extra {
        report::Extra {
            encounters: self.encounters,
            distance_m: self.extra_distance_m_mean,
            time_s: self.extra_time_s_mean,
        }
    }
}

#[derive(Serialize)]
struct Timing<'a> {
    schema: u32,
    threads: u32,
    planners: &'a [Cost],
}

/// Measures the plans (of planners that do not take their process with them), writes `timing.json`
/// and prints it.
pub(super) fn measure(
    plans: &[&Plan],
    registry: Registry,
    out: &Path,
    quiet: bool,
) -> Result<Vec<Cost>, Error> {
    let registry = Arc::new(registry);
    let costs: Vec<Cost> =
        plans.iter().map(|plan| cost(plan, &registry)).collect::<Result<_, Error>>()?;
    let timing = Timing { schema: 1, threads: 1, planners: &costs };
    let mut text = serde_json::to_string_pretty(&timing)
        .map_err(|e| Error::Fault(format!("failed to write timing.json: {e}")))?;
    text.push('\n');
    files::write(&out.join("timing.json"), text.as_bytes())?;
    if !quiet {
        say!("{:20} {:>12} {:>18} {:>14}", "", "us per call", "extra distance, m", "time, s");
        for cost in &costs {
            say!(
                "{:20} {:>12.2} {:>18.0} {:>14.1}",
                cost.planner,
                cost.planning_us_per_call,
                cost.extra_distance_m_mean,
                cost.extra_time_s_mean
            );
        }
    }
    Ok(costs)
}

fn cost(plan: &Plan, registry: &Arc<Registry>) -> Result<Cost, Error> {
    let clock = Arc::new(Clock::default());
    let clocked = Registry::new().with(clocked(plan, registry, &clock)?);
    let shop = Shop::new(plan, &clocked)?;
    let mut worker = Worker::new(&shop)?;
    let beat = AtomicU64::new(0);
    let (mut encounters, mut distance_m, mut time_s) = (0, 0.0, 0.0);
    for stratum in 0..plan.strata.len() as u32 {
        for j in 0..SAMPLE.min(plan.encounters_per_stratum) {
            let run = worker.run(stratum, j, &beat)?;
            if let (Some(extra_m), false) = (run.row.extra_distance_m, run.row.unknown) {
                encounters += 1;
                distance_m += extra_m;
                time_s += extra_time_s(&run);
            }
        }
    }
    let calls = clock.calls.load(Ordering::Relaxed);
    let spent_us = clock.spent_ns.load(Ordering::Relaxed) as f64 / 1000.0;
    let runs = encounters.max(1) as f64;
    Ok(Cost {
        planner: plan.planner.name.clone(),
        encounters,
        calls,
        planning_us_per_call: spent_us / calls.max(1) as f64,
        extra_distance_m_mean: distance_m / runs,
        extra_time_s_mean: time_s / runs,
    })
}

/// Time of the run and of the rest of the way at planned speed, less the whole way at planned
/// speed, seconds.
fn extra_time_s(run: &Run) -> f64 {
    let (own, trace) = (&run.trace.own, &run.trace);
    let mut planned_m = 0.0;
    let mut from_m = run.encounter.own.start.position_m;
    for waypoint in &run.encounter.own.route {
        planned_m += (waypoint.position_m - from_m).norm();
        from_m = waypoint.position_m;
    }
    let to_go_m = (from_m - own.position_m(own.len() - 1)).norm();
    trace.end_s + (to_go_m - planned_m) / trace.cruise_mps
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
