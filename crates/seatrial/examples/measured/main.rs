//! Tables of the documents under `docs/`, computed from results; nothing in them is written by
//! hand.
//!
//! ```text
//! cargo run -p seatrial --example measured -- into RESULTS DOCUMENT...
//! cargo run -p seatrial --example measured -- print RESULTS TABLE [DIR...]
//! ```
//!
//! A document has marked blocks, `<!-- measured TABLE DIR... -->` up to `<!-- /measured -->`;
//! `into` puts the tables between the marks. Folders are relative to RESULTS, which the commands at
//! the head of `docs/seed-planner.md` fill. The tables:
//!
//! * `findings`: the seed planner's faults, each with the clusters of the reports that show it;
//! * `failures DIR...`: what checks and events found in a result, by class, with exact bounds and
//!   the worst encounter;
//! * `radius DIR...`: why runs came inside the safety radius;
//! * `random DIR...`: the paper's own world: distances, first alterations, inner loop and goal;
//! * `made DIR...`: the build that made the results, one line for each that differs;
//! * `compare DIR`: the planners of a comparison side by side;
//! * `scenes DIR...`: the smallest distances of named scenes.

mod compare;
mod failures;
mod findings;
mod radius;
mod random;

use anyhow::{Context, bail};
use record::RunRow;
use std::path::{Path, PathBuf};

/// Adds a line to a table.
macro_rules! line {
    ($out:expr, $($arg:tt)*) => {{
        $out.push_str(&format!($($arg)*));
        $out.push('\n');
    }};
}
pub(crate) use line;

const OPENS: &str = "<!-- measured ";
const CLOSES: &str = "<!-- /measured -->";

fn main() -> anyhow::Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match &args[..] {
        [what, results, documents @ ..] if what == "into" && !documents.is_empty() => {
            documents.iter().try_for_each(|document| into(Path::new(results), document))
        }
        [what, results, words @ ..] if what == "print" => {
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            print!("{}", table_of(Path::new(results), &words)?);
            Ok(())
        }
        _ => bail!("usage: measured into RESULTS DOCUMENT... | print RESULTS TABLE [DIR...]"),
    }
}

/// Puts every table of a document between its marks.
fn into(results: &Path, document: &str) -> anyhow::Result<()> {
    let text = std::fs::read_to_string(document).with_context(|| format!("reading {document}"))?;
    let mut written = String::new();
    let mut rest = text.as_str();
    while let Some(at) = rest.find(OPENS) {
        let mark_ends = at + rest[at..].find("-->").context("a mark without its end")? + 3;
        let words: Vec<&str> = rest[at + OPENS.len()..mark_ends - 3].split_whitespace().collect();
        let closes =
            rest.find(CLOSES).with_context(|| format!("{document}: {CLOSES} is missing"))?;
        written.push_str(&rest[..mark_ends]);
        let table = table_of(results, &words).with_context(|| format!("{document}: {words:?}"))?;
        written.push_str(&format!("\n\n{}\n\n{CLOSES}", table.trim()));
        rest = &rest[closes + CLOSES.len()..];
    }
    written.push_str(rest);
    std::fs::write(document, written).with_context(|| format!("writing {document}"))
}

fn table_of(results: &Path, words: &[&str]) -> anyhow::Result<String> {
    let Some((what, dirs)) = words.split_first() else { bail!("a table without a name") };
    let dirs: Vec<PathBuf> = dirs.iter().map(|dir| results.join(dir)).collect();
    let mut out = String::new();
    match *what {
        "findings" => findings::print(&mut out, results)?,
        "failures" => failures::print(&mut out, &dirs)?,
        "radius" => radius::print(&mut out, &dirs)?,
        "random" => random::print(&mut out, &dirs)?,
        "compare" => compare::print(&mut out, &dirs)?,
        "made" => made(&mut out, &dirs)?,
        "scenes" => compare::print_scenes(&mut out, &dirs)?,
        other => bail!("there is no table `{other}`"),
    }
    Ok(out)
}

/// The rows of a result, one by one.
fn each_row(dir: &Path, mut each: impl FnMut(&RunRow)) -> anyhow::Result<()> {
    for row in table::read_rows(dir.join("runs.parquet"))? {
        each(&row?);
    }
    Ok(())
}

/// The name of the planner of a result.
fn planner(dir: &Path) -> anyhow::Result<String> {
    let text = std::fs::read_to_string(dir.join("summary.json"))?;
    let summary: serde_json::Value = serde_json::from_str(&text)?;
    Ok(summary["planner"].as_str().unwrap_or("?").to_owned())
}

/// Commit, engine and planners of results.
fn made(out: &mut String, dirs: &[PathBuf]) -> anyhow::Result<()> {
    let mut lines: Vec<String> = Vec::new();
    for dir in dirs {
        let path = dir.join("manifest.json");
        let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let manifest: serde_json::Value = serde_json::from_str(&text)?;
        let short = |key: &str| {
            let text = manifest["build"][key].as_str().unwrap_or("?");
            text.get(..12).unwrap_or(text).to_owned()
        };
        let (commit, engine, planners) = (short("git_commit"), short("engine"), short("planners"));
        let line = format!("Made at commit {commit}, engine {engine}, planners {planners}.");
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    line!(out, "{}", lines.join("\n"));
    Ok(())
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
