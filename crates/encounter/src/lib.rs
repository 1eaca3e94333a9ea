//! Where encounters come from: random strata, named sets, other tools' files.
//!
//! First stage of the way of the data: a table of the campaign file goes in, [`record::Encounter`]
//! comes out. Read [`sample`] first: it draws one encounter.
#![forbid(unsafe_code)]

mod checks;
pub mod course;
pub mod distribution;
pub mod dnv;
mod dnv_ship;
pub mod encounter_rate;
pub mod error;
pub mod geographic;
pub mod hazard;
pub mod intent;
mod json;
pub mod limits;
mod named;
pub mod nominal;
pub mod placement;
mod rate_checks;
pub mod sample;
pub mod sensing;
pub mod situation;
pub mod spec;
mod target;
pub mod wanted;
pub mod weather;

pub use distribution::Distribution;
pub use dnv::{SituationSettings, read_situations};
pub use error::Error;
pub use limits::{Limits, ScaledLimits};
pub use named::situations;
pub use nominal::{class_at_start, last_cpa_s, nominal_cpa};
pub use sample::{Drawn, Generator, RunSettings};
pub use situation::{SetSettings, Situation};
pub use spec::Model;
