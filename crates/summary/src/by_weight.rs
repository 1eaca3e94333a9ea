//! Counts by the size of the importance weight: integers that add up like all others, from which
//! weighted rates and their bounds are made.

use crate::PairedCounts;
use record::{Check, RunRow, Status};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Bits of the fraction of a weight that its bin keeps: 256 bins in each doubling, so a bin is at
/// most 1/256 of its weight wide and its middle at most 1/512 (0.2 %) from any weight in it. A rate
/// made of the middles is that close to the rate of the weights, and a bound made of the ends
/// holds.
const FRACTION_BITS: u32 = 8;
const DROPPED_BITS: u32 = f64::MANTISSA_DIGITS - 1 - FRACTION_BITS;

/// A bin of weights: the leading bits of the number, which rise with it. No logarithm is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct WeightBin(u32);

impl WeightBin {
    /// The bin of a weight; what is not a number, or below zero, is as zero.
    pub fn new(weight: f64) -> Self {
        let bits = if weight > 0.0 { weight.to_bits() } else { 0 };
        Self((bits >> DROPPED_BITS) as u32)
    }

    /// The least weight in it.
    pub fn low(self) -> f64 {
        f64::from_bits(u64::from(self.0) << DROPPED_BITS)
    }

    /// Above every weight in it.
    pub fn high(self) -> f64 {
        Self(self.0 + 1).low()
    }

    /// Its middle.
    pub fn middle(self) -> f64 {
        0.5 * (self.low() + self.high())
    }
}

/// The counts of each bin that has any run.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ByWeight(BTreeMap<WeightBin, WeightCounts>);

/// The headline events of some runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct EventCounts {
    /// Own ship hit a target.
    pub collisions: u64,
    /// The safety radius was broken.
    pub breaches: u64,
    /// Unknown runs that did not collide before.
    pub unknown_without_collision: u64,
    /// Unknown runs that had not broken the safety radius before.
    pub unknown_without_breach: u64,
}

impl EventCounts {
    pub(crate) fn add(&mut self, row: &RunRow) {
        let (collided, breach) = (row.collided(), row.safety_radius_broken);
        self.collisions += u64::from(collided);
        self.breaches += u64::from(breach);
        self.unknown_without_collision += u64::from(row.unknown && !collided);
        self.unknown_without_breach += u64::from(row.unknown && !breach);
    }

    pub(crate) fn merge(&mut self, other: &Self) {
        self.collisions += other.collisions;
        self.breaches += other.breaches;
        self.unknown_without_collision += other.unknown_without_collision;
        self.unknown_without_breach += other.unknown_without_breach;
    }
}

/// What is counted of the runs whose weights lie in one bin.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct WeightCounts {
    /// Rows.
    pub n: u64,
    /// Runs that collided, that broke the safety radius, and the unknown ones of each.
    pub events: EventCounts,
    /// Runs that no manoeuvre of own ship could have cleared.
    pub unavoidable: u64,
    /// What of `events` were such runs.
    pub unavoidable_events: EventCounts,
    /// Collisions without and with avoiding.
    pub collision_pairs: PairedCounts,
    /// Breaches of the safety radius without and with avoiding.
    pub safety_radius_pairs: PairedCounts,
    /// Runs by check and status, in the order of `Check::ALL` and of `Status::ALL`.
    checks: Vec<[u64; Status::ALL.len()]>,
}

impl ByWeight {
    /// Adds one run, and its pairs as the tally has found them.
    pub(crate) fn add(&mut self, row: &RunRow, collision: Pair, safety_radius: Pair) {
        let counts = self.0.entry(WeightBin::new(row.weight)).or_default();
        counts.n += 1;
        counts.events.add(row);
        if row.unavoidable == Some(true) {
            counts.unavoidable += 1;
            counts.unavoidable_events.add(row);
        }
        counts.collision_pairs.add(collision.0, collision.1);
        counts.safety_radius_pairs.add(safety_radius.0, safety_radius.1);
        counts.checks.resize(Check::COUNT, [0; Status::ALL.len()]);
        for check in Check::ALL {
            counts.checks[check as usize][row.check(check).status as usize] += 1;
        }
    }

    /// Adds the runs of another part.
    pub(crate) fn merge(&mut self, other: &Self) {
        for (&bin, add) in &other.0 {
            let counts = self.0.entry(bin).or_default();
            counts.n += add.n;
            counts.events.merge(&add.events);
            counts.unavoidable += add.unavoidable;
            counts.unavoidable_events.merge(&add.unavoidable_events);
            counts.collision_pairs.merge(&add.collision_pairs);
            counts.safety_radius_pairs.merge(&add.safety_radius_pairs);
            counts.checks.resize(Check::COUNT, [0; Status::ALL.len()]);
            for (sums, adds) in counts.checks.iter_mut().zip(&add.checks) {
                sums.iter_mut().zip(adds).for_each(|(sum, add)| *sum += add);
            }
        }
    }

    /// The bins that have any run, the smallest weight first.
    pub fn iter(&self) -> impl Iterator<Item = (WeightBin, &WeightCounts)> {
        self.0.iter().map(|(&bin, counts)| (bin, counts))
    }
}

/// The event without and with avoiding, as [`PairedCounts::add`] takes them.
pub(crate) type Pair = (Option<bool>, Option<bool>);

impl WeightCounts {
    /// Runs in which a check came to this status.
    pub fn check(&self, check: Check, status: Status) -> u64 {
        self.checks[check as usize][status as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_bin_holds_its_weight_and_is_narrow(weight in 1e-6..1e6_f64) {
            let bin = WeightBin::new(weight);
            prop_assert!(bin.low() <= weight && weight < bin.high());
            prop_assert!(bin.high() - bin.low() <= weight / 256.0);
            prop_assert!((bin.middle() - weight).abs() <= weight / 512.0);
            prop_assert_eq!(WeightBin::new(bin.low()), bin);
        }

        #[test]
        fn bins_rise_with_the_weight(a in 1e-6..1e6_f64, b in 1e-6..1e6_f64) {
            let (smaller, larger) = (a.min(b), a.max(b));
            prop_assert!(WeightBin::new(smaller) <= WeightBin::new(larger));
        }
    }

    #[test]
    fn no_weight_has_a_bin_of_its_own() {
        for weight in [0.0, -0.0, -1.0, f64::NAN] {
            assert_eq!(WeightBin::new(weight), WeightBin::new(0.0), "{weight}");
        }
        assert!(WeightBin::new(f64::MIN_POSITIVE) > WeightBin::new(0.0));
    }
}
