//! `always-port`: sees every danger in time and alters to port for it.

use super::watched::Watched;
use geom::{units::deg, wrap};
use planner_api::{Command, Mission, Planner, PlannerEvents, Situation};

/// Large enough to be readily apparent, so that only the direction is wrong.
const ALTERATION_RAD: f64 = deg(40.0);

/// The control that turns the wrong way.
#[derive(Clone, Debug, Default)]
pub struct AlwaysPort(Watched);

impl Planner for AlwaysPort {
    fn reset(&mut self, mission: &Mission) {
        self.0.reset(mission);
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let beat = self.0.beat(situation);
        let to_port_rad = if beat.avoiding { ALTERATION_RAD } else { 0.0 };
        let course_rad = wrap(beat.wish.course_rad() - to_port_rad);
        Command::course_speed(course_rad, beat.wish.speed_mps)
    }

    fn events(&self) -> PlannerEvents {
        self.0.events()
    }
}
