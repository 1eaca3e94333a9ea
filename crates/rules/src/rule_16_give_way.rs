//! Rule 16: action by the give-way vessel.
//!
//! Rule 16: "Every vessel which is directed to keep out of the way of another vessel shall, so far
//! as possible, take early and substantial action to keep well clear."
//! Reading: early is Rule 8(a) (time), substantial is 8(b) (size), well clear is 8(d) (distance);
//! the worst of the three is the verdict. It binds the ship that crosses with another on her
//! starboard side and the ship that overtakes.
//! Source: rules specification, sections 4, 6 and 7; score after Hagen 2023, equation 7.

use crate::case::Case;
use crate::ruling::{Ruling, not_applicable};
use crate::{rule_08_magnitude, rule_08_time, safe, score};
use record::{Check, Role, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    if case.role != Role::GiveWay || case.restricted {
        return not_applicable(case, Check::R16);
    }
    let parts = [rule_08_time::level(case), rule_08_magnitude::level(case), safe::level(case.life)];
    let worst =
        parts.into_iter().reduce(|a, b| if b.0.severity() > a.0.severity() { b } else { a });
    let (status, detail) = worst.expect("three parts have a worst");
    let detail = if status == Status::Pass { "" } else { detail };
    // what was not done may yet be done; a distance lost is lost
    let open = !case.complete() && parts[0].0 != Status::Fail && parts[2].0 != Status::Fail;
    let status = if open { Status::Inconclusive } else { status };
    let score = score::give_way(case);
    let sign = if status == Status::Fail { -1.0 } else { 1.0 };
    let t_s = case.action.manoeuvre_s.unwrap_or(case.onset_s());
    Ruling::new(Check::R16, case.life.target, status)
        .detail(detail)
        .margin(if status == Status::Fail { sign * (1.0 - score) } else { score })
        .score(score)
        .at(t_s)
        .metres("d", case.life.distance_m())
        .radians("x_psi", case.action.x_act_rad)
        .share("x_u", case.action.x_u)
        .say(|| {
            let what = match detail {
                "FAIL-COLLISION" | "FAIL-NEARMISS" | "FAIL-8D" => "did not keep well clear",
                "FAIL-8-NO-ACTION" => "took no substantial action",
                "FAIL-8-NOT-APPARENT" | "NOT-APPARENT" | "SMALL" => {
                    "took no substantial action that was readily apparent"
                }
                _ => "acted, and not early",
            };
            format!(
                "{}, own ship, directed to keep out of the way, {what}. Rule 16.",
                case.when(t_s)
            )
        })
        .done()
}
