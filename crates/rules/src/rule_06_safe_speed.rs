//! Rule 6: safe speed.
//!
//! Rule 6: "Every vessel shall at all times proceed at a safe speed so that she can ... be stopped
//! within a distance appropriate to the prevailing circumstances."
//! Reading: at the onset of risk (when the track was confirmed, if later) the distance in which own
//! ship stops from her speed is not more than the distance to the other ship. It needs the stopping
//! model that own ship declares; without one it is not evaluated, because a distance guessed from a
//! turn rate would be an invention.
//! Source: rules specification, section 9 (R5-R7 observables).

use crate::case::Case;
use crate::life::PairLife;
use crate::ruling::{Ruling, not_applicable};
use record::{Check, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    let Some(stopping) = case.life.actual.own.ship.stopping else {
        return without_model(Check::R6, case.life);
    };
    let k = case.life.sample(case.clock_s());
    if k > case.end() {
        // confirmed after the closest point: nothing was left to be stopped for
        return not_applicable(case, Check::R6);
    }
    let speed_mps = case.life.actual.own.stw_mps[k];
    let (stops_m, there_is_m) = (stopping.distance_m(speed_mps), case.life.distance_at_m(k));
    let safe = stops_m <= there_is_m;
    let (status, detail) = if safe { (Status::Pass, "") } else { (Status::Fail, "FAIL-6") };
    let t_s = case.life.time_s(k);
    Ruling::new(Check::R6, case.life.target, status)
        .detail(detail)
        .margin(there_is_m - stops_m)
        .at(t_s)
        .metres_a_second("speed", speed_mps)
        .metres("stopping_distance", stops_m)
        .metres("available_distance", there_is_m)
        .say(|| {
            format!(
                "{}, own ship at {speed_mps:.1} m/s needed {stops_m:.0} m to stop. Rule 6.",
                case.when(t_s)
            )
        })
        .done()
}

/// A pair that was never at risk: there was nothing to stop for.
pub(crate) fn without_risk(life: &PairLife<'_>) -> Verdict {
    match life.actual.own.ship.stopping {
        None => without_model(Check::R6, life),
        Some(_) => Ruling::new(Check::R6, life.target, Status::NotApplicable).done(),
    }
}

pub(crate) fn without_model(check: Check, life: &PairLife<'_>) -> Verdict {
    Ruling::new(check, life.target, Status::NotEvaluated).detail("NO-STOPPING-MODEL").done()
}
