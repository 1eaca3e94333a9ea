//! A frigate of 100 m by Nomoto's equation with Norrbin's term.
//!
//! K, T, n3 and the limits of the rudder come from PythonVehicleSimulator
//! (`vehicles/frigate.py`, MIT licence), which takes them from van Amerongen (1982), Adaptive
//! Steering of Ships, Delft. n3 goes with degrees here: the source does not name its unit, and with
//! radians the cubic term vanishes and full rudder turns her within her own length (5.4 degrees a
//! second at 9 m/s), which no frigate does. Engine and gains are ours.

use super::Nomoto;
use super::nomoto::Gains;
use geom::units::deg;

/// s^2/deg^2 in s^2/rad^2.
const PER_DEG2: f64 = 1.0 / (deg(1.0) * deg(1.0));

/// The frigate: length 100 m, 6 to 12 m/s.
pub static FRIGATE: Nomoto = Nomoto {
    at_speed: &[
        Gains { speed_mps: 6.0, gain_per_s: 0.08, time_s: 20.0, cubic_s2: 0.4 * PER_DEG2 },
        Gains { speed_mps: 9.0, gain_per_s: 0.18, time_s: 27.0, cubic_s2: 0.6 * PER_DEG2 },
        Gains { speed_mps: 12.0, gain_per_s: 0.23, time_s: 21.0, cubic_s2: 0.3 * PER_DEG2 },
    ],
    rudder_rad_max: deg(30.0),
    rudder_radps_max: deg(10.0),
    surge_s: 60.0,
    acceleration_mps2_max: 0.1,
    course: 0.04,
    yaw_rate: 0.2,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vessel::{Helm, State};
    use geom::Vec2;

    /// r + 0.3 r^3 = 0.23 * 30 in degrees: 2.46 degrees a second.
    #[test]
    fn full_rudder_turns_her_as_the_equation_says() {
        let limits = FRIGATE.limits();
        let r = limits.yaw_rate_radps_max / deg(1.0);
        assert!((r + 0.3 * r * r * r - 6.9).abs() < 1e-9, "{r}");
        assert!((limits.speed_mps_max - 12.0).abs() < 1e-12);
    }

    #[test]
    fn she_has_time_constants_of_a_ship() {
        assert!(FRIGATE.time_constants_s().iter().all(|t_s| (0.1..=3600.0).contains(t_s)));
    }

    /// The rudder needs three seconds to hard over.
    #[test]
    fn rudder_takes_time() {
        let helm = Helm::over_ground(deg(90.0), 9.0, Vec2::zeros());
        let mut state = State::ahead(Vec2::zeros(), 0.0, 9.0);
        for k in 1..=5 {
            state = FRIGATE.step(&state, &helm, Vec2::zeros(), 0.5);
            let expected_rad = deg(5.0) * f64::from(k);
            assert!((state.actuators.steering - expected_rad).abs() < 1e-9, "{k}");
        }
    }

    #[test]
    fn a_turn_does_not_depend_on_the_step() {
        let at = |dt_s: f64| {
            let helm = Helm::over_ground(deg(-120.0), 8.0, Vec2::zeros());
            let start = State::ahead(Vec2::zeros(), 0.0, 11.0);
            (0..(120.0 / dt_s).round() as usize)
                .fold(start, |state, _| FRIGATE.step(&state, &helm, Vec2::zeros(), dt_s))
        };
        let gap_m = (at(0.5).position_m - at(0.0625).position_m).norm();
        assert!(gap_m < 0.1, "{gap_m}");
    }
}
