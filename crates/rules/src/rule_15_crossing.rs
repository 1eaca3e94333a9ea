//! Rule 15: crossing, with the other on own starboard side.
//!
//! Rule 15: "... the vessel which has the other on her own starboard side shall keep out of the
//! way and shall, if the circumstances of the case admit, avoid crossing ahead of the other
//! vessel."
//! Reading: crossing the other's projected track within the preferred distance ahead of her bow,
//! from the onset of risk to the closest point and while risk is open as it was sailed, fails; the
//! angle band of the literature misfires for hard turns and is only in the score. A turn to port
//! that passes astern is a warning. Slowing and stopping are lawful (8(e)). Whether she kept out of
//! the way is said by Rules 8 and 16.
//! Source: rules specification, section 9 (R15); score after Hagen 2023, equations 31 and 32.

use crate::case::Case;
use crate::crossing_ahead::{Line, crossed_ahead};
use crate::ruling::{Ruling, not_applicable};
use crate::score;
use geom::EncounterClass;
use record::{Check, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    if case.class != EncounterClass::CrossingStbd || case.restricted {
        return not_applicable(case, Check::R15);
    }
    let from = case.onset.k.min(case.end());
    let crossing = crossed_ahead(case, Line::Track, from, case.end());
    let to_port = case.action.side() < 0.0;
    let (status, detail) = match crossing {
        Some(_) => (Status::Fail, "FAIL-15-AHEAD"),
        None if to_port => (Status::Warn, "PORT"),
        None => (Status::Pass, ""),
    };
    let r_pref_m = case.rules().distance.r_pref_m;
    let turn_rad = case.action.turn.map(|turn| turn.size_rad);
    let t_s = case.action.turn_seen_s;
    let ruling = Ruling::new(Check::R15, case.life.target, status)
        .detail(detail)
        .margin(crossing.map_or(case.life.distance_m(), |crossing| crossing.ahead_m - r_pref_m))
        .score(score::crossing(case))
        .at(t_s.or(crossing.map(|crossing| crossing.t_s)))
        .metres("r_pref", r_pref_m)
        .radians("turn", turn_rad.unwrap_or(0.0));
    let ruling = match crossing {
        Some(crossing) => {
            ruling.metres("ahead_of_bow", crossing.ahead_m).seconds("t_crossed", crossing.t_s)
        }
        None => ruling,
    };
    ruling.say(|| sentence(case, crossing.map(|c| (c.t_s, c.ahead_m)), turn_rad.zip(t_s))).done()
}

fn sentence(case: &Case<'_>, crossing: Option<(f64, f64)>, turn: Option<(f64, f64)>) -> String {
    match (crossing, turn) {
        (Some((_, ahead_m)), Some((turn_rad, t_s))) => {
            let (when, altered) = (case.when(t_s), Case::altered(turn_rad));
            format!(
                "{when}, own ship {altered} and passed {ahead_m:.0} m ahead of her bow. Rule 15."
            )
        }
        (Some((crossed_s, ahead_m)), None) => {
            let when = case.when(crossed_s);
            format!("{when}, own ship passed {ahead_m:.0} m ahead of her bow. Rule 15.")
        }
        (None, turn) => {
            let (turn_rad, t_s) = turn.unwrap_or((0.0, case.onset_s()));
            format!("{}, own ship {}. Rule 15.", case.when(t_s), Case::altered(turn_rad))
        }
    }
}
