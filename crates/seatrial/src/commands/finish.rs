//! From parts to files: the table, the summary, the report, the manifest.

use super::avoiding_cost::PlannerCost;
use crate::rendering::{Rendering, card};
use crate::say::{say, say_text};
use crate::timing::Stopwatch;
use crate::{files, headline, manifest};
use campaign::{Error, Folder, Plan, RowSink};
use planner_api::Registry;
use record::{Outcome, RunRow};
use report::{Card, Compared};
use std::fs;
use std::path::Path;
use summary::{Summary, Tallies};

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
        rows.iter().try_for_each(|row| self.0.push(row)).map_err(Error::stage)
    }
}

/// How a result was made, and what is said of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct How {
    pub(super) threads: usize,
    /// Print nothing.
    pub(super) quiet: bool,
    /// It is one of several that are compared in the folder above.
    pub(super) beside: bool,
}

/// Writes every file of a result, the manifest last, and prints the headline.
pub(super) fn finish(
    plan: &Plan,
    registry: &Registry,
    folder: &Folder,
    stopwatch: &mut Stopwatch,
    how: How,
) -> Result<PlannerResult, Error> {
    let dir = folder.path();
    let sink = table::ParquetSink::create(dir.join("runs.parquet"));
    let mut sink = TableSink(sink.map_err(Error::stage)?);
    let finished = campaign::finish(plan, folder, &mut sink)?;
    sink.0.finish().map_err(Error::stage)?;
    stopwatch.lap("table");
    let mut rendering = Rendering::new(
        plan,
        registry,
        finished.tallies.clone(),
        finished.root_digest.clone(),
        (&finished.cases, &finished.findings, &finished.disagreements),
    )?;
    rendering.card.beside = how.beside;
    files::write(&dir.join("summary.json"), rendering.summary.to_json().as_bytes())?;
    report::write(dir, &rendering.input()).map_err(Error::stage)?;
    stopwatch.lap("report");
    let timing = stopwatch.json(how.threads, finished.encounters);
    files::write(&dir.join("timing.json"), timing.as_bytes())?;
    manifest::write(dir, plan, &finished)?;
    folder.end()?;
    if !how.quiet {
        say_text!("{}", headline::table(&rendering.summary, headline::terminal_columns()));
        say!("root digest {}", finished.root_digest);
        if let Some(warning) = headline::wall_clock(rendering.summary.ended_by_wall_clock) {
            say!("{warning}");
        }
        say!("report: {}", dir.join("report.html").display());
    }
    let link = link(dir);
    let Rendering { card, summary, tallies, .. } = rendering;
    Ok(PlannerResult { card, summary, tallies, link })
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
pub(super) fn comparison(
    out: &Path,
    results: &[PlannerResult],
    costs: &[PlannerCost],
    quiet: bool,
) -> Result<(), Error> {
    let columns: Vec<Compared<'_>> = results
        .iter()
        .map(|r| Compared {
            card: &r.card,
            summary: &r.summary,
            tallies: &r.tallies,
            link: &r.link,
            cost: costs.iter().find(|c| c.planner == r.card.planner).map(|c| &c.cost),
        })
        .collect();
    report::write_comparison(out, &columns).map_err(Error::stage)?;
    if !quiet {
        say!("comparison: {}", out.join("comparison.html").display());
    }
    Ok(())
}
