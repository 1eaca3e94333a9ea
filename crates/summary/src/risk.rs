//! What avoiding changed: each encounter with and without it.

use serde::{Deserialize, Serialize};
use stats::RiskCounts;

/// Counts of the pairs (z, y): z, an event on the nominal track, where own ship does not avoid; y,
/// the same event in the run (statistics specification, section 2, risk ratio).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PairedCounts {
    /// Neither: nothing to avoid, nothing happened.
    pub neither: u64,
    /// z and not y: avoiding removed it.
    pub removed: u64,
    /// z and y: it was left.
    pub left: u64,
    /// y and not z: avoiding caused it.
    pub caused: u64,
    /// z, and y is unknown.
    pub unknown_with_nominal: u64,
    /// Not z, and y is unknown.
    pub unknown_only: u64,
    /// Runs without a nominal track; in none of the others.
    pub without_nominal: u64,
}

impl PairedCounts {
    /// Adds one run; `actual` is absent where the planner failed or the run was cut before.
    pub fn add(&mut self, nominal: Option<bool>, actual: Option<bool>) {
        let count = match (nominal, actual) {
            (None, _) => &mut self.without_nominal,
            (Some(false), Some(false)) => &mut self.neither,
            (Some(true), Some(false)) => &mut self.removed,
            (Some(true), Some(true)) => &mut self.left,
            (Some(false), Some(true)) => &mut self.caused,
            (Some(true), None) => &mut self.unknown_with_nominal,
            (Some(false), None) => &mut self.unknown_only,
        };
        *count += 1;
    }

    /// Adds other counts.
    pub fn merge(&mut self, other: &Self) {
        self.neither += other.neither;
        self.removed += other.removed;
        self.left += other.left;
        self.caused += other.caused;
        self.unknown_with_nominal += other.unknown_with_nominal;
        self.unknown_only += other.unknown_only;
        self.without_nominal += other.without_nominal;
    }

    /// As the four cells of an exact ratio, unknown runs counted as events or as none.
    pub fn resolved(&self, unknown_is_event: bool) -> RiskCounts {
        let (left, removed, caused, neither) = if unknown_is_event {
            (self.unknown_with_nominal, 0, self.unknown_only, 0)
        } else {
            (0, self.unknown_with_nominal, 0, self.unknown_only)
        };
        RiskCounts {
            unresolved: self.left + left,
            induced: self.caused + caused,
            removed: self.removed + removed,
            neither: self.neither + neither,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_has_its_count_and_unknown_ones_go_both_ways() {
        let mut counts = PairedCounts::default();
        let pairs = [
            (Some(true), Some(false), 6),
            (Some(true), Some(true), 2),
            (Some(false), Some(true), 1),
            (Some(false), Some(false), 4),
            (Some(true), None, 3),
            (Some(false), None, 5),
            (None, Some(true), 7),
        ];
        for (nominal, actual, times) in pairs {
            (0..times).for_each(|_| counts.add(nominal, actual));
        }
        assert_eq!((counts.removed, counts.left, counts.caused, counts.neither), (6, 2, 1, 4));
        assert_eq!(counts.without_nominal, 7);
        let cells = |c: RiskCounts| (c.unresolved, c.induced, c.removed, c.neither);
        assert_eq!(cells(counts.resolved(true)), (5, 6, 6, 4));
        assert_eq!(cells(counts.resolved(false)), (2, 1, 9, 9));
        assert_eq!(counts.resolved(true).nominal(), counts.resolved(false).nominal());
    }
}
