//! Many tests at once. Gate: Holm. Dashboard localisation: Benjamini-Hochberg, or
//! Benjamini-Yekutieli when the strata overlap. State m in the report.
//! Source: statistics specification, section 4.7; Holm (1979); Benjamini and Hochberg (1995);
//! Benjamini and Yekutieli (2001).

use crate::error::{StatsError, check_unit};
use crate::math::real;

/// Holm: rejections that keep the probability of any false one at `alpha`, whatever the
/// dependence. True at the place of every rejected p.
///
/// # Errors
/// A p outside [0, 1] or `alpha` outside (0, 1).
pub fn holm(p_values: &[f64], alpha: f64) -> Result<Vec<bool>, StatsError> {
    let order = ascending(p_values, alpha)?;
    let m = order.len();
    let passing = order
        .iter()
        .enumerate()
        .take_while(|&(i, &at)| p_values[at] <= alpha / real((m - i) as u64))
        .count();
    Ok(rejected(&order, passing))
}

/// Benjamini-Hochberg: rejections of which an expected share of at most `rate` is false, for
/// independent (or positively dependent) tests.
///
/// # Errors
/// As [`holm`].
pub fn benjamini_hochberg(p_values: &[f64], rate: f64) -> Result<Vec<bool>, StatsError> {
    step_up(p_values, rate, 1.0)
}

/// Benjamini-Yekutieli: as [`benjamini_hochberg`] under any dependence.
///
/// # Errors
/// As [`holm`].
pub fn benjamini_yekutieli(p_values: &[f64], rate: f64) -> Result<Vec<bool>, StatsError> {
    let harmonic = (1..=p_values.len() as u64).map(|i| 1.0 / real(i)).sum();
    step_up(p_values, rate, harmonic)
}

/// Rejects the i smallest for the largest i with p_(i) <= i rate / (m penalty).
fn step_up(p_values: &[f64], rate: f64, penalty: f64) -> Result<Vec<bool>, StatsError> {
    let order = ascending(p_values, rate)?;
    let m = real(order.len() as u64);
    let passing = order
        .iter()
        .enumerate()
        .filter(|&(i, &at)| p_values[at] <= real(i as u64 + 1) * rate / (m * penalty))
        .map(|(i, _)| i + 1)
        .max()
        .unwrap_or(0);
    Ok(rejected(&order, passing))
}

/// The places of the p-values in increasing order.
fn ascending(p_values: &[f64], level: f64) -> Result<Vec<usize>, StatsError> {
    check_unit("level", level)?;
    crate::weighted::check_weights(p_values.iter().copied(), "p", 1.0)?;
    let mut order: Vec<usize> = (0..p_values.len()).collect();
    order.sort_by(|&a, &b| p_values[a].total_cmp(&p_values[b]));
    Ok(order)
}

fn rejected(order: &[usize], passing: usize) -> Vec<bool> {
    let mut rejected = vec![false; order.len()];
    for &at in &order[..passing] {
        rejected[at] = true;
    }
    rejected
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Benjamini and Hochberg (1995), section 3.2: fifteen p-values; BH rejects four at .05, the
    /// Bonferroni family three.
    const P: [f64; 15] = [
        0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344, 0.0459, 0.3240, 0.4262,
        0.5719, 0.6528, 0.7590, 1.0,
    ];

    #[test]
    fn published_example() {
        let count = |rejected: Vec<bool>| rejected.into_iter().filter(|&r| r).count();
        assert_eq!(count(benjamini_hochberg(&P, 0.05).unwrap()), 4);
        assert_eq!(count(holm(&P, 0.05).unwrap()), 3);
        assert_eq!(count(benjamini_yekutieli(&P, 0.05).unwrap()), 3);
    }

    #[test]
    fn order_does_not_matter_and_a_gap_stops_holm() {
        let mut reversed = P;
        reversed.reverse();
        let mut back = benjamini_hochberg(&reversed, 0.05).unwrap();
        back.reverse();
        assert_eq!(back, benjamini_hochberg(&P, 0.05).unwrap());
        // The largest passes its own threshold, but the one before it does not.
        assert_eq!(holm(&[0.03, 0.04], 0.05).unwrap(), [false, false]);
        assert_eq!(benjamini_hochberg(&[0.03, 0.04], 0.05).unwrap(), [true, true]);
        assert_eq!(holm(&[], 0.05).unwrap(), Vec::<bool>::new());
        assert!(holm(&[f64::NAN], 0.05).is_err());
    }
}
