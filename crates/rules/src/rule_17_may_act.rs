//! Rule 17(a)(ii): the stand-on vessel may act.
//!
//! Rule 17(a)(ii): "The latter vessel may however take action to avoid collision by her manoeuvre
//! alone, as soon as it becomes apparent to her that the vessel required to keep out of the way is
//! not taking appropriate action".
//! Reading: the moment is the first sample from stage 3 on at which a pass closer than the minimum
//! distance has been predicted for 5 s while risk is open. From then on neither acting nor holding
//! is penalised, so this check passes when the moment came and says when; what was done before it
//! is judged as 17(a)(i).
//! Source: rules specification, section 9 (R17).

use crate::case::Case;
use crate::ruling::{Ruling, not_applicable};
use record::{Check, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    let Some(may_s) = case.may_act_s().filter(|_| case.stands_on() && !case.restricted) else {
        return not_applicable(case, Check::R17May);
    };
    let acted_s = case.action.detectable_s.filter(|&acted_s| acted_s >= may_s);
    Ruling::new(Check::R17May, case.life.target, Status::Pass)
        .detail(if acted_s.is_some() { "ACTED" } else { "HELD" })
        .at(may_s)
        .seconds("t_17a", may_s)
        .seconds("t_acted", acted_s)
        .done()
}
