//! Reaction times: counted, early, never.

use record::Reaction;
use serde::{Deserialize, Serialize};
use stats::{Bins, Histogram};

/// Times from the onset of risk to an alteration, in bins of 0.1 s. Runs in which risk never
/// opened have nothing to react to and stand outside.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Times {
    /// Seconds. Early ones count as 0; those that never came, or had not come when the run was cut
    /// short, rank above every number.
    pub histogram: Histogram,
    /// Altered before risk opened.
    pub early: u64,
    /// Never altered, in a run that was long enough.
    pub never: u64,
    /// Had not altered when the run was cut short, or the planner failed.
    pub cut_short: u64,
    /// Risk never opened.
    pub no_risk: u64,
}

/// Longer than the longest run that a campaign allows (3 hours).
const END_S: u32 = 11_000;

impl Default for Times {
    fn default() -> Self {
        let histogram = Histogram::new(Bins::tenths_up_to(END_S));
        Self { histogram, early: 0, never: 0, cut_short: 0, no_risk: 0 }
    }
}

impl Times {
    /// Adds one run.
    pub fn add(&mut self, reaction: Reaction) {
        match reaction {
            Reaction::NoRisk => self.no_risk += 1,
            Reaction::Early => {
                self.early += 1;
                self.add_seconds(0.0);
            }
            Reaction::After(time_s) => self.add_seconds(time_s),
            Reaction::Never => {
                self.never += 1;
                self.histogram.add_censored();
            }
            Reaction::Unknown => {
                self.cut_short += 1;
                self.histogram.add_censored();
            }
        }
    }

    /// Adds the runs of another part.
    pub fn merge(&mut self, other: &Self) {
        self.histogram.merge(&other.histogram).expect("all time histograms have the same bins");
        self.early += other.early;
        self.never += other.never;
        self.cut_short += other.cut_short;
        self.no_risk += other.no_risk;
    }

    /// Runs in which risk opened.
    pub fn n(&self) -> u64 {
        self.histogram.n()
    }

    fn add_seconds(&mut self, time_s: f64) {
        self.histogram.add(time_s).expect("a reaction time is a number");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn those_that_never_acted_rank_last_and_early_ones_first() {
        let mut times = Times::default();
        for reaction in [
            Reaction::Never,
            Reaction::Early,
            Reaction::After(12.34),
            Reaction::Unknown,
            Reaction::NoRisk,
        ] {
            times.add(reaction);
        }
        assert_eq!((times.n(), times.early, times.never), (4, 1, 1));
        assert_eq!((times.cut_short, times.no_risk), (1, 1));
        assert_eq!(times.histogram.quantile_permille(250).number(), Some(0.0));
        assert_eq!(times.histogram.quantile_permille(500).number(), Some(12.3));
        assert_eq!(times.histogram.quantile_permille(501).number(), None);
    }
}
