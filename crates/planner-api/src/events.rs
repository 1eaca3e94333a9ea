//! Counts that a planner keeps of itself.

use serde::{Deserialize, Serialize};

/// What a planner counted of itself since its last reset. All zero if it keeps no count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PlannerEvents {
    /// Beats at which an inner loop met its cap.
    pub inner_loop_cap: u32,
    /// Beats at which a limit of the planner cut its own order (speed clamped at 0, and the like).
    pub limited: u32,
    /// Beats at which it was inside a safety circle and called that safe.
    pub inside_called_safe: u32,
    /// Beats at which its class of some target differed from the beat before.
    pub class_changes: u32,
    /// Beats at which a receding target was treated as a danger.
    pub receding_flagged: u32,
    /// Passes of inner loops, in all.
    pub passes: u32,
}
