//! On which side own ship first altered, and how often Rule 8(c) failed: the tables of
//! `docs/measured/paper-random.md`, straight from the seed, without a result's folder.
//!
//! `cargo run --release -p campaign --example first_alterations -- FILE PLANNER...`, with FILE
//! `campaigns/paper-random.toml`; every encounter of the file is run.
#![forbid(unsafe_code)]

mod common;

use campaign::worker::{Shop, Worker};
use campaign::{Error, Overrides, Plan};
use record::{Check, RunRow, Status};
use std::sync::atomic::AtomicU64;

/// Alterations of less than this do not count, radians.
const TURN_RAD: f64 = geom::units::deg(2.0);

#[derive(Default)]
struct Line {
    n: u64,
    port: u64,
    starboard: u64,
    /// Failures of the turn direction check and of Rule 8(c), of the runs to which they applied.
    turn: (u64, u64),
    third: (u64, u64),
}

fn main() -> Result<(), Error> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [file, planners @ ..] = &words[..] else {
        return Err(Error::input("usage: first_alterations CAMPAIGN.toml PLANNER..."));
    };
    let overrides = Overrides { planners: planners.to_vec(), ..Overrides::default() };
    let registry = planners::registry();
    let plans = common::plans(file, &overrides, &registry, |_| ())?;
    println!(
        "| planner | class | n | first to port | to starboard | none | turn direction failed | \
         Rule 8(c) failed |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (planner, plan) in planners.iter().zip(&plans) {
        let shop = Shop::new(plan, &registry)?;
        let strata = 0..plan.strata.len();
        let lines: Vec<Result<Line, Error>> = std::thread::scope(|scope| {
            let work = |stratum: usize| {
                let shop = &shop;
                scope.spawn(move || line(plan, shop, stratum as u32))
            };
            let threads: Vec<_> = strata.map(work).collect();
            threads.into_iter().map(|t| t.join().expect("a line does not panic")).collect()
        });
        for (name, line) in plan.strata.iter().zip(lines) {
            line?.print(planner, name);
        }
    }
    Ok(())
}

fn line(plan: &Plan, shop: &Shop<'_>, stratum: u32) -> Result<Line, Error> {
    let mut worker = Worker::new(shop)?;
    let mut line = Line::default();
    for j in 0..plan.encounters_per_stratum {
        line.add(&worker.run(stratum, j, &AtomicU64::new(0))?.row);
    }
    Ok(line)
}

impl Line {
    fn add(&mut self, row: &RunRow) {
        self.n += 1;
        let turn_rad = row.first_turn_rad.unwrap_or(0.0);
        self.starboard += u64::from(turn_rad > TURN_RAD);
        self.port += u64::from(turn_rad < -TURN_RAD);
        let count = |(failed, applied): &mut (u64, u64), check: Check| {
            // a run that the planner spoilt has no cells
            let status = row.checks.get(check as usize).map(|cell| cell.status);
            *failed += u64::from(status == Some(Status::Fail));
            let open = [Status::NotApplicable, Status::NotEvaluated].map(Some);
            *applied += u64::from(status.is_some() && !open.contains(&status));
        };
        count(&mut self.turn, Check::Turn);
        count(&mut self.third, Check::R8Third);
    }

    fn print(&self, planner: &str, stratum: &str) {
        let Self { n, port, starboard, turn, third } = self;
        let share = |k: u64| format!("{:.1}", 100.0 * k as f64 / *n as f64);
        println!(
            "| {planner} | {stratum} | {n} | {} | {} | {} | {} of {} | {} of {} |",
            share(*port),
            share(*starboard),
            share(n - port - starboard),
            turn.0,
            turn.1,
            third.0,
            third.1
        );
    }
}
