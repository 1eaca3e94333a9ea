//! What a ship does of herself, without a planner: targets by their intent, own ship on the
//! nominal track.
//!
//! Asked once a beat, like a planner, on the same snapshot.

use crate::duty::Duty;
use crate::pose::Pose;
use crate::ship::Ship;
use crate::vessel::Helm;
use geom::{Vec2, angle, math, wrap};
use record::{Intent, Turn, Visibility, Waypoint};

/// A script and how far it has come.
#[derive(Clone, Debug)]
pub enum Script {
    /// Keeps heading and speed.
    Hold,
    /// Alters course and speed over ground at a time.
    Alter {
        /// When, seconds; it takes effect at the first beat from then on.
        at_s: f64,
        /// Course, rad.
        course_rad: f64,
        /// Speed, m/s.
        speed_mps: f64,
    },
    /// Follows a route.
    Follow(Route),
    /// Alters course again and again.
    Turns {
        /// What is still to come, the next one last.
        left: Vec<Turn>,
        /// Speed over ground, m/s.
        speed_mps: f64,
    },
    /// Minds own ship, or fails to.
    Duty(Duty),
}

impl Script {
    /// The script of an intent. A target under a planner has one as well: it keeps her course
    /// where nobody asks the planner, on the nominal track.
    pub fn of(intent: &Intent, ship: &Ship, speed_mps: f64, visibility: Visibility) -> Self {
        match intent {
            Intent::HoldCourse | Intent::Planner(_) => Self::Hold,
            Intent::Alter { at_s, course_rad, speed_mps } => {
                Self::Alter { at_s: *at_s, course_rad: *course_rad, speed_mps: *speed_mps }
            }
            Intent::Track(waypoints) => Self::Follow(Route::new(ship, waypoints, speed_mps)),
            Intent::Turns(turns) => {
                Self::Turns { left: turns.iter().rev().copied().collect(), speed_mps }
            }
            Intent::Duty(conduct) => {
                let visual_range_m = match visibility {
                    Visibility::InSight => None,
                    Visibility::Restricted { visual_range_m } => Some(visual_range_m),
                };
                Self::Duty(Duty::new(conduct, ship, speed_mps, visual_range_m))
            }
        }
    }

    /// Gives the ship her order of the beat at `t_s`. `own` is own ship as everybody sees her, or
    /// absent where nobody reacts to her: on the nominal track.
    pub fn steer(&mut self, ship: &mut Ship, t_s: f64, own: Option<&Pose>) {
        match self {
            Self::Hold => {
                if !ship.is_straight() && t_s <= 0.0 {
                    ship.hold(t_s);
                }
            }
            Self::Alter { at_s, course_rad, speed_mps } => {
                if t_s < *at_s {
                    if t_s <= 0.0 {
                        ship.hold(t_s);
                    }
                } else {
                    let (course, current_mps) = (wrap(*course_rad), ship.current_mps());
                    ship.steer(Helm::over_ground(course, *speed_mps, current_mps), t_s);
                }
            }
            Self::Follow(route) => route.steer(ship, t_s),
            Self::Turns { left, speed_mps } => {
                let mut due = None;
                while left.last().is_some_and(|turn| turn.at_s <= t_s) {
                    due = left.pop();
                }
                if let Some(turn) = due {
                    let (course, current_mps) = (wrap(turn.course_rad), ship.current_mps());
                    ship.steer(Helm::over_ground(course, *speed_mps, current_mps), t_s);
                } else if t_s <= 0.0 {
                    ship.hold(t_s);
                }
            }
            Self::Duty(duty) => duty.steer(ship, t_s, own),
        }
    }

    /// Whether own ship has made her do what she would not have done by herself.
    pub(crate) fn has_reacted(&self) -> bool {
        match self {
            Self::Duty(duty) => duty.has_reacted(),
            Self::Hold | Self::Alter { .. } | Self::Follow(_) | Self::Turns { .. } => false,
        }
    }
}

/// Two directions nearer than this are the same, rad: a goal that was placed ahead of a ship is
/// ahead of her, whatever the last bit of its coordinates says.
const AHEAD_RAD: f64 = 1e-9;

/// A route, followed leg by leg by line-of-sight guidance (Fossen 2011, section 10.3): the course
/// points at a place on the leg one look-ahead distance beyond the foot of the ship. A leg ends
/// one turning radius before its waypoint; after the last one the ship keeps her course.
#[derive(Clone, Debug)]
pub struct Route {
    legs: Vec<Leg>,
    next: usize,
    lookahead_m: f64,
}

#[derive(Clone, Copy, Debug)]
struct Leg {
    from_m: Vec2,
    course_rad: f64,
    direction: Vec2,
    length_m: f64,
    speed_mps: f64,
}

/// Look-ahead distance in ship lengths; two to five are usual for line-of-sight guidance.
const LOOKAHEAD_LENGTHS: f64 = 4.0;
/// Look-ahead time where current, gusts and waves keep pushing a ship off her leg, seconds. Four
/// lengths of a boat are five seconds: she would chase every push, and the track that nobody
/// alters on would show alterations.
const LOOKAHEAD_IN_WEATHER_S: f64 = 120.0;

impl Route {
    /// The route of `ship` from where she is through `waypoints`, at `speed_mps` until a waypoint
    /// says otherwise.
    pub fn new(ship: &Ship, waypoints: &[Waypoint], speed_mps: f64) -> Self {
        let mut legs: Vec<Leg> = Vec::with_capacity(waypoints.len());
        let (mut from_m, mut speed_mps) = (ship.state.position_m, speed_mps);
        for waypoint in waypoints {
            let leg_m = waypoint.position_m - from_m;
            speed_mps = waypoint.speed_mps.unwrap_or(speed_mps);
            let length_m = leg_m.norm();
            if length_m > 0.0 {
                let before_rad = legs.last().map_or(ship.state.psi_rad, |leg| leg.course_rad);
                let exact_rad = wrap(angle::direction(leg_m));
                let same = wrap(exact_rad - before_rad).abs() < AHEAD_RAD;
                let course_rad = if same { before_rad } else { exact_rad };
                let direction = geom::unit(course_rad);
                legs.push(Leg { from_m, course_rad, direction, length_m, speed_mps });
            }
            from_m = waypoint.position_m;
        }
        Self { legs, next: 0, lookahead_m: LOOKAHEAD_LENGTHS * ship.outline.length_m }
    }

    /// The same route, followed with the patience that weather asks for.
    #[must_use]
    pub fn in_weather(mut self) -> Self {
        let fastest_mps = self.legs.iter().map(|leg| leg.speed_mps).fold(0.0, f64::max);
        self.lookahead_m = self.lookahead_m.max(LOOKAHEAD_IN_WEATHER_S * fastest_mps);
        self
    }

    /// Whether it is one course at one speed, the ship's own.
    pub fn is_straight(&self, ship: &Ship) -> bool {
        self.legs.iter().all(|leg| {
            (leg.course_rad - ship.state.psi_rad).abs() <= 0.0
                && (leg.speed_mps - ship.state.surge_mps).abs() <= 0.0
        })
    }

    fn steer(&mut self, ship: &mut Ship, t_s: f64) {
        while let Some(leg) = self.legs.get(self.next) {
            let along_m = (ship.state.position_m - leg.from_m).dot(&leg.direction);
            let last = self.next + 1 == self.legs.len();
            let margin_m = if last { 0.0 } else { turning_radius_m(ship).min(0.5 * leg.length_m) };
            if along_m < leg.length_m - margin_m {
                break;
            }
            self.next += 1;
        }
        let Some(leg) = self.legs.get(self.next).or(self.legs.last()) else {
            ship.hold(t_s);
            return;
        };
        let off_m = ship.state.position_m - leg.from_m;
        let cross_track_m = leg.direction.x * off_m.y - leg.direction.y * off_m.x;
        // beyond the last waypoint, and on the leg but for rounding, the course is the leg's
        let on_leg = self.next == self.legs.len()
            || cross_track_m.abs() <= AHEAD_RAD * (self.lookahead_m + off_m.norm());
        let course_rad = if on_leg {
            leg.course_rad
        } else {
            wrap(leg.course_rad - math::atan(cross_track_m / self.lookahead_m))
        };
        ship.steer(Helm::over_ground(course_rad, leg.speed_mps, ship.current_mps()), t_s);
    }
}

/// Radius of the tightest turn that the ship declares at her present speed, metres.
fn turning_radius_m(ship: &Ship) -> f64 {
    ship.state.surge_mps.abs() / ship.model.limits().yaw_rate_radps_max
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::{HullOutline, units::deg};
    use record::{Motion, Vessel};

    fn ship(vessel: &Vessel) -> Ship {
        let start = Motion { position_m: Vec2::zeros(), psi_rad: 0.0, speed_mps: 6.0 };
        Ship::new(HullOutline::centred(8.45, 2.71), vessel, &start, Vec2::zeros()).unwrap()
    }

    fn kinematic() -> Vessel {
        Vessel::Kinematic {
            yaw_rate_radps_max: 0.1,
            acceleration_mps2_max: 0.5,
            speed_mps_max: 12.0,
        }
    }

    fn sail(script: &mut Script, ship: &mut Ship, from_s: usize, to_s: usize) {
        for second in from_s..to_s {
            let t_s = second as f64;
            script.steer(ship, t_s, None);
            ship.advance(t_s + 0.5, 0.5);
            ship.advance(t_s + 1.0, 0.5);
        }
    }

    #[test]
    fn holding_is_straight_to_the_last_bit() {
        let mut ship = ship(&kinematic());
        sail(&mut Script::Hold, &mut ship, 0, 1000);
        assert_eq!(ship.state.position_m, Vec2::new(6000.0, 0.0));
    }

    #[test]
    fn alters_at_the_beat_of_its_time() {
        let mut ship = ship(&kinematic());
        let mut script = Script::Alter { at_s: 9.5, course_rad: deg(30.0), speed_mps: 4.0 };
        sail(&mut script, &mut ship, 0, 10);
        assert_eq!(ship.state.position_m, Vec2::new(60.0, 0.0));
        sail(&mut script, &mut ship, 10, 30);
        assert!((ship.state.psi_rad - deg(30.0)).abs() < 1e-12);
        assert!((ship.state.surge_mps - 4.0).abs() < 1e-12);
    }

    #[test]
    fn follows_a_route_with_speeds_and_goes_on_behind_it() {
        for vessel in [kinematic(), Vessel::Model("viknes".to_owned())] {
            let mut ship = ship(&vessel);
            let point =
                |x: f64, y: f64, speed_mps| Waypoint { position_m: Vec2::new(x, y), speed_mps };
            let route = [point(600.0, 0.0, None), point(600.0, 900.0, Some(4.0))];
            let mut script = Script::Follow(Route::new(&ship, &route, 6.0));
            sail(&mut script, &mut ship, 0, 90);
            assert!((ship.state.position_m - Vec2::new(540.0, 0.0)).norm() < 1e-9);
            sail(&mut script, &mut ship, 90, 400);
            assert!((ship.state.position_m.x - 600.0).abs() < 0.5, "{:?}", ship.state.position_m);
            assert!((ship.state.psi_rad - deg(90.0)).abs() < deg(0.2));
            assert!((ship.state.surge_mps - 4.0).abs() < 0.01);
            assert!(ship.state.position_m.y > 950.0);
        }
    }

    #[test]
    fn goal_ahead_is_straight_ahead() {
        let mut ship = ship(&kinematic());
        ship.state.psi_rad = 2.1;
        ship.state.heading = geom::unit(2.1);
        let goal = geom::unit(2.1) * 4321.0;
        let route = Route::new(&ship, &[Waypoint { position_m: goal, speed_mps: None }], 6.0);
        assert!(route.is_straight(&ship));
        assert!(
            !Route::new(&ship, &[Waypoint { position_m: goal, speed_mps: None }], 5.0)
                .is_straight(&ship)
        );
    }
}
