//! Rule 17(a)(i): the stand-on vessel keeps her course and speed.
//!
//! Rule 17(a)(i): "Where one of two vessels is to keep out of the way the other shall keep her
//! course and speed."
//! Reading: from stage 2 until she may act (17(a)(ii)) or must (17(b)), the mean heading
//! over 30 s stays within 10 degrees of the mean before stage 2 and the speed within a quarter of
//! that at its entry; from 2 degrees or 7 % it is a warning. A departure counts when it is held.
//! Heading is a mean because a yaw of 1 degree rms would warn in 98 % of held courses.
//! A change on the planned route is no departure; one forced by giving way to a third ship is
//! excused, and where she owed that all the time she had nothing to hold: the rule was not put to
//! the test (section 12, vacuity).
//! Source: rules specification, sections 9 (R17) and 11; score after Hagen 2023, equations 15 to
//! 24.

use crate::case::Case;
use crate::ruling::{Ruling, not_applicable};
use crate::{rule_17_port, score};
use record::{Check, Status, Verdict};

/// Largest departures in a part of the encounter.
#[derive(Clone, Copy, Debug, Default)]
struct Departure {
    turn_rad: f64,
    share: f64,
    /// The sample of the largest one.
    k: usize,
}

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    let (Some(begin), true, false) = (case.stages[0], case.stands_on(), case.restricted) else {
        return not_applicable(case, Check::R17Hold);
    };
    let m = &case.rules().manoeuvre;
    // 17(b) ends the duty, from stage 4 on or from when the other alone can no longer avoid
    let shall_act = case.target_helpless_s().map(|t_s| case.life.sample(t_s));
    let until = [case.may_act, shall_act, case.stages[2], Some(case.end() + 1)];
    // the first sample at which she is free: what she does from then on is by right
    let end = until.into_iter().flatten().min().unwrap_or(begin);
    if end <= begin {
        return not_applicable(case, Check::R17Hold);
    }
    let held = departure(case, begin, end);
    let stage_3 = case.stages[1].unwrap_or(end).clamp(begin, end);
    let parts = [departure(case, begin, stage_3), departure(case, stage_3, end)];
    let parts = parts.map(|part| (part.turn_rad.abs(), part.share.abs()));
    let score = score::stand_on(case, parts, rule_17_port::in_stage_4(case));
    if let Some(other) = case.gives_way_throughout(begin..end) {
        return Ruling::new(Check::R17Hold, case.life.target, Status::NotApplicable)
            .detail(format!("EXCUSED-BY-TARGET-{other}"))
            .score(score)
            .done();
    }
    let broke =
        |turn_rad: f64, share: f64| held.turn_rad.abs() >= turn_rad || held.share.abs() >= share;
    let (mut status, mut detail) = if broke(m.substantial_turn_rad, m.substantial_speed_fraction) {
        (Status::Fail, "FAIL-17AI".into())
    } else if broke(m.detectable_turn_rad, m.detectable_speed_fraction) {
        (Status::Warn, "UNSTEADY".into())
    } else {
        (Status::Pass, std::borrow::Cow::Borrowed(""))
    };
    let excused = if let (Some(other), true) = (case.forced_by, status != Status::Pass) {
        (status, detail) = (Status::Pass, format!("EXCUSED-BY-TARGET-{other}").into());
        true
    } else {
        false
    };
    let margin_rad = if excused { 0.0 } else { margin_rad(case, held) };
    let t_s = case.life.time_s(held.k);
    Ruling::new(Check::R17Hold, case.life.target, status)
        .detail(detail)
        .margin(margin_rad)
        .score(score)
        .at(t_s)
        .radians("x_psi", held.turn_rad)
        .share("x_u", held.share)
        .seconds("t_2", case.stage_s(2))
        .seconds("t_17a", case.may_act_s())
        .say(|| {
            let when = case.when(t_s);
            if held.turn_rad.abs() >= m.detectable_turn_rad {
                let altered = Case::altered(held.turn_rad);
                format!("{when}, own ship, bound to keep her course, {altered}. Rule 17(a)(i).")
            } else {
                let change = 100.0 * held.share;
                let changed = format!("changed her speed by {change:+.0} %");
                format!("{when}, own ship, bound to keep it, {changed}. Rule 17(a)(i).")
            }
        })
        .done()
}

/// Largest held departures in samples `begin..end`: of the mean heading from its mean before
/// `begin`, of the speed from that at `begin`.
fn departure(case: &Case<'_>, begin: usize, end: usize) -> Departure {
    let (own, m) = (case.own, &case.rules().manoeuvre);
    let mut worst = Departure { k: begin, ..Departure::default() };
    if end <= begin {
        return worst;
    }
    let means_rad = mean_departures_rad(case, begin, end);
    let held = (m.offset_held_s / case.life.trace.sample_s).ceil() as usize;
    for (k, window) in means_rad.windows(held + 1).enumerate() {
        // held to one side: the least of it, signed
        let (low, high) = window
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
        let turn_rad = if low > 0.0 { low } else { high.min(0.0) };
        if turn_rad.abs() > worst.turn_rad.abs() {
            (worst.turn_rad, worst.k) = (turn_rad, begin + k);
        }
    }
    let (level_mps, u_0_mps) = (own.departure_mps[begin], own.speed_mps[begin]);
    worst.share = speed_share(case, begin..end, level_mps, u_0_mps);
    worst
}

/// How far the centred mean of the heading lies from its mean before `begin`, at each sample of
/// `begin..end`. No mean looks at `end` or past it.
fn mean_departures_rad(case: &Case<'_>, begin: usize, end: usize) -> Vec<f64> {
    let heading_rad = &case.own.heading_rad;
    let mean_s = case.rules().stand_on.heading_mean_s;
    let half = (mean_s / 2.0 / case.life.trace.sample_s).round() as usize;
    let before = &heading_rad[begin.saturating_sub(2 * half)..begin.max(1)];
    let psi_0_rad = before.iter().sum::<f64>() / before.len() as f64;
    let last = end - 1;
    // a running sum over the window
    let window = |k: usize| (k.saturating_sub(half), (k + half).min(last));
    let (mut from, mut to) = window(begin);
    let mut sum: f64 = heading_rad[from..=to].iter().map(|psi| psi - psi_0_rad).sum();
    (begin..=last)
        .map(|k| {
            let (next_from, next_to) = window(k);
            while from < next_from {
                sum -= heading_rad[from] - psi_0_rad;
                from += 1;
            }
            while to < next_to {
                to += 1;
                sum += heading_rad[to] - psi_0_rad;
            }
            sum / (to + 1 - from) as f64
        })
        .collect()
}

/// Largest change of speed held in a range of samples, as a signed share.
fn speed_share(
    case: &Case<'_>,
    range: std::ops::Range<usize>,
    level_mps: f64,
    u_0_mps: f64,
) -> f64 {
    if u_0_mps < case.rules().manoeuvre.moving_mps {
        return 0.0;
    }
    let [slower, faster] = [-1.0, 1.0].map(|side| {
        case.action.held_change_mps(case.life, case.own, level_mps, side, range.clone()) / u_0_mps
    });
    if slower > faster { -slower } else { faster }
}

/// Distance to failing: the smaller of course and speed, speed as its share of the limit.
fn margin_rad(case: &Case<'_>, held: Departure) -> f64 {
    let m = &case.rules().manoeuvre;
    let speed = held.share.abs() / m.substantial_speed_fraction * m.substantial_turn_rad;
    m.substantial_turn_rad - held.turn_rad.abs().max(speed)
}
