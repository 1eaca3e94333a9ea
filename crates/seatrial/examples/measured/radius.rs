//! Where a ship that has planned to keep the safety radius came inside it: every such run of a
//! result under the first heading that fits, and under the last one if none does.

use crate::{each_row, line, planner};
use record::{Check, EncounterClass, RunRow, Status};
use std::path::PathBuf;

type Fits = fn(&RunRow) -> bool;

/// In the order in which they are asked.
const HEADINGS: [(&str, Fits); 8] = [
    ("no risk of the nominal tracks: the other ship altered into one", |row| row.class.is_none()),
    ("own ship stands on, and the limit of the rule set is kept", |row| {
        stands_on(row) && row.check(Check::Safe).status == Status::Pass
    }),
    ("own ship stands on, nearer, and the other ship altered", |row| stands_on(row) && alters(row)),
    ("own ship stands on, nearer, and the other ship kept her course", stands_on),
    ("own ship gives way, and the other ship altered", alters),
    ("own ship gives way, but another class is within 2 degrees", |row| row.ambiguous),
    ("own ship gives way, and fails the rule of her class", fails_rule_of_class),
    ("none of these", |_| true),
];

fn stands_on(row: &RunRow) -> bool {
    matches!(row.class, Some(EncounterClass::CrossingPort | EncounterClass::Overtaken))
}

fn alters(row: &RunRow) -> bool {
    row.intents.split('+').any(|intent| intent != "hold_course")
}

fn fails_rule_of_class(row: &RunRow) -> bool {
    [Check::R13, Check::R14, Check::R15].iter().any(|&c| row.check(c).status == Status::Fail)
}

/// Runs under one heading.
#[derive(Default)]
struct Under {
    runs: u64,
    too_near: u64,
    nearest: Option<(f64, String)>,
}

impl Under {
    fn add(&mut self, row: &RunRow) {
        self.runs += 1;
        self.too_near += u64::from(row.check(Check::Safe).status == Status::Fail);
        let distance_m = row.cpa_hull_m.unwrap_or(0.0);
        if self.nearest.as_ref().is_none_or(|(least_m, _)| distance_m < *least_m) {
            self.nearest = Some((distance_m, row.id.to_string()));
        }
    }
}

pub(crate) fn print(out: &mut String, dirs: &[PathBuf]) -> anyhow::Result<()> {
    for dir in dirs {
        let mut under: [Under; HEADINGS.len()] = Default::default();
        let (mut all, mut broken) = (0_u64, 0_u64);
        each_row(dir, |row| {
            all += 1;
            if !row.safety_radius_broken {
                return;
            }
            broken += 1;
            // the last heading fits everything
            let first = HEADINGS.iter().position(|(_, fits)| fits(row));
            under[first.unwrap_or(HEADINGS.len() - 1)].add(row);
        })?;
        line!(out, "\n`{}`: {broken} of {all} runs inside the safety radius.\n", planner(dir)?);
        line!(out, "| | runs | fail the passing distance | nearest, m | |");
        line!(out, "|---|---|---|---|---|");
        for ((heading, _), Under { runs, too_near, nearest }) in HEADINGS.iter().zip(&under) {
            let nearest = nearest.as_ref().map_or_else(
                || "| |".to_owned(),
                |(distance_m, id)| format!("{distance_m:.0} | `{id}` |"),
            );
            line!(out, "| {heading} | {runs} | {too_near} | {nearest}");
        }
    }
    Ok(())
}
