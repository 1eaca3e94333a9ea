//! Sequential statistics of one arm: intervals and tests that may be read at any time.
//!
//! The beta-binomial mixture's confidence sequence for a rate, Wald's sequential test of two
//! rates, and the hedged betting interval of a mean. Source: statistics specification, section
//! 4.4; Robbins (1970); Wald (1945); Waudby-Smith and Ramdas (2021).

use serde::{Deserialize, Serialize};

use crate::error::{StatsError, check_counts, check_open, check_unit};
use crate::math::{bisect, exp, expm1, ln, log1p, real};
use crate::special::ln_beta;
use crate::weighted::check_weights;
use crate::{Estimate, Method};

/// Robbins' mixture over Beta(s, t): the set of p with
/// ln B(k + s, n - k + t) - ln B(s, t) - k ln p - (n - k) ln(1 - p) < ln(1/a).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BetaBinomial {
    s: f64,
    t: f64,
}

impl BetaBinomial {
    /// The mixture Beta(`s`, `t`).
    ///
    /// # Errors
    /// A shape that is not positive and finite.
    pub fn new(s: f64, t: f64) -> Result<Self, StatsError> {
        check_open("s", s, 0.0, f64::INFINITY)?;
        check_open("t", t, 0.0, f64::INFINITY)?;
        Ok(Self { s, t })
    }

    /// The mixture that is sharpest about `n_target` encounters with few events: Beta(.5, .5 n).
    ///
    /// # Errors
    /// `n_target` of 0.
    pub fn tuned(n_target: u64) -> Result<Self, StatsError> {
        Self::new(0.5, 0.5 * real(n_target))
    }

    /// The interval at confidence 1 - `alpha`, simultaneously at all n.
    ///
    /// # Errors
    /// No trial, more events than trials, or `alpha` outside (0, 1).
    pub fn interval(&self, k: u64, n: u64, alpha: f64) -> Result<Estimate, StatsError> {
        check_unit("alpha", alpha)?;
        check_counts(k, n)?;
        let ln_level = -ln(alpha);
        let outside = |ln_p: f64| self.ln_wealth_at(k, n, ln_p, -expm1(ln_p)) >= ln_level;
        let peak = if k == 0 { -700.0 } else { ln(real(k) / real(n)) };
        let lower = if k == 0 { 0.0 } else { exp(bisect(-700.0, peak, |ln_p| !outside(ln_p)).0) };
        let upper = if k == n { 1.0 } else { exp(bisect(peak, 0.0, outside).1) };
        let value = real(k) / real(n);
        let method = Method::ConfidenceSequence;
        Ok(Estimate { value, lower, upper, n, n_effective: real(n), method })
    }

    /// ln of the wealth against the rate `p`: at least ln(1/a) puts `p` outside.
    ///
    /// # Errors
    /// More events than trials, no trial, or `p` outside (0, 1).
    pub fn ln_wealth(&self, k: u64, n: u64, p: f64) -> Result<f64, StatsError> {
        check_counts(k, n)?;
        check_unit("p", p)?;
        Ok(self.ln_wealth_at(k, n, ln(p), 1.0 - p))
    }

    fn ln_wealth_at(&self, k: u64, n: u64, ln_p: f64, q: f64) -> f64 {
        let (events, rest) = (real(k), real(n - k));
        let ln_q = if q > 0.5 { log1p(-exp(ln_p)) } else { ln(q) };
        let of_rest = if n == k { 0.0 } else { rest * ln_q };
        let of_events = if k == 0 { 0.0 } else { events * ln_p };
        ln_beta(events + self.s, rest + self.t) - ln_beta(self.s, self.t) - of_events - of_rest
    }
}

/// What Wald's test says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SprtDecision {
    /// The rate is the good one.
    Good,
    /// The rate is the bad one.
    Bad,
    /// Not yet.
    Continue,
}

/// Wald's sequential probability ratio test of a good rate p0 against a bad one p1 > p0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sprt {
    good: f64,
    bad: f64,
    ln_event: f64,
    ln_none: f64,
    ln_bad: f64,
    ln_good: f64,
}

impl Sprt {
    /// Wald's thresholds ln((1 - b)/a) and ln(b/(1 - a)); they bound only a + b.
    ///
    /// # Errors
    /// Rates not 0 < p0 < p1 < 1, or levels outside (0, 1).
    pub fn wald(good: f64, bad: f64, alpha: f64, beta: f64) -> Result<Self, StatsError> {
        check_unit("alpha", alpha)?;
        check_unit("beta", beta)?;
        Self::new(good, bad, ln((1.0 - beta) / alpha), ln(beta / (1.0 - alpha)))
    }

    /// The thresholds ln(1/a) and ln(b), for a claim: each error is bounded by its own level.
    ///
    /// # Errors
    /// As [`Sprt::wald`].
    pub fn claim(good: f64, bad: f64, alpha: f64, beta: f64) -> Result<Self, StatsError> {
        check_unit("alpha", alpha)?;
        check_unit("beta", beta)?;
        Self::new(good, bad, -ln(alpha), ln(beta))
    }

    fn new(good: f64, bad: f64, ln_bad: f64, ln_good: f64) -> Result<Self, StatsError> {
        check_unit("bad rate", bad)?;
        check_open("good rate", good, 0.0, bad)?;
        let ln_event = ln(bad / good);
        let ln_none = log1p(-bad) - log1p(-good);
        Ok(Self { good, bad, ln_event, ln_none, ln_bad, ln_good })
    }

    /// The decision after `k` events in `n` encounters.
    ///
    /// # Errors
    /// More events than encounters, or none at all.
    pub fn decide(&self, k: u64, n: u64) -> Result<SprtDecision, StatsError> {
        check_counts(k, n)?;
        let ln_ratio = real(k) * self.ln_event + real(n - k) * self.ln_none;
        Ok(if ln_ratio >= self.ln_bad {
            SprtDecision::Bad
        } else if ln_ratio <= self.ln_good {
            SprtDecision::Good
        } else {
            SprtDecision::Continue
        })
    }

    /// Wald's approximation to the expected number of encounters when the rate is the good one
    /// and when it is the bad one.
    #[must_use]
    pub fn expected_encounters(&self) -> (f64, f64) {
        // The walk ends on one of two values, and its likelihood ratio has mean 1 under good.
        let (up, down) = (exp(self.ln_bad), exp(self.ln_good));
        let bad_if_good = (1.0 - down) / (up - down);
        let bad_if_bad = bad_if_good * up;
        let end = |p_bad: f64| p_bad * self.ln_bad + (1.0 - p_bad) * self.ln_good;
        let drift = |rate: f64| rate * self.ln_event + (1.0 - rate) * self.ln_none;
        (end(bad_if_good) / drift(self.good), end(bad_if_bad) / drift(self.bad))
    }
}

/// The hedged betting interval at confidence 1 - `alpha` for the mean of values in [0, 1], in the
/// order in which they came. Predictable stakes l_i, capped at c/m and c/(1 - m) with c = 1/2;
/// the set of m at which neither bettor's half of the capital has reached 1/a.
///
/// # Errors
/// No value, a value outside [0, 1], or `alpha` outside (0, 1).
pub fn betting_interval(values: &[f64], alpha: f64) -> Result<Estimate, StatsError> {
    check_unit("alpha", alpha)?;
    check_weights(values.iter().copied(), "value", 1.0)?;
    if values.is_empty() {
        return Err(StatsError::TooFew { what: "a betting interval", need: "one value" });
    }
    const CAP: f64 = 0.5;
    let stakes = predictable_stakes(values, alpha);
    let ln_level = ln(2.0 / alpha);
    let above = |mean: f64| -> f64 {
        let bets = values.iter().zip(&stakes);
        bets.map(|(x, stake)| log1p(stake.min(CAP / mean) * (x - mean))).sum()
    };
    let below = |mean: f64| -> f64 {
        let bets = values.iter().zip(&stakes);
        bets.map(|(x, stake)| log1p(-stake.min(CAP / (1.0 - mean)) * (x - mean))).sum()
    };
    let low = f64::MIN_POSITIVE;
    let lower =
        if above(low) < ln_level { 0.0 } else { bisect(low, 1.0, |m| above(m) < ln_level).0 };
    let upper = bisect(0.0, 1.0, |mean| below(mean) >= ln_level).1;
    let n = values.len() as u64;
    let value = values.iter().sum::<f64>() / real(n);
    Ok(Estimate { value, lower, upper, n, n_effective: real(n), method: Method::Betting })
}

/// l_i = sqrt(2 ln(2/a) / (v_(i-1) i ln(i + 1))), v the regularised variance of what came before.
fn predictable_stakes(values: &[f64], alpha: f64) -> Vec<f64> {
    let budget = 2.0 * ln(2.0 / alpha);
    let (mut sum, mut squares) = (0.5, 0.25);
    let mut stakes = Vec::with_capacity(values.len());
    for (i, value) in (1_u64..).zip(values) {
        let i = real(i);
        let variance = squares / i;
        stakes.push((budget / (variance * i * log1p(i))).sqrt());
        sum += value;
        let off = value - sum / (i + 1.0);
        squares += off * off;
    }
    stakes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Section 4.4: the price of reading at any time, U n at k = 0, n = 1e6, a = .05.
    #[test]
    fn price_of_a_confidence_sequence() {
        let price =
            |mixture: BetaBinomial| mixture.interval(0, 1_000_000, 0.05).unwrap().upper * 1e6;
        assert!((price(BetaBinomial::new(1.0, 1.0).unwrap()) - 16.8).abs() < 0.05);
        assert!((price(BetaBinomial::new(0.5, 0.5).unwrap()) - 10.5).abs() < 0.05);
        assert!((price(BetaBinomial::tuned(1_000_000).unwrap()) - 3.55).abs() < 0.005);
    }

    #[test]
    fn sequence_is_wider_than_the_fixed_interval() {
        let mixture = BetaBinomial::tuned(100_000).unwrap();
        for (k, n) in [(3, 100_000), (1000, 100_000), (100_000, 1_000_000_000)] {
            let sequence = mixture.interval(k, n, 0.05).unwrap();
            let fixed = crate::clopper_pearson(k, n, 0.05).unwrap();
            assert!(sequence.lower < fixed.lower && sequence.upper > fixed.upper);
            assert!(mixture.ln_wealth(k, n, sequence.upper * 1.001).unwrap() > -ln(0.05));
            assert!(mixture.ln_wealth(k, n, sequence.upper * 0.999).unwrap() < -ln(0.05));
        }
        let all = mixture.interval(5, 5, 0.05).unwrap();
        assert!(all.upper >= 1.0 && all.lower > 0.0);
    }

    /// Section 4.4: 1e-4 against 2e-4, a = b = .05.
    #[test]
    fn sprt_has_the_known_sizes() {
        let test = Sprt::wald(1e-4, 2e-4, 0.05, 0.05).unwrap();
        assert_eq!(test.decide(0, 29_439).unwrap(), SprtDecision::Continue);
        assert_eq!(test.decide(0, 29_440).unwrap(), SprtDecision::Good);
        let (good, bad) = test.expected_encounters();
        assert!((good / 8.6e4 - 1.0).abs() < 0.01 && (bad / 6.9e4 - 1.0).abs() < 0.01);
        assert_eq!(test.decide(10, 10).unwrap(), SprtDecision::Bad);
        let claim = Sprt::claim(1e-4, 2e-4, 0.05, 0.05).unwrap();
        assert_eq!(claim.decide(0, 29_440).unwrap(), SprtDecision::Continue);
        assert_eq!(claim.decide(0, 29_960).unwrap(), SprtDecision::Good);
        assert!(Sprt::wald(2e-4, 1e-4, 0.05, 0.05).is_err());
    }

    /// One value of 1 at a = 1/2: the stake is capped at 1/(2m), so 1/2 + 1/(2m) = 2/a = 4 at
    /// m = 1/7; and the mirror image.
    #[test]
    fn betting_interval_of_one_value_is_worked_by_hand() {
        let of_one = betting_interval(&[1.0], 0.5).unwrap();
        assert!((of_one.lower - 1.0 / 7.0).abs() < 1e-12 && of_one.upper >= 1.0, "{of_one:?}");
        let of_none = betting_interval(&[0.0], 0.5).unwrap();
        assert!((of_none.upper - 6.0 / 7.0).abs() < 1e-12 && of_none.lower <= 0.0, "{of_none:?}");
    }

    #[test]
    fn betting_interval_encloses_and_tightens() {
        let values =
            |n: u32| -> Vec<f64> { (0..n).map(|i| f64::from(i * 37 % 101) / 100.0).collect() };
        let few = betting_interval(&values(101), 0.05).unwrap();
        let many = betting_interval(&values(5050), 0.05).unwrap();
        for interval in [few, many] {
            assert!(interval.lower < 0.5 && 0.5 < interval.upper, "{interval:?}");
        }
        assert!(many.upper - many.lower < 0.05 && few.upper - few.lower < 0.4);
        assert!(betting_interval(&[], 0.05).is_err());
        assert!(betting_interval(&[1.1], 0.05).is_err());
    }
}
