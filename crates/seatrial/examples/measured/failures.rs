//! What the checks and the events of a result found, by class of the encounter.

use crate::{each_row, planner, rate};
use record::{Check, PlannerEvents, RunRow, Status};
use std::collections::BTreeMap;

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

type Event = (&'static str, fn(&PlannerEvents) -> u32);

const EVENTS: [Event; 5] = [
    ("event: inner loop at its cap", |e| e.inner_loop_cap),
    ("event: a limit cut the order", |e| e.limited),
    ("event: inside the circle called safe", |e| e.inside_called_safe),
    ("event: class changed within the encounter", |e| e.class_changes),
    ("event: receding target taken for a danger", |e| e.receding_flagged),
];

pub(crate) fn print(dirs: &[String]) -> anyhow::Result<()> {
    for dir in dirs {
        let mut clusters: BTreeMap<(String, String), Cluster> = BTreeMap::new();
        each_row(dir, |row| add(row, &mut clusters))?;
        println!("\n`{}`\n", planner(dir)?);
        let few = |cluster: &Cluster| (1..=LISTED).contains(&cluster.first.len());
        println!("| check or event | class | failed | warned | looked at | % [95 %] | worst |");
        println!("|---|---|---|---|---|---|---|");
        for ((what, class), cluster) in &clusters {
            let Some((_, id)) = &cluster.worst else { continue };
            let Cluster { fail, warn, open, looked_at, .. } = cluster;
            let share = rate(*fail, *open, *looked_at);
            println!("| {what} | {class} | {fail} | {warn} | {looked_at} | {share} | `{id}` |");
        }
        for ((what, class), cluster) in clusters.iter().filter(|((_, class), _)| class != "all") {
            if few(cluster) {
                println!("\n{what}, {class}: {}", cluster.first.join(", "));
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
    for (what, count) in EVENTS {
        let count = count(&row.events);
        put(what, failed(count > 0), -f64::from(count));
    }
}
