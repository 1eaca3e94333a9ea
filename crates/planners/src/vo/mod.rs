//! Two planners that search a grid of velocities for one outside every velocity obstacle.
//!
//! Fiorini & Shiller 1998 for the obstacle, Kuwata, Wolf, Zarzhitsky & Huntsberger 2014 for the
//! regions that the rules forbid. No square of the grid is skipped: a candidate is left out only
//! where its distance from the wish alone already costs more than the best one found.

pub mod cone;
pub mod grid;
pub mod kuwata;
pub mod plain;

pub use kuwata::{KuwataOptions, KuwataVo};
pub use plain::{PlainVo, PlainVoOptions};
