//! Rule 17(b): the stand-on vessel shall act.
//!
//! Rule 17(b): "When, from any cause, the vessel required to keep her course and speed finds
//! herself so close that collision cannot be avoided by the action of the give-way vessel alone,
//! she shall take such action as will best aid to avoid collision."
//! Reading: the moment is the other's last safe instant where it was computed, or the entry of
//! stage 4, whichever comes first. By a few seconds later (or own last safe instant, if sooner) a
//! run of 10 degrees or a cut of a quarter of the speed must have begun, if the hulls are still to
//! pass within a near miss. An action begun earlier under 17(a)(ii) satisfies it.
//! Source: rules specification, section 9 (R17).

use crate::case::Case;
use crate::ruling::{Ruling, not_applicable};
use record::{Check, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    let moment = moment_s(case).filter(|_| case.stands_on() && !case.restricted);
    let Some(shall_s) = moment.filter(|&t_s| case.life.sample(t_s) <= case.end()) else {
        return not_applicable(case, Check::R17Shall);
    };
    let grace_s = shall_s + case.rules().stand_on.shall_act_grace_s;
    let end_s = case.life.time_s(case.end());
    let deadline_s = case.own_last_s().map_or(grace_s, |last_s| grace_s.min(last_s));
    let acted_s = case.action.manoeuvre_s.or_else(|| first_substantial_s(case));
    let by_deadline = acted_s.is_some_and(|t_s| t_s <= deadline_s);
    let at = case.life.sample(deadline_s.min(end_s));
    let predicted_m = case.life.actual.hull_dcpa_m(at, case.life.actual.own.velocity_mps(at));
    let near_miss_m = case.rules().distance.r_nm_m;
    let (status, detail) = if by_deadline {
        (Status::Pass, "")
    } else if predicted_m >= near_miss_m {
        (Status::NotApplicable, "CLEARING")
    } else if !case.complete() && deadline_s > end_s {
        (Status::Inconclusive, "")
    } else {
        (Status::Fail, "FAIL-17B")
    };
    let margin_s = acted_s.map_or(deadline_s - end_s.max(deadline_s), |t_s| deadline_s - t_s);
    Ruling::new(Check::R17Shall, case.life.target, status)
        .detail(detail)
        .margin(margin_s)
        .at(shall_s)
        .seconds("t_17b", shall_s)
        .seconds("t_acted", acted_s)
        .metres("predicted_hull_distance", predicted_m)
        .metres("r_nm", near_miss_m)
        .say(|| {
            let when = case.when(shall_s);
            let acted = match acted_s {
                Some(t_s) => format!("acted only {:.0} s later", t_s - shall_s),
                None => "did not act".to_owned(),
            };
            format!(
                "{when}, own ship could no longer leave it to the other, was to pass at \
                 {predicted_m:.0} m, and {acted}. Rule 17(b)."
            )
        })
        .done()
}

/// `t_17b`, seconds: never the later of the two.
fn moment_s(case: &Case<'_>) -> Option<f64> {
    [case.target_helpless_s(), case.stage_s(4)].into_iter().flatten().reduce(f64::min)
}

/// A substantial run of any side.
fn first_substantial_s(case: &Case<'_>) -> Option<f64> {
    let least_rad = case.rules().manoeuvre.substantial_turn_rad;
    let large = case.action.runs.iter().find(|run| run.size_rad.abs() >= least_rad);
    large.map(|run| case.life.time_s(run.start))
}
