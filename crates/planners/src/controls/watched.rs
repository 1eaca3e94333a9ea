//! The seed planner under a watch that says whether it is avoiding somebody.

use crate::guidance::{Guidance, Wish};
use crate::zhuang::{Zhuang, ZhuangOptions};
use geom::wrap;
use planner_api::{Mission, Order, Planner, PlannerEvents, Situation};

/// Orders closer than this to the wish are the wish: the rounding of two changes of frame.
const SAME: f64 = 1e-9;

/// `zhuang`, and the route that it would follow if it were alone.
#[derive(Clone, Debug)]
pub struct Watched {
    zhuang: Zhuang,
    guidance: Guidance,
}

/// One beat of it.
#[derive(Clone, Copy, Debug)]
pub struct WatchedBeat {
    /// Where the route leads.
    pub wish: Wish,
    /// Ordered course, radians clockwise from north.
    pub course_rad: f64,
    /// Ordered speed, m/s.
    pub speed_mps: f64,
    /// The order is not the wish.
    pub avoiding: bool,
}

impl Default for Watched {
    fn default() -> Self {
        let zhuang = Zhuang::new(ZhuangOptions::default());
        Self { zhuang, guidance: Guidance::default() }
    }
}

impl Watched {
    /// As [`Planner::reset`].
    pub fn reset(&mut self, mission: &Mission) {
        self.zhuang.reset(mission);
        self.guidance.reset(mission);
    }

    /// What the seed planner orders, beside what it would order alone.
    pub fn beat(&mut self, situation: &Situation<'_>) -> WatchedBeat {
        let wish = self.guidance.wish(situation.own.position_m);
        let Order::CourseSpeed { course_rad, speed_mps } = self.zhuang.plan(situation).order else {
            unreachable!("the seed planner orders a course and a speed");
        };
        let turned = wrap(course_rad - wish.course_rad()).abs() > SAME;
        let avoiding = turned || (speed_mps - wish.speed_mps).abs() > SAME;
        WatchedBeat { wish, course_rad, speed_mps, avoiding }
    }

    /// As [`Planner::events`].
    pub fn events(&self) -> PlannerEvents {
        self.zhuang.events()
    }
}
