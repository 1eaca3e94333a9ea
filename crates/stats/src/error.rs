//! What can be wrong with a question put to this crate.

use thiserror::Error;

use crate::Method;

/// Why no number is given. The messages are fragments that follow "failed to".
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StatsError {
    /// A probability, level or margin is outside its open interval.
    #[error("use {name} = {value}: it must lie between {low} and {high}, both excluded")]
    OutOfRange {
        /// Which parameter.
        name: &'static str,
        /// What was given.
        value: f64,
        /// Excluded lower end.
        low: f64,
        /// Excluded upper end.
        high: f64,
    },
    /// More events than trials, or no trial at all.
    #[error("take {k} events in {n} trials: there must be a trial and no more events than trials")]
    Counts {
        /// Events.
        k: u64,
        /// Trials.
        n: u64,
    },
    /// A weight or value of a sample is outside its declared range.
    #[error("take sample {index} with {name} = {value}: it must lie in [{low}, {high}]")]
    Sample {
        /// Position in the slice, from 0.
        index: usize,
        /// Which quantity.
        name: &'static str,
        /// What was given.
        value: f64,
        /// Included lower end.
        low: f64,
        /// Included upper end.
        high: f64,
    },
    /// Not a number where one is needed.
    #[error("take {name} = {value}: it is not a number")]
    NotANumber {
        /// Which quantity.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// Too little data for the method to say anything.
    #[error("compute {what}: {need}")]
    TooFew {
        /// Which result.
        what: &'static str,
        /// What would be enough.
        need: &'static str,
    },
    /// Two histograms with different bins were added.
    #[error("merge histograms: their bins differ")]
    BinsDiffer,
    /// An interval that is approximate was offered as a claim.
    #[error(
        "use a {method} interval as a claim: it is approximate and for display only; \
         use an exact or betting bound"
    )]
    Approximate {
        /// The method that was offered.
        method: Method,
    },
}

/// Checks that `value` lies strictly between 0 and 1.
pub(crate) fn check_unit(name: &'static str, value: f64) -> Result<(), StatsError> {
    check_open(name, value, 0.0, 1.0)
}

/// Checks that `value` lies strictly between `low` and `high`.
pub(crate) fn check_open(
    name: &'static str,
    value: f64,
    low: f64,
    high: f64,
) -> Result<(), StatsError> {
    if value > low && value < high {
        Ok(())
    } else {
        Err(StatsError::OutOfRange { name, value, low, high })
    }
}

/// Checks that there is a trial and that the events fit into the trials.
pub(crate) fn check_counts(k: u64, n: u64) -> Result<(), StatsError> {
    if n > 0 && k <= n { Ok(()) } else { Err(StatsError::Counts { k, n }) }
}
