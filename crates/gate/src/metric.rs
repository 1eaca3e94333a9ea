//! Metrics: events that an encounter has, has not, or cannot be said to have.
//!
//! The denominator of every metric is all encounters; a rule that does not apply is no event.
//! Unknown runs (planner failures, runs cut before their closest point) are undetermined for every
//! event that they do not prove. Source: statistics specification, section 5, items 2 and 8.

use crate::ArmRow;
use record::{Check, Outcome, Status};
use serde::{Deserialize, Serialize};
use stats::Observation;

/// What is counted, the worst first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Event {
    /// Own ship's hull touched another hull or a hazard.
    Collision,
    /// The planner, and nobody else, ended the run.
    PlannerFailure,
    /// Closer than the safety radius.
    SafetyRadius,
    /// A check of the judge failed.
    Check(Check),
    /// Closer than a multiple of the safety radius, so that a limit that was lowered shows. The
    /// least of all: it breaks no limit.
    Near,
}

const NAMED: [(&str, Event); 4] = [
    ("collision", Event::Collision),
    ("planner_failure", Event::PlannerFailure),
    ("safety_radius", Event::SafetyRadius),
    ("near", Event::Near),
];

impl Event {
    /// The word used in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Check(check) => check.name(),
            other => NAMED.iter().find(|(_, event)| *event == other).map_or("", |(name, _)| name),
        }
    }

    /// What a reader sees.
    pub fn title(self) -> &'static str {
        match self {
            Self::Collision => "Collision",
            Self::PlannerFailure => "Planner failure",
            Self::SafetyRadius => "Safety radius broken",
            Self::Near => "Near the safety radius",
            Self::Check(check) => check.title(),
        }
    }

    /// The event with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        let named = NAMED.iter().find(|(word, _)| *word == name).map(|(_, event)| *event);
        named.or_else(|| Check::from_name(name).map(Self::Check))
    }

    /// Every name, for messages.
    pub fn names() -> String {
        let named = NAMED.iter().map(|(name, _)| *name);
        named.chain(Check::ALL.into_iter().map(Check::name)).collect::<Vec<_>>().join(", ")
    }

    /// Whether this run had it. `near_m` is the distance below which a run is near.
    pub fn of(self, row: &ArmRow, near_m: f64) -> Observation {
        let unless_unknown = |event: bool| match (event, row.unknown) {
            (true, _) => Observation::Event,
            (false, true) => Observation::Undetermined,
            (false, false) => Observation::NoEvent,
        };
        match self {
            Self::Collision => {
                unless_unknown(matches!(row.outcome, Outcome::Collision | Outcome::Grounding))
            }
            Self::PlannerFailure => match row.outcome {
                Outcome::Invalid => Observation::Undetermined,
                outcome if outcome.is_planner_failure() => Observation::Event,
                _ => Observation::NoEvent,
            },
            Self::SafetyRadius => unless_unknown(row.safety_radius_broken),
            Self::Near => unless_unknown(row.cpa_m.is_some_and(|cpa_m| cpa_m < near_m)),
            Self::Check(check) => match row.status(check) {
                Status::Fail => Observation::Event,
                Status::Inconclusive => Observation::Undetermined,
                // a run without a judgement says nothing of any rule
                Status::NotEvaluated if row.unknown => Observation::Undetermined,
                _ => Observation::NoEvent,
            },
        }
    }
}

impl Serialize for Event {
    fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Event {
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let name = String::deserialize(from)?;
        Self::from_name(&name).ok_or_else(|| {
            serde::de::Error::custom(format!("there is no event `{name}`; {}", Self::names()))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::Digest;

    fn row(outcome: Outcome, unknown: bool) -> ArmRow {
        ArmRow {
            id: 0,
            outcome,
            digest: Digest(0),
            unknown,
            safety_radius_broken: false,
            cpa_m: Some(200.0),
            statuses: vec![Status::Pass; Check::COUNT],
        }
    }

    #[test]
    fn names_are_read_back() {
        for event in NAMED.iter().map(|(_, e)| *e).chain(Check::ALL.map(Event::Check)) {
            assert_eq!(Event::from_name(event.name()), Some(event));
        }
        assert_eq!(Event::from_name("nothing"), None);
    }

    #[test]
    fn an_unknown_run_proves_only_what_it_shows() {
        use Observation::{Event as Yes, NoEvent as No, Undetermined};
        let near_m = 180.0;
        let cut = ArmRow { safety_radius_broken: true, ..row(Outcome::Truncated, true) };
        assert_eq!(Event::SafetyRadius.of(&cut, near_m), Yes);
        assert_eq!(Event::Collision.of(&cut, near_m), Undetermined);
        assert_eq!(Event::PlannerFailure.of(&cut, near_m), No);
        let nan = ArmRow { statuses: Vec::new(), ..row(Outcome::PlannerNonFinite, true) };
        assert_eq!(Event::PlannerFailure.of(&nan, near_m), Yes);
        assert_eq!(Event::Collision.of(&nan, near_m), Undetermined);
        assert_eq!(Event::Check(Check::R14).of(&nan, near_m), Undetermined);
        let hit = row(Outcome::Collision, false);
        assert_eq!(Event::Collision.of(&hit, near_m), Yes);
        assert_eq!(Event::PlannerFailure.of(&hit, near_m), No);
    }

    #[test]
    fn near_is_a_strict_bound_and_a_rule_that_does_not_apply_is_no_event() {
        let mut run = row(Outcome::Completed, false);
        assert_eq!(Event::Near.of(&run, 200.0), Observation::NoEvent);
        assert_eq!(Event::Near.of(&run, 200.1), Observation::Event);
        run.statuses[Check::R14 as usize] = Status::NotApplicable;
        assert_eq!(Event::Check(Check::R14).of(&run, 0.0), Observation::NoEvent);
        run.statuses[Check::R14 as usize] = Status::Inconclusive;
        assert_eq!(Event::Check(Check::R14).of(&run, 0.0), Observation::Undetermined);
        run.statuses[Check::R14 as usize] = Status::Fail;
        assert_eq!(Event::Check(Check::R14).of(&run, 0.0), Observation::Event);
    }
}
