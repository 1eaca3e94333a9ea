//! Coverage by simulation: data sets drawn at a known truth, and how often each interval misses
//! it. Shared by the quick test and by the full study in `examples/coverage.rs`.

use stats::{
    BetaBinomial, DifferenceSequence, Estimate, MeanBets, Method, PairedCounts, RiskCounts,
    RiskEvent, RiskPart, RiskSums, StatsError, WeightedCount, bca_mean, betting_interval,
    betting_ratio, clopper_pearson, exact_difference, exact_ratio, fay_feuer, jeffreys,
    last_particle, tango, wilson,
};

use crate::generator::Generator;

/// Two-sided level of every interval; each side has half of it.
pub(crate) const ALPHA: f64 = 0.05;

/// How often an interval missed.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Cover {
    /// Data sets with an interval.
    pub(crate) sets: u64,
    /// Data sets in which the method declined to answer.
    pub(crate) declined: u64,
    /// The lower limit was above the truth.
    pub(crate) missed_low: u64,
    /// The upper limit was below the truth.
    pub(crate) missed_high: u64,
}

impl Cover {
    fn add(&mut self, interval: Result<Estimate, StatsError>, truth: f64) {
        match interval {
            Ok(interval) => {
                self.sets += 1;
                self.missed_low += u64::from(interval.lower > truth);
                self.missed_high += u64::from(interval.upper < truth);
            }
            Err(_) => self.declined += 1,
        }
    }
}

/// A method and what is drawn for it.
#[derive(Debug)]
pub(crate) struct Studied {
    /// As it is printed.
    pub(crate) name: &'static str,
    /// The method that its estimates carry.
    pub(crate) method: Method,
    /// Share of the asked data sets that are run (the bootstrap is slow).
    pub(crate) share: u64,
    run: fn(&mut Generator, f64, &mut Cover),
}

impl Studied {
    /// Whether the method is claim-bearing.
    pub(crate) fn is_claim(&self) -> bool {
        self.method.is_claim_bearing()
    }
}

/// Everything that gives an interval.
pub(crate) const METHODS: [Studied; 18] = [
    studied("Clopper-Pearson", Method::ClopperPearson, 1, |draw, rate, cover| {
        let (k, n) = counted(draw, rate);
        cover.add(clopper_pearson(k, n, ALPHA), rate);
    }),
    studied("exact difference", Method::ExactDifference, 1, |draw, rate, cover| {
        cover.add(exact_difference(&paired(draw, rate), ALPHA), 0.5 * rate);
    }),
    studied("exact ratio", Method::ExactRatio, 1, |draw, rate, cover| {
        cover.add(exact_ratio(&risk(draw, rate), ALPHA), RISK_RATIO);
    }),
    studied("betting ratio", Method::Betting, 1, |draw, rate, cover| {
        let counts = risk(draw, rate);
        let events = RiskEvent::from_counts(&counts);
        cover.add(betting_ratio(&events, 1.0, counts.n(), ALPHA), RISK_RATIO);
    }),
    studied("betting ratio, weighted", Method::Betting, 1, |draw, rate, cover| {
        let events = weighted_risk(draw, rate);
        let n = encounters(100.0, rate);
        cover.add(betting_ratio(&events, 2.0, n, ALPHA), RISK_RATIO);
    }),
    studied("betting mean, rare", Method::Betting, 1, |draw, rate, cover| {
        let n = encounters(20.0, rate);
        let values: Vec<f64> = (0..draw.binomial(n, rate)).map(|_| rare_value(draw)).collect();
        let bets = MeanBets::planned(rate, 20.0).expect("a rate and events are planned");
        cover.add(bets.interval(&values, n, ALPHA), RARE_MEAN * rate);
    }),
    studied("betting mean, hedged", Method::Betting, 1, |draw, rate, cover| {
        let values: Vec<f64> = (0..100).map(|_| 2.0 * rate * draw.uniform()).collect();
        cover.add(betting_interval(&values, ALPHA), rate);
    }),
    studied("sequence of D, all N", Method::ConfidenceSequence, 1, difference_sequence),
    studied("sequence of p, all n", Method::ConfidenceSequence, 1, rate_sequence),
    studied("Wilson", Method::Wilson, 1, |draw, rate, cover| {
        let (k, n) = counted(draw, rate);
        cover.add(wilson(k, n, ALPHA), rate);
    }),
    studied("Jeffreys", Method::Jeffreys, 1, |draw, rate, cover| {
        let (k, n) = counted(draw, rate);
        cover.add(jeffreys(k, n, ALPHA), rate);
    }),
    studied("Tango", Method::Tango, 1, |draw, rate, cover| {
        cover.add(tango(&paired(draw, rate), ALPHA), 0.5 * rate);
    }),
    studied("ratio, delta", Method::Delta, 1, |draw, rate, cover| {
        let sums = RiskSums::from_counts(&risk(draw, rate));
        cover.add(sums.delta(RiskPart::Total, ALPHA), RISK_RATIO);
    }),
    studied("ratio, log-delta", Method::LogDelta, 1, |draw, rate, cover| {
        let sums = RiskSums::from_counts(&risk(draw, rate));
        cover.add(sums.log_delta(RiskPart::Total, ALPHA), RISK_RATIO);
    }),
    studied("induced, log-delta", Method::LogDelta, 1, |draw, rate, cover| {
        let sums = RiskSums::from_counts(&risk(draw, rate));
        cover.add(sums.log_delta(RiskPart::Induced, ALPHA), 0.05);
    }),
    studied("Fay-Feuer", Method::FayFeuer, 1, |draw, rate, cover| {
        let n = encounters(5.0, rate);
        let weights = [0.9 / n as f64, 0.1 / n as f64];
        let events = weights.map(|weight| WeightedCount { weight, count: draw.binomial(n, rate) });
        cover.add(fay_feuer(&events, weights[0], 2 * n, ALPHA), rate);
    }),
    studied("last particle, ideal", Method::LastParticle, 1, |draw, rate, cover| {
        // Killings are a Poisson count of mean -100 ln p: exponential steps until it is passed.
        let (mut killings, mut at) = (0, -libm::log(draw.uniform()));
        while at < -100.0 * libm::log(rate) {
            killings += 1;
            at -= libm::log(draw.uniform());
        }
        cover.add(last_particle(100, killings, ALPHA), rate);
    }),
    studied("BCa, skewed, n = 40", Method::Bca, 20, |draw, rate, cover| {
        let sample: Vec<f64> = (0..40).map(|_| -rate * libm::log(draw.uniform())).collect();
        cover.add(bca_mean(&sample, ALPHA, 2000, &mut || draw.uniform()), rate);
    }),
];

/// Runs every method over `sets` data sets at `rate`, in the order of [`METHODS`].
pub(crate) fn study(sets: u64, rate: f64) -> Vec<Cover> {
    let run = |(seed, studied): (u64, &Studied)| {
        let mut draw = Generator::new(seed.wrapping_mul(0x5851_f42d_4c95_7f2d));
        let mut cover = Cover::default();
        for _ in 0..sets.div_ceil(studied.share) {
            (studied.run)(&mut draw, rate, &mut cover);
        }
        cover
    };
    (1..).zip(&METHODS).map(run).collect()
}

const fn studied(
    name: &'static str,
    method: Method,
    share: u64,
    run: fn(&mut Generator, f64, &mut Cover),
) -> Studied {
    Studied { name, method, share, run }
}

/// Encounters that give `expected` events at `rate`.
fn encounters(expected: f64, rate: f64) -> u64 {
    (expected / rate).ceil() as u64
}

fn counted(draw: &mut Generator, rate: f64) -> (u64, u64) {
    let n = encounters(5.0, rate);
    (draw.binomial(n, rate), n)
}

/// p10 = rate, p01 = rate / 2, about ten breaks.
fn paired(draw: &mut Generator, rate: f64) -> PairedCounts {
    let n = encounters(10.0, rate);
    let discordant = draw.binomial(n, 1.5 * rate);
    let n10 = draw.binomial(discordant, 2.0 / 3.0);
    PairedCounts::discordant(n10, discordant - n10, n)
}

/// P(y given z) = .1 and P(induced) = .05 P(z).
const RISK_RATIO: f64 = 0.15;

/// P(z) = rate, about a hundred nominal events and fifteen with the planner.
fn risk(draw: &mut Generator, rate: f64) -> RiskCounts {
    let n = encounters(100.0, rate);
    let events = draw.binomial(n, 1.05 * rate);
    let induced = draw.binomial(events, 0.05 / 1.05);
    let unresolved = draw.binomial(events - induced, 0.1);
    let removed = events - induced - unresolved;
    RiskCounts { unresolved, induced, removed, neither: n - events }
}

/// As [`risk`], half of the encounters with weight 2 and half with 2/3, whatever the outcome.
fn weighted_risk(draw: &mut Generator, rate: f64) -> Vec<RiskEvent> {
    let mut events = Vec::new();
    for event in RiskEvent::from_counts(&risk(draw, rate)) {
        let heavy = draw.binomial(event.count, 0.5);
        events.push(RiskEvent { weight: 2.0, count: heavy, ..event });
        events.push(RiskEvent { weight: 2.0 / 3.0, count: event.count - heavy, ..event });
    }
    events
}

/// Values of .2, .5 and 1 with equal probability.
const RARE_MEAN: f64 = 1.7 / 3.0;

fn rare_value(draw: &mut Generator) -> f64 {
    match draw.bits() % 3 {
        0 => 0.2,
        1 => 0.5,
        _ => 1.0,
    }
}

/// Missed if the truth lies outside at any N up to forty expected breaks: looked at after every
/// discordant pair and just before it, between which the wealth moves one way.
fn difference_sequence(draw: &mut Generator, rate: f64, cover: &mut Cover) {
    let sequence = DifferenceSequence::planned(0.5 * rate, rate).expect("rates are rates");
    let truth = 0.5 * rate;
    let last = encounters(40.0, rate);
    let ln_level = libm::log(2.0 / ALPHA);
    let mut counts = PairedCounts::default();
    let (mut low, mut high) = (false, false);
    let mut look = |counts: &PairedCounts| {
        high |= sequence.ln_e(counts, truth) >= ln_level;
        low |= sequence.ln_e(&counts.swapped(), -truth) >= ln_level;
    };
    while counts.n() < last {
        let quiet = (draw.gap(1.5 * rate) - 1).min(last - counts.n());
        counts.n00 += quiet;
        look(&counts);
        if counts.n() < last {
            let breaks = draw.uniform() < 2.0 / 3.0;
            counts.add(breaks, !breaks);
            look(&counts);
        }
    }
    cover.sets += 1;
    cover.missed_low += u64::from(low);
    cover.missed_high += u64::from(high);
}

/// The same for the rate of one arm; the mixture's set is two-sided, split by where the estimate
/// stands.
fn rate_sequence(draw: &mut Generator, rate: f64, cover: &mut Cover) {
    let last = encounters(40.0, rate);
    let mixture = BetaBinomial::tuned(last).expect("there are encounters");
    let ln_level = -libm::log(ALPHA);
    let (mut k, mut n) = (0, 0);
    let (mut low, mut high) = (false, false);
    let mut look = |k: u64, n: u64| {
        if n > 0 && mixture.ln_wealth(k, n, rate).expect("k of n") >= ln_level {
            let above = k as f64 > n as f64 * rate;
            low |= above;
            high |= !above;
        }
    };
    while n < last {
        n += (draw.gap(rate) - 1).min(last - n);
        look(k, n);
        if n < last {
            (k, n) = (k + 1, n + 1);
            look(k, n);
        }
    }
    cover.sets += 1;
    cover.missed_low += u64::from(low);
    cover.missed_high += u64::from(high && !low);
}
