//! Where a ship is and how she moves over ground at one instant, and between two instants.

use crate::vessel::State;
use geom::{Vec2, math};

/// One instant of one ship, over ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position of the reference point, metres north and east.
    pub position_m: Vec2,
    /// Velocity over ground, m/s.
    pub velocity_mps: Vec2,
    /// Unit vector of the heading.
    pub heading: Vec2,
    /// Yaw rate, rad/s.
    pub yaw_rate_radps: f64,
}

impl Pose {
    /// The pose of a state in a current.
    pub fn of(state: &State, current_mps: Vec2) -> Self {
        Self {
            position_m: state.position_m,
            velocity_mps: state.through_water_mps() + current_mps,
            heading: state.heading,
            yaw_rate_radps: state.yaw_rate_radps,
        }
    }

    /// Velocity over ground of the point `arm_m` (north and east) off the reference point, m/s.
    pub fn velocity_at_mps(&self, arm_m: Vec2) -> Vec2 {
        self.velocity_mps + Vec2::new(-arm_m.y, arm_m.x) * self.yaw_rate_radps
    }

    /// The pose at `fraction` (0 to 1) of the `dt_s` seconds from `start` to `end`: cubic in the
    /// position, which keeps both positions and both velocities, so that a turn between two
    /// samples is a curve and not its chord. The error goes with the fourth power of `dt_s`.
    pub fn between(start: &Self, end: &Self, dt_s: f64, fraction: f64) -> Self {
        let (s, dt) = (fraction, dt_s);
        let travel_m = end.position_m - start.position_m;
        let bend_m = (start.velocity_mps + end.velocity_mps) * dt - travel_m * 2.0;
        let slack_m = travel_m - start.velocity_mps * dt;
        let position_m = start.position_m
            + start.velocity_mps * (s * dt)
            + (slack_m - bend_m) * (s * s)
            + bend_m * (s * s * s);
        let velocity_mps =
            start.velocity_mps + ((slack_m - bend_m) * (2.0 * s) + bend_m * (3.0 * s * s)) / dt;
        let (a, b) = (start.heading, end.heading);
        let turn_rad = math::atan2(a.x * b.y - a.y * b.x, a.dot(&b));
        let turn =
            Turn { turn_rad, start_radps: start.yaw_rate_radps, end_radps: end.yaw_rate_radps };
        let (angle_rad, yaw_rate_radps) = turn.at(s, dt);
        Self {
            position_m,
            velocity_mps,
            heading: geom::angle::rotate(a, angle_rad),
            yaw_rate_radps,
        }
    }
}

/// The same cubic for the heading.
struct Turn {
    turn_rad: f64,
    start_radps: f64,
    end_radps: f64,
}

impl Turn {
    fn at(&self, s: f64, dt: f64) -> (f64, f64) {
        let bend = (self.start_radps + self.end_radps) * dt - self.turn_rad * 2.0;
        let slack = self.turn_rad - self.start_radps * dt;
        let angle = self.start_radps * (s * dt) + (slack - bend) * (s * s) + bend * (s * s * s);
        let rate = self.start_radps + ((slack - bend) * (2.0 * s) + bend * (3.0 * s * s)) / dt;
        (angle, rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle of 70 m at 7 m/s, half a second a step: the chord is off by 22 mm in the middle.
    #[test]
    fn curve_between_two_samples_is_followed() {
        let on_circle = |t_s: f64| {
            let psi = 0.1 * t_s;
            let (sin, cos) = math::sin_cos(psi);
            Pose {
                position_m: Vec2::new(70.0 * sin, 70.0 * (1.0 - cos)),
                velocity_mps: Vec2::new(7.0 * cos, 7.0 * sin),
                heading: Vec2::new(cos, sin),
                yaw_rate_radps: 0.1,
            }
        };
        let (start, end) = (on_circle(3.0), on_circle(3.5));
        for fraction in [0.0, 0.25, 0.5, 0.8, 1.0] {
            let exact = on_circle(3.0 + 0.5 * fraction);
            let pose = Pose::between(&start, &end, 0.5, fraction);
            assert!((pose.position_m - exact.position_m).norm() < 2e-6);
            assert!((pose.velocity_mps - exact.velocity_mps).norm() < 2e-5);
            assert!((pose.heading - exact.heading).norm() < 1e-9);
        }
    }
}
