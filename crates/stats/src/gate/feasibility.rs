//! Before the run: can the cap show what the plan asks, and how long is it expected to take?
//!
//! A margin that no outcome could show within the cap is a campaign error, named with the cap
//! that it needs. Source: statistics specification, section 5, item 3.

use serde::{Deserialize, Serialize};

use super::plan::{AbsolutePlan, AbsoluteTest, GatePlan, PlanError, entry_error};
use crate::RateTest;
use crate::math::{exp, ln, real};

/// What every requirement of a plan needs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Feasibility {
    /// In the order metrics, absolutes, ratchets.
    pub needs: Vec<PlannedNeed>,
    /// The cap, rounded down to whole cycles.
    pub cap: u64,
}

impl Feasibility {
    /// Whether a neutral change at the planned rates is expected to pass within the cap.
    #[must_use]
    pub fn neutral_change_passes(&self) -> bool {
        self.needs.iter().all(|need| need.pairs_expected.is_some_and(|pairs| pairs <= self.cap))
    }
}

/// What one requirement needs, in pairs of the whole campaign.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlannedNeed {
    /// Metric, requirement or arm and metric.
    pub name: String,
    /// Without a single difference or event: no smaller cap can ever show it.
    pub pairs_min: u64,
    /// Expected for a neutral change at the planned rates; none when it is not expected to pass.
    /// A forecast, not a claim.
    pub pairs_expected: Option<u64>,
}

impl GatePlan {
    /// Checks the plan and says what it needs.
    ///
    /// # Errors
    /// [`PlanError`]; [`PlanError::Infeasible`] names the requirement that needs the largest cap.
    pub fn feasibility(&self) -> Result<Feasibility, PlanError> {
        self.check()?;
        let mut needs = Vec::new();
        let alpha = self.alpha_pass_used();
        for metric in &self.metrics {
            let test = entry_error(&metric.name, metric.margin.test(metric.discordance_plan))?;
            needs.push(self.need(metric.name.clone(), &test, alpha));
        }
        for absolute in &self.absolutes {
            needs.push(self.need_absolute(absolute)?);
        }
        for ratchet in &self.ratchets {
            for (margin, metric) in ratchet.margins.iter().zip(&self.metrics) {
                let name = format!("{} / {}", ratchet.name, metric.name);
                let test = entry_error(&name, margin.test(metric.discordance_plan))?;
                needs.push(self.need(name, &test, alpha));
            }
        }
        let cap = self.cap_pairs();
        let hardest = needs.iter().max_by_key(|need| need.pairs_min);
        match hardest.filter(|need| need.pairs_min > cap) {
            Some(need) => Err(PlanError::Infeasible {
                entry: need.name.clone(),
                cap,
                cap_needed: need.pairs_min,
            }),
            None => Ok(Feasibility { needs, cap }),
        }
    }

    fn need(&self, name: String, test: &crate::NonInferiority, alpha: f64) -> PlannedNeed {
        let whole = |pairs: u64| pairs.div_ceil(self.cycle()) * self.cycle();
        PlannedNeed {
            name,
            pairs_min: test.encounters_undisturbed(alpha).map_or(u64::MAX, whole),
            pairs_expected: test.encounters_planned(alpha).map(whole),
        }
    }

    fn need_absolute(&self, absolute: &AbsolutePlan) -> Result<PlannedNeed, PlanError> {
        let alpha = self.alpha_absolute_demonstrated();
        let in_stratum = match absolute.test {
            AbsoluteTest::Sequential => {
                entry_error(&absolute.name, RateTest::demonstrated(absolute.rate_max))?
                    .encounters_undisturbed(alpha)
            }
            AbsoluteTest::DeclaredN => Some(zero_events_needed(absolute.rate_max, alpha)),
        };
        let places = self.pairs_in_stratum(absolute.stratum, self.cycle());
        let pairs = in_stratum.map_or(u64::MAX, |n| n.div_ceil(places) * self.cycle());
        // No rate is planned for an absolute requirement; zero events is its best case.
        Ok(PlannedNeed {
            name: absolute.name.clone(),
            pairs_min: pairs,
            pairs_expected: in_stratum.map(|_| pairs),
        })
    }

    /// a / H: the level of each of the H absolute requirements.
    pub(super) fn alpha_absolute_demonstrated(&self) -> f64 {
        self.alpha_pass_used() / real(self.absolutes.len().max(1) as u64)
    }
}

/// Smallest n with (1 - p0)^n <= alpha: the exact bound at zero events is then at most p0.
fn zero_events_needed(rate_max: f64, alpha: f64) -> u64 {
    let n = (ln(alpha) / crate::math::log1p(-rate_max)).ceil();
    debug_assert!(exp(n * crate::math::log1p(-rate_max)) <= alpha * (1.0 + 1e-12));
    n as u64
}
