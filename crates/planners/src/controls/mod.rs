//! Negative controls: planners that are broken on purpose, each in one way.
//!
//! They are the seed planner (`zhuang`) but for their fault. A bench that passes one of them
//! measures nothing; each line of the registry names the verdict that must catch it.

pub mod always_port;
pub mod blind;
pub mod destructive;
pub mod dribble;
pub mod late;
pub mod watched;

pub use always_port::AlwaysPort;
pub use blind::BlindToNearest;
pub use destructive::{Destructive, DestructiveOptions, Fault};
pub use dribble::{Dribble, DribbleOptions};
pub use late::{Late, LateOptions};
