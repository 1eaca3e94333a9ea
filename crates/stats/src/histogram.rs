//! Integer histograms of fixed bins whose parts add up to the whole.
//!
//! Closest distances (0.1 m) and times (0.1 s) of a campaign are kept as counts in bins, never as
//! samples: memory does not grow with the number of encounters, and merging the histograms of any
//! partition of the encounters, in any order, gives the histogram of all of them, bit for bit.
//!
//! Quantile: the q-quantile is the value of rank max(1, ceil(q N)) in increasing order (the
//! inverse of the empirical distribution, Hyndman and Fan's type 1), N counting every value that
//! was added, the censored ones last. It is reported as the *lower edge* of its bin: the true one
//! lies less than one bin width above. Censored values (something that never happened) rank above
//! everything; a quantile that falls there has no number.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::StatsError;
use crate::binomial::{binomial_lower_tail, binomial_upper_tail};
use crate::error::check_unit;
use crate::math::real;

/// The fixed bins [i, i + 1) / `per_unit` for i from `first` to `first + count - 1`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bins {
    /// Bins per metre or second; an integer, so that bin edges are decimal numbers.
    pub per_unit: u32,
    /// Index of the lowest bin; below zero for signed quantities.
    pub first: i64,
    /// How many bins; values above them are counted together.
    pub count: u32,
}

impl Bins {
    /// Bins of 0.1 from 0 to `end` (metres or seconds).
    #[must_use]
    pub fn tenths_up_to(end: u32) -> Self {
        Self { per_unit: 10, first: 0, count: end.saturating_mul(10) }
    }

    fn lower_edge(&self, bin: u32) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "bin indices stay below 2^53")]
        let index = (self.first + i64::from(bin)) as f64;
        index / f64::from(self.per_unit)
    }
}

/// Counts of values in fixed bins, with those below, above and never reached.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Histogram {
    bins: Bins,
    counts: BTreeMap<u32, u64>,
    below: u64,
    above: u64,
    censored: u64,
}

/// Where a quantile (or the largest value) lies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "at", content = "value")]
pub enum QuantileValue {
    /// No value was added.
    Empty,
    /// Below the lowest bin.
    Below,
    /// In the bin with this lower edge, in the histogram's unit.
    Bin(f64),
    /// Above the highest bin.
    Above,
    /// Among the values that were never reached.
    Censored,
}

impl QuantileValue {
    /// The number to print, or none when the histogram has none.
    #[must_use]
    pub fn number(self) -> Option<f64> {
        match self {
            Self::Bin(value) => Some(value),
            Self::Empty | Self::Below | Self::Above | Self::Censored => None,
        }
    }
}

impl Histogram {
    /// An empty histogram over `bins`.
    #[must_use]
    pub fn new(bins: Bins) -> Self {
        Self { bins, counts: BTreeMap::new(), below: 0, above: 0, censored: 0 }
    }

    /// Adds a value in the histogram's unit. Plus infinity counts as censored.
    ///
    /// # Errors
    /// NaN and minus infinity are not values.
    pub fn add(&mut self, value: f64) -> Result<(), StatsError> {
        if value.is_nan() || value == f64::NEG_INFINITY {
            return Err(StatsError::NotANumber { name: "histogram value", value });
        }
        if value == f64::INFINITY {
            self.add_censored();
            return Ok(());
        }
        // For a value written with one decimal, value * 10 rounds back to the integer.
        let index = (value * f64::from(self.bins.per_unit)).floor();
        #[expect(clippy::cast_precision_loss, reason = "bin indices stay below 2^53")]
        let offset = index - self.bins.first as f64;
        if offset < 0.0 {
            self.below += 1;
        } else if offset >= f64::from(self.bins.count) {
            self.above += 1;
        } else {
            *self.counts.entry(offset as u32).or_insert(0) += 1;
        }
        Ok(())
    }

    /// Adds a value that was never reached: it ranks above every number.
    pub fn add_censored(&mut self) {
        self.censored += 1;
    }

    /// Adds every value of another histogram over the same bins.
    ///
    /// # Errors
    /// [`StatsError::BinsDiffer`].
    pub fn merge(&mut self, other: &Self) -> Result<(), StatsError> {
        if self.bins != other.bins {
            return Err(StatsError::BinsDiffer);
        }
        for (&bin, &count) in &other.counts {
            *self.counts.entry(bin).or_insert(0) += count;
        }
        self.below += other.below;
        self.above += other.above;
        self.censored += other.censored;
        Ok(())
    }

    /// The bins.
    #[must_use]
    pub fn bins(&self) -> Bins {
        self.bins
    }

    /// Values added, of every kind.
    #[must_use]
    pub fn n(&self) -> u64 {
        self.below + self.counts.values().sum::<u64>() + self.above + self.censored
    }

    /// Values below the lowest bin.
    #[must_use]
    pub fn below(&self) -> u64 {
        self.below
    }

    /// Values above the highest bin.
    #[must_use]
    pub fn above(&self) -> u64 {
        self.above
    }

    /// Values that were never reached.
    #[must_use]
    pub fn censored(&self) -> u64 {
        self.censored
    }

    /// The occupied bins in increasing order: (lower edge, count).
    pub fn occupied(&self) -> impl Iterator<Item = (f64, u64)> + '_ {
        self.counts.iter().map(|(&bin, &count)| (self.bins.lower_edge(bin), count))
    }

    /// The quantile at `permille` / 1000: 10 for the first percentile, 500 for the median. In
    /// whole thousandths, so that the rank is exact.
    #[must_use]
    pub fn quantile_permille(&self, permille: u32) -> QuantileValue {
        let n = self.n();
        let rank = (u128::from(n) * u128::from(permille.min(1000))).div_ceil(1000).max(1);
        self.at_rank(u64::try_from(rank).unwrap_or(u64::MAX))
    }

    /// The largest value.
    #[must_use]
    pub fn largest(&self) -> QuantileValue {
        self.at_rank(self.n())
    }

    /// The value of a rank, from 1 (the smallest) to n.
    #[must_use]
    pub fn at_rank(&self, rank: u64) -> QuantileValue {
        if self.n() == 0 {
            return QuantileValue::Empty;
        }
        let mut seen = self.below;
        if rank <= seen {
            return QuantileValue::Below;
        }
        for (&bin, &count) in &self.counts {
            seen += count;
            if rank <= seen {
                return QuantileValue::Bin(self.bins.lower_edge(bin));
            }
        }
        if rank <= seen + self.above { QuantileValue::Above } else { QuantileValue::Censored }
    }
}

/// Ranks (l, u) of the order statistics that enclose the q-quantile with confidence at least
/// 1 - `alpha` whatever the distribution: P(X_(l) <= x_q) and P(x_q <= X_(u)) are each at least
/// 1 - alpha/2. `None` where no order statistic is far enough out.
/// Source: statistics specification, section 4.5 (exact order-statistic bounds).
///
/// # Errors
/// `q` or `alpha` outside (0, 1).
pub fn quantile_rank_bounds(
    n: u64,
    q: f64,
    alpha: f64,
) -> Result<(Option<u64>, Option<u64>), StatsError> {
    check_unit("q", q)?;
    check_unit("alpha", alpha)?;
    if n == 0 {
        return Ok((None, None));
    }
    // X_(l) > x_q needs fewer than l values at or below x_q: P(Bin(n, q) <= l - 1) <= alpha/2.
    let lower_ok = |l: u64| binomial_lower_tail(l - 1, n, q).map(|p| p <= 0.5 * alpha);
    // X_(u) < x_q needs at least u values below x_q: P(Bin(n, q) >= u) <= alpha/2.
    let upper_ok = |u: u64| binomial_upper_tail(u, n, q).map(|p| p <= 0.5 * alpha);
    let lower = if lower_ok(1)? {
        let (mut good, mut bad) = (1, n + 1);
        while bad - good > 1 {
            let middle = good + (bad - good) / 2;
            if lower_ok(middle)? { good = middle } else { bad = middle }
        }
        Some(good)
    } else {
        None
    };
    let upper = if upper_ok(n)? {
        let (mut bad, mut good) = (0, n);
        while good - bad > 1 {
            let middle = bad + (good - bad) / 2;
            if upper_ok(middle)? { good = middle } else { bad = middle }
        }
        Some(good)
    } else {
        None
    };
    debug_assert!(lower.is_none_or(|l| real(l) <= real(n)));
    Ok((lower, upper))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn filled(values: &[f64]) -> Histogram {
        let mut histogram = Histogram::new(Bins::tenths_up_to(100));
        for &value in values {
            histogram.add(value).unwrap();
        }
        histogram
    }

    #[test]
    fn decimal_values_come_back_exactly() {
        let mut histogram = Histogram::new(Bins::tenths_up_to(300_000));
        for tenth in 0..2_000_000_u32 {
            histogram.add(f64::from(tenth) / 10.0).unwrap();
        }
        assert!(histogram.occupied().all(|(_, count)| count == 1));
        assert_eq!(histogram.quantile_permille(500), QuantileValue::Bin(99_999.9));
    }

    #[test]
    fn quantiles_are_null_in_the_censored_part() {
        let mut histogram = filled(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
        histogram.add_censored();
        assert_eq!(histogram.quantile_permille(500).number(), Some(5.0));
        assert_eq!(histogram.quantile_permille(900).number(), Some(9.0));
        assert_eq!(histogram.quantile_permille(950), QuantileValue::Censored);
        assert_eq!(histogram.largest().number(), None);
        assert_eq!(filled(&[]).quantile_permille(500), QuantileValue::Empty);
    }

    #[test]
    fn the_ends_are_named() {
        let histogram = filled(&[-0.1, 50.0, 100.0]);
        assert_eq!((histogram.below(), histogram.above()), (1, 1));
        assert_eq!(histogram.at_rank(1), QuantileValue::Below);
        assert_eq!(histogram.at_rank(3), QuantileValue::Above);
        let mut histogram = histogram;
        assert!(histogram.add(f64::NAN).is_err());
        assert!(histogram.add(f64::NEG_INFINITY).is_err());
        assert_eq!(histogram.n(), 3);
    }

    #[test]
    fn other_bins_do_not_merge() {
        let mut histogram = Histogram::new(Bins::tenths_up_to(10));
        let other = Histogram::new(Bins::tenths_up_to(20));
        assert_eq!(histogram.merge(&other), Err(StatsError::BinsDiffer));
    }

    /// Hahn and Meeker's classic case: the median of 10 values lies between the 2nd and the 9th
    /// with confidence 0.979.
    #[test]
    fn median_of_ten_is_enclosed_by_the_second_and_ninth() {
        assert_eq!(quantile_rank_bounds(10, 0.5, 0.05).unwrap(), (Some(2), Some(9)));
        assert_eq!(quantile_rank_bounds(4, 0.5, 0.05).unwrap(), (None, None));
    }

    proptest! {
        #[test]
        fn merging_parts_equals_one_whole(
            values in prop::collection::vec((-5.0..120.0_f64, any::<bool>(), 0_usize..4), 0..200),
        ) {
            let bins = Bins { per_unit: 10, first: -20, count: 1000 };
            let mut whole = Histogram::new(bins);
            let mut parts = vec![Histogram::new(bins); 4];
            for &(value, never, part) in &values {
                for histogram in [&mut whole, &mut parts[part]] {
                    if never { histogram.add_censored() } else { histogram.add(value).unwrap() }
                }
            }
            let mut merged = Histogram::new(bins);
            for part in parts.iter().rev() {
                merged.merge(part).unwrap();
            }
            prop_assert_eq!(merged, whole);
        }

        #[test]
        fn a_quantile_is_the_sorted_sample_floored_to_its_bin(
            mut values in prop::collection::vec(0.0..99.0_f64, 1..100),
            permille in 1_u32..=1000,
        ) {
            let histogram = filled(&values);
            values.sort_by(f64::total_cmp);
            let rank = (values.len() * permille as usize).div_ceil(1000);
            let quantile = histogram.quantile_permille(permille).number().unwrap();
            let sample = values[rank - 1];
            prop_assert!(quantile <= sample && sample < quantile + 0.1 + 1e-9);
        }
    }
}
