//! TURN: rule-consistent turn direction, the headline check; one line for each pair.
//!
//! Rules 14 (starboard), 15 (not ahead), 17(a)(i) (hold), 17(c) (not to port for a ship on the
//! port side).
//! Reading: the first run of at least 10 degrees that belongs to this target decides, by a table;
//! a smaller one counts only where there is none, and then a failure becomes a warning. Speed
//! alone says nothing here. A turn begun before risk opened is not failed: the law leaves the
//! choice free.
//! Source: rules specification, section 9 (TURN); the table is this project's.

use crate::case::Case;
use crate::crossing_ahead::{Line, crossed_ahead};
use crate::ruleset::PortInExtremis;
use crate::ruling::{Ruling, not_applicable};
use geom::EncounterClass;
use record::{Check, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    if case.restricted {
        return not_applicable(case, Check::Turn);
    }
    let Some(turn) = case.action.turn else {
        let status = if case.complete() { Status::NotApplicable } else { Status::Inconclusive };
        return Ruling::new(Check::Turn, case.life.target, status).detail("NO-TURN").done();
    };
    if let Some(other) = case.forced_by {
        let detail = format!("FORCED-BY-TARGET-{other}");
        return Ruling::new(Check::Turn, case.life.target, Status::NotApplicable)
            .detail(detail)
            .done();
    }
    let t_s = case.action.turn_seen_s.unwrap_or(case.life.time_s(turn.start));
    let small = turn.size_rad.abs() < case.rules().manoeuvre.substantial_turn_rad;
    let (mut status, mut detail) = by_table(case, t_s);
    let mut ahead_m = None;
    if case.class == EncounterClass::CrossingStbd && turn.size_rad < 0.0 {
        let from = case.onset.k.min(case.end());
        if let Some(crossing) = crossed_ahead(case, Line::Track, from, case.end()) {
            ahead_m = Some(crossing.ahead_m);
            (status, detail) = (Status::Fail, "FAIL-15-AHEAD");
        }
    }
    let failed = status == Status::Fail;
    if failed && small {
        (status, detail) = (Status::Warn, "SMALL");
    }
    if case.turned_early() && detail != "FAIL-15-AHEAD" && status == Status::Fail {
        (status, detail) = (Status::Warn, "EARLY");
    }
    let margin_rad = if failed { -turn.size_rad.abs() } else { turn.size_rad.abs() };
    Ruling::new(Check::Turn, case.life.target, status)
        .detail(detail)
        .margin(margin_rad)
        .at(t_s)
        .radians("turn", turn.size_rad)
        .metres("range", case.range_at_m(t_s))
        .radians("beta", case.onset.seen.beta_rad)
        .radians("alpha", case.onset.seen.alpha_rad)
        .seconds("t_17a", case.may_act_s())
        .say(|| sentence(case, t_s, turn.size_rad, ahead_m))
        .done()
}

/// The table of section 9, for a turn that is large enough.
fn by_table(case: &Case<'_>, t_s: f64) -> (Status, &'static str) {
    let starboard = case.action.side() > 0.0;
    let may_act = case.may_act_s().is_some_and(|from_s| t_s >= from_s);
    let early = case.turned_early();
    let in_extremis = case.stage_s(4).is_some_and(|from_s| t_s >= from_s)
        && case.rules().stand_on.port_in_stage_4 == PortInExtremis::Warn;
    match (case.class, starboard) {
        (EncounterClass::HeadOn, true) | (EncounterClass::CrossingStbd, true) => (Status::Pass, ""),
        (EncounterClass::HeadOn, false) => (Status::Fail, "FAIL-14-PORT"),
        (EncounterClass::CrossingStbd, false) => (Status::Warn, "PORT"),
        (EncounterClass::Overtaking | EncounterClass::Static, _) => (Status::Pass, ""),
        (EncounterClass::CrossingPort, true) if may_act || early => (Status::Pass, ""),
        (EncounterClass::CrossingPort, true) => (Status::Warn, "BEFORE-17A"),
        (EncounterClass::CrossingPort, false) if in_extremis => (Status::Warn, "PORT-IN-EXTREMIS"),
        (EncounterClass::CrossingPort, false) => (Status::Fail, "FAIL-17C"),
        (EncounterClass::Overtaken, _) if !may_act && !early => (Status::Warn, "BEFORE-17A"),
        // Cockcroft & Lameijer p. 109
        (EncounterClass::Overtaken, false) if case.onset.seen.beta_rad < 0.0 => {
            (Status::Warn, "TOWARDS-OVERTAKER")
        }
        (EncounterClass::Overtaken, _) => (Status::Pass, ""),
    }
}

fn sentence(case: &Case<'_>, t_s: f64, turn_rad: f64, ahead_m: Option<f64>) -> String {
    let rule = match case.class {
        EncounterClass::HeadOn => "Rule 14",
        EncounterClass::CrossingStbd => "Rule 15",
        EncounterClass::CrossingPort if turn_rad < 0.0 => "Rule 17(c)",
        EncounterClass::CrossingPort | EncounterClass::Overtaken => "Rule 17(a)",
        EncounterClass::Overtaking => "Rule 13",
        EncounterClass::Static => "Rule 8",
    };
    let (when, altered) = (case.when(t_s), Case::altered(turn_rad));
    match ahead_m {
        Some(ahead_m) => {
            let bow = format!("passed {ahead_m:.0} m ahead of her bow");
            format!("{when}, own ship {altered} and {bow}. {rule}.")
        }
        None => format!("{when}, own ship {altered}. {rule}."),
    }
}
