//! Rule 8(b): no succession of small alterations.
//!
//! Rule 8(b): "a succession of small alterations of course and/or speed shall be avoided."
//! Reading: complete turns to the side of the action, of 2 to 30 degrees, that end before own ship
//! is readily apparently off her course; two are a warning, three a failure.
//! Source: rules specification, section 6; the counts are this project's (cf. Crystal Jewel and
//! British Aviator, Cockcroft & Lameijer p. 47 and 51).

use crate::case::Case;
use crate::ruling::{Ruling, not_applicable};
use geom::EncounterClass;
use record::{Check, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    let judged = case.gives_way()
        || case.stands_on()
        || case.restricted
        || case.class == EncounterClass::Static;
    let Some(turn) = case.action.turn.filter(|_| judged) else {
        return not_applicable(case, Check::R8Dribble);
    };
    let m = &case.rules().manoeuvre;
    let apparent_s = case.action.turn_apparent_s.unwrap_or(f64::INFINITY);
    let small = case.action.runs.iter().filter(|run| {
        let ended_s = case.life.time_s(run.end);
        run.size_rad * turn.size_rad > 0.0
            && run.size_rad.abs() < m.apparent_turn_rad
            && ended_s < apparent_s
            && run.end <= case.end()
    });
    let count = small.count() as u32;
    let (status, detail) = if count >= m.dribble_fail_runs {
        (Status::Fail, "FAIL-8-DRIBBLE")
    } else if count >= m.dribble_warn_runs {
        (Status::Warn, "DRIBBLE")
    } else {
        (Status::Pass, "")
    };
    let t_s = case.life.time_s(turn.start);
    Ruling::new(Check::R8Dribble, case.life.target, status)
        .detail(detail)
        .margin(f64::from(m.dribble_fail_runs) - 1.0 - f64::from(count))
        .at(t_s)
        .share("small_turns", f64::from(count))
        .say(|| {
            let side = if turn.size_rad < 0.0 { "port" } else { "starboard" };
            let when = case.when(t_s);
            format!("{when}, own ship began {count} small alterations to {side}. Rule 8(b).")
        })
        .done()
}
