//! R/V Gunnerus, the 31.25 m research vessel of NTNU, with two azimuth thrusters at the stern.
//!
//! Mass, added mass, damping, force limits, lever, actuator rates, areas above the water and
//! coefficients of the wind come from the default parameters of NTNU's colav-simulator
//! (`core/models.py`, MIT licence). The source's added mass couples sway and yaw by -473,278 and
//! -571,162 kg m; here both are their mean, for a matrix that is not symmetric has no kinetic
//! energy. The gains are ours.

use super::{Autopilot, Damping, MassMatrix, Propulsion, Rates, Steering, ThreeDof, Windage};

/// Largest force of the two thrusters together, N.
const THRUST_N_MAX: f64 = 154_273.0;

/// R/V Gunnerus: length 31.25 m, beam 9.6 m.
pub static GUNNERUS: ThreeDof = ThreeDof {
    displacement_kg: 574_127.69,
    inertia_kgm2: 41_237_080.0,
    mass: MassMatrix {
        surge: 574_127.69 + 26_599.247_217_21,
        sway: 574_127.69 + 132_619.44,
        sway_yaw: -0.5 * (473_277.78 + 571_162.06),
        yaw: 41_237_080.0 + 13_320_142.0,
    },
    damping: [
        Damping { linear: 1_117.598_31, quadratic: 1_671.600_069_65, cubic: 0.0 },
        Damping { linear: 22_288.64, quadratic: 23_611.351_393, cubic: 0.0 },
        Damping { linear: 1_949_686.56, quadratic: 365_427_334.0, cubic: 0.0 },
    ],
    propulsion: Propulsion {
        thrust_n_max: THRUST_N_MAX,
        astern_n_max: THRUST_N_MAX,
        side_n_max: 92_563.8,
        rudder_arm_m: -15.560_009_7,
        steering: Steering::Azimuth,
        // The source turns the thrusters by 30 degrees a second, and takes three seconds from no
        // propeller speed to full. A force that turns by w changes across at most by F w.
        rates: Some(Rates {
            thrust_nps: THRUST_N_MAX / 3.0,
            side_nps: THRUST_N_MAX * 0.523_598_775_598_298_8,
        }),
    },
    windage: Windage {
        frontal_m2: 115.2,
        lateral_m2: 375.0,
        head_drag: 0.55,
        stern_drag: 0.65,
        cross_drag: 0.85,
        cross_force: 0.6,
    },
    // The steering can brake the turn that the course gain asks for:
    // 0.105 rad/s * 0.1 / s < 92,564 N * 15.56 m / 54.6e6 kg m^2.
    autopilot: Autopilot { course: 0.1, yaw_rate: 0.4, speed: 0.1 },
    yaw_rate_radps_max: 0.104_719_755_119_659_77,
    speed_mps_max: 6.481_994_4,
    steerage_mps: None,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vessel::{Helm, Model, State};
    use geom::Vec2;
    use geom::units::deg;

    fn start(speed_mps: f64) -> State {
        Model::ThreeDof(&GUNNERUS).settled(State::ahead(Vec2::zeros(), 0.0, speed_mps))
    }

    fn sail(mut state: State, course_rad: f64, speed_mps: f64, dt_s: f64, steps: usize) -> State {
        let helm = Helm::over_ground(course_rad, speed_mps, Vec2::zeros());
        for _ in 0..steps {
            state = GUNNERUS.step(&state, &helm, Vec2::zeros(), dt_s);
        }
        state
    }

    /// M is symmetric and positive definite: no motion has negative energy.
    #[test]
    fn mass_matrix_is_positive_definite() {
        let m = &GUNNERUS.mass;
        assert!(m.surge > 0.0 && m.sway > 0.0 && m.sway * m.yaw > m.sway_yaw * m.sway_yaw);
    }

    #[test]
    fn she_has_time_constants_of_a_ship() {
        let [surge_s, sway_s, yaw_s] = GUNNERUS.time_constants_s();
        assert!((surge_s - 537.5).abs() < 0.1, "{surge_s}");
        assert!((sway_s - 31.71).abs() < 0.01, "{sway_s}");
        assert!((yaw_s - 27.98).abs() < 0.01, "{yaw_s}");
        assert!(GUNNERUS.is_a_ship());
    }

    #[test]
    fn keeps_and_changes_course_and_speed() {
        let straight = sail(start(5.0), 0.0, 5.0, 0.5, 240);
        assert!((straight.position_m - Vec2::new(600.0, 0.0)).norm() < 1e-6);
        let end = sail(start(5.0), deg(90.0), 3.0, 0.5, 400);
        assert!((end.psi_rad - deg(90.0)).abs() < deg(0.5), "{}", end.psi_rad);
        assert!((end.surge_mps - 3.0).abs() < 1e-2, "{}", end.surge_mps);
    }

    /// From full ahead to full astern the thrust needs six seconds, and says so on the way.
    #[test]
    fn actuators_take_time() {
        let mut state = start(6.0);
        let ahead_n = state.actuators.engine;
        let rate_nps = THRUST_N_MAX / 3.0;
        for k in 1..=4 {
            state = sail(state, 0.0, 0.0, 0.5, 1);
            let expected_n = (ahead_n - rate_nps * 0.5 * f64::from(k)).max(-THRUST_N_MAX);
            assert!((state.actuators.engine - expected_n).abs() < 1e-6, "{k}");
        }
        let turning = sail(start(6.0), deg(90.0), 6.0, 0.25, 1);
        let side_n = THRUST_N_MAX * deg(30.0) * 0.25;
        assert!((turning.actuators.steering.abs() - side_n).abs() < 1e-6);
    }

    /// Steering and engine meet their rates in each of these turns. With those kinks taken in one
    /// piece the third was 18 mm off.
    #[test]
    fn half_the_step_changes_a_turn_by_less_than_two_millimetres() {
        for (course_deg, speed_mps) in [(20.0, 6.0), (45.0, 4.0), (90.0, 6.0), (-160.0, 2.0)] {
            let end = |dt_s: f64| {
                let steps = (60.0 / dt_s).round() as usize;
                sail(start(6.0), deg(course_deg), speed_mps, dt_s, steps).position_m
            };
            for finer_s in [0.25, 0.03125] {
                let gap_m = (end(0.5) - end(finer_s)).norm();
                assert!(gap_m < 2e-3, "{course_deg} degrees, {speed_mps} m/s: {gap_m} m");
            }
        }
    }

    #[test]
    fn unpowered_hull_only_loses_energy() {
        for (u, v, r) in [(6.0, 0.0, 0.0), (4.0, 1.5, 0.08), (-3.0, -1.0, -0.1), (0.0, 0.2, 0.1)] {
            let mut state = State::ahead(Vec2::zeros(), 0.4, u);
            (state.sway_mps, state.yaw_rate_radps) = (v, r);
            let mut before_j = GUNNERUS.kinetic_energy_j(&state);
            for _ in 0..1200 {
                state = GUNNERUS.coast(&state, Vec2::zeros(), 0.5);
                let after_j = GUNNERUS.kinetic_energy_j(&state);
                assert!(after_j <= before_j, "{before_j} -> {after_j}");
                before_j = after_j;
            }
        }
    }

    #[test]
    fn mirror_image_is_exact() {
        let (mut state, mut image) = (start(6.0), start(6.0));
        for k in 0..300 {
            let course_rad = [1.2, -0.9, 2.8][k / 100];
            state = sail(state, course_rad, 5.0, 0.5, 1);
            image = sail(image, -course_rad, 5.0, 0.5, 1);
            assert_eq!(state.position_m.x.to_bits(), image.position_m.x.to_bits());
            assert_eq!(state.position_m.y.to_bits(), (-image.position_m.y).to_bits());
        }
    }
}
