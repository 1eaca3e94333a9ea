//! Rules 5 and 7: look-out, and determining if risk of collision exists.
//!
//! Track data cannot prove a look-out, so nothing here fails.
//! Reading: from the sensors' and the planner's own declarations: the track confirmed and the
//! conflict declared before stage 3 is a pass, later or never a warning; an alert with no risk near
//! it is a false one. A planner that declares nothing is not evaluated.
//! Source: rules specification, sections 7 (alerts) and 9 (R5-R7 observables).

use crate::case::Case;
use crate::life::PairLife;
use crate::ruling::Ruling;
use record::{Check, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    let life = case.life;
    if life.trace.alerts.is_empty() {
        return nothing(life, Status::NotEvaluated).detail("NO-ALERTS-DECLARED").done();
    }
    let alert_s = alerts(life).find(|&t_s| !is_false(life, t_s));
    let deadline_s = case.stage_s(3);
    let late = |t_s: f64| deadline_s.is_some_and(|deadline_s| t_s > deadline_s);
    let tracked_s = life.pair().tracked_s;
    let (status, detail) = match alert_s {
        None if deadline_s.is_none() && !case.complete() => (Status::Inconclusive, ""),
        None => (Status::Warn, "MISSED-ALERT"),
        Some(t_s) if late(t_s) => (Status::Warn, "MISSED-ALERT"),
        _ if tracked_s.is_none_or(late) => (Status::Warn, "LATE-TRACK"),
        _ if false_alerts(life) > 0 => (Status::Warn, "FALSE-ALERT"),
        Some(_) => (Status::Pass, ""),
    };
    let latency_s = alert_s.map(|t_s| (t_s - case.clock_s()).max(0.0));
    let told_s = alert_s.or(deadline_s).unwrap_or(case.onset_s());
    nothing(life, status)
        .detail(detail)
        .margin_if(deadline_s.zip(alert_s).map(|(deadline_s, t_s)| deadline_s - t_s))
        .at(told_s)
        .seconds("t_alert_latency", latency_s)
        .seconds("t_trk", tracked_s)
        .share("false_alerts", false_alerts(life) as f64)
        .say(|| {
            let when = case.when(told_s);
            match detail {
                "MISSED-ALERT" => {
                    format!("{when}, own ship had not declared the risk in time. Rule 7.")
                }
                "LATE-TRACK" => format!("{when}, own ship had no confirmed track. Rule 5."),
                _ => format!("{when}; own ship also declared risk where there was none. Rule 7."),
            }
        })
        .done()
}

/// A pair that was never at risk: an alert about it is a false one.
pub(crate) fn without_risk(life: &PairLife<'_>) -> Verdict {
    let false_alerts = false_alerts(life);
    if false_alerts == 0 {
        return nothing(life, Status::NotApplicable).done();
    }
    let first_s = alerts(life).next();
    nothing(life, Status::Warn)
        .detail("FALSE-ALERT")
        .at(first_s)
        .share("false_alerts", false_alerts as f64)
        .say(|| {
            let seconds = first_s.unwrap_or(0.0) as u64;
            let (minutes, seconds) = (seconds / 60, seconds % 60);
            format!(
                "At {minutes:02}:{seconds:02}, own ship declared risk with a vessel that was \
                 never one. Rule 7."
            )
        })
        .done()
}

fn nothing(life: &PairLife<'_>, status: Status) -> Ruling {
    Ruling::new(Check::R5R7, life.target, status)
}

fn alerts<'a>(life: &'a PairLife<'_>) -> impl Iterator<Item = f64> + 'a {
    let ours = |target: u8| usize::from(target) == life.target;
    life.trace.alerts.iter().filter(move |alert| ours(alert.target)).map(|alert| alert.t_s)
}

/// No risk within the tolerance of the alert.
fn is_false(life: &PairLife<'_>, t_s: f64) -> bool {
    let tolerance_s = life.rules.timing.alert_tolerance_s;
    !life.risk.iter().any(|&(from, until)| {
        t_s >= life.time_s(from) - tolerance_s && t_s <= life.time_s(until) + tolerance_s
    })
}

fn false_alerts(life: &PairLife<'_>) -> usize {
    alerts(life).filter(|&t_s| is_false(life, t_s)).count()
}
