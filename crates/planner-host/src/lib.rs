//! Planners from outside: a process that speaks JSON lines (`exec:`), a shared library (`lib:`).
//!
//! Both become a [`planner_api::PlannerEntry`], so that nothing behind it knows where a planner
//! lives. A planner from outside may do anything; whatever it does costs its own encounter, ends it
//! with a named outcome ([`planner_api::PlannerFailure`]) and leaves the next encounter untouched.
//! `docs/your-planner.md` is the walk for authors; the messages stand in [`wire`] and as JSON
//! Schema in `schema/`, the C interface in [`abi`] and in `include/seatrial_planner.h`.
//!
//! The only crate with unsafe code: calls into a library, and limits on a process.

pub mod abi;
mod child;
mod convert;
pub mod entry;
mod exec;
mod library;
mod non_finite;
pub mod schema;
pub mod tail;
pub mod wire;

pub use entry::{OutsideKind, files, outside, relocated};
