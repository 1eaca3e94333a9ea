//! SAFE: minimum passing distance (Rules 8(d) and 16). The hard gate.
//!
//! Rule 8(d): "Action taken to avoid collision with another vessel shall be such as to result in
//! passing at a safe distance." "Safe" has no number in law.
//! Reading: the smallest distance of the whole run, in the campaign's kind, against the distances
//! of the rule set. A ship that had to stand on and broke no rule is warned, not failed, where the
//! other passed close; contact and near miss fail in any role.
//! Source: rules specification, section 4; distances after Hagen et al. 2023.

use crate::case::Case;
use crate::life::PairLife;
use crate::ruling::Ruling;
use crate::score;
use record::{Check, Status, Verdict};

/// Status by distance alone, with its detail; as if the run had gone past the closest point.
pub(crate) fn level(life: &PairLife<'_>) -> (Status, &'static str) {
    let (d, distance_m) = (&life.rules.distance, life.distance_m());
    if life.touched() {
        (Status::Fail, "FAIL-COLLISION")
    } else if distance_m < d.r_nm_m {
        (Status::Fail, "FAIL-NEARMISS")
    } else if distance_m < d.r_min_m {
        (Status::Fail, "FAIL-8D")
    } else if distance_m >= d.r_pref_m {
        (Status::Pass, "EXCELLENT")
    } else {
        (Status::Pass, "")
    }
}

/// Judges a pair at risk; `own_breach` is whether own ship failed any rule towards this target.
pub(crate) fn check(case: &Case<'_>, own_breach: bool) -> Verdict {
    let (mut status, mut detail) = level(case.life);
    if status == Status::Fail && detail == "FAIL-8D" && case.stands_on() && !own_breach {
        (status, detail) = (Status::Warn, "CLOSE-BY-OTHER");
    }
    let ruling = ruling(case.life, status, detail);
    let t_s = case.life.pair().minimum.of(case.life.trace.distance).1;
    ruling
        .score(score::safety(case))
        .say(|| {
            let distance_m = case.life.distance_m();
            if case.life.touched() {
                format!("{}, the hulls touched. Rule 8(d).", case.when(t_s))
            } else if status == Status::Warn {
                let text = "the other ship passed at";
                format!(
                    "{}, {text} {distance_m:.0} m by her own choice. Rule 8(d).",
                    case.when(t_s)
                )
            } else {
                let d = &case.rules().distance;
                let (what, limit_m) = match detail {
                    "FAIL-NEARMISS" => ("a near miss of ", d.r_nm_m),
                    _ => ("", d.r_min_m),
                };
                let passed = format!("own ship passed at {distance_m:.0} m");
                let when = case.when(t_s);
                format!("{when}, {passed}, {what}less than {limit_m:.0} m. Rule 8(d).")
            }
        })
        .done()
}

/// Judges a pair that was never at risk.
pub(crate) fn without_risk(life: &PairLife<'_>) -> Verdict {
    let (status, detail) = level(life);
    let status =
        if life.passed.is_none() && status == Status::Pass { Status::Inconclusive } else { status };
    let t_s = life.pair().minimum.of(life.trace.distance).1 as u64;
    ruling(life, status, detail)
        .say(|| {
            let (minutes, seconds) = (t_s / 60, t_s % 60);
            let distance_m = life.distance_m();
            format!(
                "At {minutes:02}:{seconds:02}, own ship passed at {distance_m:.0} m from a vessel \
                 with which there was no risk before. Rule 8(d)."
            )
        })
        .done()
}

fn ruling(life: &PairLife<'_>, status: Status, detail: &'static str) -> Ruling {
    let (distance_m, t_s) = life.pair().minimum.of(life.trace.distance);
    Ruling::new(Check::Safe, life.target, status)
        .detail(detail)
        .margin(distance_m - life.rules.distance.r_min_m)
        .at(t_s)
        .metres("d", distance_m)
        .metres("hull_distance", life.pair().minimum.hull_m)
        .metres("r_min", life.rules.distance.r_min_m)
}
