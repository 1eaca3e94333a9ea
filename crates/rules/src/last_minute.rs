//! The last-minute margin: how long before the last safe instant own ship acted.
//!
//! No rule by itself; "in extremis" of the literature (Krata & Montewka 2015 and others).
//! Reading: the last instant at which own ship alone could still clear (contact), found by the
//! campaign on the nominal track and stored in the trace; this check only reads it. Acting after
//! it, or not at all where own ship had to act, fails; within 10 s of it warns.
//! Source: rules specification, section 10.

use crate::case::Case;
use crate::ruling::{Ruling, not_applicable};
use record::{Check, LastInstant, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    let empty = |status: Status, detail: &'static str| {
        Ruling::new(Check::LastMinute, case.life.target, status).detail(detail).done()
    };
    let Some(last) = case.life.last_minute() else {
        return empty(Status::NotEvaluated, "NO-LAST-MINUTE-DATA");
    };
    let (last_s, indicative) = match last.own {
        LastInstant::NeverCritical => return not_applicable(case, Check::LastMinute),
        LastInstant::BeforeStart => return empty(Status::Inconclusive, "TOO-LATE-AT-START"),
        LastInstant::At(t_s) => (t_s, false),
        LastInstant::Indicative(t_s) => (t_s, true),
    };
    let end_s = case.life.time_s(case.end());
    let Some(acted_s) = case.action.manoeuvre_s else {
        let owed = case.gives_way() || case.life.touched();
        return match (owed, end_s > last_s) {
            (false, _) => not_applicable(case, Check::LastMinute),
            (true, false) if !case.complete() => empty(Status::Inconclusive, ""),
            (true, _) => ruling(case, Status::Fail, "FAIL-NO-ACTION", last_s, last_s - end_s),
        };
    };
    let margin_s = last_s - acted_s;
    let (status, detail) = if margin_s < 0.0 {
        (Status::Fail, "IN-EXTREMIS")
    } else if margin_s < case.rules().timing.last_minute_warn_s {
        (Status::Warn, if indicative { "INDICATIVE" } else { "LAST-MINUTE" })
    } else {
        (Status::Pass, if indicative { "INDICATIVE" } else { "" })
    };
    ruling(case, status, detail, last_s, margin_s)
}

fn ruling(
    case: &Case<'_>,
    status: Status,
    detail: &'static str,
    last_s: f64,
    margin_s: f64,
) -> Verdict {
    let acted_s = case.action.manoeuvre_s;
    Ruling::new(Check::LastMinute, case.life.target, status)
        .detail(detail)
        .margin(margin_s)
        .at(last_s)
        .seconds("t_lm", last_s)
        .seconds("t_man", acted_s)
        .say(|| {
            let when = case.when(last_s);
            let last = "own ship could last have cleared alone";
            match acted_s {
                None => format!("{when}, {last}, and did not act."),
                Some(_) if margin_s < 0.0 => {
                    format!("{when}, {last}; she acted {:.0} seconds later.", -margin_s)
                }
                Some(_) => format!("{when}, {last}; she acted {margin_s:.0} seconds before."),
            }
        })
        .done()
}
