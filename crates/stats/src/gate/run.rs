//! A gate while it runs: pairs go in by id, a verdict comes out at a declared look.
//!
//! The state takes the next id and nothing else, and the stratum that the pattern gives that id,
//! so neither completion order nor one stratum after another can reach the statistics. Looks
//! happen at the end of whole cycles, at multiples of the declared step. Undetermined outcomes
//! count against the candidate in the PASS test and for it in the FAIL test.
//! Source: statistics specification, section 5, items 2 to 5.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::plan::{GatePlan, PlanError, entry_error};
use super::result::{CorpusResult, GateResult, GateVerdict};
use super::rule::judge;
use super::tally::{Absolute, Comparison};
use crate::math::ln;

/// Whether one encounter had the event of one metric.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Observation {
    /// It had.
    Event,
    /// It had not, or the metric does not apply.
    NoEvent,
    /// It cannot be said.
    Undetermined,
}

/// One encounter under every planner of the gate, by metric in the plan's order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PairRow {
    /// Place in the campaign, from 0.
    pub id: u64,
    /// As the pattern gives it.
    pub stratum: usize,
    /// The candidate B.
    pub candidate: Vec<Observation>,
    /// The baseline A.
    pub baseline: Vec<Observation>,
    /// The ratchet's arms, in the plan's order.
    pub ratchets: Vec<Vec<Observation>>,
}

/// Why a row is not taken. The state is unchanged.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum GateError {
    /// Another id is next: rows come in id order, each once.
    #[error("take encounter {found}: the next one is {expected}, rows come in id order")]
    OutOfOrder {
        /// The id that is next.
        expected: u64,
        /// The id that came.
        found: u64,
    },
    /// The pattern gives this id another stratum.
    #[error("take encounter {id} of stratum {found}: the plan's pattern has stratum {expected}")]
    Stratum {
        /// The id.
        id: u64,
        /// The pattern's stratum.
        expected: usize,
        /// The row's stratum.
        found: usize,
    },
    /// The row has not one outcome for every metric, or not every arm.
    #[error("take encounter {id}: it must have {metrics} metrics for each of {planners} planners")]
    Shape {
        /// The id.
        id: u64,
        /// Metrics of the plan.
        metrics: usize,
        /// Planners of the gate.
        planners: usize,
    },
    /// The verdict has fallen.
    #[error("take encounter {id}: the gate was decided at {pairs} pairs")]
    Decided {
        /// The id.
        id: u64,
        /// Where it was decided.
        pairs: u64,
    },
}

/// The state of a gate.
#[derive(Debug, Clone)]
pub struct Gate {
    plan: GatePlan,
    evidence: Evidence,
    next_look: u64,
    /// The answer at the last look.
    latest: GateResult,
    decided: bool,
}

/// Everything that was seen, up to the last encounter taken.
#[derive(Debug, Clone)]
pub(super) struct Evidence {
    pub(super) corpus: CorpusResult,
    pub(super) metrics: Vec<Comparison>,
    pub(super) absolutes: Vec<Absolute>,
    /// By arm, then by metric.
    pub(super) ratchets: Vec<Vec<Comparison>>,
    pub(super) pairs: u64,
    pub(super) looks: u64,
}

impl Gate {
    /// A gate that has seen no encounter. A corpus that fails decides it at once.
    ///
    /// # Errors
    /// A plan that is wrong or that its cap can never show.
    pub fn new(plan: GatePlan, corpus: CorpusResult) -> Result<Self, PlanError> {
        plan.feasibility()?;
        let comparison = |name: &str, margin: super::Margin, discordance: f64| {
            Comparison::new(margin, discordance)
                .map_err(|source| PlanError::Entry { entry: name.to_owned(), source })
        };
        let metrics = plan
            .metrics
            .iter()
            .map(|m| comparison(&m.name, m.margin, m.discordance_plan))
            .collect::<Result<Vec<_>, _>>()?;
        let absolutes = plan
            .absolutes
            .iter()
            .map(|a| entry_error(&a.name, Absolute::new(a.rate_max)))
            .collect::<Result<Vec<_>, _>>()?;
        let mut ratchets = Vec::new();
        for arm in &plan.ratchets {
            let pairs = arm.margins.iter().zip(&plan.metrics);
            ratchets.push(
                pairs
                    .map(|(&margin, m)| comparison(&arm.name, margin, m.discordance_plan))
                    .collect::<Result<Vec<_>, _>>()?,
            );
        }
        let next_look = plan.next_look(0);
        let evidence = Evidence { corpus, metrics, absolutes, ratchets, pairs: 0, looks: 0 };
        let latest = judge(&plan, &evidence);
        let decided = latest.verdict == GateVerdict::Fail;
        Ok(Self { plan, evidence, next_look, latest, decided })
    }

    /// Takes the next encounters, in id order, and looks wherever a look is due. Rows behind the
    /// look that decides are left out: they were run, and nobody looks at them.
    ///
    /// # Errors
    /// A row that is not the next one or not of the plan's form; the rows before it are taken.
    pub fn take(&mut self, rows: &[PairRow]) -> Result<Option<GateVerdict>, GateError> {
        if let (true, Some(row)) = (self.decided, rows.first()) {
            return Err(GateError::Decided { id: row.id, pairs: self.evidence.pairs });
        }
        for row in rows {
            self.check(row)?;
            self.count(row);
            self.evidence.pairs += 1;
            if self.evidence.pairs == self.next_look {
                self.look();
                if self.decided {
                    break;
                }
                self.next_look = self.plan.next_look(self.evidence.pairs);
            }
        }
        Ok(self.verdict())
    }

    /// The verdict, once it has fallen.
    #[must_use]
    pub fn verdict(&self) -> Option<GateVerdict> {
        self.decided.then_some(self.latest.verdict)
    }

    /// The answer at the last look, with its numbers; INCONCLUSIVE before a verdict has fallen.
    #[must_use]
    pub fn result(&self) -> &GateResult {
        &self.latest
    }

    /// The id that is next.
    #[must_use]
    pub fn next_id(&self) -> u64 {
        self.evidence.pairs
    }

    /// The plan.
    #[must_use]
    pub fn plan(&self) -> &GatePlan {
        &self.plan
    }

    fn check(&self, row: &PairRow) -> Result<(), GateError> {
        let id = row.id;
        if id != self.evidence.pairs {
            return Err(GateError::OutOfOrder { expected: self.evidence.pairs, found: id });
        }
        let expected = self.plan.pattern[(id % self.plan.cycle()) as usize];
        if row.stratum != expected {
            return Err(GateError::Stratum { id, expected, found: row.stratum });
        }
        let metrics = self.evidence.metrics.len();
        let whole = |observations: &Vec<Observation>| observations.len() == metrics;
        if whole(&row.candidate)
            && whole(&row.baseline)
            && row.ratchets.len() == self.evidence.ratchets.len()
            && row.ratchets.iter().all(whole)
        {
            Ok(())
        } else {
            Err(GateError::Shape { id, metrics, planners: 2 + self.evidence.ratchets.len() })
        }
    }

    fn count(&mut self, row: &PairRow) {
        for (metric, comparison) in self.evidence.metrics.iter_mut().enumerate() {
            comparison.count(row.candidate[metric], row.baseline[metric]);
        }
        for (arm, observations) in self.evidence.ratchets.iter_mut().zip(&row.ratchets) {
            for (metric, comparison) in arm.iter_mut().enumerate() {
                comparison.count(row.candidate[metric], observations[metric]);
            }
        }
        for (absolute, plan) in self.evidence.absolutes.iter_mut().zip(&self.plan.absolutes) {
            if plan.stratum == row.stratum {
                absolute.count(row.candidate[plan.metric]);
            }
        }
    }

    fn look(&mut self) {
        self.evidence.looks += 1;
        let ln_level = -ln(self.plan.alpha_pass_used());
        for comparison in
            self.evidence.metrics.iter_mut().chain(self.evidence.ratchets.iter_mut().flatten())
        {
            comparison.look(self.evidence.pairs, ln_level);
        }
        for absolute in &mut self.evidence.absolutes {
            absolute.look();
        }
        self.latest = judge(&self.plan, &self.evidence);
        self.decided = self.latest.verdict != GateVerdict::Inconclusive
            || self.evidence.pairs == self.plan.cap_pairs();
    }
}
