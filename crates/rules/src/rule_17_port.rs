//! Rule 17(c): the stand-on vessel does not alter to port for a vessel on her own port side.
//!
//! Rule 17(c): "A power-driven vessel which takes action in a crossing situation in accordance
//! with subparagraph (a)(ii) ... shall, if the circumstances of the case admit, not alter course
//! to port for a vessel on her own port side."
//! Reading: in stage 3, with the other on the port side and forward of the overtaking sector, an
//! offset to port of 10 degrees fails and one of 2 warns. In stage 4 Rule 17(b) asks for "such
//! action as will best aid" and names no side: a warning (a failure in the conservative reading).
//! A return to the route after the closest point is none; a turn begun before risk opened is a
//! warning.
//! Source: rules specification, section 9 (R17).

use crate::case::Case;
use crate::ruleset::PortInExtremis;
use crate::ruling::{Ruling, not_applicable};
use geom::EncounterClass;
use geom::class::OVERTAKING_SECTOR_RAD;
use record::{Check, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    let crossing = case.class == EncounterClass::CrossingPort && !case.restricted;
    let (Some(stage_3), true) = (case.stages[1], crossing && case.stands_on()) else {
        return not_applicable(case, Check::R17Port);
    };
    let m = &case.rules().manoeuvre;
    let stage_4 = case.stages[2].unwrap_or(case.end() + 1);
    let in_3_rad = port_rad(case, stage_3, stage_4);
    let in_4_rad = port_rad(case, stage_4, case.end() + 1);
    if in_3_rad.max(in_4_rad) < m.detectable_turn_rad && case.action.turn.is_none() {
        let status = if case.complete() { Status::Pass } else { Status::Inconclusive };
        let margin_rad = m.substantial_turn_rad - in_3_rad.max(in_4_rad);
        return Ruling::new(Check::R17Port, case.life.target, status).margin(margin_rad).done();
    }
    if !on_port_side(case) {
        return not_applicable(case, Check::R17Port);
    }
    let conservative = case.rules().stand_on.port_in_stage_4 == PortInExtremis::Fail;
    let judged_rad = if conservative { in_3_rad.max(in_4_rad) } else { in_3_rad };
    let (mut status, mut detail) = if judged_rad >= m.substantial_turn_rad {
        (Status::Fail, "FAIL-17C")
    } else if judged_rad >= m.detectable_turn_rad {
        (Status::Warn, "PORT")
    } else if in_4_rad >= m.detectable_turn_rad {
        (Status::Warn, "PORT-IN-EXTREMIS")
    } else {
        (Status::Pass, "")
    };
    if case.turned_early() && status == Status::Fail {
        (status, detail) = (Status::Warn, "EARLY");
    }
    if let (Some(_), true) = (case.forced_by, status == Status::Fail) {
        (status, detail) = (Status::Warn, "FORCED");
    }
    let t_s = case.action.turn_seen_s.unwrap_or(case.life.time_s(stage_3));
    let worst_rad = in_3_rad.max(in_4_rad);
    Ruling::new(Check::R17Port, case.life.target, status)
        .detail(detail)
        .margin(m.substantial_turn_rad - judged_rad)
        .at(t_s)
        .radians("x_port_stage_3", in_3_rad)
        .radians("x_port_stage_4", in_4_rad)
        .seconds("t_3", case.stage_s(3))
        .seconds("t_4", case.stage_s(4))
        .say(|| {
            let when = case.when(t_s);
            let altered = Case::altered(-worst_rad);
            format!("{when}, own ship {altered} for a vessel on her own port side. Rule 17(c).")
        })
        .done()
}

/// Whether own ship was off to port in stage 4 by what can be seen (for the score).
pub(crate) fn in_stage_4(case: &Case<'_>) -> bool {
    let port = |k: usize| port_rad(case, k, case.end() + 1);
    let least_rad = case.rules().manoeuvre.detectable_turn_rad;
    case.stages[2].is_some_and(|stage_4| port(stage_4) >= least_rad)
}

/// Largest offset to port held in a range of samples, radians.
fn port_rad(case: &Case<'_>, from: usize, until: usize) -> f64 {
    let from = from.max(case.action.search_from);
    case.action.held_offset_rad(case.life, case.own, -1.0, from..until.max(from))
}

/// The other was on the port side, forward of the overtaking sector, when the action to port began.
/// Where there is none (a way back to the route is none) the class says so.
fn on_port_side(case: &Case<'_>) -> bool {
    let back = case.action.first_return(case.life).unwrap_or(usize::MAX);
    let acts = case.action.runs.iter().take_while(|run| run.start < back);
    let to_port = acts.into_iter().find(|run| run.size_rad < 0.0);
    to_port.is_none_or(|run| {
        let beta_rad = crate::risk::relative(&case.life.actual, run.start).beta_rad;
        beta_rad > -OVERTAKING_SECTOR_RAD && beta_rad < 0.0
    })
}
