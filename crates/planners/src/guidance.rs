//! Where a planner would go if nobody were in the way: along the route, at the planned speed.
//!
//! Every planner of this crate takes its wish from here, so that they differ only in avoidance.

use geom::{Vec2, angle};
use planner_api::{Mission, Waypoint};

/// A waypoint counts as reached no farther away than this many turning circles' radii.
const ACCEPTANCE_TURN_RADII: f64 = 1.5;
/// Bounds of the acceptance radius: a small boat needs room for her sensors' noise, and a ship
/// that hardly turns must not skip her whole route.
const ACCEPTANCE_M: (f64, f64) = (50.0, 1000.0);

/// The wish of one beat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// Unit vector of the course.
    pub direction: Vec2,
    /// Speed, m/s; within own ship's range.
    pub speed_mps: f64,
}

impl Wish {
    /// Metres a second, north and east.
    pub fn velocity_mps(&self) -> Vec2 {
        self.direction * self.speed_mps
    }

    /// Radians clockwise from north.
    pub fn course_rad(&self) -> f64 {
        angle::direction(self.direction)
    }
}

/// Line-of-sight guidance along the route. Straight at the next waypoint; an inner waypoint is
/// left behind when it is near or abeam, and the goal when it is near and abeam, after which the
/// last leg's course is held.
#[derive(Clone, Debug, Default)]
pub struct Guidance {
    route: Vec<Waypoint>,
    cruise_mps: f64,
    speed_mps_max: f64,
    acceptance_m: f64,
    next: usize,
    leg_from_m: Option<Vec2>,
}

impl Guidance {
    /// Starts again with the mission's route.
    pub fn reset(&mut self, mission: &Mission) {
        self.route.clone_from(&mission.route);
        self.cruise_mps = mission.cruise_mps;
        self.speed_mps_max = mission.own.speed_mps_max;
        let turn_radius_m = mission.cruise_mps / mission.own.yaw_rate_radps_max.max(1e-6);
        let (least_m, most_m) = ACCEPTANCE_M;
        self.acceptance_m = (ACCEPTANCE_TURN_RADII * turn_radius_m).clamp(least_m, most_m);
        self.next = 0;
        self.leg_from_m = None;
    }

    /// The wish at this position. The first call sets where the first leg begins.
    pub fn wish(&mut self, position_m: Vec2) -> Wish {
        let mut from_m = *self.leg_from_m.get_or_insert(position_m);
        while let Some(waypoint) = self.route.get(self.next) {
            let is_goal = self.next + 1 == self.route.len();
            let ahead_m = waypoint.position_m - position_m;
            let near = ahead_m.norm() <= self.acceptance_m;
            let abeam = ahead_m.dot(&(waypoint.position_m - from_m)) <= 0.0;
            let reached = if is_goal { near && abeam } else { near || abeam };
            if !reached {
                return self.towards(ahead_m, waypoint.speed_mps);
            }
            if is_goal {
                break;
            }
            from_m = waypoint.position_m;
            self.leg_from_m = Some(from_m);
            self.next += 1;
        }
        // Past the goal: the last waypoint's leg goes on for ever.
        self.next = self.route.len();
        let last = self.route.last();
        let along_m = last.map_or_else(Vec2::zeros, |waypoint| waypoint.position_m - from_m);
        self.towards(along_m, last.and_then(|waypoint| waypoint.speed_mps))
    }

    fn towards(&self, vector_m: Vec2, speed_mps: Option<f64>) -> Wish {
        let length_m = vector_m.norm();
        let direction = if length_m > 0.0 { vector_m / length_m } else { Vec2::new(1.0, 0.0) };
        let speed_mps = speed_mps.unwrap_or(self.cruise_mps).clamp(0.0, self.speed_mps_max);
        Wish { direction, speed_mps }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_api::OwnShip;

    fn guidance(points: &[(f64, f64)]) -> Guidance {
        let waypoint =
            |&(x, y): &(f64, f64)| Waypoint { position_m: Vec2::new(x, y), speed_mps: None };
        let mut guidance = Guidance::default();
        guidance.reset(&Mission {
            own: OwnShip {
                length_m: 8.0,
                beam_m: 3.0,
                speed_mps_max: 12.0,
                yaw_rate_radps_max: 0.1,
                acceleration_mps2_max: 0.5,
            },
            route: points.iter().map(waypoint).collect(),
            cruise_mps: 8.0,
            safety_radius_m: 150.0,
            between_centres: true,
            beat_s: 1.0,
            hazards: Vec::new(),
            stream_seed: 1,
        });
        guidance
    }

    #[test]
    fn an_inner_waypoint_is_left_behind_when_near_and_the_goal_is_passed_straight() {
        let mut g = guidance(&[(1000.0, 0.0), (1000.0, 1000.0)]);
        assert_eq!(g.wish(Vec2::zeros()).direction, Vec2::new(1.0, 0.0));
        assert_eq!(g.wish(Vec2::new(879.0, 0.0)).direction, Vec2::new(1.0, 0.0));
        assert!(g.wish(Vec2::new(881.0, 0.0)).direction.y > 0.9, "1.5 * 8 / 0.1 = 120 m");
        assert_eq!(g.wish(Vec2::new(1000.0, 999.0)).direction, Vec2::new(0.0, 1.0));
        assert_eq!(g.wish(Vec2::new(1000.0, 1001.0)).direction, Vec2::new(0.0, 1.0));
        assert_eq!(g.wish(Vec2::new(1010.0, 5000.0)).direction, Vec2::new(0.0, 1.0));
    }

    #[test]
    fn a_goal_that_was_missed_is_turned_back_to() {
        let mut g = guidance(&[(1000.0, 0.0)]);
        g.wish(Vec2::zeros());
        let back = g.wish(Vec2::new(1200.0, 300.0)).direction;
        assert!(back.x < 0.0 && back.y < 0.0, "130 m is the limit: {back:?}");
    }
}
