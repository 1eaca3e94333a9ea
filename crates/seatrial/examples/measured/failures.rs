//! What the checks and the events of a result found, by class of the encounter.

use crate::{each_row, line, planner, rate};
use record::{Check, RunRow, Status};
use std::collections::BTreeMap;
use std::path::PathBuf;
use summary::PlannerEvent;

/// Runs of one class in which a check or an event was looked at.
#[derive(Default)]
struct Cluster {
    fail: u64,
    warn: u64,
    open: u64,
    looked_at: u64,
    worst: Option<(f64, String)>,
    first: Vec<String>,
}

/// Failures that are so few are listed, all of them.
const LISTED: usize = 20;

impl Cluster {
    /// Adds a run; the smallest `worth` among the failures is the worst one.
    fn add(&mut self, row: &RunRow, status: Status, worth: f64) {
        match status {
            Status::NotApplicable | Status::NotEvaluated => return,
            Status::Fail => {
                self.fail += 1;
                if self.first.len() <= LISTED {
                    self.first.push(row.id.to_string());
                }
                if self.worst.as_ref().is_none_or(|(least, _)| worth < *least) {
                    self.worst = Some((worth, row.id.to_string()));
                }
            }
            Status::Warn => self.warn += 1,
            Status::Inconclusive => self.open += 1,
            Status::Pass => {}
        }
        self.looked_at += 1;
    }
}

pub(crate) fn print(out: &mut String, dirs: &[PathBuf]) -> anyhow::Result<()> {
    for dir in dirs {
        let mut clusters: BTreeMap<(String, String), Cluster> = BTreeMap::new();
        each_row(dir, |row| add(row, &mut clusters))?;
        line!(out, "\n`{}`\n", planner(dir)?);
        let few = |cluster: &Cluster| (1..=LISTED).contains(&cluster.first.len());
        line!(out, "| check or event | class | failed | warned | looked at | % [95 %] | worst |");
        line!(out, "|---|---|---|---|---|---|---|");
        for ((what, class), cluster) in &clusters {
            let Some((_, id)) = &cluster.worst else { continue };
            let Cluster { fail, warn, open, looked_at, .. } = cluster;
            let share = rate(*fail, *open, *looked_at);
            line!(out, "| {what} | {class} | {fail} | {warn} | {looked_at} | {share} | `{id}` |");
        }
        for ((what, class), cluster) in clusters.iter().filter(|((_, class), _)| class != "all") {
            if few(cluster) {
                line!(out, "\n{what}, {class}: {}", cluster.first.join(", "));
            }
        }
    }
    Ok(())
}

fn add(row: &RunRow, clusters: &mut BTreeMap<(String, String), Cluster>) {
    let class = row.class.map_or("no risk", |class| class.name());
    let mut put = |what: &str, status: Status, worth: f64| {
        for class in [class, "all"] {
            let key = (what.to_owned(), class.to_owned());
            clusters.entry(key).or_default().add(row, status, worth);
        }
    };
    let failed = |is: bool| if is { Status::Fail } else { Status::Pass };
    let distance_m = row.cpa_hull_m.unwrap_or(0.0);
    put("collision", failed(row.collided()), -row.impact_mps.unwrap_or(0.0));
    put("safety radius broken", failed(row.safety_radius_broken), distance_m);
    put("outcome unknown", failed(row.unknown), 0.0);
    for check in Check::ALL {
        let cell = row.check(check);
        put(check.title(), cell.status, cell.margin.unwrap_or(0.0));
    }
    for event in PlannerEvent::ALL {
        let beats = event.beats(&row.events);
        put(&format!("event: {}", event.title()), failed(beats > 0), -f64::from(beats));
    }
}
