//! How many encounters a claim needs. Source: statistics specification, section 4.3; the paired
//! sizes stand with the paired tests.

use crate::binomial::clopper_pearson_upper;
use crate::error::{StatsError, check_open, check_unit};
use crate::special::{chi_squared_quantile, normal_quantile};

/// N p0 at which `k` events still leave the one-sided bound at p0, for small p0:
/// chi2_(1-a)(2k + 2) / 2.
///
/// # Errors
/// `alpha` outside (0, 1).
pub fn events_allowance(k: u32, alpha: f64) -> Result<f64, StatsError> {
    Ok(0.5 * chi_squared_quantile(1.0 - alpha, 2.0 * f64::from(k) + 2.0)?)
}

/// The smallest n at which `k` events leave the exact one-sided upper bound at or below `rate`.
///
/// # Errors
/// `rate` or `alpha` outside (0, 1).
pub fn encounters_for_bound(k: u64, rate: f64, alpha: f64) -> Result<u64, StatsError> {
    check_unit("rate", rate)?;
    let shown = |n: u64| clopper_pearson_upper(k, n, alpha).map(|upper| upper <= rate);
    let mut high = k + 1;
    while !shown(high)? {
        high *= 2;
    }
    let mut low = k;
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if shown(middle)? { high = middle } else { low = middle }
    }
    Ok(high)
}

/// Encounters for a two-sided relative half-width at a rate: z^2 (1 - p) / (p e^2).
///
/// # Errors
/// `rate` or `alpha` outside (0, 1), or a half-width that is not positive.
pub fn encounters_for_width(
    rate: f64,
    half_width_relative: f64,
    alpha: f64,
) -> Result<f64, StatsError> {
    check_unit("rate", rate)?;
    check_unit("alpha", alpha)?;
    check_open("half_width_relative", half_width_relative, 0.0, f64::INFINITY)?;
    let z = normal_quantile(0.5 * alpha)? / half_width_relative;
    Ok(z * z * (1.0 - rate) / rate)
}

/// Encounters of a fixed-size test of a good rate against a bad one, one-sided, by the normal
/// approximation: (z_a sqrt(p0 q0) + z_b sqrt(p1 q1))^2 / (p1 - p0)^2.
///
/// # Errors
/// Rates not 0 < p0 < p1 < 1, or levels outside (0, 1).
pub fn encounters_fixed_test(
    good: f64,
    bad: f64,
    alpha: f64,
    beta: f64,
) -> Result<f64, StatsError> {
    check_unit("bad rate", bad)?;
    check_open("good rate", good, 0.0, bad)?;
    let root = normal_quantile(alpha)? * (good * (1.0 - good)).sqrt()
        + normal_quantile(beta)? * (bad * (1.0 - bad)).sqrt();
    Ok(root * root / ((bad - good) * (bad - good)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of section 4.3. Three of its entries are a last digit off: 99 %, k = 4 and 10, are
    /// 11.6046 and 20.1447, and 99.9 %, k = 5, is 16.4547 to more digits.
    #[test]
    fn table_of_required_sizes() {
        let ks = [0, 1, 2, 3, 4, 5, 10, 20];
        let rows = [
            (0.05, [2.996, 4.744, 6.296, 7.754, 9.154, 10.51, 16.96, 29.06]),
            (0.01, [4.605, 6.638, 8.406, 10.05, 11.60, 13.11, 20.14, 33.10]),
            (0.001, [6.908, 9.233, 11.23, 13.06, 14.79, 16.45, 24.13, 38.04]),
        ];
        for (alpha, row) in rows {
            for (k, expected) in ks.into_iter().zip(row) {
                let got = events_allowance(k, alpha).unwrap();
                let last_digit = if expected < 10.0 { 5e-4 } else { 5e-3 };
                assert!((got - expected).abs() <= last_digit * 1.01, "{k} {alpha}: {got}");
            }
        }
    }

    #[test]
    fn exact_size_is_the_smallest() {
        for (k, rate, alpha) in [(0, 1e-4, 0.05), (3, 1e-3, 0.01), (20, 0.3, 0.05)] {
            let n = encounters_for_bound(k, rate, alpha).unwrap();
            assert!(clopper_pearson_upper(k, n, alpha).unwrap() <= rate);
            assert!(clopper_pearson_upper(k, n - 1, alpha).unwrap() > rate);
        }
        assert_eq!(encounters_for_bound(0, 1e-4, 0.05).unwrap(), 29_956);
    }

    #[test]
    fn widths_and_fixed_tests_have_the_known_sizes() {
        let width = encounters_for_width(1e-4, 0.1, 0.05).unwrap();
        assert!((width / 3.84e6 - 1.0).abs() < 1e-3, "{width}");
        let fixed = encounters_fixed_test(1e-4, 2e-4, 0.05, 0.05).unwrap();
        assert!((fixed / 1.58e5 - 1.0).abs() < 5e-3, "{fixed}");
    }
}
