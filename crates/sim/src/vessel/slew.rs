//! Actuators that take time: a rudder turns and an engine changes its thrust at a limited rate.

/// Where the actuators of a ship stand, in the units of her model: newtons or radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Actuators {
    /// Thrust.
    pub engine: f64,
    /// Rudder angle or side force, positive where it turns the ship to starboard.
    pub steering: f64,
}

/// How a steering angle becomes a side force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steering {
    /// In proportion to the angle; the largest force at this angle, radians.
    Proportional {
        /// Angle of the largest force.
        angle_rad_max: f64,
    },
    /// The thrust itself turns.
    Azimuth,
}

/// Largest rates of change, N/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// Of the thrust.
    pub thrust_nps: f64,
    /// Of the side force.
    pub side_nps: f64,
}

/// Where an actuator stood, and how fast it moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    pub(super) from: f64,
    /// Units a second.
    pub(super) rate: f64,
}

/// Where an actuator that is asked for `wish` stands `after_s` seconds later.
#[inline]
pub(super) fn reach(actuator: Reach, wish: f64, after_s: f64) -> f64 {
    let most = actuator.rate * after_s;
    wish.clamp(actuator.from - most, actuator.from + most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_actuator_moves_at_its_rate_and_stops_at_the_wish() {
        let rudder = Reach { from: 5.0, rate: 10.0 };
        for (wish, after_s, there) in
            [(35.0, 1.0, 15.0), (35.0, 9.0, 35.0), (-35.0, 0.5, 0.0), (6.0, 1.0, 6.0)]
        {
            assert!((reach(rudder, wish, after_s) - there).abs() < 1e-12, "{wish} {after_s}");
        }
    }
}
