//! Rule 19: conduct of vessels in restricted visibility, not in sight of one another.
//!
//! Rule 19(d): a vessel that detects another by radar alone shall "avoid (i) an alteration of
//! course to port for a vessel forward of the beam, other than for a vessel being overtaken; (ii)
//! an alteration of course towards a vessel abeam or abaft the beam"; 19(e): where close quarters
//! with a vessel forward of the beam cannot be avoided she "shall reduce her speed to the minimum
//! at which she can be kept on her course".
//! Reading: no vessel stands on. (d) is judged on each turn of 10 degrees (2 warn), at the bearing
//! at which it began; "so far as possible": a warning where own last safe instant had passed. (e):
//! at half the close-quarters distance and still closing on a vessel forward of the beam she is at
//! steerage speed. Ample time and size are Rule 8's.
//! Source: rules specification, section 9 (R19). 19(b), safe speed, is a check
//! of its own.

use crate::case::Case;
use crate::ruling::{Ruling, not_applicable};
use crate::runs::TurnRun;
use geom::EncounterClass;
use record::{Check, Status, Verdict};
use std::f64::consts::FRAC_PI_2;

struct Finding {
    status: Status,
    detail: &'static str,
    t_s: f64,
    turn_rad: f64,
    beta_rad: f64,
}

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    if !case.restricted {
        return not_applicable(case, Check::R19);
    }
    let worst = case
        .action
        .runs
        .iter()
        .filter(|run| !case.life.in_sight_by(run.start))
        .filter_map(|run| wrong_turn(case, run))
        .chain(keeps_way_on(case))
        .reduce(|a, b| if b.status.severity() > a.status.severity() { b } else { a });
    let status = worst.as_ref().map_or(Status::Pass, |finding| finding.status);
    let m = &case.rules().manoeuvre;
    let margin_rad = match &worst {
        Some(finding) if finding.detail != "FAIL-19E" => {
            m.substantial_turn_rad - finding.turn_rad.abs()
        }
        Some(_) => -m.substantial_turn_rad,
        None => m.substantial_turn_rad,
    };
    let ruling = Ruling::new(Check::R19, case.life.target, status).margin(margin_rad);
    let Some(finding) = worst else { return ruling.done() };
    ruling
        .detail(finding.detail)
        .at(finding.t_s)
        .radians("turn", finding.turn_rad)
        .radians("beta", finding.beta_rad)
        .say(|| {
            let when = case.when(finding.t_s);
            let altered = Case::altered(finding.turn_rad);
            match finding.detail {
                "FAIL-19E" => format!("{when}, own ship had not reduced her speed. Rule 19(e)."),
                "FAIL-19D-II" => {
                    format!(
                        "{when}, own ship {altered}, towards her, abaft the beam. Rule 19(d)(ii)."
                    )
                }
                _ => format!("{when}, own ship {altered} in restricted visibility. Rule 19(d)(i)."),
            }
        })
        .done()
}

/// 19(d)(i) and (ii).
fn wrong_turn(case: &Case<'_>, run: &TurnRun) -> Option<Finding> {
    let beta_rad = crate::risk::relative(&case.life.actual, run.start).beta_rad;
    let forward = beta_rad.abs() < FRAC_PI_2;
    let overtaking = case.class == EncounterClass::Overtaking;
    let detail = if forward && run.size_rad < 0.0 && !overtaking {
        "FAIL-19D-I"
    } else if !forward && run.size_rad * beta_rad > 0.0 {
        "FAIL-19D-II"
    } else {
        return None;
    };
    let t_s = case.life.time_s(run.start);
    let large = run.size_rad.abs() >= case.rules().manoeuvre.substantial_turn_rad;
    let no_choice = case.had_no_choice(t_s);
    let early = t_s < case.onset_s();
    // (d)(ii) has no warning for a small turn: section 9 gives one for (d)(i) only
    if !large && detail == "FAIL-19D-II" {
        return None;
    }
    let status = if large && !no_choice && !early { Status::Fail } else { Status::Warn };
    Some(Finding { status, detail, t_s, turn_rad: run.size_rad, beta_rad })
}

/// 19(e).
fn keeps_way_on(case: &Case<'_>) -> Option<Finding> {
    let rules = &case.rules().restricted_visibility;
    let life = case.life;
    let within_m = rules.close_quarters_m / 2.0;
    let steerage_mps = (life.actual.own.ship.steerage_mps)
        .unwrap_or(rules.steerage_fraction * life.trace.cruise_mps);
    let k = (case.onset.k..=case.end()).find(|&k| {
        life.distance_at_m(k) < within_m && life.actual.closing(k) && !life.in_sight_by(k)
    })?;
    let beta_rad = crate::risk::relative(&life.actual, k).beta_rad;
    let slow = case.own.speed_mps[k] <= steerage_mps;
    (beta_rad.abs() < FRAC_PI_2 && !slow).then(|| Finding {
        status: Status::Fail,
        detail: "FAIL-19E",
        t_s: life.time_s(k),
        turn_rad: 0.0,
        beta_rad,
    })
}
