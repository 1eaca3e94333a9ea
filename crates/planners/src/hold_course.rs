//! `hold-course`: follows its route and never acts for anybody.

use crate::guidance::Guidance;
use planner_api::{Command, Mission, Planner, Situation};
use serde::{Deserialize, Serialize};

/// It has no options.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoOptions {}

/// The planner that never acts.
#[derive(Clone, Debug, Default)]
pub struct HoldCourse(Guidance);

impl Planner for HoldCourse {
    fn reset(&mut self, mission: &Mission) {
        self.0.reset(mission);
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let wish = self.0.wish(situation.own.position_m);
        Command::course_speed(wish.course_rad(), wish.speed_mps)
    }
}
