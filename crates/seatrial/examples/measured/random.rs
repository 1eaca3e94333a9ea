//! The table of the paper's own world: one line for each planner and class.

use crate::{each_row, line, planner, rate};
use record::{Check, RunRow, Status};
use std::path::PathBuf;

/// The paper's R in this world, metres between centres.
const R_M: f64 = 150.0;
/// First alterations below this do not count, radians.
const TURN_RAD: f64 = geom::units::deg(2.0);

#[derive(Default)]
struct Line {
    n: u64,
    unknown: u64,
    below: [u64; 3],
    /// Spoilt before they came so near.
    open: [u64; 3],
    starboard: u64,
    port: u64,
    /// Failures of the turn direction check, of the runs to which it applied.
    turn: (u64, u64),
    cap: u64,
    no_goal: u64,
}

impl Line {
    fn add(&mut self, row: &RunRow) {
        self.n += 1;
        self.unknown += u64::from(row.unknown);
        // a run that was spoilt proves the distance that it had already come to, and no other
        let cpa_m = row.cpa_centre_m.unwrap_or(f64::INFINITY);
        for (i, limit_m) in [R_M, 0.9 * R_M, 0.5 * R_M].into_iter().enumerate() {
            self.below[i] += u64::from(cpa_m < limit_m);
            self.open[i] += u64::from(row.unknown && cpa_m >= limit_m);
        }
        let turn_rad = row.first_turn_rad.unwrap_or(0.0);
        self.starboard += u64::from(turn_rad > TURN_RAD);
        self.port += u64::from(turn_rad < -TURN_RAD);
        let turn = row.check(Check::Turn).status;
        self.turn.0 += u64::from(turn == Status::Fail);
        let open = [Status::NotApplicable, Status::NotEvaluated];
        self.turn.1 += u64::from(!open.contains(&turn));
        self.cap += u64::from(row.events.inner_loop_cap > 0);
        self.no_goal += u64::from(!row.goal_reached);
    }

    fn print(&self, out: &mut String, planner: &str, stratum: &str) {
        let Self { n, unknown, below, open, starboard, port, turn, cap, no_goal } = *self;
        let none = n - starboard - port;
        let share = |k: u64| format!("{:.1}", 100.0 * k as f64 / n as f64);
        line!(
            out,
            "| {planner} | {stratum} | {n} | {unknown} | {} | {} | {} | {} | {} | {} | {} of {} | \
             {} | {} |",
            rate(below[0], open[0], n),
            rate(below[1], open[1], n),
            rate(below[2], open[2], n),
            share(port),
            share(starboard),
            share(none),
            turn.0,
            turn.1,
            share(cap),
            share(no_goal),
        );
    }
}

pub(crate) fn print(out: &mut String, dirs: &[PathBuf]) -> anyhow::Result<()> {
    line!(
        out,
        "| planner | class | n | unknown | CPA < R | CPA < 0.9 R | CPA < R/2 | first to port | \
         to starboard | none | turn direction failed | cap met | goal not reached |"
    );
    line!(out, "|---|---|---|---|---|---|---|---|---|---|---|---|---|");
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
        lines.iter().for_each(|(stratum, line)| line.print(out, &planner, stratum));
    }
    Ok(())
}
