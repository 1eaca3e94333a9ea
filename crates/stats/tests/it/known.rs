//! Answers worked out apart from this crate, from the formulas of the specification with 40 digits
//! (the bootstrap with SciPy's normal distribution), at inputs in which every part counts: unequal
//! weights, a largest weight that is not 1, every kind of outcome.

use stats::{
    BetaBinomial, Forecast, Harm, ImportanceFitness, MeanBets, NonInferiority, PairedCounts,
    RateTest, RiskCounts, RiskEvent, RiskPart, RiskSums, WeightedCount, bca_mean, beta_quantile,
    betting_ratio, binomial_upper_tail, clopper_pearson, fay_feuer, last_particle_cv_squared,
    ln_binomial_pmf, mcnemar_exact, mcnemar_randomised, tango,
};

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{found}, expected {expected}");
}

#[test]
fn wealth_of_the_bets() {
    let counts = |n11, n10, n01, n00| PairedCounts { n11, n10, n01, n00 };
    near(Harm::default().ln_e(&counts(30, 17, 6, 952)), 2.244_367_466_253);
    let absolute = NonInferiority::absolute(0.01, 0.02).unwrap();
    near(absolute.ln_e(&counts(30, 7, 11, 952)), 3.999_598_143_994);
    let relative = NonInferiority::relative(0.2, 0.05, 0.03).unwrap();
    near(relative.ln_e(&counts(300, 7, 11, 682)), 34.427_190_553_2);
    let demonstrated = RateTest::demonstrated(0.02).unwrap();
    near(demonstrated.ln_e(3, 500).unwrap(), 1.206_294_181_394);
    let violated = RateTest::violated(0.02).unwrap();
    near(violated.ln_e(25, 500).unwrap(), 4.521_689_303_96);
}

#[test]
fn betting_bounds_of_a_mean() {
    let mixed = [0.5, 0.5, 1.0, 0.8, 0.3, 0.9, 0.7, 0.6];
    let interval = MeanBets::planned(0.1, 10.0).unwrap().interval(&mixed, 40, 0.2).unwrap();
    near(interval.lower, 0.037_401_799_616_75);
    near(interval.upper, 0.273_122_265_329_8);
    let same = MeanBets::planned(0.02, 20.0).unwrap().interval(&[0.9; 12], 200, 0.1).unwrap();
    near(same.lower, 0.018_118_114_276_57);
    near(same.upper, 0.107_612_570_815_1);
}

#[test]
fn betting_bounds_of_a_risk_ratio() {
    let event = |weight, planner, nominal, count| RiskEvent { weight, planner, nominal, count };
    let better = [
        event(1.5, true, true, 6),
        event(0.5, true, false, 9),
        event(2.0, false, true, 30),
        event(0.25, false, true, 8),
        event(2.0, true, true, 0),
    ];
    let interval = betting_ratio(&better, 2.0, 1_000, 0.1).unwrap();
    near(interval.lower, 0.030_727_789_377_26);
    near(interval.upper, 0.392_398_485_596_1);
    let worse = [
        event(1.0, true, true, 20),
        event(1.0, true, false, 60),
        event(1.0, false, true, 2),
        event(0.5, true, false, 10),
    ];
    let interval = betting_ratio(&worse, 1.0, 1_000, 0.1).unwrap();
    near(interval.lower, 2.473_477_635_122);
    near(interval.upper, 8.283_952_534_534);
}

#[test]
fn delta_intervals_of_weighted_encounters() {
    let mut sums = RiskSums::default();
    for (weight, planner, nominal) in [
        (1.0, true, true),
        (0.5, true, false),
        (0.5, false, true),
        (2.0, false, true),
        (1.0, false, false),
        (0.25, true, true),
    ] {
        sums.add(weight, planner, nominal).unwrap();
    }
    for (part, value, upper, log_lower, log_upper) in [
        (RiskPart::Total, 7.0 / 15.0, 1.162_671_109_838, 0.105_022_764_815, 2.073_624_496_179),
        (RiskPart::Unresolved, 1.0 / 3.0, 0.889_744_265_736, 0.062_797_181_576, 1.769_364_616_730),
        (RiskPart::Induced, 2.0 / 15.0, 0.469_354_811_929, 0.010_726_219_546, 1.657_413_192_120),
    ] {
        let delta = sums.delta(part, 0.05).unwrap();
        near(delta.value, value);
        near(delta.upper, upper);
        near(delta.lower, 0.0);
        let log_delta = sums.log_delta(part, 0.05).unwrap();
        near(log_delta.lower, log_lower);
        near(log_delta.upper, log_upper);
    }
}

/// Of two encounters there is a standard error, of one there is none.
#[test]
fn two_encounters_are_enough_for_a_risk_ratio() {
    let of = |unresolved, removed| {
        let counts = RiskCounts { unresolved, induced: 0, removed, neither: 0 };
        RiskSums::from_counts(&counts).delta(RiskPart::Total, 0.05)
    };
    assert!(of(1, 0).is_err());
    // R = 1/2, z = (1, 1), x = (1, 0): sqrt(2 / 1 * (1/4 + 1/4)) / 2 = 1/2
    near(of(1, 1).unwrap().upper, 0.5 + 0.5 * 1.959_963_984_54);
}

#[test]
fn rates_of_weighted_events() {
    let events =
        [WeightedCount { weight: 0.01, count: 3 }, WeightedCount { weight: 0.002, count: 2 }];
    let interval = fay_feuer(&events, 0.01, 100, 0.05).unwrap();
    near(interval.lower, 0.008_758_849_617_347);
    near(interval.upper, 0.091_530_334_938_9);
    let fitness = ImportanceFitness::new(&[0.5, 0.25, 1.0, 0.125, 0.5], 100).unwrap();
    near(fitness.rate, 0.023_75);
    near(fitness.rate_error, 0.012_397_941_952_05);
    near(fitness.events_effective, 3.574_257_425_743);
    near(fitness.share_max, 0.421_052_631_578_9);
    near(last_particle_cv_squared(0.001, 100).unwrap(), 0.071_519_305_237_61);
}

/// 1471 and (470 + 0.3 * 1001) of 2^14.
#[test]
fn paired_tests_of_ten_breaks_and_four_fixes() {
    near(mcnemar_exact(10, 4).unwrap(), 0.089_782_714_843_75);
    near(mcnemar_randomised(10, 4, 0.3).unwrap(), 0.047_015_380_859_375);
}

/// The constrained maximum of the likelihood found by search, not by Tango's root.
#[test]
fn score_intervals_of_a_difference() {
    let of = |n10, n01, n, alpha| {
        let interval = tango(&PairedCounts::discordant(n10, n01, n), alpha).unwrap();
        (interval.lower, interval.upper)
    };
    let (lower, upper) = of(9, 4, 60, 0.05);
    near(lower, -0.038_189_199_820_03);
    near(upper, 0.209_374_715_730_7);
    let (lower, upper) = of(3, 12, 500, 0.1);
    near(lower, -0.032_789_729_966_48);
    near(upper, -0.005_810_856_443_214);
}

/// Order statistics 116 and 990 of 1,000 resampled means, 320 and 3,991 of 4,000, 156 and 1,943 of
/// 2,000: the sample leans to one side, so that all three corrections move them.
#[test]
fn bootstrap_of_samples_that_lean_to_one_side() {
    let waits = [0.0, 0.0, 1.0, 0.0, 3.0, 0.0, 0.0, 8.0, 1.0, 0.0, 2.0, 0.0, 0.0, 21.0, 5.0];
    let of = |sample: &[f64], alpha, resamples| {
        let mut state = 1_u64;
        let mut uniform = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let interval = bca_mean(sample, alpha, resamples, &mut uniform).unwrap();
        (interval.value, interval.lower, interval.upper)
    };
    let expect = |(value, lower, upper): (f64, f64, f64), expected: [f64; 3]| {
        near(value, expected[0]);
        near(lower, expected[1]);
        near(upper, expected[2]);
    };
    expect(of(&waits, 0.1, 1_000), [41.0 / 15.0, 16.0 / 15.0, 104.0 / 15.0]);
    expect(of(&waits, 0.05, 4_000), [41.0 / 15.0, 14.0 / 15.0, 121.0 / 15.0]);
    expect(of(&waits.map(|x| -x), 0.1, 1_000), [-41.0 / 15.0, -104.0 / 15.0, -16.0 / 15.0]);
    let rising: Vec<f64> = (0..12).map(|v| 0.1 * f64::from(v * v) - 0.3 * f64::from(v)).collect();
    expect(of(&rising, 0.1, 2_000), [77.0 / 30.0, 1.4, 4.2]);
}

/// What is missing to 1000, divided by the best bet's growth at the rates seen so far (half an
/// event added to each kind of difference), rounded up.
#[test]
fn forecasts_of_small_counts() {
    let counts = PairedCounts { n11: 4, n10: 1, n01: 2, n00: 33 };
    let narrow = NonInferiority::absolute(0.01, 0.02).unwrap();
    assert_eq!(narrow.forecast(&counts, 0.001), Forecast::Encounters(1_130));
    let wide = NonInferiority::absolute(0.1, 0.2).unwrap();
    assert_eq!(wide.forecast(&counts, 0.001), Forecast::Encounters(102));
    let relative = NonInferiority::relative(0.5, 0.1, 0.05).unwrap();
    assert_eq!(relative.forecast(&counts, 0.001), Forecast::Encounters(233));
    let rate = RateTest::demonstrated(0.2).unwrap();
    assert_eq!(rate.forecast(2, 25, 0.001).unwrap(), Forecast::Encounters(179));
}

/// 1 less what is left over would be nothing at all here.
#[test]
fn small_tails_and_small_quantiles_keep_their_digits() {
    near(binomial_upper_tail(90, 100, 0.5).unwrap(), 1.531_645_087_719e-17);
    near(binomial_upper_tail(60, 80, 0.2).unwrap(), 5.116_191_901_477e-26);
    near(ln_binomial_pmf(0, 1_000_000_000_000_000, 1e-15).unwrap(), -1.0);
    near(beta_quantile(0.01, 0.01, 5.0).unwrap(), 1.253_990_451_123e-201);
    near(beta_quantile(0.025, 3.5, 40.5).unwrap(), 0.020_040_880_111_35);
}

#[test]
fn both_sides_of_a_rate_at_half_the_level_each() {
    let few = clopper_pearson(3, 40, 0.05).unwrap();
    near(few.lower, 0.015_742_179_851_04);
    near(few.upper, 0.203_864_748_732_9);
    let most = clopper_pearson(37, 40, 0.05).unwrap();
    near(most.lower, 0.796_135_251_267_1);
    near(most.upper, 0.984_257_820_149);
}

/// Shapes at which Stirling's formula no longer serves.
#[test]
fn a_sequence_may_have_shapes_near_nothing() {
    for (s, t, expected) in [
        (1e-9, 3.0, -20.344_722_599_97),
        (3.0, 1e-9, -23.745_919_980_04),
        (1e-9, 2e-9, -20.144_051_906_21),
        (1e-12, 0.5, -26.761_033_917_87),
    ] {
        near(BetaBinomial::new(s, t).unwrap().ln_wealth(2, 10, 0.3).unwrap(), expected);
    }
}

/// C(33, 16) / 2^33: from 16 on Stirling's error is a series.
#[test]
fn the_series_of_stirling_begins_with_all_its_digits() {
    let found = ln_binomial_pmf(16, 33, 0.5).unwrap();
    assert!((found / -1.996_323_497_114_239_5 - 1.0).abs() < 1e-13, "{found}");
}
