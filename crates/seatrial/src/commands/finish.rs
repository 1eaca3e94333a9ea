//! From parts to files: the table, the summary, the report, the manifest.

use crate::timing::Stopwatch;
use crate::{files, headline, manifest};
use campaign::worker::{self, Run};
use campaign::{Error, Finished, Folder, Plan, RowSink};
use planner_api::Registry;
use record::{Outcome, RunRow};
use report::{Card, Case, Compared, ReportInput};
use std::fs;
use std::path::Path;
use summary::{Summary, SummaryHead, Tallies};

/// Encounters that a report shows with their tracks.
const CASES_SHOWN: usize = 12;

/// What a comparison needs of one planner.
#[derive(Debug)]
pub(super) struct PlannerResult {
    card: Card,
    summary: Summary,
    tallies: Tallies,
    link: String,
}

impl PlannerResult {
    /// Whether a run of it ended its process or never returned: it is not run again outside an
    /// engine.
    pub(super) fn takes_its_process(&self) -> bool {
        let strata = &self.summary.strata;
        [Outcome::PlannerHung, Outcome::PlannerCrashed]
            .iter()
            .any(|outcome| strata.iter().any(|s| s.outcomes.get(outcome).is_some_and(|&k| k > 0)))
    }
}

struct TableSink(table::ParquetSink);

impl RowSink for TableSink {
    fn push(&mut self, rows: Vec<RunRow>) -> Result<(), Error> {
        rows.into_iter()
            .try_for_each(|row| self.0.push(row))
            .map_err(|e| Error::Fault(format!("failed to {e}")))
    }
}

/// Writes every file of a result, the manifest last, and prints the headline.
pub(super) fn finish(
    plan: &Plan,
    registry: &Registry,
    folder: &Folder,
    stopwatch: &mut Stopwatch,
    (threads, quiet): (usize, bool),
) -> Result<PlannerResult, Error> {
    let dir = folder.path();
    let sink = table::ParquetSink::create(&dir.join("runs.parquet"));
    let mut sink = TableSink(sink.map_err(|e| Error::Fault(format!("failed to {e}")))?);
    let finished = campaign::finish(plan, folder, &mut sink)?;
    sink.0.finish().map_err(|e| Error::Fault(format!("failed to {e}")))?;
    stopwatch.lap("table");
    let summary = summarise(plan, &finished);
    files::write(&dir.join("summary.json"), summary.to_json().as_bytes())?;
    let cases = cases(plan, registry, &finished)?;
    let card = card(plan)?;
    let tallies = &finished.tallies;
    report::write(dir, &ReportInput { card: &card, summary: &summary, tallies, cases: &cases })
        .map_err(|e| Error::Fault(format!("failed to {e}")))?;
    stopwatch.lap("report");
    manifest::write(dir, plan, &finished)?;
    let timing = stopwatch.json(threads, finished.encounters);
    files::write(&dir.join("timing.json"), timing.as_bytes())?;
    folder.end()?;
    if !quiet {
        print!("{}", headline::table(&summary, headline::terminal_columns()));
        println!("root digest {}", finished.root_digest);
        println!("report: {}", dir.join("report.html").display());
    }
    let link = link(dir);
    Ok(PlannerResult { card, summary, tallies: finished.tallies, link })
}

fn summarise(plan: &Plan, finished: &Finished) -> Summary {
    let head = SummaryHead {
        campaign: plan.campaign.clone(),
        planner: plan.planner.name.clone(),
        seed: plan.seed,
        root_digest: finished.root_digest.clone(),
    };
    Summary::new(head, &finished.tallies, plan.strata.iter().map(String::as_str))
}

/// The encounters that the report shows, run again: their traces were not kept.
fn cases(plan: &Plan, registry: &Registry, finished: &Finished) -> Result<Vec<Case>, Error> {
    let ids = finished.cases.ids(CASES_SHOWN);
    ids.iter().map(|id| worker::run_alone(plan, registry, id).map(case)).collect()
}

/// A run as the report wants it.
pub(super) fn case(run: Run) -> Case {
    Case { encounter: run.encounter, trace: run.trace, judgement: run.judgement, row: run.row }
}

/// What a report says of the plan.
fn card(plan: &Plan) -> Result<Card, Error> {
    let mut resolved = Vec::new();
    let json = plan.json()?;
    for key in ["seed", "encounters_per_stratum", "planner", "run", "source", "build"] {
        flatten(key, &json[key], &mut resolved);
    }
    Ok(Card {
        title: plan.title.clone(),
        campaign: plan.campaign.clone(),
        planner: plan.planner.name.clone(),
        rules: format!("{} ({})", plan.rules.name, &plan.rules.hash[..12]),
        tool: format!("seatrial {}", plan.build.tool_version),
        distance: plan.run.distance,
        safety_radius_m: plan.run.safety_radius_m,
        // not the folder itself: two runs into two folders are byte for byte the same
        replay_command: "seatrial replay DIR {id}".to_owned(),
        resolved,
        not_claimed: Vec::new(),
    })
}

/// Longest list of a plan that a report shows item by item.
const ITEMS_SHOWN: usize = 12;

/// `key.path = value` lines of a plan.
fn flatten(key: &str, value: &serde_json::Value, lines: &mut Vec<(String, String)>) {
    use serde_json::Value;
    match value {
        Value::Object(map) => {
            map.iter().for_each(|(name, value)| flatten(&format!("{key}.{name}"), value, lines));
        }
        Value::Array(items) if items.len() > ITEMS_SHOWN => {
            lines.push((key.to_owned(), format!("{} entries", items.len())));
        }
        Value::Array(items) if items.iter().any(|item| item.is_object() || item.is_array()) => {
            for (i, item) in items.iter().enumerate() {
                flatten(&format!("{key}[{i}]"), item, lines);
            }
        }
        Value::String(text) => lines.push((key.to_owned(), text.clone())),
        other => lines.push((key.to_owned(), other.to_string())),
    }
}

/// The last part of a folder's path: reports must not depend on where they were written.
fn folder_shown(dir: &Path) -> String {
    dir.file_name().map_or_else(|| "DIR".to_owned(), |name| name.to_string_lossy().into_owned())
}

fn link(dir: &Path) -> String {
    format!("{}/report.html", folder_shown(dir))
}

/// The result of a planner that was finished before.
pub(super) fn read_back(plan: &Plan, folder: &Folder) -> Result<PlannerResult, Error> {
    let dir = folder.path();
    let path = dir.join("summary.json");
    let text = fs::read_to_string(&path).map_err(Error::io("read", &path))?;
    let summary = serde_json::from_str(&text)
        .map_err(|e| Error::input(format!("{} is damaged: {e}", path.display())))?;
    let mut tallies = Tallies::new();
    let damaged = |e: table::TableError| Error::input(format!("failed to {e}"));
    for row in table::read_rows(dir.join("runs.parquet")).map_err(damaged)? {
        tallies.add(&row.map_err(damaged)?);
    }
    Ok(PlannerResult { card: card(plan)?, summary, tallies, link: link(dir) })
}

/// Writes the side-by-side of several planners.
pub(super) fn comparison(out: &Path, results: &[PlannerResult], quiet: bool) -> Result<(), Error> {
    let columns: Vec<Compared<'_>> = results
        .iter()
        .map(|r| Compared {
            card: &r.card,
            summary: &r.summary,
            tallies: &r.tallies,
            link: &r.link,
        })
        .collect();
    report::write_comparison(out, &columns).map_err(|e| Error::Fault(format!("failed to {e}")))?;
    if !quiet {
        println!("comparison: {}", out.join("comparison.html").display());
    }
    Ok(())
}
