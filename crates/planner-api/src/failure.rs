//! How a planner from outside ends its own encounter.
//!
//! `plan` returns an order and nothing else, because a planner in Rust that cannot answer panics,
//! and the simulator already turns an unwinding into an outcome. A planner behind a process or a
//! library has more to say than that, so its adapter unwinds with this payload, and the simulator
//! tells it from a plain panic by `downcast_ref::<PlannerFailure>()`.

/// What went wrong; each kind is one outcome word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FailureKind {
    /// `planner_hung`: no answer within a limit on the wall clock. The digest of such a run comes
    /// from id and outcome alone.
    Hung,
    /// `planner_crashed`: its process ended, or its library reported that it cannot go on.
    Crashed,
    /// `planner_protocol`: it said something that the protocol does not allow.
    Protocol,
    /// `planner_non_finite`: NaN or an infinity, in a form that is not a JSON number.
    NonFinite,
}

/// The end of an encounter by the planner's adapter.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{detail}")]
pub struct PlannerFailure {
    /// Which outcome.
    pub kind: FailureKind,
    /// What happened and the last lines the planner said, for a human reader.
    pub detail: String,
}

impl PlannerFailure {
    /// Unwinds with this as payload, without the panic hook: the simulator catches it.
    pub fn raise(self) -> ! {
        std::panic::resume_unwind(Box::new(self))
    }
}
