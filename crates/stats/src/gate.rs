//! The gate: may this planner change be merged?
//!
//! A pure rule: a plan that was written down before the run, encounters in id order, and a
//! verdict of three values out. Source: statistics specification, section 5. First file to read:
//! `run`, then `rule`.

mod feasibility;
mod plan;
mod result;
mod rule;
mod run;
mod tally;

pub use feasibility::{Feasibility, PlannedNeed};
pub use plan::{AbsolutePlan, AbsoluteTest, GatePlan, Margin, MetricPlan, PlanError, RatchetPlan};
pub use result::{
    AbsoluteResult, BrokenCase, CorpusResult, GateResult, GateVerdict, Harmed, LayerVerdict,
    MetricResult, RatchetResult,
};
pub use rule::{combine, judge_absolute};
pub use run::{Gate, GateError, Observation, PairRow};
