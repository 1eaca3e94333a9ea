//! What decides at an edge: walks between two thresholds, equal bounds, nothing seen yet, a plan
//! that lacks something. Numbers with more than six digits were worked out with 40.

use crate::gate::{plan, quiet};
use stats::{
    AbsolutePlan, AbsoluteTest, BetaBinomial, Claim, CorpusResult, Gate, GateError,
    ImportanceFitness, LayerVerdict, MeanBets, Observation, PlanError, RatchetPlan, Sprt,
    SprtDecision, StatsError, WeightedCount, WeightedNonInferiority, bca_mean, betting_interval,
    binomial_lower_tail, binomial_upper_tail, check_intervals, clopper_pearson, fay_feuer,
    judge_absolute, last_particle, normal_quantile, quantile_rank_bounds, student_t_quantile,
    unpaired_needed,
};

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{found}, expected {expected}");
}

/// An event is worth ln 3 = 1.0986, none ln(7/9) = -0.2513; bad from ln 20 = 2.9957, good at
/// ln 0.1 = -2.3026.
#[test]
fn a_walk_that_has_seen_both_is_decided_by_their_sum() {
    let test = Sprt::claim(0.1, 0.3, 0.05, 0.1).unwrap();
    let decided = |k, n| test.decide(k, n).unwrap();
    assert_eq!((decided(5, 14), decided(5, 15)), (SprtDecision::Bad, SprtDecision::Continue));
    assert_eq!((decided(1, 14), decided(1, 15)), (SprtDecision::Continue, SprtDecision::Good));
    let (good, bad) = test.expected_encounters();
    near(good, 17.734_968_591_25);
    near(bad, 16.203_336_314_31);
}

#[test]
fn a_sequence_has_the_bounds_at_which_its_wealth_reaches_the_level() {
    let wide = BetaBinomial::new(2.0, 5.0).unwrap().interval(7, 40, 0.05).unwrap();
    near(wide.lower, 0.050_486_818_427_87);
    near(wide.upper, 0.381_821_649_426_3);
    let tuned = BetaBinomial::tuned(1000).unwrap().interval(3, 1000, 0.01).unwrap();
    near(tuned.lower, 0.000_155_497_138_661_2);
    near(tuned.upper, 0.013_494_061_090_38);
}

/// 1 - 1e-15 is no number of the machine; the rate itself is.
#[test]
fn the_wealth_against_a_rate_near_0_or_1_keeps_its_digits() {
    let sequence = BetaBinomial::new(0.5, 0.5).unwrap();
    let n = 1_000_000_000_000_000;
    near(sequence.ln_wealth(0, n, 1e-15).unwrap(), -16.841_753_140_38);
    near(sequence.ln_wealth(n, n, 1.0 - 1e-15).unwrap(), -16.842_552_418_22);
}

#[test]
fn a_betting_interval_has_the_bounds_of_its_own_stakes() {
    let mixed = [0.2, 0.9, 0.4, 0.6, 0.1, 0.7, 0.3, 0.5, 0.8, 0.6, 0.4, 0.5];
    let interval = betting_interval(&mixed, 0.4).unwrap();
    near(interval.lower, 0.363_188_663_945_2);
    near(interval.upper, 0.637_088_526_666_5);
    let close: Vec<f64> = (0..30).map(|i| 0.5 + 0.03 * f64::from((7 * i) % 5 - 2)).collect();
    let interval = betting_interval(&close, 0.05).unwrap();
    near(interval.lower, 0.395_497_978_861);
    near(interval.upper, 0.604_502_021_139);
}

#[test]
fn where_nothing_was_seen_nothing_is_worth_something() {
    near(fay_feuer(&[], 0.01, 100, 0.05).unwrap().n_effective, 0.0);
    let bets = MeanBets::planned(0.1, 10.0).unwrap();
    near(bets.interval(&[], 10, 0.05).unwrap().n_effective, 0.0);
}

#[test]
fn equal_rates_have_no_sample_size() {
    assert!(unpaired_needed(0.2, 0.2, 0.05, 0.9).is_err());
}

/// Weights, margin and plan in another unit say the same.
#[test]
fn weights_count_as_shares_of_the_largest() {
    let ln_e = |unit: f64| {
        let mut test = WeightedNonInferiority::new(0.1 * unit, unit, 0.3 * unit).unwrap();
        for (weight, candidate, baseline) in
            [(0.2, true, false), (0.75, false, true), (1.0, true, true), (0.5, false, false)]
        {
            test.add(weight * unit, candidate, baseline).unwrap();
        }
        test.ln_e()
    };
    near(ln_e(4.0), ln_e(1.0));
    let mut test = WeightedNonInferiority::new(0.1, 1.0, 0.3).unwrap();
    test.add(0.5, true, false).unwrap();
    test.add(0.5, true, false).unwrap();
    let sample = StatsError::Sample { index: 2, name: "weight", value: 1.5, low: 0.0, high: 1.0 };
    assert_eq!(test.add(1.5, true, false), Err(sample));
}

#[test]
fn the_first_of_two_equally_wrong_lines_is_named() {
    let line = "1,10,0.05,0.0051162,0.3941633\n";
    let csv = format!("k,n,one_sided_alpha,lower,upper\n{line}{line}");
    assert_eq!(check_intervals(&csv).unwrap().line_worst, 2);
}

#[test]
fn a_rate_that_may_equal_its_limit_is_not_violated() {
    let claim = Claim::try_from(clopper_pearson(30, 1000, 0.05).unwrap()).unwrap();
    let bounds = *claim.estimate();
    assert_eq!(judge_absolute(&claim, bounds.lower), LayerVerdict::Inconclusive);
    assert_eq!(judge_absolute(&claim, bounds.lower - 1e-9), LayerVerdict::Fail);
    assert_eq!(judge_absolute(&claim, bounds.upper), LayerVerdict::Pass);
}

#[test]
fn a_corpus_without_cases_was_not_asked() {
    let verdict = |cases| CorpusResult { cases, ..CorpusResult::default() }.verdict();
    assert_eq!((verdict(0), verdict(3)), (LayerVerdict::NotAsked, LayerVerdict::Pass));
}

#[test]
fn every_further_attempt_halves_the_level() {
    let level = |attempt| {
        let mut plan = plan(1, 1e-3, 20_000);
        plan.attempt = attempt;
        plan.alpha_pass_used()
    };
    for (attempt, expected) in [(1, 0.05), (2, 0.025), (3, 0.0125), (4, 0.00625)] {
        near(level(attempt), expected);
    }
}

#[test]
fn a_plan_without_looks_is_refused() {
    let mut plan = plan(1, 1e-3, 20_000);
    plan.look_every = 0;
    let refused = Gate::new(plan, CorpusResult::default()).unwrap_err();
    assert_eq!(refused, PlanError::Missing { what: "look_every" });
}

/// ln(0.05 / 2) / ln(1 - 0.001) = 3687.0: two requirements share the level.
#[test]
fn requirements_share_the_level() {
    let mut plan = plan(1, 1e-2, 20_000);
    let absolute = |name: &str| AbsolutePlan {
        name: name.into(),
        metric: 0,
        stratum: 0,
        rate_max: 1e-3,
        test: AbsoluteTest::DeclaredN,
    };
    plan.absolutes = vec![absolute("one"), absolute("other")];
    let needs = plan.feasibility().unwrap().needs;
    let of_absolutes: Vec<u64> =
        needs.iter().filter(|need| need.name != "metric_0").map(|need| need.pairs_min).collect();
    assert_eq!(of_absolutes, [3_688 * 4, 3_688 * 4]);
}

#[test]
fn a_row_that_lacks_a_ratchet_is_told_how_many_planners_there_are() {
    let mut plan = plan(1, 1e-3, 20_000);
    let margins = vec![plan.metrics[0].margin];
    plan.ratchets = vec![RatchetPlan { name: "release".into(), margins }];
    let mut gate = Gate::new(plan, CorpusResult::default()).unwrap();
    let shape = GateError::Shape { id: 0, metrics: 1, planners: 3 };
    assert_eq!(gate.take(&[quiet(0, 1)]), Err(shape));
}

/// Each rank is the last that is far enough out, as counting through all of them finds it.
#[test]
fn ranks_about_a_quantile_are_the_nearest_that_hold() {
    for (n, q) in [(1, 0.01), (2, 0.99), (7, 0.5), (8, 0.99), (45, 0.9), (60, 0.999), (61, 0.02)] {
        let half = 0.1;
        let below = |k| binomial_lower_tail(k, n, q).unwrap() <= half;
        let above = |k| binomial_upper_tail(k, n, q).unwrap() <= half;
        let lower = (1..=n).rev().find(|l| below(l - 1));
        let upper = (1..=n).find(|&u| above(u));
        assert_eq!(quantile_rank_bounds(n, q, 2.0 * half).unwrap(), (lower, upper), "{n} {q}");
    }
}

#[test]
fn the_fewest_that_are_enough_are_taken_and_fewer_are_not() {
    assert!(clopper_pearson(0, 0, 0.05).is_err());
    assert!(ImportanceFitness::new(&[0.5], 2).is_ok());
    assert!(ImportanceFitness::new(&[0.5], 1).is_err());
    assert!(last_particle(2, 3, 0.05).is_ok());
    assert!(last_particle(1, 3, 0.05).is_err());
    assert!(bca_mean(&[1.0, 2.0], 0.1, 1_000, &mut || 0.5).is_ok());
    assert!(bca_mean(&[1.0, 2.0], 0.1, 999, &mut || 0.5).is_err());
}

/// Of 1,000 pairs 6 break, 4 fix, and 3 are undetermined, which count for no difference.
#[test]
fn the_difference_that_is_shown_is_that_of_the_pairs() {
    let mut plan = plan(1, 1e-3, 20_000);
    plan.look_every = 1_000;
    let mut gate = Gate::new(plan, CorpusResult::default()).unwrap();
    let before = gate.result().metrics[0].difference;
    assert_eq!((before.n, before.value.to_bits()), (0, 0));
    let rows: Vec<_> = (0..1_000)
        .map(|id| {
            let mut row = quiet(id, 1);
            match id {
                10..16 => row.candidate[0] = Observation::Event,
                20..24 => row.baseline[0] = Observation::Event,
                30..32 => row.candidate[0] = Observation::Undetermined,
                32 => row.baseline[0] = Observation::Undetermined,
                _ => {}
            }
            row
        })
        .collect();
    gate.take(&rows).unwrap();
    let metric = &gate.result().metrics[0];
    near(metric.difference.value, 0.002);
    assert_eq!((metric.difference.n, metric.undetermined), (1_000, 3));
}

#[test]
fn a_weight_that_did_not_occur_is_not_the_largest() {
    let events = [WeightedCount { weight: 1.0, count: 3 }, WeightedCount { weight: 9.0, count: 0 }];
    near(ImportanceFitness::of_counts(&events, 10).unwrap().share_max, 1.0 / 3.0);
}

/// Draws that always take the smaller of two: every resampled mean lies below the mean.
#[test]
fn a_bootstrap_whose_means_lie_on_one_side_has_an_interval() {
    let interval = bca_mean(&[1.0, 2.0], 0.1, 1_000, &mut || 0.0).unwrap();
    near(interval.lower, 1.0);
    near(interval.upper, 1.0);
}

#[test]
fn the_middle_of_a_symmetric_distribution_is_0() {
    let middle = (student_t_quantile(0.5, 7.0).unwrap(), normal_quantile(0.5).unwrap());
    assert!(middle.0.abs() < 1e-12 && middle.1.abs() < 1e-12, "{middle:?}");
}
