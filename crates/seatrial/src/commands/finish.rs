//! From parts to files: the table, the summary, the report, the manifest.

use super::avoiding_cost::PlannerCost;
use crate::rendering::{Rendering, card};
use crate::say::{say, say_text};
use crate::timing::Stopwatch;
use crate::{files, headline, manifest};
use campaign::folder::TABLE;
use campaign::parts_list::{PARTS_LIST, PartsList};
use campaign::{Error, Folder, PartRead, Plan, RowSink};
use planner_api::Registry;
use record::Outcome;
use report::{Card, Compared};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
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

/// Where the rows of a result go.
enum Rows {
    Table(Box<table::ParquetSink>),
    /// They stay in the parts, which are listed.
    Parts(PartsList),
}

impl Rows {
    /// Either takes the place of the other, which is of an earlier merge.
    fn create(dir: &Path, in_parts: bool) -> Result<Self, Error> {
        let other = dir.join(if in_parts { TABLE } else { PARTS_LIST });
        match fs::remove_file(&other) {
            Err(e) if e.kind() == ErrorKind::NotFound => {}
            removed => removed.map_err(Error::io("remove", &other))?,
        }
        if in_parts {
            return PartsList::create(dir).map(Self::Parts);
        }
        let table = table::ParquetSink::create(dir.join(TABLE)).map_err(Error::stage)?;
        Ok(Self::Table(Box::new(table)))
    }

    fn finish(self) -> Result<(), Error> {
        match self {
            Self::Table(table) => table.finish().map(drop).map_err(Error::stage),
            Self::Parts(list) => list.finish(),
        }
    }
}

impl RowSink for Rows {
    fn push(&mut self, part: PartRead) -> Result<(), Error> {
        match self {
            Self::Table(table) => {
                part.rows.iter().try_for_each(|row| table.push(row)).map_err(Error::stage)
            }
            Self::Parts(list) => list.push(part),
        }
    }
}

/// Takes rows until the user wants to stop.
struct Stoppable<'a> {
    rows: Rows,
    dir: &'a Path,
    how: How<'a>,
}

impl RowSink for Stoppable<'_> {
    fn push(&mut self, part: PartRead) -> Result<(), Error> {
        self.how.stop_if_interrupted(self.dir)?;
        self.rows.push(part)
    }
}

/// How a result was made, and what is said of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct How<'a> {
    pub(super) threads: usize,
    /// Leave the rows in the parts instead of making a table of them.
    pub(super) in_parts: bool,
    /// Print nothing.
    pub(super) quiet: bool,
    /// It is one of several that are compared in the folder above.
    pub(super) beside: bool,
    /// Set when the user wants to stop.
    pub(super) interrupted: &'a AtomicBool,
    /// What the user is told then.
    pub(super) go_on: &'a str,
}

impl How<'_> {
    fn stop_if_interrupted(&self, dir: &Path) -> Result<(), Error> {
        let stopped = self.interrupted.load(Ordering::Relaxed);
        if stopped { Err(Error::stopped(dir, self.go_on)) } else { Ok(()) }
    }
}

/// Writes every file of a result, the manifest last, and prints the headline.
pub(super) fn finish(
    plan: &Plan,
    registry: &Registry,
    folder: &Folder,
    stopwatch: &mut Stopwatch,
    how: How<'_>,
) -> Result<PlannerResult, Error> {
    let dir = folder.path();
    let mut rows = Stoppable { rows: Rows::create(dir, how.in_parts)?, dir, how };
    let finished = campaign::finish(plan, folder, &mut rows)?;
    rows.rows.finish()?;
    stopwatch.lap("table");
    let mut rendering = Rendering::new(
        plan,
        registry,
        finished.tallies.clone(),
        finished.root_digest.clone(),
        (&finished.cases, &finished.findings, &finished.disagreements),
    )?;
    rendering.card.beside = how.beside;
    how.stop_if_interrupted(dir)?;
    files::write(&dir.join("summary.json"), rendering.summary.to_json().as_bytes())?;
    report::write(dir, &rendering.input()).map_err(Error::stage)?;
    stopwatch.lap("report");
    let timing = stopwatch.json(how.threads, finished.encounters);
    files::write(&dir.join("timing.json"), timing.as_bytes())?;
    manifest::write(dir, plan, &finished)?;
    folder.end()?;
    if !how.quiet {
        say_text!("{}", headline::table(&rendering.summary, headline::terminal_columns()));
        if let Some(failures) = headline::planner_failures(&rendering.summary) {
            say!("{failures}");
            if let Some((id, said)) = rendering.first_failure() {
                say!("{id}: {said}");
            }
        }
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
    for row in crate::stored::rows(dir, plan)? {
        tallies.add(&row?);
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
