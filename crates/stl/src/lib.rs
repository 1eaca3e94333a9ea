//! The second judge: temporal-logic robustness over the same trace.
//!
//! Flow: `Trace -> signals -> lives and actions -> formulas -> Robustness`. It shares nothing with
//! the first judge but the trace and the written specification, so that a slip of one is seen by
//! the other.
#![forbid(unsafe_code)]

pub mod action;
pub mod checks;
pub mod clearance;
mod forced;
pub mod formula;
pub mod judge;
pub mod life;
pub mod params;
pub mod phi;
pub mod risk;
pub mod runs;
pub mod semantics;
pub mod signals;
mod stand_on;
pub mod truth;

pub use formula::{Comparison, Formula, Predicate, Signals, Window};
pub use judge::{Finding, Robustness, WITH_FORMULA, judge};
pub use params::{Params, RunParams, Scales, StageClock};
pub use semantics::{Bounds, FormulaError, bounds, robustness};
pub use truth::truth;
