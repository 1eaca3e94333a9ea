//! What went wrong, clustered: one finding for each kind of event and class of encounter.
//!
//! Rows go in, in any number and in order of id; a finding holds how many there were and the worst
//! of them. Memory grows with the kinds, not with the rows.

use crate::PlannerEvent;
use record::{Check, EncounterClass, EncounterId, Outcome, RunRow, Status};
use std::collections::BTreeMap;

/// What went wrong. The order is that of reports: the gravest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Event {
    /// Own ship's hull touched another ship or a hazard.
    Contact(Outcome),
    /// The planner failed, or the bench could not run the encounter.
    Unknown(Outcome),
    /// Nearer than the safety radius, without contact.
    SafetyRadius,
    /// A check of the judge failed.
    Failed(Check),
    /// The planner counted this of itself, on at least one beat.
    Planner(PlannerEvent),
}

impl Event {
    /// What a reader sees.
    pub fn title(self) -> String {
        match self {
            Self::Contact(outcome) => outcome.name().replace('_', " "),
            Self::Unknown(outcome) => {
                format!("outcome unknown: {}", outcome.name()).replace('_', " ")
            }
            Self::SafetyRadius => "safety radius broken".to_owned(),
            Self::Failed(check) => format!("{}: fail", check.title()),
            Self::Planner(event) => format!("planner's count: {}", event.title()),
        }
    }
}

/// One cluster.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What went wrong.
    pub event: Event,
    /// In which class of encounter, by the judge; `None`: risk never opened.
    pub class: Option<EncounterClass>,
    /// Runs in which it did.
    pub count: u64,
    /// The worst of them: the hardest contact, the smallest distance, the smallest margin, the most
    /// beats; of equals the first.
    pub worst: EncounterId,
    /// How it ended.
    pub worst_outcome: Outcome,
    badness: f64,
}

/// All findings of a campaign.
#[derive(Clone, Debug, Default)]
pub struct Findings(BTreeMap<(Event, Option<EncounterClass>), Finding>);

impl Findings {
    /// Adds a run to every cluster that it belongs to.
    pub fn offer(&mut self, row: &RunRow) {
        let near_m = row.cpa_hull_m.unwrap_or(f64::INFINITY);
        if matches!(row.outcome, Outcome::Collision | Outcome::Grounding) {
            self.add(Event::Contact(row.outcome), row.impact_mps.unwrap_or(0.0), row);
        } else if row.unknown {
            self.add(Event::Unknown(row.outcome), 0.0, row);
        }
        if row.safety_radius_broken && !row.collided() {
            self.add(Event::SafetyRadius, -near_m, row);
        }
        for check in Check::ALL {
            let cell = row.check(check);
            if cell.status == Status::Fail {
                self.add(Event::Failed(check), -cell.margin.unwrap_or(0.0), row);
            }
        }
        for event in PlannerEvent::ALL {
            let beats = event.beats(&row.events);
            if beats > 0 {
                self.add(Event::Planner(event), f64::from(beats), row);
            }
        }
    }

    /// The findings, the gravest kind first, the most frequent first within a kind.
    pub fn list(&self) -> Vec<&Finding> {
        let mut list: Vec<&Finding> = self.0.values().collect();
        list.sort_by(|a, b| {
            a.event.cmp(&b.event).then(b.count.cmp(&a.count)).then(a.class.cmp(&b.class))
        });
        list
    }

    fn add(&mut self, event: Event, badness: f64, row: &RunRow) {
        let new = || Finding {
            event,
            class: row.class,
            count: 0,
            worst: row.id.clone(),
            worst_outcome: row.outcome,
            badness,
        };
        let finding = self.0.entry((event, row.class)).or_insert_with(new);
        finding.count += 1;
        if badness > finding.badness {
            finding.badness = badness;
            finding.worst = row.id.clone();
            finding.worst_outcome = row.outcome;
        }
    }
}
