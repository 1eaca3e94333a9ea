//! Rule 14: head-on.
//!
//! Rule 14(a): "When two power-driven vessels are meeting on reciprocal or nearly reciprocal
//! courses so as to involve risk of collision each shall alter her course to starboard so that
//! each shall pass on the port side of the other."
//! Reading, first match: 10 degrees to port before the first starboard run of 10 fails; less than
//! 10 degrees to starboard fails, whatever the speed did; 30 degrees to starboard (or 10, at the
//! preferred distance) and a port-to-port pass pass; the rest is a warning, and so is a yaw to
//! port of 2 to 10 degrees first. A port turn begun before risk opened was free and is a warning,
//! but she must still alter to starboard: the next match decides.
//! Source: rules specification, section 9 (R14); score after Hagen 2023, equations 27 to 30.

use crate::case::Case;
use crate::ruling::{Ruling, not_applicable};
use crate::score;
use geom::EncounterClass;
use record::{Check, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    if case.class != EncounterClass::HeadOn || case.restricted {
        return not_applicable(case, Check::R14);
    }
    let m = &case.rules().manoeuvre;
    let (action, end) = (case.action, case.end());
    let starboard = |run: &&crate::runs::TurnRun| run.size_rad >= m.substantial_turn_rad;
    let first_starboard = action.runs.iter().find(starboard).map_or(end + 1, |run| run.edge);
    let search = action.search_from..first_starboard.max(action.search_from);
    let x_port_rad = action.held_offset_rad(case.life, case.own, -1.0, search);
    let x_stbd_rad = action.x_stbd_rad;
    let port_to_port =
        case.life.passed.is_some_and(|pose| pose.beta_rad < 0.0 && pose.alpha_rad < 0.0);
    let preferred = case.life.distance_m() >= case.rules().distance.r_pref_m;
    let large =
        x_stbd_rad >= m.apparent_turn_rad || (x_stbd_rad >= m.substantial_turn_rad && preferred);
    let to_port = x_port_rad >= m.substantial_turn_rad;
    let (mut status, detail) = if to_port && !case.turned_early() {
        (Status::Fail, "FAIL-14-PORT")
    } else if x_stbd_rad < m.substantial_turn_rad {
        (Status::Fail, "FAIL-14-NOACT")
    } else if to_port {
        (Status::Warn, "EARLY")
    } else if large && port_to_port && x_port_rad < m.detectable_turn_rad {
        (Status::Pass, "")
    } else if large && port_to_port {
        (Status::Warn, "YAW-TO-PORT")
    } else if port_to_port {
        (Status::Warn, "SMALL")
    } else {
        (Status::Warn, "NOT-PORT-TO-PORT")
    };
    let margin_rad = match detail {
        "FAIL-14-PORT" => m.substantial_turn_rad - x_port_rad,
        _ => x_stbd_rad - m.substantial_turn_rad,
    };
    if detail == "FAIL-14-NOACT" && !case.complete() {
        status = Status::Inconclusive;
    }
    let did_not = detail == "FAIL-14-NOACT";
    let t_s = action.turn_seen_s.filter(|_| !did_not).unwrap_or(case.onset_s());
    Ruling::new(Check::R14, case.life.target, status)
        .detail(detail)
        .margin(margin_rad)
        .score(score::head_on(case))
        .at(t_s)
        .radians("x_stbd", x_stbd_rad)
        .radians("x_port", x_port_rad)
        .radians("beta_cpa", case.life.passed.map_or(f64::NAN, |pose| pose.beta_rad))
        .radians("alpha_cpa", case.life.passed.map_or(f64::NAN, |pose| pose.alpha_rad))
        .say(|| sentence(case, t_s, detail, x_port_rad, x_stbd_rad))
        .done()
}

fn sentence(case: &Case<'_>, t_s: f64, detail: &str, port_rad: f64, stbd_rad: f64) -> String {
    let when = case.when(t_s);
    let to_starboard = Case::altered(stbd_rad);
    match detail {
        "FAIL-14-NOACT" => format!("{when}, own ship did not alter course to starboard. Rule 14."),
        "FAIL-14-PORT" | "EARLY" | "YAW-TO-PORT" => {
            format!("{when}, own ship {}. Rule 14.", Case::altered(-port_rad))
        }
        "SMALL" => format!("{when}, own ship only {to_starboard}. Rule 14."),
        _ => format!("{when}, own ship {to_starboard} and did not pass port to port. Rule 14."),
    }
}
