//! What an estimate says beside its bounds (the value, how many encounters, how many they are
//! worth), sums that are merged, and closed forms worked out by hand or with SciPy's quantiles.

use stats::{
    BetaBinomial, Bins, Forecast, Histogram, Margin, MeanBets, Method, NonInferiority,
    PairedCounts, RateTest, RiskCounts, RiskEvent, RiskPart, RiskSums, WeightedCount,
    betting_interval, betting_ratio, chi_squared_quantile, clopper_pearson, clopper_pearson_lower,
    clopper_pearson_upper, encounters_fixed_test, encounters_for_width, exact_difference_upper,
    exact_ratio, fay_feuer, holm, jeffreys, last_particle, ln_binomial_pmf, pairs_needed,
    replications, student_t_quantile, unpaired_needed, wilson,
};

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-6 * expected.abs(), "{found}, expected {expected}");
}

#[test]
fn a_rate_is_events_by_encounters() {
    for estimate in [clopper_pearson(3, 40, 0.05), wilson(3, 40, 0.05), jeffreys(3, 40, 0.05)] {
        let estimate = estimate.unwrap();
        near(estimate.value, 0.075);
        near(estimate.n_effective, 40.0);
        assert_eq!(estimate.n, 40);
    }
    let sequence = BetaBinomial::tuned(1000).unwrap();
    near(sequence.interval(3, 40, 0.05).unwrap().value, 0.075);
    near(betting_interval(&[0.5, 0.0, 1.0, 0.5], 0.05).unwrap().value, 0.5);
}

/// The wealth is a fair game: over every outcome, weighed by its probability, it is worth 1.
#[test]
fn the_wealth_of_a_sequence_is_fair() {
    let sequence = BetaBinomial::new(2.0, 5.0).unwrap();
    for p in [0.02, 0.3, 0.7, 0.95] {
        let worth = |k: u64| {
            let ln_mass = ln_binomial_pmf(k, 12, p).unwrap();
            libm::exp(ln_mass + sequence.ln_wealth(k, 12, p).unwrap())
        };
        near((0..=12).map(worth).sum(), 1.0);
    }
}

#[test]
fn paired_counts_add_up() {
    let part = PairedCounts { n11: 1, n10: 5, n01: 2, n00: 12 };
    let mut both = PairedCounts { n11: 10, n10: 20, n01: 30, n00: 40 };
    both.merge(&part);
    assert_eq!(both, PairedCounts { n11: 11, n10: 25, n01: 32, n00: 52 });
    near(part.difference(), 0.15);
    let upper = clopper_pearson_upper(5, 20, 0.025).unwrap();
    let lower = clopper_pearson_lower(2, 20, 0.025).unwrap();
    near(exact_difference_upper(&part, 0.05).unwrap(), upper - lower);
}

/// 4 unresolved, 2 induced and 16 removed: R = 0.3, and the variance by hand.
#[test]
fn risk_ratios_by_hand() {
    let counts = RiskCounts { unresolved: 4, induced: 2, removed: 16, neither: 978 };
    let sums = RiskSums::from_counts(&counts);
    let delta = sums.delta(RiskPart::Total, 0.05).unwrap();
    near(delta.value, 0.3);
    near(delta.lower, 0.072_158_814_8);
    near(delta.upper, 0.527_841_185_2);
    let log_delta = sums.log_delta(RiskPart::Total, 0.05).unwrap();
    near(log_delta.lower, 0.140_374_220_1);
    near(log_delta.upper, 0.641_143_366_2);
    near(sums.delta(RiskPart::Induced, 0.05).unwrap().value, 0.1);

    let exact = exact_ratio(&counts, 0.06).unwrap();
    near(exact.value, 0.3);
    let low = |k: u64, n: u64| clopper_pearson_lower(k, n, 0.01).unwrap();
    let high = |k: u64, n: u64| clopper_pearson_upper(k, n, 0.01).unwrap();
    near(exact.lower, low(4, 20) + low(2, 1000) / high(20, 1000));
    near(exact.upper, high(4, 20) + high(2, 1000) / low(20, 1000));
}

#[test]
fn merged_risk_sums_are_those_of_all() {
    let all = [
        (1.0, true, true),
        (0.5, true, false),
        (0.5, false, true),
        (1.0, false, true),
        (1.0, false, false),
        (0.25, true, true),
    ];
    let sums_of = |part: &[(f64, bool, bool)]| {
        let mut sums = RiskSums::default();
        for &(weight, planner, nominal) in part {
            sums.add(weight, planner, nominal).unwrap();
        }
        sums
    };
    let mut merged = sums_of(&all[..3]);
    merged.merge(&sums_of(&all[3..]));
    assert_eq!(merged, sums_of(&all));
    // (sum of w)^2 / sum of w^2
    let delta = merged.delta(RiskPart::Total, 0.05).unwrap();
    near(delta.n_effective, 4.25 * 4.25 / 3.5625);
    near(delta.value, 1.75 / 2.75);
    assert_eq!(delta.n, 6);
}

#[test]
fn weighted_estimates_by_hand() {
    let event = |weight, planner, nominal, count| RiskEvent { weight, planner, nominal, count };
    let events =
        [event(1.0, true, true, 3), event(0.5, true, false, 2), event(0.5, false, true, 4)];
    let ratio = betting_ratio(&events, 1.0, 1000, 0.05).unwrap();
    near(ratio.value, 0.8);
    near(ratio.n_effective, 8.0);
    let weighted =
        [WeightedCount { weight: 0.01, count: 3 }, WeightedCount { weight: 0.002, count: 2 }];
    let rate = fay_feuer(&weighted, 0.01, 100, 0.05).unwrap();
    near(rate.value, 0.034);
    near(rate.n_effective, 0.034 * 0.034 / 0.000_308);
    let bets = MeanBets::planned(0.1, 10.0).unwrap();
    let mean = bets.interval(&[0.5, 0.5, 1.0], 10, 0.05).unwrap();
    near(mean.value, 0.2);
    near(mean.n_effective, 4.0 / 1.5);
    // a value that occurs twice is two values
    let listed = |weight: f64, count: u64| bets.upper(&[WeightedCount { weight, count }], 10, 0.05);
    let twice = [WeightedCount { weight: 0.5, count: 1 }; 2];
    near(listed(0.5, 2).unwrap(), bets.upper(&twice, 10, 0.05).unwrap());
    near(
        bets.lower(&[WeightedCount { weight: 0.5, count: 8 }], 10, 0.2).unwrap(),
        bets.lower(&[WeightedCount { weight: 0.5, count: 1 }; 8], 10, 0.2).unwrap(),
    );
}

#[test]
fn rare_events_by_hand() {
    let split = last_particle(100, 460, 0.05).unwrap();
    near(split.value, 0.009_821_764_459);
    let quantile = |p: f64, freedom: f64| chi_squared_quantile(p, freedom).unwrap();
    near(split.lower, libm::exp(-quantile(0.975, 922.0) / 200.0));
    near(split.upper, libm::exp(-quantile(0.025, 920.0) / 200.0));
    assert_eq!(split.n, 560);
    let rates: Vec<f64> = (0..30).map(|i| if i % 2 == 0 { 0.01 } else { 0.03 }).collect();
    let mean = replications(&rates, 1000, 0.05).unwrap();
    near(mean.lower, 0.016_202_103_9);
    near(mean.upper, 0.023_797_896_1);
    assert_eq!(mean.n, 30_000);
}

#[test]
fn quantiles_of_students_t() {
    near(student_t_quantile(0.9, 5.0).unwrap(), 1.475_884_049);
    near(student_t_quantile(0.1, 5.0).unwrap(), -1.475_884_049);
    near(student_t_quantile(0.975, 29.0).unwrap(), 2.045_229_642);
}

/// With z(0.05) = 1.644854, z(0.1) = 1.281552 and z(0.025) = 1.959964.
#[test]
fn sample_sizes_by_hand() {
    near(encounters_for_width(0.1, 0.1, 0.05).unwrap(), 3_457.312_938_6);
    near(encounters_fixed_test(0.1, 0.2, 0.05, 0.1).unwrap(), 101.219_035_5);
    near(unpaired_needed(0.1, 0.2, 0.05, 0.9).unwrap(), 214.096_183_8);
    near(pairs_needed(0.02, 0.01, 0.05, 0.9).unwrap(), 2_565.402_106);
}

/// Against 0.05 / 4 and 0.05 / 3, then 0.05 / 2.
#[test]
fn holm_steps_down() {
    let rejected = holm(&[0.015, 0.04, 0.03, 0.005], 0.05).unwrap();
    assert_eq!(rejected, [true, false, false, true]);
}

#[test]
fn a_histogram_counts_what_lies_outside() {
    let mut histogram = Histogram::new(Bins { per_unit: 10, first: -5, count: 10 });
    for value in [-0.6, -0.7, -0.5, 0.0, 0.49, 0.5, 3.0, 4.0, f64::INFINITY, f64::INFINITY] {
        histogram.add(value).unwrap();
    }
    let outside = (histogram.below(), histogram.above(), histogram.censored());
    assert_eq!((outside, histogram.n()), ((2, 3, 2), 10));
    let bins: Vec<_> = histogram.occupied().collect();
    assert_eq!(bins, [(-0.5, 1), (0.0, 1), (0.4, 1)]);
}

#[test]
fn a_margin_is_scaled_by_its_own_kind() {
    let relative = Margin::Relative { ratio: 0.2, rate_plan: 0.05 };
    near(relative.as_difference(), 0.01);
    assert_eq!(relative.scaled(3.0), Margin::Relative { ratio: 3.0 * 0.2, rate_plan: 0.05 });
    near(Margin::Absolute { difference: 0.004 }.scaled(3.0).as_difference(), 0.012);
}

#[test]
fn a_method_prints_its_name() {
    assert_eq!(Method::ClopperPearson.to_string(), "Clopper-Pearson");
    assert_eq!(Method::Replications.to_string(), "t over replications");
}

/// The level is reached about where the forecast says, if it goes on at the rates seen so far (half
/// an event added to each).
#[test]
fn a_forecast_comes_about() {
    let more = |forecast: Forecast| match forecast {
        Forecast::Encounters(more) => more,
        other => panic!("{other:?}"),
    };
    let about = |ln_e: f64, alpha: f64| {
        let ratio = -ln_e / libm::log(alpha);
        assert!((ratio - 1.0).abs() < 0.08, "{ln_e}");
    };
    let rate = RateTest::demonstrated(0.02).unwrap();
    let n = 400 + more(rate.forecast(2, 400, 0.001).unwrap());
    about(rate.ln_e(n * 5 / 802, n).unwrap(), 0.001);
    let counts = PairedCounts { n11: 300, n10: 10, n01: 20, n00: 7670 };
    let share = |n: u64, half_events: u64| n * half_events / 16_002;
    for (test, alpha) in [
        (NonInferiority::absolute(0.001, 0.004).unwrap(), 1e-9),
        (NonInferiority::relative(0.05, 0.04, 0.004).unwrap(), 1e-9),
    ] {
        let n = 8000 + more(test.forecast(&counts, alpha));
        let (n11, n10, n01) = (share(n, 600), share(n, 21), share(n, 41));
        let then = PairedCounts { n11, n10, n01, n00: n - n11 - n10 - n01 };
        about(test.ln_e(&then), alpha);
    }
}

/// The planned numbers are where the wealth reaches the level; and as they were.
#[test]
fn the_planned_encounters_reach_the_level() {
    let absolute = NonInferiority::absolute(0.01, 0.004).unwrap();
    let relative = NonInferiority::relative(0.2, 0.05, 0.004).unwrap();
    let planned = [&absolute, &relative].map(|test| test.encounters_planned(0.001).unwrap());
    let still = [&absolute, &relative].map(|test| test.encounters_undisturbed(0.001).unwrap());
    assert_eq!((planned, still), ([1975, 2131], [726, 801]));
    let about = |ln_e: f64| assert!((ln_e / libm::log(1000.0) - 1.0).abs() < 0.03, "{ln_e}");
    about(absolute.ln_e(&PairedCounts { n11: 0, n10: 4, n01: 4, n00: 1967 }));
    about(absolute.ln_e(&PairedCounts { n11: 0, n10: 0, n01: 0, n00: 726 }));
    about(relative.ln_e(&PairedCounts { n11: 102, n10: 4, n01: 4, n00: 2021 }));
    about(relative.ln_e(&PairedCounts { n11: 40, n10: 0, n01: 0, n00: 761 }));
    // fixes cannot be planned above the planned rate
    assert!(NonInferiority::relative(0.2, 0.05, 0.09).is_ok());
    assert!(NonInferiority::relative(0.2, 0.05, 0.11).is_err());
}
