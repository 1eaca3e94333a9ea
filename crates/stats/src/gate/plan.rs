//! What is declared before a gate runs: levels, metrics, margins, strata, looks and the cap.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::{NonInferiority, RateTest, StatsError};

/// Everything that is fixed before the first encounter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GatePlan {
    /// a_F: probability of a false FAIL by the comparison with the baseline, all looks together.
    pub alpha_fail: f64,
    /// a_P: probability of a false PASS of a first attempt, all looks together.
    pub alpha_pass: f64,
    /// a_abs: probability of a false "violated", all strata and looks together.
    pub alpha_absolute: f64,
    /// Which attempt of one change series this is, from 1; attempt j passes at a_P / 2^(j-1).
    pub attempt: u32,
    /// The stratum of every encounter: encounter i has stratum `pattern[i % pattern.len()]`. One
    /// cycle is one whole pattern, and looks are taken at the end of whole cycles only.
    pub pattern: Vec<usize>,
    /// Pairs between looks; rounded up to whole cycles.
    pub look_every: u64,
    /// The largest number of pairs; rounded down to whole cycles.
    pub cap: u64,
    /// What is compared.
    pub metrics: Vec<MetricPlan>,
    /// What the candidate must show by itself.
    pub absolutes: Vec<AbsolutePlan>,
    /// Older planners against which the change must pass too.
    pub ratchets: Vec<RatchetPlan>,
}

/// One metric: an event that an encounter has or has not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MetricPlan {
    /// As it is printed.
    pub name: String,
    /// How much worse the candidate may be.
    pub margin: Margin,
    /// Planned share of encounters in which the planners differ, p10 + p01. It shapes the
    /// stakes and the forecast, never the guarantee.
    pub discordance_plan: f64,
}

/// How much worse than the other planner is still accepted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Margin {
    /// p_B - p_A below `difference`.
    Absolute {
        /// Per encounter.
        difference: f64,
    },
    /// p_B below (1 + `ratio`) p_A. Never replaced by a difference computed from an estimate.
    Relative {
        /// 0.1 for "at most 10 % worse".
        ratio: f64,
        /// Planned p_A.
        rate_plan: f64,
    },
}

impl Margin {
    /// The margin widened by a factor, as the ratchet's arms have it (2 for the release, 3 for
    /// the anchor).
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Absolute { difference } => Self::Absolute { difference: factor * difference },
            Self::Relative { ratio, rate_plan } => {
                Self::Relative { ratio: factor * ratio, rate_plan }
            }
        }
    }

    /// The margin as a difference of rates, at the planned rate when it is relative.
    #[must_use]
    pub fn as_difference(self) -> f64 {
        match self {
            Self::Absolute { difference } => difference,
            Self::Relative { ratio, rate_plan } => ratio * rate_plan,
        }
    }

    pub(super) fn test(self, discordance_plan: f64) -> Result<NonInferiority, StatsError> {
        match self {
            Self::Absolute { difference } => NonInferiority::absolute(difference, discordance_plan),
            Self::Relative { ratio, rate_plan } => {
                NonInferiority::relative(ratio, rate_plan, discordance_plan)
            }
        }
    }
}

/// A rate that the candidate must stay below in one stratum, whatever the baseline does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AbsolutePlan {
    /// As it is printed.
    pub name: String,
    /// Index into the plan's metrics.
    pub metric: usize,
    /// The stratum, as the pattern names it.
    pub stratum: usize,
    /// p0: the rate that must not be reached.
    pub rate_max: f64,
    /// How it is demonstrated.
    pub test: AbsoluteTest,
}

/// How an absolute requirement is demonstrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AbsoluteTest {
    /// By the e-process, at any look.
    Sequential,
    /// By the exact binomial bound at the cap. A plan with one of these never passes early.
    DeclaredN,
}

/// An older planner on the same encounters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RatchetPlan {
    /// `release` or `anchor`, as it is printed.
    pub name: String,
    /// One margin for each metric of the plan, in its order.
    pub margins: Vec<Margin>,
}

/// What is wrong with a plan. All of these are campaign errors.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlanError {
    /// A list that must not be empty is, or a number that must be at least 1 is 0.
    #[error("plan the gate: {what} must be at least 1")]
    Missing {
        /// Which entry.
        what: &'static str,
    },
    /// The cap holds no whole cycle.
    #[error("plan the gate: a cap of {cap} pairs is less than one cycle of {cycle}")]
    CapBelowCycle {
        /// Declared cap.
        cap: u64,
        /// Encounters in a cycle.
        cycle: u64,
    },
    /// A number of an entry is impossible.
    #[error("plan the gate: `{entry}`: failed to {source}")]
    Entry {
        /// Metric, requirement or arm.
        entry: String,
        /// What is wrong.
        source: StatsError,
    },
    /// An entry refers to something that the plan does not have.
    #[error("plan the gate: `{entry}` needs {needs}, which the plan does not have")]
    Reference {
        /// Metric, requirement or arm.
        entry: String,
        /// What is not there.
        needs: String,
    },
    /// The cap can never show the margin, even if the planners never differ.
    #[error(
        "plan the gate: `{entry}` can never pass within {cap} pairs: \
         even without a single difference or event it needs a cap of {cap_needed}"
    )]
    Infeasible {
        /// Metric, requirement or arm.
        entry: String,
        /// The cap, rounded down to whole cycles.
        cap: u64,
        /// The smallest cap that could show it, in pairs.
        cap_needed: u64,
    },
}

impl GatePlan {
    /// Encounters in one cycle through the strata.
    #[must_use]
    pub fn cycle(&self) -> u64 {
        self.pattern.len() as u64
    }

    /// Pairs between looks: whole cycles.
    #[must_use]
    pub fn look_step(&self) -> u64 {
        self.look_every.max(1).div_ceil(self.cycle()) * self.cycle()
    }

    /// The last pair that may be looked at: whole cycles.
    #[must_use]
    pub fn cap_pairs(&self) -> u64 {
        self.cap / self.cycle() * self.cycle()
    }

    /// The first look after `pairs`.
    #[must_use]
    pub fn next_look(&self, pairs: u64) -> u64 {
        ((pairs / self.look_step() + 1) * self.look_step()).min(self.cap_pairs())
    }

    /// The level at which this attempt passes: a_P / 2^(j-1).
    #[must_use]
    pub fn alpha_pass_used(&self) -> f64 {
        let mut alpha = self.alpha_pass;
        for _ in 1..self.attempt {
            alpha *= 0.5;
        }
        alpha
    }

    /// Encounters of `stratum` among the first `pairs`, for whole cycles.
    #[must_use]
    pub fn pairs_in_stratum(&self, stratum: usize, pairs: u64) -> u64 {
        pairs / self.cycle() * self.places(stratum)
    }

    fn places(&self, stratum: usize) -> u64 {
        self.pattern.iter().filter(|&&at| at == stratum).count() as u64
    }

    /// Checks everything but feasibility.
    pub(super) fn check(&self) -> Result<(), PlanError> {
        for (what, there) in [
            ("the number of strata in the pattern", !self.pattern.is_empty()),
            ("the number of metrics", !self.metrics.is_empty()),
            ("look_every", self.look_every > 0),
            ("attempt", self.attempt > 0),
        ] {
            if !there {
                return Err(PlanError::Missing { what });
            }
        }
        if self.cap_pairs() == 0 {
            return Err(PlanError::CapBelowCycle { cap: self.cap, cycle: self.cycle() });
        }
        for (name, alpha) in [
            ("alpha_fail", self.alpha_fail),
            ("alpha_pass", self.alpha_pass),
            ("alpha_pass of this attempt", self.alpha_pass_used()),
            ("alpha_absolute", self.alpha_absolute),
        ] {
            entry_error("levels", crate::error::check_unit(name, alpha))?;
        }
        for metric in &self.metrics {
            entry_error(&metric.name, metric.margin.test(metric.discordance_plan))?;
        }
        self.check_references()
    }

    fn check_references(&self) -> Result<(), PlanError> {
        for absolute in &self.absolutes {
            let missing =
                |needs: String| PlanError::Reference { entry: absolute.name.clone(), needs };
            if absolute.metric >= self.metrics.len() {
                return Err(missing(format!("metric {}", absolute.metric)));
            }
            if self.places(absolute.stratum) == 0 {
                return Err(missing(format!("stratum {}", absolute.stratum)));
            }
            entry_error(&absolute.name, RateTest::demonstrated(absolute.rate_max))?;
        }
        for ratchet in &self.ratchets {
            if ratchet.margins.len() != self.metrics.len() {
                return Err(PlanError::Reference {
                    entry: ratchet.name.clone(),
                    needs: format!("a margin for each of {} metrics", self.metrics.len()),
                });
            }
            for (margin, metric) in ratchet.margins.iter().zip(&self.metrics) {
                entry_error(&ratchet.name, margin.test(metric.discordance_plan))?;
            }
        }
        Ok(())
    }
}

/// Names the entry in which a number is impossible.
pub(super) fn entry_error<T>(entry: &str, result: Result<T, StatsError>) -> Result<T, PlanError> {
    result.map_err(|source| PlanError::Entry { entry: entry.to_owned(), source })
}
