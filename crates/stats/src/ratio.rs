//! Risk ratio, unresolved and induced risk: what the planner removed, left and caused.
//!
//! For encounter i with weight w, y = event with the planner, z = event on the nominal track
//! (same randomness): RR = sum w y / sum w z = unresolved + induced, unresolved = sum w y z /
//! sum w z, induced = sum w y (1 - z) / sum w z. The delta interval carries the denominator's
//! variance and covariance: r_i = w_i (x_i - R z_i), se = sqrt(n / (n - 1) sum r^2) / sum w z.
//! Below about 20 events with the planner no delta interval is honest (measured coverage .84 to
//! .88 of .95); the exact and the betting bounds are. Source: statistics specification, section 2.

use serde::{Deserialize, Serialize};

use crate::binomial::{clopper_pearson_lower, clopper_pearson_upper};
use crate::eprocess::Stakes;
use crate::error::{StatsError, check_open, check_unit};
use crate::math::{exp, ln, log1p, real, root};
use crate::special::normal_quantile;
use crate::weighted::check_weights;
use crate::{Estimate, Method};

/// Unweighted encounters by what the planner did to them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RiskCounts {
    /// Event with and without the planner (y z).
    pub unresolved: u64,
    /// Event with the planner only (y (1 - z)).
    pub induced: u64,
    /// Event without the planner only ((1 - y) z).
    pub removed: u64,
    /// No event.
    pub neither: u64,
}

impl RiskCounts {
    /// All encounters.
    #[must_use]
    pub fn n(&self) -> u64 {
        self.unresolved + self.induced + self.removed + self.neither
    }

    /// Events on the nominal track.
    #[must_use]
    pub fn nominal(&self) -> u64 {
        self.unresolved + self.removed
    }
}

/// Which of the three ratios.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RiskPart {
    /// RR: every event with the planner.
    Total,
    /// Events that the planner left.
    Unresolved,
    /// Events that the planner caused.
    Induced,
}

/// Sums over encounters, from which all three ratios and their variances follow. Fed and merged
/// in id order.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct RiskSums {
    n: u64,
    weight: f64,
    weight_squared: f64,
    /// Sum of w and of w^2 over unresolved, induced and removed encounters.
    parts: [[f64; 2]; 3],
}

impl RiskSums {
    /// Adds an encounter.
    ///
    /// # Errors
    /// A weight that is negative or not finite.
    pub fn add(
        &mut self,
        weight: f64,
        planner_event: bool,
        nominal_event: bool,
    ) -> Result<(), StatsError> {
        check_weights(std::iter::once(weight), "weight", f64::MAX)?;
        self.n += 1;
        self.weight += weight;
        self.weight_squared += weight * weight;
        let part = match (planner_event, nominal_event) {
            (true, true) => 0,
            (true, false) => 1,
            (false, true) => 2,
            (false, false) => return Ok(()),
        };
        self.parts[part][0] += weight;
        self.parts[part][1] += weight * weight;
        Ok(())
    }

    /// The sums of unweighted encounters.
    #[must_use]
    pub fn from_counts(counts: &RiskCounts) -> Self {
        let n = counts.n();
        let part = |count| [real(count), real(count)];
        Self {
            n,
            weight: real(n),
            weight_squared: real(n),
            parts: [part(counts.unresolved), part(counts.induced), part(counts.removed)],
        }
    }

    /// Adds the sums of the encounters that follow.
    pub fn merge(&mut self, next: &Self) {
        self.n += next.n;
        self.weight += next.weight;
        self.weight_squared += next.weight_squared;
        for (part, more) in self.parts.iter_mut().zip(&next.parts) {
            part[0] += more[0];
            part[1] += more[1];
        }
    }

    /// Delta interval R +- z se, full covariance. For display only.
    ///
    /// # Errors
    /// Fewer than two encounters, no nominal event, or `alpha` outside (0, 1).
    pub fn delta(&self, part: RiskPart, alpha: f64) -> Result<Estimate, StatsError> {
        let (value, error) = self.value_and_error(part)?;
        let half = -normal_quantile(0.5 * alpha)? * error;
        Ok(self.estimate(value, (value - half).max(0.0), value + half, Method::Delta))
    }

    /// Delta interval on the logarithm, R exp(+- z se / R). For display only.
    ///
    /// # Errors
    /// As [`RiskSums::delta`], or a ratio of 0, about which the logarithm says nothing.
    pub fn log_delta(&self, part: RiskPart, alpha: f64) -> Result<Estimate, StatsError> {
        let (value, error) = self.value_and_error(part)?;
        if value <= 0.0 {
            return Err(StatsError::TooFew {
                what: "a log-delta interval",
                need: "one event with the planner; use the exact ratio bound",
            });
        }
        let factor = exp(-normal_quantile(0.5 * alpha)? * error / value);
        Ok(self.estimate(value, value / factor, value * factor, Method::LogDelta))
    }

    fn estimate(&self, value: f64, lower: f64, upper: f64, method: Method) -> Estimate {
        let n_effective = self.weight * self.weight / self.weight_squared;
        Estimate { value, lower, upper, n: self.n, n_effective, method }
    }

    fn value_and_error(&self, part: RiskPart) -> Result<(f64, f64), StatsError> {
        let [unresolved, induced, removed] = self.parts;
        let nominal = unresolved[0] + removed[0];
        if self.n < 2 || nominal <= 0.0 {
            return Err(StatsError::TooFew {
                what: "a risk ratio",
                need: "two encounters and one event on the nominal track",
            });
        }
        // x for unresolved and induced encounters; a removed one has x = 0 and z = 1.
        let (x_unresolved, x_induced) = match part {
            RiskPart::Total => (1.0, 1.0),
            RiskPart::Unresolved => (1.0, 0.0),
            RiskPart::Induced => (0.0, 1.0),
        };
        let ratio = (x_unresolved * unresolved[0] + x_induced * induced[0]) / nominal;
        let off = x_unresolved - ratio;
        let squares =
            off * off * unresolved[1] + x_induced * induced[1] + ratio * ratio * removed[1];
        let n = real(self.n);
        Ok((ratio, (n / (n - 1.0) * squares).sqrt() / nominal))
    }
}

/// Exact two-sided bounds of the risk ratio at confidence 1 - `alpha` for unweighted encounters:
/// U = U_CP(unresolved | n_z) + U_CP(induced | N) / L_CP(z | N), each at a third of the side's
/// level (union bound), and the mirror image for L.
///
/// # Errors
/// No event on the nominal track (the ratio is then unbounded), or `alpha` outside (0, 1).
pub fn exact_ratio(counts: &RiskCounts, alpha: f64) -> Result<Estimate, StatsError> {
    let upper = exact_ratio_upper(counts, 0.5 * alpha)?;
    let third = alpha / 6.0;
    let (n, nominal) = (counts.n(), counts.nominal());
    let lower = clopper_pearson_lower(counts.unresolved, nominal, third)?
        + clopper_pearson_lower(counts.induced, n, third)?
            / clopper_pearson_upper(nominal, n, third)?;
    let value = real(counts.unresolved + counts.induced) / real(nominal);
    Ok(Estimate { value, lower, upper, n, n_effective: real(n), method: Method::ExactRatio })
}

/// The one-sided upper bound of [`exact_ratio`] at confidence 1 - `alpha`.
///
/// # Errors
/// As [`exact_ratio`].
pub fn exact_ratio_upper(counts: &RiskCounts, alpha: f64) -> Result<f64, StatsError> {
    check_unit("alpha", alpha)?;
    let (n, nominal) = (counts.n(), counts.nominal());
    if nominal == 0 {
        return Err(no_nominal_event());
    }
    let third = alpha / 3.0;
    Ok(clopper_pearson_upper(counts.unresolved, nominal, third)?
        + clopper_pearson_upper(counts.induced, n, third)?
            / clopper_pearson_lower(nominal, n, third)?)
}

/// Encounters with the same weight and outcome, at least one of the two events having happened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RiskEvent {
    /// w, within [0, weight_max].
    pub weight: f64,
    /// Event with the planner (y).
    pub planner: bool,
    /// Event on the nominal track (z).
    pub nominal: bool,
    /// How many such encounters.
    pub count: u64,
}

impl RiskEvent {
    /// The three kinds of unweighted encounters that matter.
    #[must_use]
    pub fn from_counts(counts: &RiskCounts) -> [Self; 3] {
        let event = |planner, nominal, count| Self { weight: 1.0, planner, nominal, count };
        [
            event(true, true, counts.unresolved),
            event(true, false, counts.induced),
            event(false, true, counts.removed),
        ]
    }
}

/// Betting bounds of the risk ratio at confidence 1 - `alpha`, weighted or not, at any stopping
/// time: X_i = w_i (y_i - R z_i) / w_max, E_R = sum_j pi_j prod (1 - l_j X_i); U is the smallest R
/// with E_R >= 2/a, L the largest refuted from below with X_i / max(1, R) and the other sign.
/// `n` counts all encounters, those without any event included.
///
/// # Errors
/// A weight outside [0, `weight_max`], too little nominal risk for an upper bound, or levels out
/// of range.
pub fn betting_ratio(
    events: &[RiskEvent],
    weight_max: f64,
    n: u64,
    alpha: f64,
) -> Result<Estimate, StatsError> {
    check_unit("alpha", alpha)?;
    let upper = betting_ratio_upper(events, weight_max, 0.5 * alpha)?;
    let lower = betting_ratio_lower(events, weight_max, 0.5 * alpha)?;
    let sum = |of: fn(&RiskEvent) -> bool| -> f64 {
        events.iter().filter(|e| of(e)).map(|e| e.weight * real(e.count)).sum()
    };
    let value = sum(|e| e.planner) / sum(|e| e.nominal);
    let squares: f64 = events.iter().map(|e| e.weight * e.weight * real(e.count)).sum();
    let total = sum(|_| true);
    let n_effective = total * total / squares;
    Ok(Estimate { value, lower, upper, n, n_effective, method: Method::Betting })
}

/// The one-sided upper bound of [`betting_ratio`] at confidence 1 - `alpha`.
///
/// # Errors
/// As [`betting_ratio`].
pub fn betting_ratio_upper(
    events: &[RiskEvent],
    weight_max: f64,
    alpha: f64,
) -> Result<f64, StatsError> {
    check_unit("alpha", alpha)?;
    check_open("weight_max", weight_max, 0.0, f64::INFINITY)?;
    check_weights(events.iter().map(|event| event.weight), "weight", weight_max)?;
    let ln_level = -ln(alpha);
    let over = |ratio: f64| ln_e_ratio(events, weight_max, ratio, -1.0) - ln_level;
    let (mut low, mut high) = (0.0, 1.0);
    while over(high) < 0.0 {
        (low, high) = (high, 2.0 * high);
        if high > 1e12 {
            return Err(no_nominal_event());
        }
    }
    Ok(root(low, high, over).1)
}

/// The one-sided lower bound of [`betting_ratio`] at confidence 1 - `alpha`; 0 where nothing is
/// refuted.
///
/// # Errors
/// As [`betting_ratio`], but for nominal risk: without any there is still a lower bound.
pub fn betting_ratio_lower(
    events: &[RiskEvent],
    weight_max: f64,
    alpha: f64,
) -> Result<f64, StatsError> {
    check_unit("alpha", alpha)?;
    check_open("weight_max", weight_max, 0.0, f64::INFINITY)?;
    check_weights(events.iter().map(|event| event.weight), "weight", weight_max)?;
    let ln_level = -ln(alpha);
    let short = |ratio: f64| ln_level - ln_e_ratio(events, weight_max, ratio, ratio.max(1.0));
    if short(0.0) >= 0.0 {
        return Ok(0.0);
    }
    // with R each bet shrinks to nothing, so some R is kept
    let (mut low, mut high) = (0.0, 1.0);
    while short(high) < 0.0 {
        (low, high) = (high, 2.0 * high);
    }
    Ok(root(low, high, short).0)
}

/// ln E_R with stakes on X_i / `scale`: a negative scale of -1 bets that RR is below R, a
/// positive one that it is above.
fn ln_e_ratio(events: &[RiskEvent], weight_max: f64, ratio: f64, scale: f64) -> f64 {
    Stakes::declared(1.0, 0.5).ln_mixture(|stake| {
        let each = events.iter().filter(|event| event.count > 0).map(|event| {
            let (y, z) = (f64::from(u8::from(event.planner)), f64::from(u8::from(event.nominal)));
            let x = event.weight / weight_max * (y - ratio * z);
            real(event.count) * log1p(stake * x / scale)
        });
        each.sum()
    })
}

fn no_nominal_event() -> StatsError {
    StatsError::TooFew { what: "a bound of the risk ratio", need: "events on the nominal track" }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNTS: RiskCounts =
        RiskCounts { unresolved: 40, induced: 10, removed: 360, neither: 19_590 };

    #[test]
    fn parts_add_up_and_weight_one_is_no_weight() {
        let sums = RiskSums::from_counts(&COUNTS);
        let value = |part| sums.delta(part, 0.05).unwrap().value;
        assert!((value(RiskPart::Total) - 0.125).abs() < 1e-15);
        let parts = value(RiskPart::Unresolved) + value(RiskPart::Induced);
        assert!((value(RiskPart::Total) - parts).abs() < 1e-15);
        let mut fed = RiskSums::default();
        for (count, y, z) in
            [(40, true, true), (10, true, false), (360, false, true), (19_590, false, false)]
        {
            for _ in 0..count {
                fed.add(1.0, y, z).unwrap();
            }
        }
        assert_eq!(fed, sums);
        assert!(fed.add(-1.0, true, true).is_err());
    }

    /// se worked from its definition: sum r^2 = 40 (7/8)^2 + 10 + 360 / 64 = 46.25.
    #[test]
    fn standard_error_has_the_full_covariance() {
        let sums = RiskSums::from_counts(&COUNTS);
        let interval = sums.delta(RiskPart::Total, 0.05).unwrap();
        let error = (20_000.0 / 19_999.0 * 46.25_f64).sqrt() / 400.0;
        assert!((interval.upper - 0.125 - 1.959_963_984_540_054 * error).abs() < 1e-12);
        let log = sums.log_delta(RiskPart::Total, 0.05).unwrap();
        assert!((log.upper * log.lower - 0.125 * 0.125).abs() < 1e-12);
    }

    /// Medians of U / RR: 1.48 by betting and 1.51 by three exact bounds (section 2, row 1); the
    /// expected counts must come near both.
    #[test]
    fn betting_is_tighter_than_three_exact_bounds() {
        let events = RiskEvent::from_counts(&COUNTS);
        let betting = betting_ratio_upper(&events, 1.0, 0.05).unwrap() / 0.125;
        let exact = exact_ratio_upper(&COUNTS, 0.05).unwrap() / 0.125;
        assert!(betting < exact, "{betting} {exact}");
        assert!((betting - 1.48).abs() < 0.04, "{betting}");
        assert!((exact - 1.51).abs() < 0.04, "{exact}");
    }

    #[test]
    fn lower_bounds_stay_below_and_work_above_one() {
        let harmful = RiskCounts { unresolved: 90, induced: 300, removed: 10, neither: 9_600 };
        let events = RiskEvent::from_counts(&harmful);
        for interval in [
            betting_ratio(&events, 1.0, 10_000, 0.05).unwrap(),
            exact_ratio(&harmful, 0.05).unwrap(),
        ] {
            assert!(interval.lower > 2.0 && interval.lower < 3.9, "{interval:?}");
            assert!(interval.upper > 3.9 && interval.upper < 6.5, "{interval:?}");
        }
    }

    #[test]
    fn without_nominal_events_there_is_no_bound() {
        let none = RiskCounts { unresolved: 0, induced: 3, removed: 0, neither: 100 };
        assert_eq!(exact_ratio(&none, 0.05), Err(no_nominal_event()));
        let events = RiskEvent::from_counts(&none);
        assert_eq!(betting_ratio(&events, 1.0, 103, 0.05), Err(no_nominal_event()));
        assert!(RiskSums::from_counts(&none).delta(RiskPart::Total, 0.05).is_err());
    }
}
