//! Rule 8(b) and (c), Rule 16: the alteration is large enough to be readily apparent.
//!
//! Rule 8(b): "Any alteration of course and/or speed to avoid collision shall, if the circumstances
//! of the case admit, be large enough to be readily apparent to another vessel".
//! Reading: course or speed, either suffices. 30 degrees or half the speed pass; from 10 degrees or
//! a quarter of the speed it is a warning; less is a failure, unless something was done that could
//! be seen and own ship passed clear by it: open water admits a large alteration, so that too is a
//! warning. Gaining speed counts for nothing. A stand-on ship is judged once she acts by right. Out
//! of sight of one another there is no allowance below what radar shows.
//! Source: rules specification, section 6; the leniency is this project's.

use crate::case::Case;
use crate::ruling::{Ruling, not_applicable};
use crate::{safe, score};
use geom::EncounterClass;
use record::{Check, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    if !applies(case) {
        return not_applicable(case, Check::R8Magnitude);
    }
    let (status, detail) = level(case);
    let (m, action) = (&case.rules().manoeuvre, case.action);
    let status = match status {
        // what was not done may yet be done
        Status::Fail if !case.complete() => Status::Inconclusive,
        other => other,
    };
    let seen_s = action.detectable_s.unwrap_or(case.onset_s());
    let t_s = action.apparent_s.filter(|_| status == Status::Pass).unwrap_or(seen_s);
    Ruling::new(Check::R8Magnitude, case.life.target, status)
        .detail(detail)
        .margin_if(margin_rad(case, status))
        .score(score::apparent_action(case))
        .at(t_s)
        .radians("x_psi", action.x_act_rad)
        .share("x_u", action.x_u)
        .radians("apparent_turn", m.apparent_turn_rad)
        .share("apparent_speed_fraction", m.apparent_speed_fraction)
        .say(|| {
            let when = case.when(t_s);
            let turn = geom::units::to_deg(action.x_act_rad);
            let cut = 100.0 * action.x_u;
            if action.detectable() {
                let most = format!("altered course by at most {turn:.0} degrees");
                let speed = format!("cut her speed by at most {cut:.0} %");
                format!("{when}, own ship {most} and {speed}. Rule 8(b).")
            } else {
                format!("{when}, risk opened, and own ship did nothing that could be seen. Rule 8.")
            }
        })
        .done()
}

/// Whether the size of own ship's action is a question here.
pub(crate) fn applies(case: &Case<'_>) -> bool {
    case.gives_way()
        || case.restricted
        || case.class == EncounterClass::Static
        || acts_by_right(case)
}

/// Status by size alone.
pub(crate) fn level(case: &Case<'_>) -> (Status, &'static str) {
    let (m, action) = (&case.rules().manoeuvre, case.action);
    let reaches = |turn_rad: f64, share: f64| action.x_act_rad >= turn_rad || action.x_u >= share;
    let detectable = reaches(m.detectable_turn_rad, m.detectable_speed_fraction);
    if reaches(m.apparent_turn_rad, m.apparent_speed_fraction) {
        (Status::Pass, "")
    } else if case.restricted {
        (Status::Fail, "FAIL-8-NOT-APPARENT")
    } else if reaches(m.substantial_turn_rad, m.substantial_speed_fraction) {
        (Status::Warn, "NOT-APPARENT")
    } else if detectable && cleared_by_own_action(case) {
        (Status::Warn, "SMALL")
    } else {
        (Status::Fail, "FAIL-8-NOT-APPARENT")
    }
}

/// She passed clear, and further off than she would have.
fn cleared_by_own_action(case: &Case<'_>) -> bool {
    let life = case.life;
    let nominal = life.trace.nominal.as_ref().map(|nominal| {
        let minimum = nominal.minima.get(life.target);
        minimum.map_or(0.0, |minimum| minimum.of(life.trace.distance).0)
    });
    safe::level(life).0 == Status::Pass
        && nominal.is_none_or(|nominal_m| life.distance_m() > nominal_m)
}

/// A stand-on ship that acts from the moment at which she may.
fn acts_by_right(case: &Case<'_>) -> bool {
    case.stands_on()
        && (case.may_act_s().zip(case.action.detectable_s))
            .is_some_and(|(may_s, acted_s)| acted_s >= may_s)
}

/// How far the turn is from failing, as an angle; a cut of speed counts by its share of what is
/// readily apparent.
fn margin_rad(case: &Case<'_>, status: Status) -> Option<f64> {
    let (m, action) = (&case.rules().manoeuvre, case.action);
    let by_speed = action.x_u / m.apparent_speed_fraction * m.apparent_turn_rad;
    let margin_rad = action.x_act_rad.max(by_speed) - m.substantial_turn_rad;
    match status {
        Status::Pass => Some(margin_rad.max(0.0)),
        Status::Warn => Some(margin_rad),
        Status::Fail => Some(margin_rad.min(0.0)),
        _ => None,
    }
}
