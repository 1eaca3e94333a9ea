//! Rule 19(b): safe speed in restricted visibility.
//!
//! Rule 19(b): "Every vessel shall proceed at a safe speed adapted to the prevailing circumstances
//! and conditions of restricted visibility."
//! Reading: from the onset of risk until the other comes in sight or is passed, the distance in
//! which own ship stops from her speed is not more than a share of the visual range: the convention
//! "half the visibility", of which no source gives the value. It needs the stopping model that own
//! ship declares; without one it is not evaluated.
//! Source: rules specification, section 9 (R19); the share is this project's.

use crate::case::Case;
use crate::rule_06_safe_speed::without_model;
use crate::ruling::{Ruling, not_applicable};
use record::{Check, Status, Verdict, Visibility};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    let Visibility::Restricted { visual_range_m } = case.life.trace.visibility else {
        return not_applicable(case, Check::R19Speed);
    };
    if !case.restricted {
        return not_applicable(case, Check::R19Speed);
    }
    let Some(stopping) = case.life.actual.own.ship.stopping else {
        return without_model(Check::R19Speed, case.life);
    };
    let speeds_mps = &case.life.actual.own.stw_mps;
    let begin = case.onset.k.min(case.end());
    let unseen = (begin..=case.end()).take_while(|&k| !case.life.in_sight_by(k));
    let Some(k) = unseen.max_by(|&a, &b| speeds_mps[a].total_cmp(&speeds_mps[b])) else {
        return not_applicable(case, Check::R19Speed);
    };
    let stops_m = stopping.distance_m(speeds_mps[k]);
    let share = case.rules().restricted_visibility.stopping_visibility_share;
    let safe_m = share * visual_range_m;
    let (status, detail) =
        if stops_m <= safe_m { (Status::Pass, "") } else { (Status::Fail, "FAIL-19B") };
    let t_s = case.life.time_s(k);
    Ruling::new(Check::R19Speed, case.life.target, status)
        .detail(detail)
        .margin(safe_m - stops_m)
        .at(t_s)
        .metres_a_second("speed", speeds_mps[k])
        .metres("stopping_distance", stops_m)
        .metres("visual_range", visual_range_m)
        .share("stopping_visibility_share", share)
        .say(|| {
            format!(
                "{}, own ship at {:.1} m/s needed {stops_m:.0} m to stop, and could see \
                 {visual_range_m:.0} m. Rule 19(b).",
                case.when(t_s),
                speeds_mps[k]
            )
        })
        .done()
}
