//! Scores in [0, 1] after Hagen et al. 2023 (Ocean Engineering 288:115991), equations 2 to 32.
//!
//! The formulas come from third-party reconstructions whose numbers are not confirmed, so a score
//! is called "after Hagen 2023" and decides no verdict. Their constants are the paper's and stand
//! here; distances come from the rule set. Reference: rules specification, sections 4 to 9, 14.

use crate::case::Case;
use crate::ruleset::Manoeuvre;
use geom::math;
use std::f64::consts::FRAC_PI_2;

/// `m(x; md, app)`, equations 10 to 14: 0 below the detectable, 1 from the apparent on.
pub(crate) fn apparent(x: f64, detectable: f64, apparent: f64) -> f64 {
    let share = ((x - detectable) / (apparent - detectable)).clamp(0.0, 1.0);
    share * share
}

/// Course or speed, whichever is more apparent (either suffices: Rule 8(b)).
pub(crate) fn apparent_action(case: &Case<'_>) -> f64 {
    let m = &case.rules().manoeuvre;
    apparent_turn(case, m).max(apparent(
        case.action.x_u,
        m.detectable_speed_fraction,
        m.apparent_speed_fraction,
    ))
}

fn apparent_turn(case: &Case<'_>, m: &Manoeuvre) -> f64 {
    apparent(case.action.x_act_rad, m.detectable_turn_rad, m.apparent_turn_rad)
}

/// `S_safety`, equations 2 to 6: distance, softened by the pose at the closest point.
pub(crate) fn safety(case: &Case<'_>) -> f64 {
    let d = &case.rules().distance;
    let distance_m = case.life.distance_m();
    if case.life.touched() || distance_m < d.r_col_m {
        return 0.0;
    }
    let part = |upper: f64, lower: f64| (upper - distance_m) / (upper - lower);
    let by_distance = if distance_m >= d.r_pref_m {
        return 1.0;
    } else if distance_m >= d.r_min_m {
        1.0 - 0.2 * part(d.r_pref_m, d.r_min_m)
    } else if distance_m >= d.r_nm_m {
        0.8 - 0.3 * part(d.r_min_m, d.r_nm_m)
    } else {
        0.5 - 0.5 * part(d.r_nm_m, d.r_col_m)
    };
    if by_distance <= 0.0 {
        return 0.0;
    }
    let Some(passed) = case.life.passed else { return by_distance };
    let bow = |angle_rad: f64| {
        if angle_rad.abs() < FRAC_PI_2 { 1.0 - math::cos(angle_rad) } else { 1.0 }
    };
    let pose = 0.25 * bow(passed.alpha_rad) + 0.75 * bow(passed.beta_rad);
    by_distance + (1.0 - by_distance) * pose
}

/// `1 - P_delay`, equation 8: how far inside stage 3 the action began.
pub(crate) fn promptness(case: &Case<'_>) -> f64 {
    let entry_m = case.limits_m[1];
    let moment_s = case.action.manoeuvre_s.or(case.life.passed.map(|passed| passed.t_s));
    let Some(moment_s) = moment_s else { return 0.0 };
    1.0 - ((entry_m - case.range_at_m(moment_s)) / entry_m).clamp(0.0, 1.0)
}

/// `S16 = S_safety * Apparent * (1 - P_delay)`, equation 7.
pub(crate) fn give_way(case: &Case<'_>) -> f64 {
    safety(case) * apparent_action(case) * promptness(case)
}

/// `S13 = S16 - 0.3` where own ship was ahead of the other at the closest point (eq. 25, 26).
pub(crate) fn overtaking(case: &Case<'_>) -> f64 {
    let ahead = case.life.passed.is_some_and(|p| p.alpha_rad.abs() < geom::units::deg(45.0));
    (give_way(case) - if ahead { 0.3 } else { 0.0 }).max(0.0)
}

/// `S14`, equations 27 to 30: starboard turn and port-to-port pose.
pub(crate) fn head_on(case: &Case<'_>) -> f64 {
    let Some(passed) = case.life.passed else { return 0.0 };
    let m = &case.rules().manoeuvre;
    let half = |angle_rad: f64| {
        let share = (1.0 - math::sin(angle_rad)) / 2.0;
        share * share
    };
    let p_pose = 1.0 - half(passed.alpha_rad) * half(passed.beta_rad);
    let span = m.apparent_turn_rad - m.substantial_turn_rad;
    let starboard = ((case.action.x_stbd_rad - m.substantial_turn_rad) / span).clamp(0.0, 1.0);
    let p_turn = 1.0 - starboard * starboard;
    (1.0 - 0.4 * p_turn - 0.6 * p_pose).max(0.0) * apparent_turn(case, m) * promptness(case)
}

/// `S15 = S16 - 0.5` in the angle band of crossing ahead (eq. 31, 32).
pub(crate) fn crossing(case: &Case<'_>) -> f64 {
    let band = geom::units::deg(-25.0)..geom::units::deg(165.0);
    let ahead =
        case.life.passed.is_some_and(|p| p.alpha_rad > band.start && p.alpha_rad < band.end);
    (give_way(case) - if ahead { 0.5 } else { 0.0 }).max(0.0)
}

/// `C_x,gw`: what is left of a stand-on ship's penalties while she gives way to another target
/// (section 11; CCTA 2023).
const COMPENSATION: f64 = 0.2;

/// `S17`, equations 15 to 24, from the largest departures in stages 2 and 3 (angle, share) and
/// whether own ship turned to port in stage 4.
pub(crate) fn stand_on(case: &Case<'_>, stages: [(f64, f64); 2], port_in_stage_4: bool) -> f64 {
    let m = &case.rules().manoeuvre;
    let linear = |x: f64, from: f64, to: f64| ((x - from) / (to - from)).clamp(0.0, 1.0);
    let weight = if case.forced_by.is_some() { COMPENSATION } else { 1.0 };
    let held: f64 = stages
        .iter()
        .map(|&(turn_rad, share)| {
            let turn = linear(turn_rad, m.detectable_turn_rad, m.apparent_turn_rad);
            // speed: 0.07 to 0.25 in the reconstruction
            let cut = linear(share, m.detectable_speed_fraction, m.substantial_speed_fraction);
            1.0 - weight * (0.5 * turn + 0.5 * cut)
        })
        .product();
    let port = if port_in_stage_4 { 1.0 - weight } else { 1.0 };
    safety(case) * held * port
}
