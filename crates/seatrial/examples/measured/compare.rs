//! Several planners on the same encounters: the tables of `docs/measured/compare.md`, and the
//! smallest distances of named scenes.

use crate::line;
use serde_json::Value;
use std::path::{Path, PathBuf};

type Cell = fn(&Value) -> String;

const TABLES: [(&str, Cell); 4] = [
    ("Collisions, %", |s| bounded(&s["collision"])),
    ("Safety radius broken, %", |s| bounded(&s["safety_radius"])),
    ("Smallest distance between hulls, m: first percentile · median", |s| {
        let cpa = &s["min_cpa_m"];
        format!("{} · {}", number(&cpa["p01"]), number(&cpa["median"]))
    }),
    ("Reaction time, s: median · 95 % (none: that many never reacted)", |s| {
        let times = &s["reaction_time_s"];
        format!("{} · {}", number(&times["median"]), number(&times["p95"]))
    }),
];

fn bounded(rate: &Value) -> String {
    let percent = |key: &str| format!("{:.1}", 100.0 * rate[key].as_f64().unwrap_or(f64::NAN));
    format!("{} [{}, {}]", percent("rate"), percent("lower_95"), percent("upper_95"))
}

fn number(value: &Value) -> String {
    value.as_f64().map_or_else(|| "none".to_owned(), |value| format!("{value:.1}"))
}

fn json(path: &Path) -> anyhow::Result<Value> {
    let text = std::fs::read_to_string(path)
        .map_err(|e| anyhow::anyhow!("cannot read {}: {e}", path.display()))?;
    Ok(serde_json::from_str(&text)?)
}

/// The summaries of all planners of a comparison, in the order in which they were asked for.
fn summaries(dir: &Path, timing: &Value) -> anyhow::Result<Vec<Value>> {
    let mut all: Vec<Value> = Vec::new();
    let planners = timing["planners"].as_array().into_iter().flatten();
    for name in planners.filter_map(|planner| planner["planner"].as_str()) {
        all.push(json(&dir.join(name).join("summary.json"))?);
    }
    Ok(all)
}

/// One table for each number, one line for each stratum, one column for each planner.
pub(crate) fn print(out: &mut String, dirs: &[PathBuf]) -> anyhow::Result<()> {
    for dir in dirs {
        let timing = json(&dir.join("timing.json"))?;
        let all = summaries(dir, &timing)?;
        let names: Vec<String> = all.iter().map(|s| format!("`{}`", text(&s["planner"]))).collect();
        for (title, cell) in TABLES {
            line!(out, "\n## {title}\n\n| stratum | {} |", names.join(" | "));
            line!(out, "|---|{}", "---|".repeat(names.len()));
            let strata = all.first().map_or(0, |s| s["strata"].as_array().map_or(0, Vec::len));
            for i in 0..strata {
                let cells: Vec<String> = all.iter().map(|s| cell(&s["strata"][i])).collect();
                line!(out, "| {} | {} |", text(&all[0]["strata"][i]["name"]), cells.join(" | "));
            }
        }
        line!(out, "\n## What avoiding costs\n");
        line!(out, "| planner | extra distance, m | extra time, s | us per call |");
        line!(out, "|---|---|---|---|");
        for cost in timing["planners"].as_array().into_iter().flatten() {
            let of = |key: &str| cost[key].as_f64().unwrap_or(f64::NAN);
            let (distance_m, time_s) = (of("extra_distance_m_mean"), of("extra_time_s_mean"));
            let (name, us) = (text(&cost["planner"]), of("planning_us_per_call"));
            line!(out, "| `{name}` | {distance_m:.0} | {time_s:.1} | {us:.2} |");
        }
    }
    Ok(())
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or("?")
}

/// Smallest distance between hulls, or how the run ended: one line for each scene.
pub(crate) fn print_scenes(out: &mut String, dirs: &[PathBuf]) -> anyhow::Result<()> {
    let mut lines: Vec<(String, Vec<String>)> = Vec::new();
    for dir in dirs {
        let mut i = 0;
        crate::each_row(dir, |row| {
            let distance = row.cpa_hull_m.map_or_else(|| "none".to_owned(), |m| format!("{m:.1}"));
            let cell = match row.outcome {
                record::Outcome::Completed => distance,
                other => other.name().replace('_', " "),
            };
            if lines.len() == i {
                lines.push((row.id.stratum.to_string(), Vec::new()));
            }
            lines[i].1.push(cell);
            i += 1;
        })?;
    }
    let names: Vec<String> =
        dirs.iter().map(|dir| crate::planner(dir)).collect::<anyhow::Result<_>>()?;
    line!(out, "| scene | {} |\n|---|{}", names.join(" | "), "---|".repeat(names.len()));
    lines.iter().for_each(|(scene, cells)| line!(out, "| {scene} | {} |", cells.join(" | ")));
    Ok(())
}
