//! May this change of a planner be merged?
//!
//! ```text
//! gate.toml -> plan -> [ both planners on the same fresh encounters ] -> verdict, report
//! spec.rs      arm.rs, child.rs, run.rs                          stats::Gate, report.rs
//! ```
//!
//! Where it stands in the flow: after `campaign`, whose workers run the encounters; the rule
//! itself is pure and lives in `stats`. First file to read: [`run`].
#![forbid(unsafe_code)]

pub mod arm;
pub mod baseline;
pub mod child;
pub mod corpus;
pub mod fresh;
pub mod junit;
pub mod ledger;
pub mod memory;
pub mod metric;
pub mod mutants;
pub mod report;
pub mod run;
pub mod self_test;
pub mod serve;
pub mod shrink;
pub mod spec;
pub mod text;

pub use arm::{Arm, ArmRow, InProcess};
pub use baseline::{Record, Role};
pub use child::Child;
pub use fresh::FreshKey;
pub use ledger::Ledger;
pub use metric::Event;
pub use report::{ArmIdentity, GateReport, NewFailure};
pub use run::{Paired, PairedRun};
pub use spec::{GateSpec, GateTable};
