//! The gate rule by itself: order, looks, verdicts, feasibility, undetermined outcomes, ratchet.

use crate::generator::Generator;
use stats::{
    AbsolutePlan, AbsoluteTest, BrokenCase, CorpusResult, Forecast, Gate, GateError, GatePlan,
    GateVerdict, Harmed, LayerVerdict, Margin, MetricPlan, NonInferiority, Observation, PairRow,
    PlanError, RatchetPlan,
};

const STRATA: usize = 4;

pub(crate) fn plan(metrics: usize, margin: f64, cap: u64) -> GatePlan {
    let metric = |i| MetricPlan {
        name: format!("metric_{i}"),
        margin: Margin::Absolute { difference: margin },
        discordance_plan: margin,
    };
    GatePlan {
        alpha_fail: 0.01,
        alpha_pass: 0.05,
        alpha_absolute: 0.001,
        attempt: 1,
        pattern: (0..STRATA).collect(),
        look_every: 998,
        cap,
        metrics: (0..metrics).map(metric).collect(),
        absolutes: Vec::new(),
        ratchets: Vec::new(),
    }
}

pub(crate) fn quiet(id: u64, metrics: usize) -> PairRow {
    PairRow {
        id,
        stratum: id as usize % STRATA,
        candidate: vec![Observation::NoEvent; metrics],
        baseline: vec![Observation::NoEvent; metrics],
        ratchets: Vec::new(),
    }
}

/// Feeds rows made by `row` in blocks of 640 until a verdict falls.
pub(crate) fn run(gate: &mut Gate, mut row: impl FnMut(u64) -> PairRow) -> GateVerdict {
    loop {
        let first = gate.next_id();
        let rows: Vec<PairRow> = (first..first + 640).map(&mut row).collect();
        if let Some(verdict) = gate.take(&rows).expect("rows come in order") {
            return verdict;
        }
    }
}

#[test]
fn planners_that_never_differ_pass_at_the_price_of_the_margin() {
    let mut gate = Gate::new(plan(2, 1e-3, 20_000), CorpusResult::default()).unwrap();
    assert_eq!(run(&mut gate, |id| quiet(id, 2)), GateVerdict::Pass);
    let result = gate.result();
    // 3.34 / d is 3,340; looks come every 1,000 pairs (998 rounded up to whole cycles of 4).
    assert_eq!((result.pairs, result.looks), (4_000, 4));
    assert!(result.metrics.iter().all(|m| m.passed_at == Some(4_000)));
    assert!(result.metrics[0].ln_harm.abs() < 1e-12);
    assert_eq!(result.metrics[0].difference.value.to_bits(), 0);
    assert_eq!((result.absolute, result.ratchet), (LayerVerdict::NotAsked, LayerVerdict::NotAsked));
}

#[test]
fn completion_order_and_blocks_of_one_stratum_are_not_taken() {
    let mut gate = Gate::new(plan(1, 1e-3, 20_000), CorpusResult::default()).unwrap();
    gate.take(&[quiet(0, 1), quiet(1, 1)]).unwrap();
    let swapped = [quiet(3, 1), quiet(2, 1)];
    assert_eq!(gate.take(&swapped), Err(GateError::OutOfOrder { expected: 2, found: 3 }));
    let again = quiet(1, 1);
    assert_eq!(gate.take(&[again]), Err(GateError::OutOfOrder { expected: 2, found: 1 }));
    let one_stratum = PairRow { stratum: 0, ..quiet(2, 1) };
    let wrong = GateError::Stratum { id: 2, expected: 2, found: 0 };
    assert_eq!(gate.take(&[one_stratum]), Err(wrong));
    let short = PairRow { baseline: Vec::new(), ..quiet(2, 1) };
    assert_eq!(gate.take(&[short]), Err(GateError::Shape { id: 2, metrics: 1, planners: 2 }));
    assert_eq!(gate.next_id(), 2);
    gate.take(&[quiet(2, 1)]).unwrap();
}

/// The verdict depends on ids alone, not on how they are cut into blocks.
#[test]
fn blocks_of_any_size_give_one_answer() {
    let row = |id: u64| {
        let mut row = quiet(id, 1);
        if id % 1_999 == 7 {
            row.candidate[0] = Observation::Event;
        }
        if id % 2_003 == 11 {
            row.baseline[0] = Observation::Event;
        }
        row
    };
    let answer = |block: u64| {
        let mut gate = Gate::new(plan(1, 2e-3, 50_000), CorpusResult::default()).unwrap();
        while gate.verdict().is_none() {
            let first = gate.next_id();
            gate.take(&(first..first + block).map(row).collect::<Vec<_>>()).unwrap();
        }
        gate.result().clone()
    };
    let reference = answer(1);
    assert_eq!(reference.pairs % 1000, 0);
    for block in [7, 999, 4_096] {
        assert_eq!(answer(block), reference);
    }
}

#[test]
fn a_breaking_candidate_fails_and_the_metric_is_named() {
    let mut gate = Gate::new(plan(3, 1e-3, 40_000), CorpusResult::default()).unwrap();
    let verdict = run(&mut gate, |id| {
        let mut row = quiet(id, 3);
        if id % 100 == 3 {
            row.candidate[1] = Observation::Event;
        }
        row
    });
    assert_eq!(verdict, GateVerdict::Fail);
    let result = gate.result();
    assert_eq!(result.comparison, LayerVerdict::Fail);
    let harmed: Vec<_> = result.metrics.iter().map(|m| m.harmed).collect();
    assert_eq!(harmed, [None, Some(Harmed::Alone), None]);
    let decided = result.pairs;
    let more = gate.take(&[quiet(decided, 3)]);
    assert_eq!(more, Err(GateError::Decided { id: decided, pairs: decided }));
}

#[test]
fn metrics_worse_only_together_fail_as_joint() {
    let mut gate = Gate::new(plan(3, 1e-2, 100_000), CorpusResult::default()).unwrap();
    // Ten breaks in each of three metrics at the first look: E is below m/a_F = 300 for
    // each, yet the mean is above 1/a_F = 100.
    let verdict = run(&mut gate, |id| {
        let mut row = quiet(id, 3);
        if id < 1_000 && id % 100 == 0 {
            row.candidate.fill(Observation::Event);
        }
        row
    });
    assert_eq!(verdict, GateVerdict::Fail);
    let harms: Vec<f64> = gate.result().metrics.iter().map(|m| m.ln_harm).collect();
    assert!(harms.iter().all(|&h| h > libm::log(100.0) && h < libm::log(300.0)), "{harms:?}");
    let joint = gate.result().metrics.iter().filter(|m| m.harmed == Some(Harmed::Joint)).count();
    assert_eq!(joint, 1);
}

/// In a random order, over many orders: the improvement is never called harm.
#[test]
fn ten_breaks_and_three_thousand_fixes_never_fail() {
    for seed in 0..50 {
        let mut plan = plan(1, 1e-4, 100_000);
        // A margin out of reach keeps the gate looking until its cap.
        plan.metrics[0].margin = Margin::Absolute { difference: 4e-5 };
        plan.metrics[0].discordance_plan = 3e-5;
        let mut draw = Generator::new(seed);
        let (mut breaks, mut discordant, mut left) = (10.0, 3_010.0, 100_000.0);
        let mut gate = Gate::new(plan, CorpusResult::default()).unwrap();
        let verdict = run(&mut gate, |id| {
            let mut row = quiet(id, 1);
            if draw.uniform() * left < discordant {
                if draw.uniform() * discordant < breaks {
                    row.candidate[0] = Observation::Event;
                    breaks -= 1.0;
                } else {
                    row.baseline[0] = Observation::Event;
                }
                discordant -= 1.0;
            }
            left -= 1.0;
            row
        });
        assert_ne!(verdict, GateVerdict::Fail, "{:?}", gate.result());
    }
}

#[test]
fn a_margin_out_of_reach_is_refused_with_the_cap_it_needs() {
    let error = Gate::new(plan(1, 1e-4, 20_000), CorpusResult::default()).unwrap_err();
    let PlanError::Infeasible { entry, cap, cap_needed } = error.clone() else {
        panic!("{error}");
    };
    assert_eq!((entry.as_str(), cap), ("metric_0", 20_000));
    assert!((33_300..33_600).contains(&cap_needed), "{cap_needed}");
    assert!(error.to_string().contains(&cap_needed.to_string()));
    assert!(Gate::new(plan(1, 1e-4, cap_needed), CorpusResult::default()).is_ok());
    assert!(Gate::new(plan(1, 1e-4, cap_needed - 1), CorpusResult::default()).is_err());
}

/// The default campaign: a neutral change at 1e-3 with a relative margin of 10 % needs about
/// 170,000 pairs; 20,000 are refused or known to end INCONCLUSIVE beforehand.
#[test]
fn the_default_campaign_needs_about_170_000_pairs() {
    let mut plan = plan(1, 1e-3, 500_000);
    plan.metrics[0].margin = Margin::Relative { ratio: 0.1, rate_plan: 1e-3 };
    plan.metrics[0].discordance_plan = 1e-4;
    let feasibility = plan.feasibility().unwrap();
    let expected = feasibility.needs[0].pairs_expected.unwrap();
    assert!((100_000..250_000).contains(&expected), "{expected}");
    assert!(feasibility.neutral_change_passes());
    plan.cap = 20_000;
    assert!(plan.feasibility().is_err() || !plan.feasibility().unwrap().neutral_change_passes());
}

#[test]
fn later_attempts_pass_at_half_the_level() {
    let mut plan = plan(1, 1e-3, 20_000);
    plan.look_every = 4;
    let passes_at = |attempt| {
        let plan = GatePlan { attempt, ..plan.clone() };
        let mut gate = Gate::new(plan, CorpusResult::default()).unwrap();
        assert_eq!(run(&mut gate, |id| quiet(id, 1)), GateVerdict::Pass);
        (gate.result().alpha_pass, gate.result().pairs)
    };
    let test = NonInferiority::absolute(1e-3, 1e-3).unwrap();
    for (attempt, alpha) in [(1, 0.05), (2, 0.025), (3, 0.0125)] {
        let pairs = test.encounters_undisturbed(alpha).unwrap().div_ceil(4) * 4;
        assert_eq!(passes_at(attempt), (alpha, pairs));
    }
    // A halving costs a little over ln 2 / d = 693 quiet pairs.
    assert!((680..740).contains(&(passes_at(2).1 - passes_at(1).1)));
}

#[test]
fn undetermined_outcomes_block_a_pass_and_cause_no_fail() {
    let mut gate = Gate::new(plan(1, 1e-3, 20_000), CorpusResult::default()).unwrap();
    let verdict = run(&mut gate, |id| {
        let mut row = quiet(id, 1);
        if id % 200 == 5 {
            row.candidate[0] = Observation::Undetermined;
        }
        row
    });
    assert_eq!(verdict, GateVerdict::Inconclusive);
    let metric = &gate.result().metrics[0];
    assert_eq!(
        (metric.undetermined, metric.counts_pass.n10, metric.counts_fail.n10),
        (100, 100, 0)
    );
    assert_eq!(metric.forecast, Forecast::CannotPass);
    assert!(metric.difference.lower < 0.0 && metric.difference.upper > 5e-3);
    // On the baseline's side: no event for PASS, an event for FAIL.
    let mut gate = Gate::new(plan(1, 1e-3, 20_000), CorpusResult::default()).unwrap();
    run(&mut gate, |id| {
        let mut row = quiet(id, 1);
        if id % 200 == 5 {
            row.baseline[0] = Observation::Undetermined;
        }
        row
    });
    let metric = &gate.result().metrics[0];
    assert_eq!((metric.counts_pass.n01, metric.counts_fail.n01), (0, metric.undetermined));
}

#[test]
fn a_broken_corpus_fails_before_any_statistics() {
    let broken = |waived: Option<&str>| CorpusResult {
        cases: 7,
        broken: vec![BrokenCase {
            name: "0007_overtaken_then_crossing".into(),
            waived: waived.map(str::to_owned),
        }],
    };
    let gate = Gate::new(plan(1, 1e-3, 20_000), broken(None)).unwrap();
    assert_eq!(gate.verdict(), Some(GateVerdict::Fail));
    assert_eq!(
        Gate::new(plan(1, 1e-3, 20_000), broken(Some(" "))).unwrap().verdict(),
        gate.verdict()
    );
    let mut waived =
        Gate::new(plan(1, 1e-3, 20_000), broken(Some("J. Smith: scene withdrawn"))).unwrap();
    assert_eq!(run(&mut waived, |id| quiet(id, 1)), GateVerdict::Pass);
}

pub(crate) fn with_absolute(rate_max: f64, test: AbsoluteTest, cap: u64) -> GatePlan {
    let mut plan = plan(1, 1e-2, cap);
    plan.absolutes.push(AbsolutePlan {
        name: "collision in stratum 2".into(),
        metric: 0,
        stratum: 2,
        rate_max,
        test,
    });
    plan
}

#[test]
fn absolute_requirements_are_demonstrated_violated_or_neither() {
    let gate = |rate_max, test, every: u64| {
        let mut gate =
            Gate::new(with_absolute(rate_max, test, 40_000), CorpusResult::default()).unwrap();
        run(&mut gate, |id| {
            let mut row = quiet(id, 1);
            // Both planners fail together: no difference, only a rate.
            if id % 4 == 2 && id / 4 % every == 1 {
                row.candidate[0] = Observation::Event;
                row.baseline[0] = Observation::Event;
            }
            row
        });
        gate.result().clone()
    };
    let shown = gate(2e-3, AbsoluteTest::Sequential, 1 << 40);
    assert_eq!((shown.verdict, shown.absolute), (GateVerdict::Pass, LayerVerdict::Pass));
    assert!(shown.pairs < 40_000 && shown.absolutes[0].n == shown.pairs / 4);
    let violated = gate(2e-3, AbsoluteTest::Sequential, 50);
    assert_eq!((violated.verdict, violated.absolute), (GateVerdict::Fail, LayerVerdict::Fail));
    // It fails although it is no worse than the baseline.
    assert_eq!(violated.comparison, LayerVerdict::Pass);
    let open = gate(2e-3, AbsoluteTest::Sequential, 480);
    assert_eq!(open.verdict, GateVerdict::Inconclusive);
    assert_eq!((open.comparison, open.pairs), (LayerVerdict::Pass, 40_000));
    // At a declared N the exact bound shows what the e-process cannot, and only at the cap.
    let declared = gate(1e-3, AbsoluteTest::DeclaredN, 2_600);
    assert_eq!((declared.verdict, declared.pairs), (GateVerdict::Pass, 40_000));
    assert_eq!(declared.absolutes[0].events_demonstrated, 4);
}

#[test]
fn absolute_requirements_out_of_reach_are_refused() {
    // ln(1/.05)/p0 = 2,996 encounters of the stratum, one in four.
    let exact = with_absolute(1e-3, AbsoluteTest::DeclaredN, 11_000);
    let error = exact.feasibility().unwrap_err();
    assert!(matches!(error, PlanError::Infeasible { cap_needed: 11_980, .. }), "{error}");
    let sequential = with_absolute(1e-3, AbsoluteTest::Sequential, 11_980);
    assert!(matches!(sequential.feasibility(), Err(PlanError::Infeasible { .. })));
}

#[test]
fn the_ratchet_must_pass_too_and_never_fails() {
    let mut plan = plan(1, 1e-3, 20_000);
    let margins = vec![plan.metrics[0].margin.scaled(3.0)];
    plan.ratchets.push(RatchetPlan { name: "anchor".into(), margins });
    let run_with = |anchor_breaks: bool| {
        let mut gate = Gate::new(plan.clone(), CorpusResult::default()).unwrap();
        run(&mut gate, |id| {
            let mut row = quiet(id, 1);
            row.ratchets.push(vec![Observation::NoEvent]);
            // The candidate and the baseline both fail where the anchor did not.
            if anchor_breaks && id % 100 == 9 {
                row.candidate[0] = Observation::Event;
                row.baseline[0] = Observation::Event;
            }
            row
        });
        gate.result().clone()
    };
    let same = run_with(false);
    assert_eq!((same.verdict, same.ratchet), (GateVerdict::Pass, LayerVerdict::Pass));
    let drifted = run_with(true);
    assert_eq!(
        (drifted.verdict, drifted.ratchet),
        (GateVerdict::Inconclusive, LayerVerdict::Inconclusive)
    );
    assert_eq!(drifted.comparison, LayerVerdict::Pass);
    assert_eq!(drifted.ratchets[0].forecast, Forecast::CannotPass);
}

#[test]
fn a_pass_that_is_worse_for_certain_says_so() {
    let mut plan = plan(1, 1e-2, 400_000);
    plan.metrics[0].discordance_plan = 5e-3;
    plan.look_every = 40_000;
    let mut gate = Gate::new(plan, CorpusResult::default()).unwrap();
    // Worse by 8 breaks in 40,000: inside the margin, and too few for FAIL's 1/a_F = 100.
    let verdict = run(&mut gate, |id| {
        let mut row = quiet(id, 1);
        if id % 5_000 == 17 {
            row.candidate[0] = Observation::Event;
        }
        row
    });
    let metric = &gate.result().metrics[0];
    assert_eq!(verdict, GateVerdict::Pass);
    assert!(metric.difference.lower > 0.0 && metric.worse_within_margin, "{metric:?}");
}

#[test]
fn impossible_plans_are_refused() {
    let broken = |change: fn(&mut GatePlan)| {
        let mut plan = plan(1, 1e-3, 20_000);
        change(&mut plan);
        Gate::new(plan, CorpusResult::default()).unwrap_err()
    };
    assert!(matches!(broken(|p| p.pattern.clear()), PlanError::Missing { .. }));
    assert!(matches!(broken(|p| p.metrics.clear()), PlanError::Missing { .. }));
    assert!(matches!(broken(|p| p.attempt = 0), PlanError::Missing { .. }));
    assert!(matches!(broken(|p| p.cap = 3), PlanError::CapBelowCycle { cap: 3, cycle: 4 }));
    assert!(matches!(broken(|p| p.alpha_fail = 0.0), PlanError::Entry { .. }));
    assert!(matches!(
        broken(|p| p.metrics[0].margin = Margin::Absolute { difference: f64::NAN }),
        PlanError::Entry { .. }
    ));
    assert!(matches!(
        broken(|p| p.ratchets.push(RatchetPlan { name: "release".into(), margins: Vec::new() })),
        PlanError::Reference { .. }
    ));
    let no_stratum = |p: &mut GatePlan| {
        p.absolutes = with_absolute(0.1, AbsoluteTest::Sequential, 1).absolutes;
        p.absolutes[0].stratum = 9;
    };
    assert!(matches!(broken(no_stratum), PlanError::Reference { .. }));
}
