//! Paired BCa bootstrap of a mean difference, for continuous measures (closest distance, size of
//! a turn). Display only. Encounters are resampled, never steps. The draws come from the caller,
//! so that the result is a function of its arguments. Source: statistics specification, section
//! 4.5; Efron (1987).

use crate::error::{StatsError, check_unit};
use crate::math::real;
use crate::special::{normal_cdf, normal_quantile};
use crate::{Estimate, Method};

/// BCa interval at nominal confidence 1 - `alpha` of the mean of paired `differences` (candidate
/// minus baseline, one for each encounter). `uniform` gives draws in [0, 1).
///
/// # Errors
/// Fewer than 100 / `alpha` resamples, fewer than two differences, one that is not finite, or all
/// of them equal (a zero-event column: use an exact bound).
pub fn bca_mean(
    differences: &[f64],
    alpha: f64,
    resamples: u32,
    uniform: &mut dyn FnMut() -> f64,
) -> Result<Estimate, StatsError> {
    check_unit("alpha", alpha)?;
    if f64::from(resamples) < 100.0 / alpha {
        return Err(StatsError::TooFew { what: "a bootstrap", need: "100 / alpha resamples" });
    }
    if let Some(&value) = differences.iter().find(|value| !value.is_finite()) {
        return Err(StatsError::NotANumber { name: "difference", value });
    }
    let n = differences.len();
    let mean = differences.iter().sum::<f64>() / real(n as u64);
    let (squares, cubes) = differences.iter().fold((0.0, 0.0), |(squares, cubes), value| {
        let off = value - mean;
        (squares + off * off, cubes + off * off * off)
    });
    if n < 2 || squares <= 0.0 {
        return Err(StatsError::TooFew {
            what: "a bootstrap",
            need: "differences that are not all equal; use an exact bound",
        });
    }
    let mut means: Vec<f64> =
        (0..resamples).map(|_| resampled_mean(differences, uniform)).collect();
    means.sort_by(f64::total_cmp);
    // Half of the ties count as below, so that a discrete mean has no bias of its own.
    let below = means.partition_point(|&value| value < mean);
    let tied = means.partition_point(|&value| value <= mean) - below;
    let total = f64::from(resamples);
    let share = (real(below as u64) + 0.5 * real(tied as u64)) / total;
    let bias = normal_quantile(share.clamp(0.5 / total, 1.0 - 0.5 / total))?;
    // The jackknife acceleration of a mean.
    let acceleration = cubes / (6.0 * squares * squares.sqrt());
    let limit = |z: f64| {
        let shifted = bias + z;
        let level = normal_cdf(bias + shifted / (1.0 - acceleration * shifted));
        let rank = (level * total).ceil().clamp(1.0, total);
        means[rank as usize - 1]
    };
    let z = -normal_quantile(0.5 * alpha)?;
    let (lower, upper) = (limit(-z), limit(z));
    let n = n as u64;
    Ok(Estimate { value: mean, lower, upper, n, n_effective: real(n), method: Method::Bca })
}

fn resampled_mean(differences: &[f64], uniform: &mut dyn FnMut() -> f64) -> f64 {
    let n = differences.len();
    let mut sum = 0.0;
    for _ in 0..n {
        let at = (uniform() * real(n as u64)) as usize;
        sum += differences[at.min(n - 1)];
    }
    sum / real(n as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A full-period generator of low quality: enough to resample with, and the same every time.
    fn uniform() -> impl FnMut() -> f64 {
        let mut state = 1_u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            real(state >> 11) / real(1 << 53)
        }
    }

    #[test]
    fn interval_of_a_symmetric_sample_is_the_normal_one() {
        let sample: Vec<f64> = (-50..=50).map(f64::from).collect();
        let interval = bca_mean(&sample, 0.05, 4000, &mut uniform()).unwrap();
        let half = 1.96 * (850.0_f64 / 101.0).sqrt();
        assert!((interval.upper - half).abs() < 0.4 && (interval.lower + half).abs() < 0.4);
        assert_eq!(interval, bca_mean(&sample, 0.05, 4000, &mut uniform()).unwrap());
    }

    #[test]
    fn interval_of_a_skewed_sample_leans_to_its_tail() {
        let sample: Vec<f64> = (1..=60).map(|i| -crate::math::ln(f64::from(i) / 61.0)).collect();
        let interval = bca_mean(&sample, 0.05, 8000, &mut uniform()).unwrap();
        assert!(interval.upper - interval.value > 1.1 * (interval.value - interval.lower));
    }

    #[test]
    fn degenerate_questions_are_refused() {
        assert!(bca_mean(&[0.0; 50], 0.05, 2000, &mut uniform()).is_err());
        assert!(bca_mean(&[1.0, 2.0], 0.05, 1999, &mut uniform()).is_err());
        assert!(bca_mean(&[1.0, f64::INFINITY], 0.05, 2000, &mut uniform()).is_err());
    }
}
