//! The public plug: what a planner is told, what it sees, what it answers.
//!
//! A planner's author depends on this crate alone, implements [`Planner`], runs the
//! [`conformance`] kit, and adds one line to a [`Registry`].
//!
//! The contract: [`Planner::reset`] once an encounter, then [`Planner::plan`] once a beat. A
//! planner never sees the truth, a wall clock, or random numbers other than its own stream. A
//! planner that panics, never returns, or orders something non-finite or out of range ends that
//! encounter with an outcome that counts against it.
#![forbid(unsafe_code)]

pub mod command;
pub mod conformance;
pub mod events;
pub mod failure;
pub mod mission;
pub mod registry;
pub mod situation;
pub mod stream;

pub use command::{Alert, Command, CommandError, Order};
pub use events::PlannerEvents;
pub use failure::{FailureKind, PlannerFailure};
pub use geom::{HeadOnSector, Vec2};
pub use mission::{Mission, OwnShip, Waypoint};
pub use registry::{Options, OptionsError, PlannerEntry, Registry};
pub use situation::{OwnState, Situation, TargetTrack};
pub use stream::PlannerStream;

/// A collision-avoidance planner under test.
pub trait Planner: Send {
    /// Forgets everything and prepares for one encounter. After it, the planner must answer as a
    /// freshly made one would.
    fn reset(&mut self, mission: &Mission);

    /// The order for this beat.
    fn plan(&mut self, situation: &Situation<'_>) -> Command;

    /// What the planner counted of itself since the last reset.
    fn events(&self) -> PlannerEvents {
        PlannerEvents::default()
    }

    /// The head-on sector by which it classifies meetings, for a planner that has one. The judge's
    /// class decides all the same; where the two differ the run says so, and what fails under the
    /// planner's class stands beside the judge's verdicts. The judge asks for the bearing, the
    /// contact angle and the departure from reciprocal headings; a planner that asks otherwise
    /// states the nearest sector.
    fn head_on_sector(&self) -> Option<HeadOnSector> {
        None
    }
}
