//! `dribble`: answers a danger with a succession of small alterations to starboard, which
//! Rule 8(b) names as what to avoid.

use super::watched::Watched;
use geom::{units::deg, wrap};
use planner_api::{Command, Mission, Planner, PlannerEvents, Situation};
use serde::{Deserialize, Serialize};

/// Its options.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DribbleOptions {
    /// Size of one alteration, degrees.
    pub step_deg: f64,
    /// Time from one to the next, seconds: long enough that two are not one turn.
    pub every_s: f64,
    /// It stops altering here, degrees.
    pub offset_deg_max: f64,
}

impl Default for DribbleOptions {
    fn default() -> Self {
        Self { step_deg: 8.0, every_s: 20.0, offset_deg_max: 80.0 }
    }
}

impl DribbleOptions {
    /// What is wrong with the values, and what would be right.
    pub fn check(&self) -> Result<(), String> {
        let Self { step_deg, every_s, offset_deg_max } = *self;
        let angles = (0.0..=180.0).contains(&step_deg) && (0.0..=180.0).contains(&offset_deg_max);
        if angles && every_s > 0.0 {
            return Ok(());
        }
        Err("`every_s` must be above 0, `step_deg` and `offset_deg_max` from 0 to 180".to_owned())
    }
}

/// The control that alters little by little.
#[derive(Clone, Debug)]
pub struct Dribble {
    options: DribbleOptions,
    watched: Watched,
    danger_since_s: Option<f64>,
}

impl Dribble {
    /// With these steps.
    pub fn new(options: DribbleOptions) -> Self {
        Self { options, watched: Watched::default(), danger_since_s: None }
    }
}

impl Planner for Dribble {
    fn reset(&mut self, mission: &Mission) {
        self.watched.reset(mission);
        self.danger_since_s = None;
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let beat = self.watched.beat(situation);
        let mut offset_deg = 0.0;
        if beat.avoiding {
            let since_s = *self.danger_since_s.get_or_insert(situation.t_s);
            let steps = 1.0 + ((situation.t_s - since_s) / self.options.every_s).floor();
            offset_deg = (steps * self.options.step_deg).min(self.options.offset_deg_max);
        } else {
            self.danger_since_s = None;
        }
        Command::course_speed(wrap(beat.wish.course_rad() + deg(offset_deg)), beat.wish.speed_mps)
    }

    fn events(&self) -> PlannerEvents {
        self.watched.events()
    }
}
