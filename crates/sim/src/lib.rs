//! World stepping, vessel dynamics, hull contact and sensing: an encounter becomes a trace.
//!
//! Start at [`world`]: it holds the loop. One logical clock (`step * step_s`, never accumulated);
//! all ships decide on one snapshot, then all move; the judge sees the [`record::Trace`] alone.
#![forbid(unsafe_code)]

pub mod approach;
pub mod check;
pub mod contact;
pub mod duty;
pub mod ending;
pub mod escapes;
mod evasion;
mod floor;
pub mod hazard;
pub mod hull;
pub mod intent;
pub mod interval;
pub mod nominal;
mod passage;
pub mod peer;
mod pilot;
pub mod pose;
pub mod recorder;
pub mod sensing;
pub mod ship;
pub mod vessel;
pub mod voyage;
mod way;
pub mod weather;
pub mod world;

pub use check::{SetupError, check};
pub use escapes::Escapes;
pub use evasion::Evasions;
pub use floor::floor;
pub use nominal::nominal;
pub use peer::MakePeer;
pub use vessel::{Limits, known_models, limits};
pub use voyage::Voyage;
pub use way::{Manoeuvre, Side};
pub use world::{Scratch, run, run_among, voyage};
