//! What a planner answers.

use geom::{Vec2, angle, wrap};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The answer of a beat.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Command {
    /// Where to go.
    pub order: Order,
    /// Conflicts that the planner declares, if it does.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alerts: Vec<Alert>,
}

impl Command {
    /// A course over ground (radians clockwise from north) and a speed (m/s), nothing declared.
    pub const fn course_speed(course_rad: f64, speed_mps: f64) -> Self {
        Self { order: Order::CourseSpeed { course_rad, speed_mps }, alerts: Vec::new() }
    }

    /// A velocity over ground, nothing declared.
    pub const fn velocity(velocity_mps: Vec2) -> Self {
        Self { order: Order::Velocity { velocity_mps }, alerts: Vec::new() }
    }
}

/// An order, in either form.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Order {
    /// A course and a speed.
    CourseSpeed {
        /// Radians clockwise from north, within one turn either way.
        course_rad: f64,
        /// Metres a second, from 0 to own ship's largest speed.
        speed_mps: f64,
    },
    /// A velocity; needs no trigonometry from the planner.
    Velocity {
        /// Metres a second north and east.
        velocity_mps: Vec2,
    },
}

/// A declared conflict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Alert {
    /// Number of the track.
    pub track: u32,
    /// The rule it follows, in its own words, such as `15`.
    #[serde(default)]
    pub rule: String,
    /// Why, for a human reader.
    #[serde(default)]
    pub why: String,
}

/// Why an order cannot be carried out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CommandError {
    /// NaN or infinite.
    #[error("the order is not a finite number")]
    NonFinite,
    /// Course beyond one turn, or speed below 0 or above the largest.
    #[error("the order is out of range: course within one turn, speed from 0 to the largest")]
    OutOfRange,
}

/// Room for the rounding of a norm or of a unit conversion, relative to the largest speed.
const SPEED_ROUNDING: f64 = 1e-9;

impl Order {
    /// The order as (course wrapped to (-pi, pi], speed in m/s), once it is checked against own
    /// ship's largest speed. A zero velocity keeps `psi_rad` as its course.
    pub fn checked(self, speed_mps_max: f64, psi_rad: f64) -> Result<(f64, f64), CommandError> {
        let (course_rad, speed_mps) = match self {
            Self::CourseSpeed { course_rad, speed_mps } => (course_rad, speed_mps),
            Self::Velocity { velocity_mps } => {
                let speed_mps = velocity_mps.norm();
                let still = speed_mps <= 0.0;
                (if still { psi_rad } else { angle::direction(velocity_mps) }, speed_mps)
            }
        };
        if !course_rad.is_finite() || !speed_mps.is_finite() {
            return Err(CommandError::NonFinite);
        }
        let too_fast = speed_mps > speed_mps_max * (1.0 + SPEED_ROUNDING);
        if course_rad.abs() > TAU || speed_mps < 0.0 || too_fast {
            return Err(CommandError::OutOfRange);
        }
        Ok((wrap(course_rad), speed_mps.min(speed_mps_max)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_checked() {
        let order =
            |course_rad, speed_mps| Order::CourseSpeed { course_rad, speed_mps }.checked(10.0, 0.3);
        assert_eq!(order(1.0, 5.0), Ok((1.0, 5.0)));
        assert_eq!(order(f64::NAN, 5.0), Err(CommandError::NonFinite));
        assert_eq!(order(1.0, f64::INFINITY), Err(CommandError::NonFinite));
        assert_eq!(order(7.0, 5.0), Err(CommandError::OutOfRange));
        assert_eq!(order(1.0, -0.1), Err(CommandError::OutOfRange));
        assert_eq!(order(1.0, 10.1), Err(CommandError::OutOfRange));
        let still = Order::Velocity { velocity_mps: Vec2::zeros() }.checked(10.0, 0.3);
        assert_eq!(still, Ok((0.3, 0.0)));
        let east = Order::Velocity { velocity_mps: Vec2::new(0.0, 3.0) }.checked(10.0, 0.3);
        assert_eq!(east, Ok((std::f64::consts::FRAC_PI_2, 3.0)));
    }
}
