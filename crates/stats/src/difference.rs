//! The confidence sequence of a paired difference D, and the weighted form of its test.
//!
//! The sequence may be read at any stopping time, which the fixed-n intervals of `paired` may
//! not. U is the smallest margin m that the non-inferiority e-process refutes at 2/a, with the
//! fractions c_j = l_j (1 - d) of the largest stake held fixed while m moves, so that E grows with
//! m and bisection finds it; L is the mirror image. Source: statistics specification, section 4.5.

use crate::eprocess::Stakes;
use crate::error::{StatsError, check_open, check_unit};
use crate::math::{bisect, ln, log_sum_exp, log1p, real};
use crate::{Estimate, Method, PairedCounts};

/// Fractions of the largest stake, fixed before the run, from which both bounds are made.
#[derive(Debug, Clone, PartialEq)]
pub struct DifferenceSequence {
    fractions: Stakes,
}

impl DifferenceSequence {
    /// A sequence that is sharpest near the margin and the discordance that were planned.
    ///
    /// # Errors
    /// `margin` or `discordance_plan` outside (0, 1).
    pub fn planned(margin: f64, discordance_plan: f64) -> Result<Self, StatsError> {
        check_unit("margin", margin)?;
        check_unit("discordance_plan", discordance_plan)?;
        let mut fractions = Stakes::declared(1.0 / (1.0 - margin), margin / discordance_plan);
        for stake in &mut fractions.stakes {
            *stake *= 1.0 - margin;
        }
        Ok(Self { fractions })
    }

    /// The interval at confidence 1 - `alpha`, simultaneously at all N.
    ///
    /// # Errors
    /// `alpha` outside (0, 1).
    pub fn interval(&self, counts: &PairedCounts, alpha: f64) -> Result<Estimate, StatsError> {
        Ok(Estimate {
            value: counts.difference(),
            lower: self.lower(counts, alpha)?,
            upper: self.upper(counts, alpha)?,
            n: counts.n(),
            n_effective: real(counts.n()),
            method: Method::ConfidenceSequence,
        })
    }

    /// The upper end of [`DifferenceSequence::interval`]; 1 while nothing is refuted.
    ///
    /// # Errors
    /// `alpha` outside (0, 1).
    pub fn upper(&self, counts: &PairedCounts, alpha: f64) -> Result<f64, StatsError> {
        check_unit("alpha", alpha)?;
        let ln_level = ln(2.0 / alpha);
        Ok(bisect(-1.0, 1.0, |margin| self.ln_e(counts, margin) >= ln_level).1)
    }

    /// The lower end of [`DifferenceSequence::interval`]; -1 while nothing is refuted.
    ///
    /// # Errors
    /// `alpha` outside (0, 1).
    pub fn lower(&self, counts: &PairedCounts, alpha: f64) -> Result<f64, StatsError> {
        Ok(-self.upper(&counts.swapped(), alpha)?)
    }

    /// ln E against D >= `margin`, for a margin inside (-1, 1); with the roles exchanged and
    /// -`margin`, against D <= `margin`. It grows with the margin.
    #[must_use]
    pub fn ln_e(&self, counts: &PairedCounts, margin: f64) -> f64 {
        let still = real(counts.n11 + counts.n00);
        let (breaks, fixes) = (real(counts.n10), real(counts.n01));
        self.fractions.ln_mixture(|fraction| {
            let stake = fraction / (1.0 - margin);
            still * log1p(stake * margin)
                + breaks * log1p(-fraction)
                + fixes * log1p(stake * (1.0 + margin))
        })
    }
}

/// (b) for weighted encounters: X_i = w_i (y_B - y_A) / w_max, tested against margin d / w_max,
/// the product running over the encounters. Fed in id order; the order of the sum is the digest's.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightedNonInferiority {
    stakes: Stakes,
    ln_wealth: Vec<f64>,
    margin_scaled: f64,
    weight_max: f64,
    fed: usize,
}

impl WeightedNonInferiority {
    /// H0: E[w (y_B - y_A)] >= `margin`, with weights in [0, `weight_max`] known before the run.
    /// `discordance_plan` is the planned E[w |y_B - y_A|].
    ///
    /// # Errors
    /// `weight_max` not positive, or `margin` or the plan outside (0, `weight_max`).
    pub fn new(margin: f64, weight_max: f64, discordance_plan: f64) -> Result<Self, StatsError> {
        check_open("weight_max", weight_max, 0.0, f64::INFINITY)?;
        check_open("margin", margin, 0.0, weight_max)?;
        check_open("discordance_plan", discordance_plan, 0.0, weight_max)?;
        let margin_scaled = margin / weight_max;
        let stakes = Stakes::declared(1.0 / (1.0 - margin_scaled), margin / discordance_plan);
        let ln_wealth = vec![0.0; stakes.stakes.len()];
        Ok(Self { stakes, ln_wealth, margin_scaled, weight_max, fed: 0 })
    }

    /// Bets on one more encounter.
    ///
    /// # Errors
    /// A weight outside [0, `weight_max`].
    pub fn add(
        &mut self,
        weight: f64,
        candidate_event: bool,
        baseline_event: bool,
    ) -> Result<(), StatsError> {
        if !(0.0..=self.weight_max).contains(&weight) {
            return Err(StatsError::Sample {
                index: self.fed,
                name: "weight",
                value: weight,
                low: 0.0,
                high: self.weight_max,
            });
        }
        self.fed += 1;
        let sign = f64::from(i8::from(candidate_event) - i8::from(baseline_event));
        let worse = weight / self.weight_max * sign;
        for (ln_wealth, stake) in self.ln_wealth.iter_mut().zip(&self.stakes.stakes) {
            *ln_wealth += log1p(stake * (self.margin_scaled - worse));
        }
        Ok(())
    }

    /// ln E.
    #[must_use]
    pub fn ln_e(&self) -> f64 {
        let nodes = self.ln_wealth.iter().zip(&self.stakes.ln_weights);
        log_sum_exp(nodes.map(|(ln_wealth, ln_weight)| ln_wealth + ln_weight))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NonInferiority;

    #[test]
    fn weighted_form_with_weight_one_is_the_unweighted_one() {
        let mut weighted = WeightedNonInferiority::new(0.01, 1.0, 0.02).unwrap();
        let mut counts = PairedCounts::default();
        for i in 0..3000_u32 {
            let (candidate, baseline) = (i % 211 == 0, i % 97 == 0);
            counts.add(candidate, baseline);
            weighted.add(1.0, candidate, baseline).unwrap();
        }
        let unweighted = NonInferiority::absolute(0.01, 0.02).unwrap();
        assert!((weighted.ln_e() - unweighted.ln_e(&counts)).abs() < 1e-9);
        assert!(weighted.add(1.5, true, false).is_err());
        assert!(weighted.add(f64::NAN, true, false).is_err());
    }

    /// The sequence refutes a margin exactly when the e-process for that margin does.
    #[test]
    fn upper_end_at_the_design_margin_is_the_test() {
        let (margin, plan) = (1e-3, 2e-3);
        let sequence = DifferenceSequence::planned(margin, plan).unwrap();
        let test = NonInferiority::absolute(margin, plan).unwrap();
        for n in [1_000, 4_000, 6_000, 8_000, 20_000] {
            let counts = PairedCounts::discordant(2, 3, n);
            assert!((sequence.ln_e(&counts, margin) - test.ln_e(&counts)).abs() < 1e-9);
            let refuted = sequence.upper(&counts, 0.05).unwrap() <= margin;
            assert_eq!(refuted, test.ln_e(&counts) >= ln(2.0 / 0.05), "{n}");
        }
    }

    #[test]
    fn nothing_seen_claims_nothing() {
        let sequence = DifferenceSequence::planned(1e-3, 2e-3).unwrap();
        let interval = sequence.interval(&PairedCounts::default(), 0.05).unwrap();
        assert!(interval.lower <= -1.0 && interval.upper >= 1.0);
    }

    #[test]
    fn ends_close_in_on_the_difference() {
        let sequence = DifferenceSequence::planned(1e-2, 5e-2).unwrap();
        let narrow =
            sequence.interval(&PairedCounts::discordant(30_000, 20_000, 1_000_000), 0.05).unwrap();
        assert!(narrow.lower > 0.0085 && narrow.lower < 0.01, "{narrow:?}");
        assert!(narrow.upper < 0.0115 && narrow.upper > 0.01, "{narrow:?}");
    }
}
