//! Frames, angles, closest points of approach, hull outlines and deterministic maths.
//!
//! The plane is north-east: x is north, y is east, in metres. Angles run clockwise from north, in
//! radians, wrapped to (-pi, pi]; a positive rotation is to starboard.
#![forbid(unsafe_code)]

pub mod angle;
pub mod class;
pub mod cpa;
pub mod hull;
pub mod math;
pub mod polygon;
pub mod relative;
pub mod units;

pub use angle::{unit, wrap};
pub use class::{EncounterClass, HeadOnSector, classify};
pub use cpa::{Cpa, cpa, segment_min_distance};
pub use hull::HullOutline;
pub use relative::Relative;

/// A position or velocity in the north-east plane: `x` north, `y` east.
pub type Vec2 = nalgebra::Vector2<f64>;
