//! Two planners on the same encounters: exact tests, bounds and sample sizes at a fixed N.
//!
//! The same encounter id gives the same geometry, noise and target behaviour, so only the
//! encounters in which the planners differ say anything: n10, where the candidate breaks what the
//! baseline passed, and n01, where it fixes. D = (n10 - n01) / N estimates p_B - p_A.
//! These are claims only at an N that was declared before the run and reached without an early
//! stop; at any other time see the confidence sequence in `difference`.
//! Source: statistics specification, section 4.5; McNemar (1947); Tango (1998).

use serde::{Deserialize, Serialize};

use crate::binomial::{
    binomial_upper_tail, clopper_pearson_lower, clopper_pearson_upper, ln_binomial_pmf,
};
use crate::error::{StatsError, check_unit};
use crate::math::{bisect, exp, real};
use crate::special::normal_quantile;
use crate::{Estimate, Method};

/// Encounters by outcome: the first digit is the candidate B, the second the baseline A, and 1
/// means that the event (a collision, a broken rule) happened.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PairedCounts {
    /// Both have the event.
    pub n11: u64,
    /// The candidate breaks: event with B, none with A.
    pub n10: u64,
    /// The candidate fixes: none with B, event with A.
    pub n01: u64,
    /// Neither has it.
    pub n00: u64,
}

impl PairedCounts {
    /// Counts from the discordant encounters and the total, no event shared.
    #[must_use]
    pub fn discordant(n10: u64, n01: u64, n: u64) -> Self {
        Self { n11: 0, n10, n01, n00: n - n10 - n01 }
    }

    /// Adds one encounter.
    pub fn add(&mut self, candidate_event: bool, baseline_event: bool) {
        match (candidate_event, baseline_event) {
            (true, true) => self.n11 += 1,
            (true, false) => self.n10 += 1,
            (false, true) => self.n01 += 1,
            (false, false) => self.n00 += 1,
        }
    }

    /// Adds the encounters of another part.
    pub fn merge(&mut self, other: &Self) {
        self.n11 += other.n11;
        self.n10 += other.n10;
        self.n01 += other.n01;
        self.n00 += other.n00;
    }

    /// All encounters.
    #[must_use]
    pub fn n(&self) -> u64 {
        self.n11 + self.n10 + self.n01 + self.n00
    }

    /// (n10 - n01) / N; 0 when there is no encounter.
    #[must_use]
    pub fn difference(&self) -> f64 {
        if self.n() == 0 { 0.0 } else { (real(self.n10) - real(self.n01)) / real(self.n()) }
    }

    /// The same encounters with the planners' roles exchanged.
    #[must_use]
    pub fn swapped(&self) -> Self {
        Self { n10: self.n01, n01: self.n10, ..*self }
    }

    fn estimate(&self, lower: f64, upper: f64, method: Method) -> Estimate {
        let n = self.n();
        Estimate { value: self.difference(), lower, upper, n, n_effective: real(n), method }
    }
}

/// McNemar's exact one-sided p: P(Bin(n10 + n01, 1/2) >= n10), small when the candidate breaks
/// more than it fixes.
///
/// # Errors
/// Never for counts that a machine can hold.
pub fn mcnemar_exact(n10: u64, n01: u64) -> Result<f64, StatsError> {
    if n10 + n01 == 0 { Ok(1.0) } else { binomial_upper_tail(n10, n10 + n01, 0.5) }
}

/// McNemar's randomised p: P(X > n10) + u P(X = n10). Uniform under the null for a uniform `u`,
/// which the plain p is not, so that a Kolmogorov-Smirnov test may look at it.
///
/// # Errors
/// `u` outside (0, 1).
pub fn mcnemar_randomised(n10: u64, n01: u64, u: f64) -> Result<f64, StatsError> {
    check_unit("u", u)?;
    let n = n10 + n01;
    if n == 0 {
        return Ok(u);
    }
    let beyond = if n10 == n { 0.0 } else { binomial_upper_tail(n10 + 1, n, 0.5)? };
    Ok(beyond + u * exp(ln_binomial_pmf(n10, n, 0.5)?))
}

/// Exact two-sided bounds of D at confidence 1 - `alpha` and a declared N, each side at
/// `alpha`/2: U_CP(n10; alpha/4) - L_CP(n01; alpha/4) and its mirror (union bound).
///
/// # Errors
/// No encounter, or `alpha` outside (0, 1).
pub fn exact_difference(counts: &PairedCounts, alpha: f64) -> Result<Estimate, StatsError> {
    let upper = exact_difference_upper(counts, 0.5 * alpha)?;
    let lower = -exact_difference_upper(&counts.swapped(), 0.5 * alpha)?;
    Ok(counts.estimate(lower, upper, Method::ExactDifference))
}

/// Exact one-sided upper bound of D at confidence 1 - `alpha` and a declared N:
/// U_CP(n10; alpha/2) - L_CP(n01; alpha/2).
///
/// # Errors
/// No encounter, or `alpha` outside (0, 1).
pub fn exact_difference_upper(counts: &PairedCounts, alpha: f64) -> Result<f64, StatsError> {
    check_unit("alpha", alpha)?;
    let n = counts.n();
    Ok(clopper_pearson_upper(counts.n10, n, 0.5 * alpha)?
        - clopper_pearson_lower(counts.n01, n, 0.5 * alpha)?)
}

/// Tango's score interval of D at nominal confidence 1 - `alpha`. For display only: its one-sided
/// coverage falls to .939 and .915 of .95 at a few counts.
///
/// # Errors
/// No encounter, or `alpha` outside (0, 1).
pub fn tango(counts: &PairedCounts, alpha: f64) -> Result<Estimate, StatsError> {
    check_unit("alpha", alpha)?;
    if counts.n() == 0 {
        return Err(StatsError::TooFew { what: "Tango's interval", need: "one encounter" });
    }
    let z = -normal_quantile(0.5 * alpha)?;
    let upper = tango_upper(counts, z);
    let lower = -tango_upper(&counts.swapped(), z);
    Ok(counts.estimate(lower, upper, Method::Tango))
}

/// The difference at which Tango's statistic falls to -z.
fn tango_upper(counts: &PairedCounts, z: f64) -> f64 {
    bisect(counts.difference(), 1.0, |d| tango_statistic(counts, d) <= -z).1
}

/// T(D) of the score test, with the constrained maximum-likelihood estimate of p01.
fn tango_statistic(counts: &PairedCounts, difference: f64) -> f64 {
    let (n, b, c) = (real(counts.n()), real(counts.n10), real(counts.n01));
    let d = difference;
    let linear = -b - c + (2.0 * n - b + c) * d;
    let constant = -c * d * (1.0 - d);
    let root = (linear * linear - 8.0 * n * constant).max(0.0).sqrt();
    let p01 = (root - linear) / (4.0 * n);
    let variance = n * (2.0 * p01 + d * (1.0 - d));
    let shift = b - c - n * d;
    if variance > 0.0 {
        shift / variance.sqrt()
    } else if shift < 0.0 {
        f64::NEG_INFINITY
    } else {
        0.0
    }
}

/// Pairs needed to detect p10 against p01 with a one-sided level `alpha` and the given power:
/// N = (z_a sqrt(p10 + p01) + z_b sqrt(p10 + p01 - D^2))^2 / D^2.
///
/// # Errors
/// Levels outside (0, 1), rates outside [0, 1], or p10 = p01 (no difference to detect).
pub fn pairs_needed(p10: f64, p01: f64, alpha: f64, power: f64) -> Result<f64, StatsError> {
    let (z_a, z_b) = level_and_power(alpha, power)?;
    let (difference, discordant) = (p10 - p01, p10 + p01);
    check_unit("p10 + p01", discordant)?;
    check_difference(difference)?;
    let root = z_a * discordant.sqrt() + z_b * (discordant - difference * difference).sqrt();
    Ok(root * root / (difference * difference))
}

/// Encounters needed in each of two independent arms to detect p_b against p_a with a one-sided
/// level `alpha` and the given power (normal approximation, unpooled variances).
///
/// # Errors
/// Levels or rates outside (0, 1), or equal rates.
pub fn unpaired_needed(p_a: f64, p_b: f64, alpha: f64, power: f64) -> Result<f64, StatsError> {
    let (z_a, z_b) = level_and_power(alpha, power)?;
    check_unit("p_a", p_a)?;
    check_unit("p_b", p_b)?;
    check_difference(p_b - p_a)?;
    let variance = p_a * (1.0 - p_a) + p_b * (1.0 - p_b);
    let z = z_a + z_b;
    Ok(z * z * variance / ((p_b - p_a) * (p_b - p_a)))
}

fn level_and_power(alpha: f64, power: f64) -> Result<(f64, f64), StatsError> {
    Ok((-normal_quantile(alpha)?, normal_quantile(power)?))
}

fn check_difference(difference: f64) -> Result<(), StatsError> {
    if difference.abs() > 0.0 {
        Ok(())
    } else {
        Err(StatsError::TooFew { what: "a sample size", need: "two rates that differ" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smallest_significant_splits() {
        assert!((mcnemar_exact(5, 0).unwrap() - 0.03125).abs() < 1e-15);
        assert!(mcnemar_exact(4, 0).unwrap() > 0.05);
        assert!((mcnemar_exact(7, 0).unwrap() - 0.0078125).abs() < 1e-15);
        assert!(mcnemar_exact(6, 0).unwrap() > 0.01);
        assert!((mcnemar_exact(0, 9).unwrap() - 1.0).abs() < 1e-15);
        assert!(mcnemar_exact(10, 3000).unwrap() > 0.999_999);
    }

    #[test]
    fn randomised_p_spans_the_step_of_the_plain_one() {
        let plain = mcnemar_exact(3, 2).unwrap();
        assert!((mcnemar_randomised(3, 2, 1.0 - 1e-12).unwrap() - plain).abs() < 1e-10);
        let below = mcnemar_exact(4, 1).unwrap();
        assert!((mcnemar_randomised(3, 2, 1e-12).unwrap() - below).abs() < 1e-10);
    }

    /// Section 4.5: from 1.0e-3 to 1.1e-3 at level .05 and power .9.
    #[test]
    fn pairing_saves_ten_to_twenty_times() {
        let unpaired = unpaired_needed(1.0e-3, 1.1e-3, 0.05, 0.9).unwrap();
        assert!((unpaired / 1.80e6 - 1.0).abs() < 0.005, "{unpaired}");
        let both = pairs_needed(1.5e-4, 0.5e-4, 0.05, 0.9).unwrap();
        assert!((both / 1.7e5 - 1.0).abs() < 0.02, "{both}");
        let breaks = pairs_needed(1e-4, 0.0, 0.05, 0.9).unwrap();
        assert!((breaks / 8.6e4 - 1.0).abs() < 0.005, "{breaks}");
        assert!(pairs_needed(1e-4, 1e-4, 0.05, 0.9).is_err());
    }

    /// Limits by an independent road: the constrained maximum of the multinomial likelihood found
    /// numerically with 30 digits, without the closed form of the quadratic.
    #[test]
    fn tango_limits_are_those_of_the_maximised_likelihood() {
        for (b, c, n, lower, upper) in [
            (7, 2, 2000, -5.504_386_226_382_32e-4, 6.323_744_365_274_182e-3),
            (12, 9, 300, -0.021_521_720_082_289_91, 0.042_693_337_738_755_44),
        ] {
            let counts = PairedCounts::discordant(b, c, n);
            let interval = tango(&counts, 0.05).unwrap();
            assert!((interval.lower - lower).abs() < 1e-12, "{interval:?}");
            assert!((interval.upper - upper).abs() < 1e-12, "{interval:?}");
            let mirrored = tango(&counts.swapped(), 0.05).unwrap();
            assert!((mirrored.upper + interval.lower).abs() < 1e-12);
        }
        let none = tango(&PairedCounts::discordant(0, 0, 100), 0.05).unwrap();
        assert!(none.lower < 0.0 && none.upper > 0.0 && none.upper < 0.1, "{none:?}");
    }

    #[test]
    fn exact_difference_is_wider_than_tango() {
        let counts = PairedCounts::discordant(7, 2, 20_000);
        let exact = exact_difference(&counts, 0.05).unwrap();
        let score = tango(&counts, 0.05).unwrap();
        assert!(exact.lower < score.lower && exact.upper > score.upper);
        assert!(exact.method.is_claim_bearing() && !score.method.is_claim_bearing());
    }
}
