//! Is the step small enough? Runs the default campaign's encounters at its step and at half of it,
//! and prints what changed: `cargo run --release -p campaign --example convergence [ENCOUNTERS]`.
#![forbid(unsafe_code)]

mod common;

use campaign::worker::{Shop, Worker};
use campaign::{Error, Overrides, Plan};
use record::{Check, RunRow, Status};
use std::collections::BTreeMap;
use std::sync::atomic::AtomicU64;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../campaigns/laboratory.toml");

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().collect();
    let encounters: u64 = arguments.get(1).and_then(|n| n.parse().ok()).unwrap_or(10_000);
    let planner = arguments.get(2).map_or("zhuang", String::as_str);
    let whole = plan(planner, 1.0)?;
    let half = plan(planner, 0.5)?;
    let strata = whole.strata.len() as u64;
    let (rows, rows_half) = std::thread::scope(|scope| {
        let a = scope.spawn(|| rows(&whole, encounters / strata));
        let b = rows(&half, encounters / strata);
        (a.join().expect("no panic in a run"), b)
    });
    report(&rows?, &rows_half?, whole.run.step_s);
    Ok(())
}

fn plan(planner: &str, step_factor: f64) -> Result<Plan, Error> {
    let overrides = Overrides { planners: vec![planner.to_owned()], ..Overrides::default() };
    let plans = common::plans(FILE, &overrides, &planners::registry(), |file| {
        file.run.step_s *= step_factor;
        file.run.twice_run_share = 0.0;
    })?;
    plans.into_iter().next().ok_or_else(|| Error::Fault("no plan".to_owned()))
}

fn rows(plan: &Plan, each: u64) -> Result<Vec<RunRow>, Error> {
    let registry = planners::registry();
    let shop = Shop::new(plan, &registry)?;
    let mut worker = Worker::new(&shop)?;
    let beat = AtomicU64::new(0);
    let mut rows = Vec::new();
    for stratum in 0..plan.strata.len() as u32 {
        for j in 0..each {
            rows.push(worker.run(stratum, j, &beat)?.row);
        }
    }
    Ok(rows)
}

fn report(rows: &[RunRow], half: &[RunRow], step_s: f64) {
    let mut changes: Vec<f64> = rows
        .iter()
        .zip(half)
        .filter_map(|(a, b)| Some((a.cpa_hull_m? - b.cpa_hull_m?).abs()))
        .collect();
    changes.sort_by(f64::total_cmp);
    let at = |share: f64| changes[((changes.len() - 1) as f64 * share) as usize];
    println!("{} encounters, step {step_s} s against {} s", rows.len(), step_s / 2.0);
    println!(
        "change of the smallest distance, m: median {:.5}, p99 {:.5}, p99.9 {:.5}, largest {:.5}",
        at(0.5),
        at(0.99),
        at(0.999),
        at(1.0)
    );
    let outcomes = rows.iter().zip(half).filter(|(a, b)| a.outcome != b.outcome).count();
    let broken = rows
        .iter()
        .zip(half)
        .filter(|(a, b)| a.safety_radius_broken != b.safety_radius_broken)
        .count();
    println!("outcomes that differ {outcomes}, safety radius {broken}");
    for check in Check::ALL {
        let mut moved: BTreeMap<(Status, Status), u32> = BTreeMap::new();
        for (a, b) in rows.iter().zip(half) {
            let (a, b) = (a.check(check).status, b.check(check).status);
            if a != b {
                *moved.entry((a, b)).or_default() += 1;
            }
        }
        for ((a, b), count) in moved {
            println!("  {}: {} -> {} in {count}", check.name(), a.name(), b.name());
        }
    }
}
