//! Which encounters a report shows: few, chosen in one pass, ties broken by id.

use record::{Check, EncounterId, RunRow, Status};
use std::collections::BTreeMap;

/// Cases kept for each stratum and reason.
const KEPT_EACH: usize = 2;

/// Why an encounter is shown.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reason {
    /// The hulls touched.
    Collision,
    /// A check failed.
    Failed(Check),
    /// The smallest distance of its stratum.
    Closest,
}

/// One candidate.
#[derive(Clone, Debug, PartialEq)]
struct Candidate {
    badness: f64,
    row: RunRow,
}

/// The worst encounters so far, by stratum and reason.
#[derive(Clone, Debug, Default)]
pub struct Cases(BTreeMap<(String, Reason), Vec<Candidate>>);

impl Cases {
    /// Looks at a row, and keeps it if it is among the worst for some reason.
    pub fn offer(&mut self, row: &RunRow) {
        let near_m = row.cpa_hull_m.unwrap_or(f64::INFINITY);
        if row.outcome.is_planner_failure() {
            return;
        }
        if row.collided() {
            self.keep(Reason::Collision, row.impact_mps.unwrap_or(0.0), row);
        }
        for check in Check::ALL {
            let cell = row.check(check);
            if cell.status == Status::Fail {
                self.keep(Reason::Failed(check), -cell.margin.unwrap_or(0.0), row);
            }
        }
        if near_m.is_finite() {
            self.keep(Reason::Closest, -near_m, row);
        }
    }

    fn keep(&mut self, reason: Reason, badness: f64, row: &RunRow) {
        let list = self.0.entry((row.id.stratum.to_string(), reason)).or_default();
        if list.len() == KEPT_EACH && list[KEPT_EACH - 1].badness >= badness {
            return;
        }
        let at = list.partition_point(|kept| kept.badness >= badness);
        list.insert(at, Candidate { badness, row: row.clone() });
        list.truncate(KEPT_EACH);
    }

    /// The ids to show, at most `most`: collisions first, then the closest, then failed checks.
    pub fn ids(&self, most: usize) -> Vec<EncounterId> {
        let rank = |reason: &Reason| match reason {
            Reason::Collision => 0,
            Reason::Closest => 1,
            Reason::Failed(_) => 2,
        };
        let mut all: Vec<(usize, u8, &EncounterId)> = self
            .0
            .iter()
            .flat_map(|((_, reason), list)| {
                list.iter().enumerate().map(move |(place, c)| (place, rank(reason), &c.row.id))
            })
            .collect();
        all.sort();
        let mut ids: Vec<EncounterId> = Vec::new();
        for (_, _, id) in all {
            if ids.len() < most && !ids.contains(id) {
                ids.push(id.clone());
            }
        }
        ids
    }
}
