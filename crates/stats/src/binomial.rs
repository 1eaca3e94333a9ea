//! Bounds of a probability from k events in n trials.
//!
//! Claims: Clopper-Pearson. U solves P(X <= k; p) = a and L solves P(X >= k; p) = a, by bisection
//! on ln p of the logarithm of exactly that tail: ln tail = ln pmf(k; n, p) + ln S, where the
//! pmf is Loader's saddle point and S = 1 + t1 + ... the ratio to its first term. No inverse beta
//! function takes part: those lose eight digits at n = 1e9. Right for n up to 3e9 and k up to 1e6
//! (beyond, it only becomes slow). Plots: Wilson, Jeffreys. Source: statistics specification,
//! section 4.1; Loader (2000); Brown, Cai and DasGupta (2001).

use crate::error::{StatsError, check_counts, check_unit};
use crate::math::{LN_SQRT_2PI, bisect, exp, expm1, ln, log1p, real};
use crate::special::{beta_quantile, deviance, normal_quantile, stirling_error};
use crate::{Estimate, Method};

/// Two-sided Clopper-Pearson interval at confidence 1 - `alpha` (`alpha`/2 on each side).
///
/// # Errors
/// `alpha` outside (0, 1), no trial, or more events than trials.
pub fn clopper_pearson(k: u64, n: u64, alpha: f64) -> Result<Estimate, StatsError> {
    check_unit("alpha", alpha)?;
    let lower = clopper_pearson_lower(k, n, 0.5 * alpha)?;
    let upper = clopper_pearson_upper(k, n, 0.5 * alpha)?;
    Ok(estimate(k, n, lower, upper, Method::ClopperPearson))
}

/// One-sided upper Clopper-Pearson bound: true with probability at least 1 - `alpha`.
///
/// # Errors
/// As [`clopper_pearson`].
pub fn clopper_pearson_upper(k: u64, n: u64, alpha: f64) -> Result<f64, StatsError> {
    check_unit("alpha", alpha)?;
    check_counts(k, n)?;
    if k == n {
        Ok(1.0)
    } else if k == 0 {
        Ok(-expm1(ln(alpha) / real(n)))
    } else if k <= n / 2 {
        Ok(exp(ln_upper_bound(k, n, ln(alpha))))
    } else {
        Ok(-expm1(ln_lower_bound(n - k, n, ln(alpha))))
    }
}

/// One-sided lower Clopper-Pearson bound: true with probability at least 1 - `alpha`.
///
/// # Errors
/// As [`clopper_pearson`].
pub fn clopper_pearson_lower(k: u64, n: u64, alpha: f64) -> Result<f64, StatsError> {
    check_unit("alpha", alpha)?;
    check_counts(k, n)?;
    if k == 0 {
        Ok(0.0)
    } else if k == n {
        Ok(exp(ln(alpha) / real(n)))
    } else if k <= n / 2 {
        Ok(exp(ln_lower_bound(k, n, ln(alpha))))
    } else {
        Ok(-expm1(ln_upper_bound(n - k, n, ln(alpha))))
    }
}

/// Wilson's score interval at nominal confidence 1 - `alpha`. For plots only.
///
/// # Errors
/// As [`clopper_pearson`].
pub fn wilson(k: u64, n: u64, alpha: f64) -> Result<Estimate, StatsError> {
    check_unit("alpha", alpha)?;
    check_counts(k, n)?;
    let z = -normal_quantile(0.5 * alpha)?;
    let (trials, events) = (real(n), real(k));
    let centre = (events + 0.5 * z * z) / (trials + z * z);
    let half = z / (trials + z * z) * (events * (real(n - k) / trials) + 0.25 * z * z).sqrt();
    // At the ends the interval touches 0 or 1; subtraction would leave a rounding crumb.
    let lower = if k == 0 { 0.0 } else { (centre - half).max(0.0) };
    let upper = if k == n { 1.0 } else { (centre + half).min(1.0) };
    Ok(estimate(k, n, lower, upper, Method::Wilson))
}

/// Jeffreys' interval at nominal confidence 1 - `alpha`, closed at 0 and 1. For plots only.
///
/// # Errors
/// As [`clopper_pearson`].
pub fn jeffreys(k: u64, n: u64, alpha: f64) -> Result<Estimate, StatsError> {
    check_unit("alpha", alpha)?;
    check_counts(k, n)?;
    let (a, b) = (real(k) + 0.5, real(n - k) + 0.5);
    let lower = if k == 0 { 0.0 } else { beta_quantile(0.5 * alpha, a, b)? };
    let upper = if k == n { 1.0 } else { beta_quantile(1.0 - 0.5 * alpha, a, b)? };
    Ok(estimate(k, n, lower, upper, Method::Jeffreys))
}

/// P(X >= k) for X ~ Binomial(n, p).
///
/// # Errors
/// `p` outside (0, 1), no trial, or more events than trials.
pub fn binomial_upper_tail(k: u64, n: u64, p: f64) -> Result<f64, StatsError> {
    check_unit("p", p)?;
    check_counts(k, n)?;
    if k == 0 {
        return Ok(1.0);
    }
    Ok(upper_tail(k, n, p, 1.0 - p))
}

/// P(X <= k) for X ~ Binomial(n, p).
///
/// # Errors
/// As [`binomial_upper_tail`].
pub fn binomial_lower_tail(k: u64, n: u64, p: f64) -> Result<f64, StatsError> {
    check_unit("p", p)?;
    check_counts(k, n)?;
    // Failures at least n - k; p and q change places without a subtraction that would lose p.
    Ok(if k == n { 1.0 } else { upper_tail(n - k, n, 1.0 - p, p) })
}

/// ln P(X = k) for X ~ Binomial(n, p), by Loader's saddle point.
///
/// # Errors
/// As [`binomial_upper_tail`].
pub fn ln_binomial_pmf(k: u64, n: u64, p: f64) -> Result<f64, StatsError> {
    check_unit("p", p)?;
    check_counts(k, n)?;
    Ok(ln_pmf(k, n, p, 1.0 - p))
}

/// P(X >= k; p) for k > 0, q = 1 - p.
fn upper_tail(k: u64, n: u64, p: f64, q: f64) -> f64 {
    // Each series falls from its first term only beyond the mean.
    if real(k) >= real(n) * p {
        exp(ln_upper_tail(k, n, p, q)).min(1.0)
    } else {
        1.0 - exp(ln_lower_tail(k - 1, n, p, q))
    }
}

fn estimate(k: u64, n: u64, lower: f64, upper: f64, method: Method) -> Estimate {
    Estimate { value: real(k) / real(n), lower, upper, n, n_effective: real(n), method }
}

/// ln of the p in [k/n, 1] with P(X <= k; p) = a, for 0 < k <= n/2.
fn ln_upper_bound(k: u64, n: u64, ln_alpha: f64) -> f64 {
    let low = ln(real(k) / real(n));
    bisect(low, 0.0, |ln_p| ln_lower_tail(k, n, exp(ln_p), -expm1(ln_p)) <= ln_alpha).1
}

/// ln of the p in (1e-300, k/n] with P(X >= k; p) = a, for 0 < k <= n/2.
fn ln_lower_bound(k: u64, n: u64, ln_alpha: f64) -> f64 {
    let high = ln(real(k) / real(n));
    bisect(ln(1e-300), high, |ln_p| ln_upper_tail(k, n, exp(ln_p), -expm1(ln_p)) >= ln_alpha).0
}

/// ln P(X <= k; p), q = 1 - p; quick when k <= np.
fn ln_lower_tail(k: u64, n: u64, p: f64, q: f64) -> f64 {
    let odds = q / p;
    let (first_down, first_up) = (real(k), real(n - k) + 1.0);
    ln_pmf(k, n, p, q) + ln(series(odds, first_down, first_up))
}

/// ln P(X >= k; p), q = 1 - p; quick when k >= np.
fn ln_upper_tail(k: u64, n: u64, p: f64, q: f64) -> f64 {
    let odds = p / q;
    let (first_down, first_up) = (real(n - k), real(k) + 1.0);
    ln_pmf(k, n, p, q) + ln(series(odds, first_down, first_up))
}

/// S = 1 + t1 + t2 + ..., t_(j+1) = t_j odds (down - j) / (up + j).
fn series(odds: f64, mut down: f64, mut up: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 1.0;
    while down > 0.0 {
        term *= down / up * odds;
        sum += term;
        if term < 1e-18 * sum {
            break;
        }
        down -= 1.0;
        up += 1.0;
    }
    sum
}

/// ln pmf(k; n, p) with q = 1 - p given exactly.
fn ln_pmf(k: u64, n: u64, p: f64, q: f64) -> f64 {
    let (events, rest, trials) = (real(k), real(n - k), real(n));
    if k == 0 {
        return trials * if p < 0.5 { log1p(-p) } else { ln(q) };
    }
    if k == n {
        return trials * if q < 0.5 { log1p(-q) } else { ln(p) };
    }
    let (mean, mean_rest) = (trials * p, trials * q);
    // The same distance in both deviances, taken where it loses least.
    let offset = if k <= n / 2 { events - mean } else { mean_rest - rest };
    stirling_error(trials)
        - stirling_error(events)
        - stirling_error(rest)
        - deviance(events, mean, offset)
        - deviance(rest, mean_rest, -offset)
        - LN_SQRT_2PI
        - 0.5 * ln(events * (rest / trials))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: f64, want: f64, relative: f64) {
        assert!((got - want).abs() <= relative * want.abs(), "got {got:e}, want {want:e}");
    }

    #[test]
    fn no_event_and_all_events_have_closed_forms() {
        close(
            clopper_pearson_upper(0, 3_000_000_000, 0.05).unwrap(),
            2.995732273553991 / 3e9,
            1e-9,
        );
        close(clopper_pearson_lower(7, 7, 0.025).unwrap(), exp(ln(0.025) / 7.0), 1e-15);
        assert!(clopper_pearson_lower(0, 10, 0.05).unwrap() <= 0.0);
        assert!(clopper_pearson_upper(10, 10, 0.05).unwrap() >= 1.0);
    }

    /// A million events in three billion trials; the values were computed with 40 digits.
    #[test]
    fn bounds_stay_right_at_a_million_events() {
        close(clopper_pearson_lower(1_000_000, 3_000_000_000, 0.025).unwrap(), LOWER_1E6, 1e-13);
        close(clopper_pearson_upper(1_000_000, 3_000_000_000, 1e-6).unwrap(), UPPER_1E6, 1e-13);
    }
    const LOWER_1E6: f64 = 3.326_804_363_547_773e-4;
    const UPPER_1E6: f64 = 3.349_202_765_469_306e-4;

    #[test]
    fn bounds_mirror_each_other() {
        for (k, n) in [(1, 3), (2, 5), (9, 10), (17, 20), (999_990, 1_000_000)] {
            let upper = clopper_pearson_upper(k, n, 0.01).unwrap();
            let mirrored = 1.0 - clopper_pearson_lower(n - k, n, 0.01).unwrap();
            close(upper, mirrored, 1e-14);
        }
    }

    #[test]
    fn tails_add_up_to_one() {
        for (k, n, p) in [(3, 10, 0.2), (60, 100, 0.5), (1, 1_000_000, 1e-6), (40, 50, 0.9)] {
            let below = binomial_lower_tail(k - 1, n, p).unwrap();
            close(below + binomial_upper_tail(k, n, p).unwrap(), 1.0, 1e-14);
        }
    }

    #[test]
    fn impossible_questions_are_refused() {
        assert_eq!(clopper_pearson(1, 0, 0.05), Err(StatsError::Counts { k: 1, n: 0 }));
        assert_eq!(clopper_pearson(5, 4, 0.05), Err(StatsError::Counts { k: 5, n: 4 }));
        assert!(clopper_pearson(1, 4, 1.0).is_err());
        assert!(clopper_pearson(1, 4, f64::NAN).is_err());
    }

    /// Wilson and Jeffreys against published values: Brown, Cai and DasGupta's formulas at
    /// k = 5, n = 20, worked with 30 digits.
    #[test]
    fn plot_intervals_have_known_values() {
        let wilson = wilson(5, 20, 0.05).unwrap();
        close(wilson.lower, WILSON.0, 1e-13);
        close(wilson.upper, WILSON.1, 1e-13);
        let jeffreys = jeffreys(5, 20, 0.05).unwrap();
        close(jeffreys.lower, JEFFREYS.0, 1e-12);
        close(jeffreys.upper, JEFFREYS.1, 1e-12);
    }
    const WILSON: (f64, f64) = (0.111_861_701_407_665_66, 0.468_700_877_618_744);
    const JEFFREYS: (f64, f64) = (0.102_398_485_683_045_09, 0.464_194_629_240_868_1);
}
