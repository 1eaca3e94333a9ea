//! Answers of the gate that are short enough to be known beforehand.

use crate::gate::{plan, quiet, run, with_absolute};
use stats::{
    AbsoluteTest, CorpusResult, Feasibility, Gate, GateResult, GateVerdict, Observation, PlanError,
    PlannedNeed,
};

/// One need that is not met, or that nobody expects to be met, is enough.
#[test]
fn a_neutral_change_passes_when_every_need_fits_the_cap() {
    let passes = |expected: &[Option<u64>]| {
        let need = |&pairs_expected: &Option<u64>| PlannedNeed {
            name: "collision".into(),
            pairs_min: 100,
            pairs_expected,
        };
        Feasibility { needs: expected.iter().map(need).collect(), cap: 1_000 }
            .neutral_change_passes()
    };
    assert!(passes(&[Some(999), Some(1_000)]));
    assert!(!passes(&[Some(999), Some(1_001)]));
    assert!(!passes(&[Some(1_001), Some(999)]));
    assert!(!passes(&[Some(999), None]));
}

/// A cap may be enough for planners that never differ, and not for ones that differ as planned.
#[test]
fn a_plan_may_be_feasible_and_a_neutral_change_not_expected_to_pass() {
    let of_cap = |cap| plan(1, 1e-3, cap).feasibility().unwrap();
    let need = of_cap(400_000).needs[0].clone();
    let expected = need.pairs_expected.unwrap();
    assert!(need.pairs_min + 4 < expected, "{need:?}");
    assert!(of_cap(expected).neutral_change_passes());
    assert!(!of_cap(expected - 4).neutral_change_passes());
    assert!(!of_cap(need.pairs_min).neutral_change_passes());
}

#[test]
fn a_stratum_has_its_places_of_every_whole_cycle() {
    let mut plan = plan(1, 1e-2, 20_000);
    plan.pattern = vec![0, 1, 1, 2, 1];
    let counted = |pairs| [0, 1, 2, 7].map(|stratum| plan.pairs_in_stratum(stratum, pairs));
    assert_eq!(counted(0), [0, 0, 0, 0]);
    assert_eq!(counted(5), [1, 3, 1, 0]);
    assert_eq!(counted(20), [4, 12, 4, 0]);
    // the cycle that is not complete gives nothing, although its first places are taken
    assert_eq!(counted(24), [4, 12, 4, 0]);
}

/// ln(0.05) / ln(1 - 0.001) = 2994.2: 2,995 encounters of the stratum, whatever share it has.
#[test]
fn a_stratum_of_many_places_needs_fewer_pairs() {
    let cap_needed = |pattern: Vec<usize>| {
        let mut plan = with_absolute(1e-3, AbsoluteTest::DeclaredN, 1_000);
        plan.pattern = pattern;
        match plan.feasibility().unwrap_err() {
            PlanError::Infeasible { cap_needed, .. } => cap_needed,
            error => panic!("{error}"),
        }
    };
    assert_eq!(cap_needed(vec![0, 1, 2, 3]), 2_995 * 4);
    // three of five: 999 cycles hold 2,997
    assert_eq!(cap_needed(vec![2, 0, 2, 1, 2]), 999 * 5);
}

/// "Worse within the margin" is said of a change that passed and is worse for certain.
#[test]
fn worse_within_the_margin_is_said_of_what_passed_and_is_worse() {
    let result = |margin: f64, breaks_every: u64| -> GateResult {
        let mut plan = plan(1, margin, 400_000);
        plan.metrics[0].discordance_plan = margin / 2.0;
        plan.look_every = 40_000;
        let mut gate = Gate::new(plan, CorpusResult::default()).unwrap();
        run(&mut gate, |id| {
            let mut row = quiet(id, 1);
            if id % breaks_every == 17 {
                row.candidate[0] = Observation::Event;
            }
            row
        });
        gate.result().clone()
    };
    let said = |result: &GateResult| {
        let metric = &result.metrics[0];
        (metric.passed_at.is_some(), metric.difference.lower > 0.0, metric.worse_within_margin)
    };
    let worse = result(1e-2, 5_000);
    assert_eq!((worse.verdict, said(&worse)), (GateVerdict::Pass, (true, true, true)));
    let same = result(1e-2, 1 << 40);
    assert_eq!((same.verdict, said(&same)), (GateVerdict::Pass, (true, false, false)));
    let beyond = result(1e-3, 100);
    assert_eq!((beyond.verdict, said(&beyond)), (GateVerdict::Fail, (false, true, false)));
}
