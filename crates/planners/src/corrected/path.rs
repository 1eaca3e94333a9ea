//! Own ship's predicted path under an order: a lag, a turn and a change of speed at limited rates,
//! then straight on. Targets keep course and speed.

use geom::{Vec2, angle, segment_min_distance, wrap};
use planner_api::{OwnShip, OwnState};

/// Step of the prediction while own ship turns or changes speed, seconds.
const STEP_S: f64 = 2.0;
/// A turn that takes longer than this is cut: the rest is taken as straight, seconds.
const UNSTEADY_S_MAX: f64 = 120.0;

/// An order to be tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Radians clockwise from north.
    pub course_rad: f64,
    /// Metres a second.
    pub speed_mps: f64,
}

/// What own ship is trusted to do.
#[derive(Clone, Copy, Debug)]
pub struct Agility {
    /// rad/s.
    pub yaw_rate_radps: f64,
    /// m/s^2.
    pub acceleration_mps2: f64,
    /// Seconds from the order to its effect.
    pub lag_s: f64,
}

impl Agility {
    /// A share of own ship's limits.
    pub fn new(ship: &OwnShip, share: f64, lag_s: f64) -> Self {
        Self {
            yaw_rate_radps: (share * ship.yaw_rate_radps_max).max(1e-4),
            acceleration_mps2: (share * ship.acceleration_mps2_max).max(1e-3),
            lag_s,
        }
    }
}

/// The path, relative to own ship's present position.
#[derive(Clone, Debug, Default)]
pub struct Path {
    /// (seconds, metres north and east), from (0, 0).
    points: Vec<(f64, Vec2)>,
    velocity_mps: Vec2,
}

/// How a target is passed.
#[derive(Clone, Copy, Debug)]
pub struct Passing {
    /// Smallest distance between reference points, metres.
    pub range_m_min: f64,
    /// Once own ship is steady, the target is left on her port hand (or is already astern).
    pub target_to_port: bool,
}

impl Path {
    /// Predicts the path of an order; reuses the buffer.
    pub fn predict(&mut self, own: &OwnState, trial: Trial, agility: Agility) {
        let (mut course_rad, mut speed_mps) = (own.cog_rad, own.sog_mps);
        let mut at_m = Vec2::zeros();
        self.points.clear();
        self.points.push((0.0, at_m));
        let mut t_s = 0.0;
        if agility.lag_s > 0.0 {
            t_s = agility.lag_s;
            at_m += own.velocity_mps * t_s;
            self.points.push((t_s, at_m));
        }
        while t_s < UNSTEADY_S_MAX {
            let left_rad = wrap(trial.course_rad - course_rad);
            let left_mps = trial.speed_mps - speed_mps;
            if left_rad.abs() < 1e-9 && left_mps.abs() < 1e-9 {
                break;
            }
            let turn_rad = left_rad.abs().min(agility.yaw_rate_radps * STEP_S).copysign(left_rad);
            let limit_mps = agility.acceleration_mps2 * STEP_S;
            let change_mps = left_mps.clamp(-limit_mps, limit_mps);
            // the mean of the step, so that a turn is neither early nor late
            let mean = angle::unit(course_rad + 0.5 * turn_rad) * (speed_mps + 0.5 * change_mps);
            at_m += mean * STEP_S;
            course_rad = wrap(course_rad + turn_rad);
            speed_mps += change_mps;
            t_s += STEP_S;
            self.points.push((t_s, at_m));
        }
        self.velocity_mps = angle::unit(course_rad) * speed_mps;
    }

    /// Own position this long after the path has become straight, with the time from now: (seconds,
    /// metres).
    pub fn straight_at(&self, after_s: f64) -> (f64, Vec2) {
        let (t_s, at_m) = self.points.last().copied().unwrap_or((0.0, Vec2::zeros()));
        (t_s + after_s, at_m + self.velocity_mps * after_s)
    }

    /// The path in pieces, and its straight end for so long, metres from own present position.
    pub fn legs(&self, straight_s: f64) -> impl Iterator<Item = [Vec2; 2]> + '_ {
        let end_m = self.points.last().map_or_else(Vec2::zeros, |point| point.1);
        let turning = self.points.windows(2).map(|pair| [pair[0].1, pair[1].1]);
        turning.chain([[end_m, end_m + self.velocity_mps * straight_s]])
    }

    /// Against a target at `from_own_m` with this velocity.
    pub fn passing(&self, from_own_m: Vec2, velocity_mps: Vec2) -> Passing {
        let los_m = |&(t_s, own_m): &(f64, Vec2)| from_own_m + velocity_mps * t_s - own_m;
        let mut range_m_min = f64::INFINITY;
        for pair in self.points.windows(2) {
            let (distance_m, _) = segment_min_distance(los_m(&pair[0]), los_m(&pair[1]));
            range_m_min = range_m_min.min(distance_m);
        }
        let last_m = self.points.last().map_or(from_own_m, los_m);
        let steady = geom::cpa(last_m, velocity_mps - self.velocity_mps);
        range_m_min = range_m_min.min(steady.dcpa_m);
        let relative_mps = self.velocity_mps - velocity_mps;
        let opening = last_m.dot(&relative_mps) <= 0.0;
        let target_to_port = if opening {
            self.velocity_mps.perp(&last_m) <= 0.0
        } else {
            last_m.perp(&relative_mps) >= 0.0
        };
        Passing { range_m_min, target_to_port }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::units::deg;

    fn own() -> OwnState {
        OwnState::steady(Vec2::new(50.0, -20.0), 0.0, 8.0)
    }

    const AGILITY: Agility =
        Agility { yaw_rate_radps: deg(3.0), acceleration_mps2: 0.3, lag_s: 3.0 };

    #[test]
    fn straight_on_is_the_closed_form() {
        let mut path = Path::default();
        path.predict(&own(), Trial { course_rad: 0.0, speed_mps: 8.0 }, AGILITY);
        let passing = path.passing(Vec2::new(1000.0, 30.0), Vec2::new(-6.0, 0.0));
        assert!((passing.range_m_min - 30.0).abs() < 1e-9);
        assert!(!passing.target_to_port);
    }

    #[test]
    fn a_turn_to_starboard_takes_time_and_leaves_the_target_to_port() {
        let mut path = Path::default();
        path.predict(&own(), Trial { course_rad: deg(90.0), speed_mps: 8.0 }, AGILITY);
        // A circle of radius 8 / (3 deg/s) = 152.8 m after 24 m straight on: its centre lies at
        // (24, 152.8), 573.5 m from the first target and 170.7 m from the second.
        let ahead = path.passing(Vec2::new(576.8, 0.0), Vec2::zeros());
        assert!((ahead.range_m_min - (573.5 - 152.8)).abs() < 2.0, "{ahead:?}");
        assert!(ahead.target_to_port);
        let beam = path.passing(Vec2::new(100.0, 0.0), Vec2::zeros());
        assert!((beam.range_m_min - (170.7 - 152.8)).abs() < 2.0, "{beam:?}");
    }
}
