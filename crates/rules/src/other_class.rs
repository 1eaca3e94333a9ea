//! What another class than the judge's would make of a pair: the classes within the doubt, which
//! can turn a failure into a warning, and the planner's own, which decides nothing.
//! Reference: rules specification, section 2.

use record::{Check, Judgement, Status, Verdict};

/// Keeps what a pair's verdicts are under the planner's class until the run is judged.
pub(crate) fn note_planner_class(out: &mut Judgement, verdicts: Option<Vec<Verdict>>) {
    if let Some(verdicts) = verdicts {
        out.by_planner_class.get_or_insert_default().extend(verdicts);
    }
}

/// The whole run under the planner's classes: where they are the judge's, his verdicts.
pub(crate) fn complete_planner_class(judgement: &mut Judgement) {
    let Some(theirs) = judgement.by_planner_class.take() else { return };
    let mut all = judgement.verdicts.clone();
    for verdict in theirs {
        let key = |verdict: &Verdict| (verdict.check, verdict.target);
        let same = all.iter_mut().find(|other| key(other) == key(&verdict));
        *same.expect("every pair has every check") = verdict;
    }
    judgement.by_planner_class = Some(all);
}

/// Turns failures into warnings where another class within the doubt gives a pass.
pub(crate) fn excuse(verdicts: &mut [Verdict], under_other: &[Verdict]) {
    let role_rule = |check: Check| !matches!(check, Check::Safe | Check::LastMinute);
    let fails = |verdict: &Verdict| verdict.status == Status::Fail && role_rule(verdict.check);
    if under_other.iter().any(fails) {
        return;
    }
    for (verdict, other) in verdicts.iter_mut().zip(under_other) {
        let passes = matches!(other.status, Status::Pass | Status::NotApplicable);
        if verdict.status == Status::Fail && role_rule(verdict.check) && passes {
            verdict.status = Status::Warn;
            verdict.detail = "AMBIGUOUS".into();
        }
    }
}
