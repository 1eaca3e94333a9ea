//! The table of the paper's own world: one line for each planner and class.

use crate::{each_row, planner, rate};
use record::{Outcome, RunRow};

/// The paper's R in this world, metres between centres.
const R_M: f64 = 150.0;
/// First alterations below this do not count, radians.
const TURN_RAD: f64 = geom::units::deg(2.0);

#[derive(Default)]
struct Line {
    n: u64,
    unknown: u64,
    below: [u64; 3],
    starboard: u64,
    port: u64,
    cap: u64,
    no_goal: u64,
}

impl Line {
    fn add(&mut self, row: &RunRow) {
        self.n += 1;
        self.unknown += u64::from(row.unknown);
        let cpa_m = row.cpa_centre_m.unwrap_or(0.0);
        for (count, limit_m) in self.below.iter_mut().zip([R_M, 0.9 * R_M, 0.5 * R_M]) {
            *count += u64::from(cpa_m < limit_m);
        }
        let turn_rad = row.first_turn_rad.unwrap_or(0.0);
        self.starboard += u64::from(turn_rad > TURN_RAD);
        self.port += u64::from(turn_rad < -TURN_RAD);
        self.cap += u64::from(row.events.inner_loop_cap > 0);
        // these campaigns run until the goal is reached
        self.no_goal += u64::from(row.outcome != Outcome::Completed);
    }

    fn print(&self, planner: &str, stratum: &str) {
        let Self { n, unknown, below: [r, r90, half], starboard, port, cap, no_goal } = *self;
        let none = n - starboard - port;
        let share = |k: u64| format!("{:.1}", 100.0 * k as f64 / n as f64);
        println!(
            "| {planner} | {stratum} | {n} | {unknown} | {} | {} | {} | {} | {} | {} | {} | {} |",
            rate(r, 0, n),
            rate(r90, 0, n),
            rate(half, 0, n),
            share(port),
            share(starboard),
            share(none),
            share(cap),
            share(no_goal),
        );
    }
}

pub(crate) fn print(dirs: &[String]) -> anyhow::Result<()> {
    println!(
        "| planner | class | n | unknown | CPA < R | CPA < 0.9 R | CPA < R/2 | first to port | \
         to starboard | none | cap met | goal not reached |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    for dir in dirs {
        let mut lines: Vec<(String, Line)> = Vec::new();
        each_row(dir, |row| {
            let stratum = row.id.stratum.to_string();
            if lines.last().is_none_or(|(name, _)| *name != stratum) {
                lines.push((stratum, Line::default()));
            }
            if let Some((_, line)) = lines.last_mut() {
                line.add(row);
            }
        })?;
        let planner = planner(dir)?;
        lines.iter().for_each(|(stratum, line)| line.print(&planner, stratum));
    }
    Ok(())
}
