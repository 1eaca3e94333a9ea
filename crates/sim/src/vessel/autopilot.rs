//! The course and speed autopilot of the 3-DOF ships.

use super::Helm;
use super::three_dof::{Forces, Nu, ThreeDof};
use geom::{Vec2, math};

/// Gains of the course and speed autopilot, 1/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Autopilot {
    /// Ordered yaw rate for each radian of course error.
    pub course: f64,
    /// Yaw acceleration for each rad/s of yaw rate error.
    pub yaw_rate: f64,
    /// Acceleration for each m/s of speed error.
    pub speed: f64,
}

/// Speed below which the drift angle loses its meaning and the autopilot steers by heading, m/s.
const DRIFT_MPS: f64 = 0.5;

impl ThreeDof {
    /// Thrust and side force (N) of the autopilot, and the limits that hold.
    ///
    /// The direction that is brought onto the order lies halfway between heading and course
    /// through the water. Heading alone leaves the boat drifting sideways long after a turn;
    /// course alone is badly damped, because sideways drift dies slowly at small angles.
    /// The error enters as `2 tan(e/2)`, which is the angle where it matters, saturates well
    /// before half a turn, is exactly odd, and costs no transcendental function.
    #[inline]
    pub(super) fn autopilot_n(&self, nu: &Nu, heading: Vec2, helm: &Helm) -> Forces {
        let [u, v, r] = *nu;
        let gains = &self.autopilot;
        let per_speed = 1.0 / (u * u + v * v + DRIFT_MPS * DRIFT_MPS).sqrt();
        let (ahead, aside) = (1.0 + u * per_speed, v * per_speed);
        let wish = helm.direction;
        let (wish_ahead, wish_aside) =
            (wish.x * heading.x + wish.y * heading.y, wish.y * heading.x - wish.x * heading.y);
        let cross = ahead * wish_aside - aside * wish_ahead;
        let dot = ahead * wish_ahead + aside * wish_aside;
        let numerator = 2.0 * gains.course * cross;
        let denominator = math::length(ahead, aside) + dot;
        let limit_radps = self.yaw_rate_radps_max;
        let yaw_rate_radps = if numerator.abs() < limit_radps * denominator {
            numerator / denominator
        } else if cross < 0.0 {
            -limit_radps
        } else {
            limit_radps
        };

        let resistance = self.resistance(nu);
        let p = &self.propulsion;
        let moment_nm = resistance[2] + self.mass.yaw * gains.yaw_rate * (yaw_rate_radps - r);
        let side_n = moment_nm / p.rudder_arm_m;
        let speed_mps = helm.speed_mps.min(self.speed_mps_max);
        let thrust_n = resistance[0] + self.mass.surge * gains.speed * (speed_mps - u);
        let limits = u8::from(yaw_rate_radps >= limit_radps)
            | u8::from(yaw_rate_radps <= -limit_radps) << 1
            | u8::from(side_n > p.side_n_max) << 2
            | u8::from(side_n < -p.side_n_max) << 3
            | u8::from(thrust_n > p.thrust_n_max) << 4
            | u8::from(thrust_n < -p.astern_n_max) << 5;
        let thrust_n = thrust_n.clamp(-p.astern_n_max, p.thrust_n_max);
        (thrust_n, side_n.clamp(-p.side_n_max, p.side_n_max), limits)
    }
}
