//! Is the step small enough? Runs a campaign's encounters at its step and at half of it, and prints
//! what changed: `cargo run --config .cargo/optimised.toml -p campaign --example convergence --
//! ENCOUNTERS PLANNER,... HALVINGS CAMPAIGN` (10,000 of `zhuang`, one halving, `laboratory`).
//!
//! Two comparisons, because a planner may answer a difference of a millimetre with another
//! manoeuvre. `replayed`: the finer run gets the orders of the coarser one, beat for beat, so what
//! differs is the integration. `decided`: the planner decides anew, so what differs is integration
//! and everything that the planner makes of it.
#![forbid(unsafe_code)]

mod common;

use campaign::judges::Judges;
use campaign::{Error, Overrides, Plan};
use planner_api::{Command, Mission, Planner, Situation};
use rayon::prelude::*;
use record::{Check, Encounter, Order, RunRow, Status, Trace};
use std::collections::BTreeMap;
use std::sync::atomic::AtomicU64;

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().collect();
    let encounters: u64 = arguments.get(1).and_then(|n| n.parse().ok()).unwrap_or(10_000);
    let planners = arguments.get(2).map_or("zhuang", String::as_str);
    let halvings: u32 = arguments.get(3).and_then(|n| n.parse().ok()).unwrap_or(1);
    let campaign = arguments.get(4).map_or("laboratory", String::as_str);
    for planner in planners.split(',') {
        let mut factor = 1.0;
        for _ in 0..halvings {
            let coarse = plan(campaign, planner, factor)?;
            factor *= 0.5;
            let fine = plan(campaign, planner, factor)?;
            let strata = coarse.strata.len() as u64;
            let compared = compare(&coarse, &fine, encounters.div_ceil(strata))?;
            let (step_s, half_s) = (coarse.run.step_s, fine.run.step_s);
            println!(
                "{planner}, {} encounters, step {step_s} s against {half_s} s",
                compared.len()
            );
            report("replayed", compared.iter().map(|c| (&c.coarse, &c.replayed)));
            report("decided", compared.iter().map(|c| (&c.coarse, &c.decided)));
        }
    }
    Ok(())
}

fn plan(campaign: &str, planner: &str, step_factor: f64) -> Result<Plan, Error> {
    let file = format!("{}/../../campaigns/{campaign}.toml", env!("CARGO_MANIFEST_DIR"));
    let overrides = Overrides { planners: vec![planner.to_owned()], ..Overrides::default() };
    let plans = common::plans(&file, &overrides, &planners::registry(), |file| {
        file.run.step_s *= step_factor;
        file.run.second_judge = false;
    })?;
    plans.into_iter().next().ok_or_else(|| Error::Fault("no plan".to_owned()))
}

/// One encounter, three times.
struct Compared {
    coarse: RunRow,
    replayed: RunRow,
    decided: RunRow,
}

fn compare(coarse: &Plan, fine: &Plan, each: u64) -> Result<Vec<Compared>, Error> {
    let ids: Vec<(u32, u64)> =
        (0..coarse.strata.len() as u32).flat_map(|s| (0..each).map(move |j| (s, j))).collect();
    let sources = [coarse.encounters_source()?, fine.encounters_source()?];
    ids.into_par_iter()
        .map_init(
            || Bench::new(coarse),
            |bench, (stratum, j)| {
                let bench = bench.as_mut().map_err(|e| Error::Fault(e.to_string()))?;
                let [whole, half] = [&sources[0], &sources[1]].map(|s| s.draw(stratum, j));
                let (whole, half) = (whole?.encounter, half?.encounter);
                let (orders, coarse) = bench.run(&whole, None)?;
                let (_, replayed) = bench.run(&half, Some(orders))?;
                let (_, decided) = bench.run(&half, None)?;
                Ok(Compared { coarse, replayed, decided })
            },
        )
        .collect()
}

/// A planner and the judges, of one thread.
struct Bench {
    planner: Box<dyn Planner>,
    judges: Judges,
    scratch: sim::Scratch,
}

impl Bench {
    fn new(plan: &Plan) -> Result<Self, Error> {
        let registry = planners::registry();
        let input = |e: &dyn std::fmt::Display| Error::input(e.to_string());
        let entry = registry.get(&plan.planner.name).map_err(|e| input(&e))?;
        let planner = (entry.make)(&plan.planner.options).map_err(|e| input(&e))?;
        let judges = Judges::new(plan.rules.rule_set()?, &plan.run)?;
        Ok(Self { planner, judges, scratch: sim::Scratch::default() })
    }

    /// Runs and judges; the orders given and the row.
    fn run(
        &mut self,
        encounter: &Encounter,
        orders: Option<Vec<Order>>,
    ) -> Result<(Vec<Order>, RunRow), Error> {
        let beat = AtomicU64::new(0);
        let mut replay = orders.map(|orders| Replay { orders, beat: 0 });
        let planner: &mut dyn Planner = match &mut replay {
            Some(replay) => replay,
            None => self.planner.as_mut(),
        };
        let mut trace: Trace = sim::run(encounter, planner, &mut self.scratch, &beat);
        trace.nominal = sim::nominal(encounter);
        let judged = self.judges.judge(encounter, &mut trace);
        let row = judged.row(encounter, &trace);
        Ok((trace.orders, row))
    }
}

/// Orders what another run was ordered, and the last of it for ever.
struct Replay {
    orders: Vec<Order>,
    beat: usize,
}

impl Planner for Replay {
    fn reset(&mut self, _: &Mission) {
        self.beat = 0;
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let order = self.orders.get(self.beat).or(self.orders.last());
        self.beat += 1;
        order.map_or_else(
            || Command::course_speed(situation.own.psi_rad, situation.own.stw_mps),
            |order| Command::course_speed(order.course_rad, order.speed_mps),
        )
    }
}

fn report<'a>(how: &str, pairs: impl Iterator<Item = (&'a RunRow, &'a RunRow)> + Clone) {
    let mut changes: Vec<f64> =
        pairs.clone().filter_map(|(a, b)| Some((a.cpa_hull_m? - b.cpa_hull_m?).abs())).collect();
    changes.sort_by(f64::total_cmp);
    let at = |share: f64| changes[((changes.len() - 1) as f64 * share) as usize];
    let differs = |differ: &dyn Fn(&RunRow, &RunRow) -> bool| {
        pairs.clone().filter(|(a, b)| differ(a, b)).count()
    };
    println!(
        "  {how}: change of the smallest distance, m: median {:.1e}, p90 {:.1e}, p99 {:.1e}, \
         p99.9 {:.1e}, largest {:.1e}",
        at(0.5),
        at(0.9),
        at(0.99),
        at(0.999),
        at(1.0)
    );
    let verdict = |a: &RunRow, b: &RunRow| {
        checks().any(|check| a.check(check).status != b.check(check).status)
    };
    println!(
        "    encounters that differ: outcome {}, safety radius {}, any verdict {}",
        differs(&|a, b| a.outcome != b.outcome),
        differs(&|a, b| a.safety_radius_broken != b.safety_radius_broken),
        differs(&verdict)
    );
    for check in checks() {
        let mut moved: BTreeMap<(Status, Status), u32> = BTreeMap::new();
        for (a, b) in pairs.clone() {
            let (a, b) = (a.check(check).status, b.check(check).status);
            if a != b {
                *moved.entry((a, b)).or_default() += 1;
            }
        }
        for ((a, b), count) in moved {
            println!("      {}: {} -> {} in {count}", check.name(), a.name(), b.name());
        }
    }
}

/// Every check but that of alerts (Rules 5 and 7), which a replay does not give.
fn checks() -> impl Iterator<Item = Check> {
    Check::ALL.into_iter().filter(|&check| check != Check::R5R7)
}
