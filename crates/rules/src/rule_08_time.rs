//! Rule 8(a), Rule 16: action in ample time.
//!
//! Rule 8(a): "Any action ... shall ... be positive, made in ample time and with due regard to the
//! observance of good seamanship."
//! Reading: the first run that led to a substantial alteration began before stage 3; between stages
//! 3 and 4 is a warning; later, later than the last safe instant, or never is a failure. Where risk
//! opens inside stage 3 the time since onset decides instead. A slow reaction is a warning in any
//! case, and a failure where the rule set has a limit: the literature has none in seconds.
//! Source: rules specification, section 7.

use crate::case::Case;
use crate::ruling::{Ruling, not_applicable};
use crate::score;
use geom::EncounterClass;
use record::{Check, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    let judged = case.gives_way() || case.restricted || case.class == EncounterClass::Static;
    if !judged {
        return not_applicable(case, Check::R8Time);
    }
    let (status, detail) = level(case);
    let acted_s = case.action.manoeuvre_s;
    let reaction_s = acted_s.map(|t_s| (t_s - case.clock_s()).max(0.0));
    let end_s = case.life.time_s(case.end());
    Ruling::new(Check::R8Time, case.life.target, status)
        .detail(detail)
        .margin_if(margin_s(case, status))
        .score(score::promptness(case))
        .at(acted_s.unwrap_or(case.onset_s()))
        .seconds("t_risk", case.onset_s())
        .seconds("t_man", acted_s)
        .seconds("t_react", reaction_s)
        .seconds("t_app", case.action.apparent_s)
        .seconds("t_3", case.stage_s(3))
        .seconds("t_4", case.stage_s(4))
        .metres("limit_3", case.limits_m[1])
        .say(|| match acted_s {
            None => {
                let when = case.when(case.onset_s());
                format!(
                    "{when}, risk opened, and by {:.0} seconds later own ship had made no \
                     substantial alteration. Rule 8(a).",
                    end_s - case.onset_s()
                )
            }
            Some(t_s) => format!(
                "{}, own ship first acted, {:.0} seconds after she could know of the risk. \
                 Rule 8(a).",
                case.when(t_s),
                reaction_s.unwrap_or(0.0)
            ),
        })
        .done()
}

/// Status by time alone.
pub(crate) fn level(case: &Case<'_>) -> (Status, &'static str) {
    let t = &case.rules().timing;
    let last_s = case.own_last_s();
    let stage_4_s = case.stage_s(4);
    let Some(acted_s) = case.action.manoeuvre_s else {
        let too_late = case.complete() || stage_4_s.is_some();
        let status = if too_late { Status::Fail } else { Status::Inconclusive };
        return (status, "FAIL-8-NO-ACTION");
    };
    let reaction_s = (acted_s - case.clock_s()).max(0.0);
    let over = |limit_s: Option<f64>| limit_s.is_some_and(|limit_s| acted_s > limit_s);
    let late_onset = case.onset.seen.range_m <= case.limits_m[1];
    let by_stage = if over(last_s) {
        (Status::Fail, "FAIL-8-AFTER-LAST-INSTANT")
    } else if late_onset && reaction_s > t.late_onset_fail_s {
        (Status::Fail, "FAIL-8-LATE")
    } else if late_onset && reaction_s > t.late_onset_pass_s {
        (Status::Warn, "LATE")
    } else if late_onset {
        (Status::Pass, "")
    } else if over(stage_4_s) {
        (Status::Fail, "FAIL-8-STAGE-4")
    } else if over(case.stage_s(3)) {
        (Status::Warn, "STAGE-3")
    } else {
        (Status::Pass, "")
    };
    let by_reaction = if t.react_fail_s.is_some_and(|limit_s| reaction_s > limit_s) {
        (Status::Fail, "FAIL-8-REACTION")
    } else if reaction_s > t.react_warn_s {
        (Status::Warn, "SLOW-REACTION")
    } else {
        (Status::Pass, "")
    };
    if by_reaction.0.severity() > by_stage.0.severity() { by_reaction } else { by_stage }
}

/// Seconds to the nearest failure: stage 4, the last safe instant, or a limit on the reaction.
fn margin_s(case: &Case<'_>, status: Status) -> Option<f64> {
    let t = &case.rules().timing;
    if status == Status::Inconclusive {
        return None;
    }
    let Some(acted_s) = case.action.manoeuvre_s else {
        return Some(case.clock_s() - case.life.time_s(case.end())).map(|s| s.min(0.0));
    };
    let late_onset = case.onset.seen.range_m <= case.limits_m[1];
    let by_stage =
        if late_onset { Some(case.clock_s() + t.late_onset_fail_s) } else { case.stage_s(4) };
    let last_s = case.own_last_s();
    let limit = t.react_fail_s.map(|limit_s| case.clock_s() + limit_s);
    [by_stage, last_s, limit].into_iter().flatten().reduce(f64::min).map(|limit| limit - acted_s)
}
