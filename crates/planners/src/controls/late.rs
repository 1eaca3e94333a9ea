//! `late`: does what the seed planner does, 60 seconds after it first should have.

use super::watched::Watched;
use planner_api::{Command, Mission, Planner, PlannerEvents, Situation};
use serde::{Deserialize, Serialize};

/// Its options.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LateOptions {
    /// How long a danger goes on before it is answered, seconds.
    pub delay_s: f64,
}

impl Default for LateOptions {
    fn default() -> Self {
        Self { delay_s: 60.0 }
    }
}

impl LateOptions {
    /// What is wrong with the values, and what would be right.
    pub fn check(&self) -> Result<(), String> {
        if self.delay_s >= 0.0 {
            return Ok(());
        }
        Err(format!("`delay_s` is {}; it must be 0 or more", self.delay_s))
    }
}

/// The control that reacts late.
#[derive(Clone, Debug)]
pub struct Late {
    options: LateOptions,
    watched: Watched,
    danger_since_s: Option<f64>,
}

impl Late {
    /// With this delay.
    pub fn new(options: LateOptions) -> Self {
        Self { options, watched: Watched::default(), danger_since_s: None }
    }
}

impl Planner for Late {
    fn reset(&mut self, mission: &Mission) {
        self.watched.reset(mission);
        self.danger_since_s = None;
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let beat = self.watched.beat(situation);
        if !beat.avoiding {
            self.danger_since_s = None;
        }
        if beat.avoiding {
            let since_s = *self.danger_since_s.get_or_insert(situation.t_s);
            if situation.t_s - since_s >= self.options.delay_s {
                return Command::course_speed(beat.course_rad, beat.speed_mps);
            }
        }
        Command::course_speed(beat.wish.course_rad(), beat.wish.speed_mps)
    }

    fn events(&self) -> PlannerEvents {
        self.watched.events()
    }
}
