//! Rule 6: safe speed.
//!
//! Rule 6: "Every vessel shall at all times proceed at a safe speed so that she can ... be stopped
//! within a distance appropriate to the prevailing circumstances."
//! Reading: it needs a declared stopping model of own ship. A trace carries none, so the check is
//! not evaluated and says so; a stopping distance guessed from a turn rate would be an invention.
//! Source: rules specification, section 9 (R5-R7 observables).

use crate::life::PairLife;
use crate::ruling::Ruling;
use record::{Check, Status, Verdict};

pub(crate) fn check(life: &PairLife<'_>) -> Verdict {
    Ruling::new(Check::R6, life.target, Status::NotEvaluated).detail("NO-STOPPING-MODEL").done()
}
