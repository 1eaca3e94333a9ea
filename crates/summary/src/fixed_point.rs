//! Sums of weights that do not depend on the order of addition.

use serde::{Deserialize, Serialize};

/// A sum of numbers that are not negative, in units of 2^-64. Each number is rounded once, when it
/// is added; the sum itself is exact, so parts add up to the whole bit for bit. It holds up to
/// 2^64 in all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct FixedSum(u128);

const ONE: f64 = 18_446_744_073_709_551_616.0;

impl FixedSum {
    /// Adds a number. What is not a number, or below zero, adds nothing; what is too large ends at
    /// the largest sum.
    pub fn add(&mut self, value: f64) {
        // `as` saturates at both ends and takes NaN to 0.
        self.0 = self.0.saturating_add((value * ONE) as u128);
    }

    /// Adds another sum.
    pub fn merge(&mut self, other: Self) {
        self.0 = self.0.saturating_add(other.0);
    }

    /// The sum, rounded to the nearest number.
    pub fn value(self) -> f64 {
        self.0 as f64 / ONE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn weights_of_one_are_counted_exactly() {
        let mut sum = FixedSum::default();
        (0..1000).for_each(|_| sum.add(1.0));
        assert_eq!(sum.value().to_bits(), 1000f64.to_bits());
        sum.add(f64::NAN);
        sum.add(-3.0);
        assert_eq!(sum.value().to_bits(), 1000f64.to_bits());
    }

    proptest! {
        #[test]
        fn order_does_not_matter(mut values in prop::collection::vec(0.0..1e6_f64, 0..50)) {
            let sum = |values: &[f64]| {
                let mut sum = FixedSum::default();
                values.iter().for_each(|&value| sum.add(value));
                sum
            };
            let forward = sum(&values);
            let plain: f64 = values.iter().sum();
            prop_assert!((forward.value() - plain).abs() <= 1e-9 * plain.max(1.0));
            values.reverse();
            prop_assert_eq!(sum(&values), forward);
        }
    }
}
