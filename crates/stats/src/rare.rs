//! What may be said about rare events that were not simply counted.
//!
//! Importance sampling with its fitness to be published, the exact interval of last-particle
//! splitting, and the interval over independent replications. Source: statistics specification,
//! section 3.

use serde::{Deserialize, Serialize};

use crate::error::{StatsError, check_open, check_unit};
use crate::math::{exp, ln, pow, real};
use crate::special::{chi_squared_quantile, student_t_quantile};
use crate::weighted::check_weights;
use crate::{Estimate, Method, WeightedCount};

/// How far an importance-sampling estimate rests on few samples.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ImportanceFitness {
    /// p = sum w y / N.
    pub rate: f64,
    /// Standard error of p.
    pub rate_error: f64,
    /// (sum w y)^2 / sum (w y)^2.
    pub events_effective: f64,
    /// max (w y) / sum w y.
    pub share_max: f64,
}

impl ImportanceFitness {
    /// From the weights of the samples with the event, of `n` samples in all.
    ///
    /// # Errors
    /// A negative weight, more events than samples, or fewer than two samples.
    pub fn new(event_weights: &[f64], n: u64) -> Result<Self, StatsError> {
        let events: Vec<WeightedCount> =
            event_weights.iter().map(|&weight| WeightedCount { weight, count: 1 }).collect();
        Self::of_counts(&events, n)
    }

    /// The same from the weights that the samples with the event have, each with how often.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_counts(events: &[WeightedCount], n: u64) -> Result<Self, StatsError> {
        check_weights(events.iter().map(|event| event.weight), "weight", f64::MAX)?;
        if n < 2 {
            return Err(StatsError::TooFew { what: "a standard error", need: "two samples" });
        }
        let count = events.iter().map(|event| event.count).sum();
        crate::error::check_counts(count, n)?;
        let over = |of: &dyn Fn(f64) -> f64| -> f64 {
            events.iter().map(|event| real(event.count) * of(event.weight)).sum()
        };
        let (sum, squares) = (over(&|w| w), over(&|w| w * w));
        let rate = sum / real(n);
        let spread = over(&|w| (w - rate) * (w - rate)) + real(n - count) * rate * rate;
        let seen = events.iter().filter(|event| event.count > 0);
        let largest = seen.map(|event| event.weight).fold(0.0, f64::max);
        let none = sum <= 0.0;
        Ok(Self {
            rate,
            rate_error: (spread / (real(n) - 1.0) / real(n)).sqrt(),
            events_effective: if none { 0.0 } else { sum * sum / squares },
            share_max: if none { 1.0 } else { largest / sum },
        })
    }

    /// At least 50 effective events, and none of them more than 5 % of the sum.
    #[must_use]
    pub fn is_publishable(&self) -> bool {
        self.events_effective >= 50.0 && self.share_max <= 0.05
    }
}

/// Last-particle splitting with N `walkers` and J `killings`: p = (1 - 1/N)^J, and the exact
/// interval of -ln p from J ~ Poisson(-N ln p), which holds for ideal sampling.
///
/// # Errors
/// Fewer than two walkers, or `alpha` outside (0, 1).
pub fn last_particle(walkers: u64, killings: u64, alpha: f64) -> Result<Estimate, StatsError> {
    check_unit("alpha", alpha)?;
    if walkers < 2 {
        return Err(StatsError::TooFew { what: "last-particle splitting", need: "two walkers" });
    }
    let (n, j) = (real(walkers), real(killings));
    let least = if killings == 0 { 0.0 } else { chi_squared_quantile(0.5 * alpha, 2.0 * j)? };
    let most = chi_squared_quantile(1.0 - 0.5 * alpha, 2.0 * j + 2.0)?;
    Ok(Estimate {
        value: pow(1.0 - 1.0 / n, j),
        lower: exp(-most / (2.0 * n)),
        upper: exp(-least / (2.0 * n)),
        n: walkers + killings,
        n_effective: n,
        method: Method::LastParticle,
    })
}

/// Student's t interval of the mean over at least 30 independent replications of an estimate,
/// each of `n_each` encounters.
///
/// # Errors
/// Fewer than 30 replications, one that is not finite, or `alpha` outside (0, 1).
pub fn replications(rates: &[f64], n_each: u64, alpha: f64) -> Result<Estimate, StatsError> {
    check_unit("alpha", alpha)?;
    if rates.len() < 30 {
        return Err(StatsError::TooFew { what: "a t interval", need: "30 replications" });
    }
    if let Some(&value) = rates.iter().find(|rate| !rate.is_finite()) {
        return Err(StatsError::NotANumber { name: "replication", value });
    }
    let r = real(rates.len() as u64);
    let mean = rates.iter().sum::<f64>() / r;
    let squares: f64 = rates.iter().map(|rate| (rate - mean) * (rate - mean)).sum();
    let half = -student_t_quantile(0.5 * alpha, r - 1.0)? * (squares / (r - 1.0) / r).sqrt();
    Ok(Estimate {
        value: mean,
        lower: (mean - half).max(0.0),
        upper: mean + half,
        n: n_each * rates.len() as u64,
        n_effective: r,
        method: Method::Replications,
    })
}

/// Squared coefficient of variation of last-particle splitting: p^(-1/N) - 1.
///
/// # Errors
/// `p` outside (0, 1) or fewer than two walkers.
pub fn last_particle_cv_squared(p: f64, walkers: u64) -> Result<f64, StatsError> {
    check_unit("p", p)?;
    check_open("walkers", real(walkers), 1.0, f64::INFINITY)?;
    Ok(crate::math::expm1(-ln(p) / real(walkers)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Section 3's table: N = 1000 walkers, CV .083, .118 and .145 at 1e-3, 1e-6 and 1e-9.
    #[test]
    fn splitting_has_the_known_variation() {
        for (p, cv) in [(1e-3, 0.083), (1e-6, 0.118), (1e-9, 0.145)] {
            let got = last_particle_cv_squared(p, 1000).unwrap().sqrt();
            assert!((got - cv).abs() < 1.5e-3, "{p}: {got}");
        }
    }

    #[test]
    fn last_particle_interval_is_poissons() {
        let interval = last_particle(1000, 6908, 0.05).unwrap();
        assert!((interval.value / 1e-3 - 1.0).abs() < 0.01, "{interval:?}");
        // 6908 +- 1.96 sqrt(6908): a factor of e^0.163 either way.
        assert!((interval.upper / interval.value - 1.18).abs() < 0.015, "{interval:?}");
        assert!(last_particle(1000, 0, 0.05).unwrap().upper >= 1.0);
        assert!(last_particle(1, 5, 0.05).is_err());
    }

    #[test]
    fn few_or_lopsided_samples_are_not_published() {
        assert!(ImportanceFitness::new(&[0.1; 60], 10_000).unwrap().is_publishable());
        assert!(!ImportanceFitness::new(&[0.1; 49], 10_000).unwrap().is_publishable());
        let mut lopsided = [0.1; 200];
        lopsided[0] = 2.0;
        assert!(!ImportanceFitness::new(&lopsided, 10_000).unwrap().is_publishable());
        let crude = ImportanceFitness::new(&[1.0; 100], 10_000).unwrap();
        assert!((crude.rate_error - (0.01 * 0.99 / 9999.0_f64).sqrt()).abs() < 1e-12);
        assert!(!ImportanceFitness::new(&[], 10_000).unwrap().is_publishable());
    }

    #[test]
    fn thirty_replications_are_needed() {
        let rates: Vec<f64> = (0..30).map(|i| 1e-4 * (1.0 + f64::from(i) / 100.0)).collect();
        let interval = replications(&rates, 1000, 0.05).unwrap();
        // t(29, .975) = 2.04523; sd of 0..29 is 8.80341.
        let half = 2.045_229_642 * 8.803_408_430_5e-6 / 30.0_f64.sqrt();
        assert!(((interval.upper - interval.value) / half - 1.0).abs() < 1e-8, "{interval:?}");
        assert!(replications(&rates[..29], 1000, 0.05).is_err());
    }
}
