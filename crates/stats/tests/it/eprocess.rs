//! The paired e-processes: known numbers, and false alarms under continuous looking.

use crate::generator::Generator;
use stats::{Forecast, Harm, NonInferiority, PairedCounts, RateTest};

fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Section 4.5: N d at zero discordance, a = .05.
#[test]
fn price_of_non_inferiority_without_discordance() {
    let price = |d: f64, plan: f64| {
        let test = NonInferiority::absolute(d, plan).unwrap();
        test.encounters_undisturbed(0.05).unwrap() as f64 * d
    };
    for d in [1e-3, 1e-4, 1e-5] {
        assert!((price(d, 0.5 * d) - 3.34).abs() < 0.01, "{}", price(d, 0.5 * d));
        assert!((price(d, d) - 3.34).abs() < 0.01, "{}", price(d, d));
        assert!((price(d, 2.0 * d) - 4.4).abs() < 0.05, "{}", price(d, 2.0 * d));
        let worst = [3.0, 10.0, 30.0, 100.0, 1e3, 9e3].map(|q| price(d, (q * d).min(0.9)));
        assert!(worst.iter().all(|&p| p <= 6.55), "{worst:?}");
    }
    // 20,000 pairs can show d >= 1.7e-4 at best, d = 1e-5 needs 3.4e5.
    let needed = |d: f64| NonInferiority::absolute(d, d).unwrap().encounters_undisturbed(0.05);
    assert!(needed(1.7e-4).unwrap() <= 20_000 && needed(1.6e-4).unwrap() > 20_000);
    assert!((needed(1e-5).unwrap() as f64 / 3.4e5 - 1.0).abs() < 0.02);
}

#[test]
fn ten_breaks_and_three_thousand_fixes_are_no_harm() {
    let harm = Harm::default();
    for n in [3_010, 1_000_000, 3_000_000_000] {
        let ln_e = harm.ln_e(&PairedCounts::discordant(10, 3000, n));
        assert!(ln_e < 0.0, "{ln_e}");
    }
    let better = NonInferiority::absolute(1e-3, 1e-3).unwrap();
    assert!(better.ln_e(&PairedCounts::discordant(10, 3000, 1_000_000)) > ln(20.0));
}

/// Every bet is a polynomial; small cases against the products written out.
#[test]
fn mixtures_are_the_declared_sums() {
    let lambdas = |limit: f64, design: f64| {
        let largest = 0.999 * limit;
        let aimed = design.min(largest);
        let mut nodes = vec![(0.5, aimed), (0.15, (2.0 * aimed).min(largest)), (0.15, aimed / 2.0)];
        nodes.extend((0..7).map(|j| (0.2 / 7.0, largest * libm::pow(3.0, -f64::from(j)))));
        nodes
    };
    let counts = PairedCounts { n11: 3, n10: 2, n01: 1, n00: 4 };
    let e = |nodes: Vec<(f64, f64)>, factors: fn(f64) -> [f64; 4]| -> f64 {
        nodes
            .into_iter()
            .map(|(weight, l)| {
                let [both, breaks, fixes, none] = factors(l);
                weight * both * both * both * breaks * breaks * fixes * none * none * none * none
            })
            .sum()
    };
    let close = |ln_e: f64, e: f64| assert!((ln_e - ln(e)).abs() < 1e-13, "{ln_e} {e}");
    close(Harm::default().ln_e(&counts), e(lambdas(1.0, 0.5), |l| [1.0, 1.0 + l, 1.0 - l, 1.0]));
    let d = 0.05;
    close(
        NonInferiority::absolute(d, 0.2).unwrap().ln_e(&counts),
        e(lambdas(1.0 / 0.95, 0.25), |l| {
            [1.0 + l * 0.05, 1.0 - l * 0.95, 1.0 + l * 1.05, 1.0 + l * 0.05]
        }),
    );
    close(
        NonInferiority::relative(0.1, 0.3, 0.2).unwrap().ln_e(&counts),
        e(lambdas(1.0, 0.15), |l| [1.0 + 0.1 * l, 1.0 - l, 1.0 + 1.1 * l, 1.0]),
    );
    let counts = PairedCounts { n11: 3, n10: 0, n01: 0, n00: 4 };
    let e = |nodes: Vec<(f64, f64)>, factors: fn(f64) -> [f64; 2]| -> f64 {
        nodes
            .into_iter()
            .map(|(weight, l)| {
                let [event, none] = factors(l);
                weight * event * event * event * none * none * none * none
            })
            .sum()
    };
    assert_eq!(counts.n(), 7);
    close(
        RateTest::demonstrated(0.2).unwrap().ln_e(3, 7).unwrap(),
        e(lambdas(1.25, 1.25), |l| [1.0 - l * 0.8, 1.0 + l * 0.2]),
    );
    close(
        RateTest::violated(0.2).unwrap().ln_e(3, 7).unwrap(),
        e(lambdas(5.0, 2.5), |l| [1.0 + l * 0.8, 1.0 - l * 0.2]),
    );
}

/// The mean of each e-value at the edge of its null is 1, summed exactly over all outcomes.
#[test]
fn mean_is_one_at_the_edge_of_the_null() {
    let n = 12_u64;
    let choose = |n: u64, k: u64| (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
    let power = |p: f64, k: u64| (0..k).fold(1.0, |product, _| product * p);
    let mean = |p11: f64, p10: f64, p01: f64, ln_e: &dyn Fn(&PairedCounts) -> f64| {
        let mut sum = 0.0;
        for n11 in 0..=n {
            for n10 in 0..=n - n11 {
                for n01 in 0..=n - n11 - n10 {
                    let n00 = n - n11 - n10 - n01;
                    let ways = choose(n, n11) * choose(n - n11, n10) * choose(n - n11 - n10, n01);
                    let probability = ways
                        * power(p11, n11)
                        * power(p10, n10)
                        * power(p01, n01)
                        * power(1.0 - p11 - p10 - p01, n00);
                    sum += probability * libm::exp(ln_e(&PairedCounts { n11, n10, n01, n00 }));
                }
            }
        }
        sum
    };
    let harm = Harm::default();
    let absolute = NonInferiority::absolute(0.1, 0.2).unwrap();
    let relative = NonInferiority::relative(0.25, 0.2, 0.2).unwrap();
    let demonstrated = RateTest::demonstrated(0.3).unwrap();
    let violated = RateTest::violated(0.3).unwrap();
    let means = [
        mean(0.1, 0.2, 0.2, &|c| harm.ln_e(c)),
        mean(0.1, 0.3, 0.2, &|c| absolute.ln_e(c)),
        // p_A = .3, p_B = .375
        mean(0.1, 0.275, 0.2, &|c| relative.ln_e(c)),
        mean(0.3, 0.0, 0.0, &|c| demonstrated.ln_e(c.n11, c.n()).unwrap()),
        mean(0.3, 0.0, 0.0, &|c| violated.ln_e(c.n11, c.n()).unwrap()),
    ];
    for mean in means {
        assert!((mean - 1.0).abs() < 1e-12, "{means:?}");
    }
}

/// How often ln E reaches `ln_level` within `pairs`, looking after every discordant or doubly
/// failing pair and just before it, which is continuous looking.
fn alarms(
    sets: u64,
    pairs: u64,
    rates: [f64; 3],
    ln_level: f64,
    ln_e: &dyn Fn(&PairedCounts) -> f64,
) -> u64 {
    let [both, breaks, fixes] = rates;
    let total = both + breaks + fixes;
    let mut alarms = 0;
    for set in 0..sets {
        let mut draw = Generator::new(set.wrapping_mul(0x1234_5678_9abc_def1));
        let mut counts = PairedCounts::default();
        loop {
            let gap = draw.gap(total);
            let quiet = (gap - 1).min(pairs - counts.n());
            counts.n00 += quiet;
            if quiet > 0 && ln_e(&counts) >= ln_level {
                alarms += 1;
                break;
            }
            if counts.n() == pairs {
                break;
            }
            let u = draw.uniform() * total;
            counts.add(u < both + breaks, u < both || u >= both + breaks);
            if ln_e(&counts) >= ln_level {
                alarms += 1;
                break;
            }
            if counts.n() == pairs {
                break;
            }
        }
    }
    alarms
}

/// Section 4.5, a = .05, at the edge of each null: at most a, with three standard errors of a
/// binomial share on top (2,000 sets: 100 + 29).
#[test]
fn false_alarms_stay_below_the_level_under_continuous_looking() {
    let ln_level = ln(20.0);
    let harm = Harm::default();
    let at_zero = alarms(2000, 400_000, [0.0, 5e-4, 5e-4], ln_level, &|c| harm.ln_e(c));
    let absolute = NonInferiority::absolute(1e-3, 2e-3).unwrap();
    let at_margin = alarms(2000, 100_000, [0.0, 1.5e-3, 0.5e-3], ln_level, &|c| absolute.ln_e(c));
    let relative = NonInferiority::relative(0.1, 5e-3, 1e-3).unwrap();
    let at_ratio = alarms(2000, 60_000, [4.75e-3, 7.5e-4, 2.5e-4], ln_level, &|c| relative.ln_e(c));
    let demonstrated = RateTest::demonstrated(1e-3).unwrap();
    let at_rate = alarms(2000, 100_000, [1e-3, 0.0, 0.0], ln_level, &|c| {
        demonstrated.ln_e(c.n11, c.n()).unwrap()
    });
    let violated = RateTest::violated(1e-3).unwrap();
    let not_violated = alarms(2000, 100_000, [1e-3, 0.0, 0.0], ln_level, &|c| {
        violated.ln_e(c.n11, c.n()).unwrap()
    });
    for count in [at_zero, at_margin, at_ratio, at_rate, not_violated] {
        assert!(count <= 129, "{at_zero} {at_margin} {at_ratio} {at_rate} {not_violated} of 2000");
    }
    // A level that is never used would pass the above: each must alarm when its null is false.
    let neutral = alarms(200, 100_000, [0.0, 5e-4, 5e-4], ln_level, &|c| absolute.ln_e(c));
    assert!(neutral >= 190, "{neutral}");
    let harmful = alarms(200, 100_000, [0.0, 1.5e-3, 0.5e-3], ln_level, &|c| harm.ln_e(c));
    assert!(harmful >= 190, "{harmful}");
}

#[test]
fn forecasts_say_reached_cannot_or_how_many() {
    let test = NonInferiority::absolute(1e-3, 1e-3).unwrap();
    let after = |n10, n01, n| test.forecast(&PairedCounts::discordant(n10, n01, n), 0.05);
    assert_eq!(after(0, 0, 10_000), Forecast::Reached);
    assert_eq!(after(50, 10, 10_000), Forecast::CannotPass);
    let Forecast::Encounters(more) = after(0, 0, 2_000) else { panic!("{:?}", after(0, 0, 2_000)) };
    assert!((1_000..4_000).contains(&more), "{more}");
    let planned = NonInferiority::absolute(1e-4, 2e-4).unwrap().encounters_planned(0.05).unwrap();
    // Measured mean 1.6e5; the expected path crosses a little earlier or later than the mean.
    assert!((1.1e5..1.9e5).contains(&(planned as f64)), "{planned}");
}
