//! The form in which an estimate leaves this crate, and the line between a claim and a picture.
//!
//! A confidence interval is claim-bearing when its coverage is at least nominal whatever the
//! truth; every other one is for display. The difference is a type: the gate takes a [`Claim`],
//! and an approximate [`Estimate`] cannot become one. Source: statistics specification,
//! sections 2 and 4 (choice of method), 4.1 ("CP for every safety claim").

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::StatsError;

/// How an interval was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Exact binomial bounds at a declared n.
    ClopperPearson,
    /// U(n10) - L(n01) and its mirror: exact bounds of a paired difference at a declared n.
    ExactDifference,
    /// Three exact binomial bounds joined: the risk ratio when events are few.
    ExactRatio,
    /// Betting bound with a declared mixture, weighted or not.
    Betting,
    /// Confidence sequence: right at every stopping time.
    ConfidenceSequence,
    /// Exact Poisson interval of last-particle splitting (ideal sampling).
    LastParticle,
    /// Wilson's score interval.
    Wilson,
    /// Jeffreys' interval.
    Jeffreys,
    /// Tango's score interval for a paired difference.
    Tango,
    /// Delta method with the full covariance.
    Delta,
    /// Delta method on the logarithm.
    LogDelta,
    /// Bias-corrected and accelerated bootstrap.
    Bca,
    /// Fay and Feuer's gamma interval for weighted counts.
    FayFeuer,
    /// Student's t over independent replications.
    Replications,
}

impl Method {
    /// Whether coverage is at least nominal whatever the truth. [`Method::LastParticle`] is not:
    /// its proof needs ideal sampling, which no real chain gives.
    #[must_use]
    pub fn is_claim_bearing(self) -> bool {
        match self {
            Self::ClopperPearson
            | Self::ExactDifference
            | Self::ExactRatio
            | Self::Betting
            | Self::ConfidenceSequence => true,
            Self::LastParticle
            | Self::Wilson
            | Self::Jeffreys
            | Self::Tango
            | Self::Delta
            | Self::LogDelta
            | Self::Bca
            | Self::FayFeuer
            | Self::Replications => false,
        }
    }

    /// The name that is printed.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ClopperPearson => "Clopper-Pearson",
            Self::ExactDifference => "exact difference",
            Self::ExactRatio => "exact ratio",
            Self::Betting => "betting",
            Self::ConfidenceSequence => "confidence sequence",
            Self::LastParticle => "last-particle Poisson",
            Self::Wilson => "Wilson",
            Self::Jeffreys => "Jeffreys",
            Self::Tango => "Tango",
            Self::Delta => "delta",
            Self::LogDelta => "log-delta",
            Self::Bca => "BCa bootstrap",
            Self::FayFeuer => "Fay-Feuer",
            Self::Replications => "t over replications",
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A value with its interval and where it comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The point estimate.
    pub value: f64,
    /// Lower confidence limit; the end of the parameter's range when the interval is one-sided.
    pub lower: f64,
    /// Upper confidence limit; the end of the parameter's range when the interval is one-sided.
    pub upper: f64,
    /// Encounters (or trials) that were looked at.
    pub n: u64,
    /// What they are worth: n when unweighted, (sum w)^2 / sum w^2 when weighted.
    pub n_effective: f64,
    /// How the interval was made.
    pub method: Method,
}

/// An estimate whose interval may carry a claim. There is no other way to make one than from an
/// [`Estimate`] by a claim-bearing [`Method`]; reading one back from a file goes through the same
/// check.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Estimate", into = "Estimate")]
pub struct Claim(Estimate);

impl Claim {
    /// The estimate that is claimed.
    #[must_use]
    pub fn estimate(&self) -> &Estimate {
        &self.0
    }
}

impl TryFrom<Estimate> for Claim {
    type Error = StatsError;

    /// # Errors
    /// [`StatsError::Approximate`] when the method is for display only.
    fn try_from(estimate: Estimate) -> Result<Self, StatsError> {
        if estimate.method.is_claim_bearing() {
            Ok(Self(estimate))
        } else {
            Err(StatsError::Approximate { method: estimate.method })
        }
    }
}

impl From<Claim> for Estimate {
    fn from(claim: Claim) -> Self {
        claim.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{clopper_pearson, jeffreys, wilson};

    #[test]
    fn only_exact_intervals_become_claims() {
        assert!(Claim::try_from(clopper_pearson(3, 100, 0.05).unwrap()).is_ok());
        for estimate in [wilson(3, 100, 0.05).unwrap(), jeffreys(3, 100, 0.05).unwrap()] {
            assert_eq!(
                Claim::try_from(estimate),
                Err(StatsError::Approximate { method: estimate.method })
            );
        }
    }
}
