//! Tables of the documents under `docs/`, computed from results; nothing in them is written by
//! hand.
//!
//! ```text
//! cargo run --release -p seatrial --example measured -- failures DIR...
//! cargo run --release -p seatrial --example measured -- random DIR...
//! cargo run --release -p seatrial --example measured -- compare DIR
//! cargo run --release -p seatrial --example measured -- scenes DIR...
//! ```
//!
//! `failures` lists what checks and events found in a result, by class of the encounter, with exact
//! bounds and the worst encounter. `random` is the table of the paper's own world: distances,
//! first alterations, the inner loop's cap and the goal. `compare` sets the planners of a
//! comparison side by side; `scenes` the smallest distances of named scenes.

mod compare;
mod failures;
mod random;

use record::RunRow;
use std::path::Path;

fn main() -> anyhow::Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match args.split_first() {
        Some((what, dirs)) if what == "failures" && !dirs.is_empty() => failures::print(dirs),
        Some((what, dirs)) if what == "random" && !dirs.is_empty() => random::print(dirs),
        Some((what, dirs)) if what == "compare" && !dirs.is_empty() => compare::print(dirs),
        Some((what, dirs)) if what == "scenes" && !dirs.is_empty() => compare::print_scenes(dirs),
        _ => anyhow::bail!("usage: measured failures|random|compare|scenes DIR..."),
    }
}

/// The rows of a result, one by one.
fn each_row(dir: &str, mut each: impl FnMut(&RunRow)) -> anyhow::Result<()> {
    for row in table::read_rows(Path::new(dir).join("runs.parquet"))? {
        each(&row?);
    }
    Ok(())
}

/// The name of the planner of a result.
fn planner(dir: &str) -> anyhow::Result<String> {
    let text = std::fs::read_to_string(Path::new(dir).join("summary.json"))?;
    let summary: serde_json::Value = serde_json::from_str(&text)?;
    Ok(summary["planner"].as_str().unwrap_or("?").to_owned())
}

/// `k of n` in per cent with exact two-sided 95 % bounds; `open` runs count as none below and as
/// events above.
fn rate(k: u64, open: u64, n: u64) -> String {
    if n == 0 {
        return "none of none".to_owned();
    }
    let bound = |k: u64| stats::clopper_pearson(k.min(n), n, 0.05).expect("k is at most n");
    let (lower, upper) = (bound(k).lower, bound(k + open).upper);
    let percent = |share: f64| format!("{:.3}", 100.0 * share);
    format!("{} [{}, {}]", percent(k as f64 / n as f64), percent(lower), percent(upper))
}
