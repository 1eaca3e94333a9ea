//! Rates from weighted counts: the gamma interval (display) and the betting bound (claim).
//!
//! Strata with shares W_h and n_h encounters have weights W_h / n_h; importance sampling has
//! w_i / N. Fay and Feuer's interval is conservative in every enumeration that was made and proved
//! in none, so a claim uses the betting bound: X_i in [0, 1], wealth prod (1 + l (m - X_i)), a
//! finite mixture over stakes fixed before the run. Source: statistics specification, sections 3,
//! 4.2 and 4.4; Fay and Feuer (1997); Waudby-Smith and Ramdas (2021).

use crate::eprocess::Stakes;
use crate::error::{StatsError, check_open, check_unit};
use crate::math::{bisect, ln, log_sum_exp, log1p, real};
use crate::special::chi_squared_quantile;
use crate::{Estimate, Method};

/// Events that share a weight: `weight` is W_h / n_h or w_i / N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightedCount {
    /// What one event adds to the rate.
    pub weight: f64,
    /// How many events.
    pub count: u64,
}

/// Fay and Feuer's two-sided interval at nominal confidence 1 - `alpha` for the rate sum w k.
/// `weight_max` is the largest *possible* weight (max_h W_h / n_h; 1 / (eta N)), never the largest
/// that was seen. `n` is the number of encounters, for the record. For display only.
///
/// # Errors
/// A weight outside [0, `weight_max`], or levels out of range.
pub fn fay_feuer(
    events: &[WeightedCount],
    weight_max: f64,
    n: u64,
    alpha: f64,
) -> Result<Estimate, StatsError> {
    check_unit("alpha", alpha)?;
    check_open("weight_max", weight_max, 0.0, f64::INFINITY)?;
    check_weights(events.iter().map(|event| event.weight), "weight", weight_max)?;
    let rate: f64 = events.iter().map(|e| e.weight * real(e.count)).sum();
    let variance: f64 = events.iter().map(|e| e.weight * e.weight * real(e.count)).sum();
    let lower = if rate > 0.0 {
        let freedom = 2.0 * rate * rate / variance;
        variance / (2.0 * rate) * chi_squared_quantile(0.5 * alpha, freedom)?
    } else {
        0.0
    };
    let (rate_one_more, variance_one_more) =
        (rate + weight_max, variance + weight_max * weight_max);
    let freedom = 2.0 * rate_one_more * rate_one_more / variance_one_more;
    let upper = variance_one_more / (2.0 * rate_one_more)
        * chi_squared_quantile(1.0 - 0.5 * alpha, freedom)?;
    let n_effective = if variance > 0.0 { rate * rate / variance } else { 0.0 };
    Ok(Estimate { value: rate, lower, upper, n, n_effective, method: Method::FayFeuer })
}

/// Betting bounds of a mean of values in [0, 1] of which all but `values` are zero, at a declared
/// or any other stopping time: the mixture does not look ahead, so no order and no n is assumed.
#[derive(Debug, Clone, PartialEq)]
pub struct MeanBets {
    /// Fractions of the largest stake, against the mean being as high as m.
    upper: Stakes,
    /// Stakes against the mean being as low as m.
    lower: Stakes,
}

impl MeanBets {
    /// Bets that are sharpest when the mean is about `mean_plan` and about `events_plan` values
    /// will be nonzero.
    ///
    /// # Errors
    /// `mean_plan` outside (0, 1) or `events_plan` not positive.
    pub fn planned(mean_plan: f64, events_plan: f64) -> Result<Self, StatsError> {
        check_unit("mean_plan", mean_plan)?;
        check_open("events_plan", events_plan, 0.0, f64::INFINITY)?;
        // The best stake against m is about |m - mean| / variance; with k events the interval
        // ends near mean (1 +- 2 / sqrt(k)).
        let width = 2.0 / events_plan.sqrt();
        Ok(Self {
            upper: Stakes::declared(1.0, width / (1.0 + width)),
            lower: Stakes::declared(1.0 / mean_plan, width),
        })
    }

    /// The interval at confidence 1 - `alpha` for the mean of `n` values, given those that are
    /// not zero.
    ///
    /// # Errors
    /// A value outside [0, 1], more values than `n`, no value at all, or `alpha` out of range.
    pub fn interval(&self, values: &[f64], n: u64, alpha: f64) -> Result<Estimate, StatsError> {
        check_unit("alpha", alpha)?;
        let values: Vec<WeightedCount> =
            values.iter().map(|&weight| WeightedCount { weight, count: 1 }).collect();
        let (lower, upper) =
            (self.lower(&values, n, 0.5 * alpha)?, self.upper(&values, n, 0.5 * alpha)?);
        let (sum, squares) = moments(&values);
        let value = sum / real(n);
        let n_effective = if squares > 0.0 { sum * sum / squares } else { 0.0 };
        Ok(Estimate { value, lower, upper, n, n_effective, method: Method::Betting })
    }

    /// The upper bound at one-sided confidence 1 - `alpha` for the mean of `n` values, given those
    /// that are not zero, each with how often it occurs. It rises with every value: values that are
    /// rounded up give a bound that holds for the true ones.
    ///
    /// # Errors
    /// As [`Self::interval`].
    pub fn upper(&self, values: &[WeightedCount], n: u64, alpha: f64) -> Result<f64, StatsError> {
        let (zeros, ln_level) = (zeros(values, n)?, level(alpha)?);
        let reached = |mean: f64| self.ln_wealth_above(values, zeros, mean) >= ln_level;
        Ok(bisect(0.0, 1.0, reached).1)
    }

    /// The lower bound, as [`Self::upper`]; it holds for values that are rounded down.
    ///
    /// # Errors
    /// As [`Self::interval`].
    pub fn lower(&self, values: &[WeightedCount], n: u64, alpha: f64) -> Result<f64, StatsError> {
        let (zeros, ln_level) = (zeros(values, n)?, level(alpha)?);
        if self.ln_wealth_below(values, zeros, f64::MIN_POSITIVE) < ln_level {
            return Ok(0.0);
        }
        let seen = moments(values).0 / real(n);
        let kept = |mean: f64| self.ln_wealth_below(values, zeros, mean) < ln_level;
        Ok(bisect(f64::MIN_POSITIVE, seen.min(1.0), kept).0)
    }

    /// ln E against "the mean is at least `mean`"; grows with `mean`.
    fn ln_wealth_above(&self, values: &[WeightedCount], zeros: f64, mean: f64) -> f64 {
        mixture(&self.upper, |fraction| {
            let stake = fraction / (1.0 - mean);
            let bets = values.iter().map(|v| real(v.count) * log1p(stake * (mean - v.weight)));
            bets.sum::<f64>() + zeros * log1p(stake * mean)
        })
    }

    /// ln E against "the mean is at most `mean`"; falls with `mean`.
    fn ln_wealth_below(&self, values: &[WeightedCount], zeros: f64, mean: f64) -> f64 {
        mixture(&self.lower, |stake| {
            let stake = stake.min(0.999 / mean);
            let bets = values.iter().map(|v| real(v.count) * log1p(stake * (v.weight - mean)));
            bets.sum::<f64>() + zeros * log1p(-stake * mean)
        })
    }
}

/// How many of `n` values in [0, 1] are zero, given the others.
fn zeros(values: &[WeightedCount], n: u64) -> Result<f64, StatsError> {
    check_weights(values.iter().map(|value| value.weight), "value", 1.0)?;
    let listed = values.iter().map(|value| value.count).sum();
    crate::error::check_counts(listed, n)?;
    Ok(real(n - listed))
}

fn level(alpha: f64) -> Result<f64, StatsError> {
    check_unit("alpha", alpha)?;
    Ok(-ln(alpha))
}

/// Sum of the values, and of their squares.
fn moments(values: &[WeightedCount]) -> (f64, f64) {
    let sum = |of: fn(f64) -> f64| values.iter().map(|v| of(v.weight) * real(v.count)).sum();
    (sum(|value| value), sum(|value| value * value))
}

/// As [`Stakes::ln_mixture`], each wealth computed once.
fn mixture(stakes: &Stakes, ln_wealth: impl Fn(f64) -> f64) -> f64 {
    let terms: Vec<f64> = stakes
        .stakes
        .iter()
        .zip(&stakes.ln_weights)
        .map(|(&stake, ln_weight)| ln_weight + ln_wealth(stake))
        .collect();
    log_sum_exp(terms.iter().copied())
}

/// Checks that every weight lies in [0, `high`].
pub(crate) fn check_weights(
    weights: impl Iterator<Item = f64>,
    name: &'static str,
    high: f64,
) -> Result<(), StatsError> {
    for (index, value) in weights.enumerate() {
        if !(0.0..=high).contains(&value) {
            return Err(StatsError::Sample { index, name, value, low: 0.0, high });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_event_bounds_the_rate_by_the_largest_weight() {
        let interval = fay_feuer(&[], 1e-6, 1_000_000, 0.05).unwrap();
        assert!((interval.upper / (-ln(0.025) * 1e-6) - 1.0).abs() < 1e-12);
        assert!(interval.lower <= 0.0);
    }

    /// With equal weights the interval is the exact Poisson one: 5 events give 1.6235 to 11.6683.
    #[test]
    fn equal_weights_give_the_poisson_interval() {
        let events = [WeightedCount { weight: 1.0, count: 5 }];
        let interval = fay_feuer(&events, 1.0, 5, 0.05).unwrap();
        assert!((interval.lower - 1.623_486_39).abs() < 1e-7, "{interval:?}");
        assert!((interval.upper - 11.668_332_1).abs() < 1e-6, "{interval:?}");
    }

    #[test]
    fn a_weight_above_the_possible_one_is_refused() {
        let events = [WeightedCount { weight: 2.0, count: 1 }];
        let wrong =
            StatsError::Sample { index: 0, name: "weight", value: 2.0, low: 0.0, high: 1.0 };
        assert_eq!(fay_feuer(&events, 1.0, 5, 0.05), Err(wrong));
    }

    /// The ends put the declared mixture, written out, on 2 / alpha.
    #[test]
    fn betting_bounds_solve_the_declared_mixture() {
        let nodes = |largest: f64, aimed: f64| {
            let mut nodes =
                vec![(0.5, aimed), (0.15, (2.0 * aimed).min(largest)), (0.15, aimed / 2.0)];
            let mut stake = largest;
            for _ in 0..7 {
                nodes.push((0.2 / 7.0, stake));
                stake /= 3.0;
            }
            nodes
        };
        // Four planned events about .5: widths of 1, so fractions about 1/2 and stakes about 1.
        let bets = MeanBets::planned(0.5, 4.0).unwrap();
        let upper = bets.interval(&[], 3, 0.05).unwrap().upper;
        let wealth = |stake: f64, by: f64| {
            let factor = 1.0 + stake * by;
            factor * factor * factor
        };
        let e: f64 =
            nodes(0.999, 0.5).iter().map(|(w, c)| w * wealth(*c, upper / (1.0 - upper))).sum();
        assert!((e - 40.0).abs() < 1e-9, "{e}");
        let many = bets.interval(&[1.0; 12], 12, 0.1).unwrap().lower;
        let e: f64 = nodes(1.998, 1.0)
            .iter()
            .map(|(w, l)| {
                let cube = wealth(l.min(0.999 / many), 1.0 - many);
                w * cube * cube * cube * cube
            })
            .sum();
        assert!((e - 20.0).abs() < 1e-9 && many > 0.0, "{e} {many}");
    }

    #[test]
    fn betting_bounds_enclose_the_mean_and_tighten() {
        let bets = MeanBets::planned(1e-3, 50.0).unwrap();
        let few = bets.interval(&[1.0; 10], 10_000, 0.05).unwrap();
        let many = bets.interval(&[1.0; 100], 100_000, 0.05).unwrap();
        for interval in [few, many] {
            assert!(interval.lower < 1e-3 && 1e-3 < interval.upper, "{interval:?}");
        }
        assert!(many.upper - many.lower < few.upper - few.lower);
        assert!(few.lower > 0.0 && few.upper < 5e-3, "{few:?}");
        assert!(bets.interval(&[1.5], 10, 0.05).is_err());
        assert!(bets.interval(&[f64::NAN], 10, 0.05).is_err());
    }
}
