//! Rule 8(c): the alteration "does not result in another close-quarters situation".
//!
//! Rule 8(c): "... an alteration of course alone may be the most effective action ... provided
//! that it is made in good time, is substantial and does not result in another close-quarters
//! situation."
//! Reading: with several targets, a turn for this one must not open risk with another that was at
//! none: a close pass newly predicted when the turn ends, and still when it has lasted.
//! Source: rules specification, sections 6 and 11.

use crate::case::Case;
use crate::life::PairLife;
use crate::ruling::{Ruling, not_applicable};
use crate::runs::TurnRun;
use record::{Check, Status, Verdict};

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    if case.others.len() < 2 || case.action.runs.is_empty() {
        return not_applicable(case, Check::R8Third);
    }
    let third = |run: &TurnRun| {
        let others = case.others.iter().filter(|other| other.target != case.life.target);
        let mut endangered = others.filter(|other| opens_risk(other, run));
        endangered.next().map(|other| (*run, other))
    };
    let found = case.action.runs.iter().find_map(third);
    let Some((run, other)) = found else {
        return Ruling::new(Check::R8Third, case.life.target, Status::Pass).done();
    };
    let k = settled(other, &run);
    let dcpa_m = other.actual.dcpa_m(k);
    Ruling::new(Check::R8Third, case.life.target, Status::Fail)
        .detail(format!("FAIL-8C-TARGET-{}", other.target))
        .margin(dcpa_m - case.rules().risk.d_risk_m)
        .at(case.life.time_s(run.start))
        .radians("turn", run.size_rad)
        .metres("dcpa_third_ship", dcpa_m)
        .say(|| {
            let when = case.when(case.life.time_s(run.start));
            let altered = Case::altered(run.size_rad);
            format!(
                "{when}, own ship {altered} and so headed to pass a third vessel at {dcpa_m:.0} m. \
                 Rule 8(c)."
            )
        })
        .done()
}

/// When the turn has ended and its smoothing has passed.
fn settled(life: &PairLife<'_>, run: &TurnRun) -> usize {
    let persistence = (life.rules.risk.persistence_s / life.trace.sample_s).ceil() as usize;
    (run.end + persistence).min(life.actual.len() - 1)
}

fn opens_risk(life: &PairLife<'_>, run: &TurnRun) -> bool {
    let rules = life.rules;
    let near = |k: usize| {
        life.actual.tcpa_s(k).is_some_and(|t| t > 0.0 && t <= rules.risk.t_risk_s)
            && life.actual.dcpa_below(k, rules.risk.d_risk_m)
            && life.actual.range_m(k) < rules.stages.r2_m
    };
    let after = settled(life, run);
    !near(run.edge) && !life.at_risk(run.start) && (run.end..=after).all(near)
}
