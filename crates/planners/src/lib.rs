//! The planners that the bench is tried on: the seed planner of the paper in every reading, its
//! repairs, two rivals from the literature, and planners that are broken on purpose.
//!
//! A bench is worth what it can tell apart, so the faults of these planners are known beforehand.
//! First file to read: [`mod@registry`], one line for each planner.
#![forbid(unsafe_code)]

pub mod clearance;
pub mod controls;
pub mod corrected;
pub mod guidance;
pub mod hold_course;
pub mod registry;
pub mod sb_mpc;
pub mod vectors;
pub mod vo;
pub mod zhuang;

pub use registry::registry;
pub use vectors::{VectorReport, VectorsError, check_vectors};
