//! Viknes 830, an 8.45 m motor boat used as an unmanned test vessel.
//!
//! Mass, damping, force limits, the lever of the steering, areas above the water and coefficients
//! of the wind come from the default parameters of NTNU's colav-simulator (`core/models.py`, MIT
//! licence), which gives no added mass. The gains are ours.

use super::{Autopilot, Damping, MassMatrix, Propulsion, Steering, ThreeDof, Windage};
use geom::units::deg;

/// Viknes 830: length 8.45 m, beam 2.71 m.
pub static VIKNES: ThreeDof = ThreeDof {
    displacement_kg: 3980.0,
    inertia_kgm2: 19_703.0,
    mass: MassMatrix { surge: 3980.0, sway: 3980.0, sway_yaw: 0.0, yaw: 19_703.0 },
    damping: [
        Damping { linear: 50.0, quadratic: 135.0, cubic: 0.0 },
        Damping { linear: 200.0, quadratic: 2000.0, cubic: 0.0 },
        Damping { linear: 1281.0, quadratic: 0.0, cubic: 3224.0 },
    ],
    // The steering force of the source does not depend on speed, as that of a steered jet.
    propulsion: Propulsion {
        thrust_n_max: 13_100.0,
        astern_n_max: 6550.0,
        side_n_max: 645.0,
        rudder_arm_m: -4.0,
        // the source gives a force and no angle
        steering: Steering::Proportional { angle_rad_max: deg(35.0) },
        rates: None,
    },
    windage: Windage {
        frontal_m2: 9.485,
        lateral_m2: 13.308_75,
        head_drag: 0.55,
        stern_drag: 0.6,
        cross_drag: 0.85,
        cross_force: 0.6,
    },
    // Critically damped together; the steering can brake the turn that the course gain asks for:
    // 0.262 rad/s * 0.35 / s < 645 N * 4 m / 19703 kg m^2.
    autopilot: Autopilot { course: 0.35, yaw_rate: 1.4, speed: 0.5 },
    yaw_rate_radps_max: deg(15.0),
    speed_mps_max: 10.0,
    steerage_mps: None,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vessel::{Helm, State};
    use geom::Vec2;

    fn sail(state: State, course_rad: f64, speed_mps: f64, dt_s: f64, duration_s: f64) -> State {
        let helm = Helm::over_ground(course_rad, speed_mps, Vec2::zeros());
        let steps = (duration_s / dt_s).round() as usize;
        (0..steps).fold(state, |s, _| VIKNES.step(&s, &helm, Vec2::zeros(), dt_s))
    }

    /// 135 u^2 + 50 u = 13100.
    #[test]
    fn largest_speed_is_where_thrust_meets_resistance() {
        let expected = (-50.0 + (2500f64 + 4.0 * 135.0 * 13_100.0).sqrt()) / 270.0;
        assert!((VIKNES.limits().speed_mps_max - expected).abs() < 1e-9);
    }

    #[test]
    fn settles_on_course_and_speed() {
        let end = sail(State::ahead(Vec2::zeros(), 0.0, 7.0), deg(60.0), 5.0, 0.5, 120.0);
        assert!((end.psi_rad - deg(60.0)).abs() < 1e-4, "{}", end.psi_rad);
        assert!((end.surge_mps - 5.0).abs() < 1e-6);
        assert!(end.sway_mps.abs() < 1e-3);
    }

    #[test]
    fn turn_respects_yaw_rate_and_overshoots_little() {
        let mut state = State::ahead(Vec2::zeros(), 0.0, 7.0);
        let (mut fastest, mut furthest) = (0f64, 0f64);
        for _ in 0..120 {
            state = sail(state, deg(90.0), 7.0, 0.5, 0.5);
            fastest = fastest.max(state.yaw_rate_radps);
            furthest = furthest.max(state.psi_rad);
        }
        assert!(fastest > deg(12.0) && fastest <= deg(15.0) * 1.001, "{fastest}");
        assert!(furthest < deg(100.0), "{furthest}");
    }

    /// The steering can give the moment 2580 N m and no more, even while the course gain asks more.
    #[test]
    fn actuators_saturate() {
        let state = State::ahead(Vec2::zeros(), 0.0, 7.0);
        let next = sail(state, deg(90.0), 7.0, 0.01, 0.01);
        let expected = 645.0 * 4.0 / 19_703.0 * 0.01;
        assert!((next.yaw_rate_radps - expected).abs() < 1e-3 * expected);
        let crash = sail(state, 0.0, 0.0, 0.01, 0.01);
        // 0.5 / s * 7 m/s * 3980 kg is more than resistance and the thrust astern give
        let expected = 7.0 - (6550.0 + 50.0 * 7.0 + 135.0 * 49.0) / 3980.0 * 0.01;
        assert!((crash.surge_mps - expected).abs() < 1e-4, "{}", crash.surge_mps);
    }

    /// Surge alone, m u' = -(50 + 135 u) u, has the closed form below with a = 50/m, b = 135/m.
    #[test]
    fn integrator_is_of_fourth_order() {
        let (a, b, u0, t_s) = (50.0 / 3980.0, 135.0 / 3980.0, 9.0, 12.0);
        let exact = a * u0 / ((a + b * u0) * geom::math::exp(a * t_s) - b * u0);
        let error = |dt_s: f64| {
            let steps = (t_s / dt_s).round() as usize;
            let start = State::ahead(Vec2::zeros(), 0.4, u0);
            let end = (0..steps).fold(start, |s, _| VIKNES.coast(&s, Vec2::zeros(), dt_s));
            (end.surge_mps - exact).abs()
        };
        let (coarse, fine) = (error(1.0), error(0.5));
        assert!((10.0..24.0).contains(&(coarse / fine)), "{coarse} {fine}");
    }

    /// Every one of these turns begins at the limit of the steering and passes that of the yaw
    /// rate. With the kinks taken in one piece the second was 8 mm off.
    #[test]
    fn half_the_step_changes_a_turn_by_less_than_a_millimetre() {
        for (course_deg, speed_mps) in [(20.0, 7.0), (45.0, 4.0), (90.0, 7.0), (-160.0, 2.0)] {
            let end = |dt_s: f64| {
                let start = State::ahead(Vec2::zeros(), 0.1, 7.3);
                sail(start, deg(course_deg), speed_mps, dt_s, 60.0).position_m
            };
            let gap_m = (end(0.5) - end(0.25)).norm();
            assert!(gap_m < 1e-3, "{course_deg} degrees, {speed_mps} m/s: {gap_m} m");
        }
    }

    #[test]
    fn unpowered_hull_only_loses_energy() {
        for (u, v, r) in [(8.0, 0.0, 0.0), (5.0, 2.0, 0.3), (-3.0, -2.5, 0.8), (0.0, 0.1, -1.2)] {
            let mut state = State::ahead(Vec2::zeros(), 1.0, u);
            (state.sway_mps, state.yaw_rate_radps) = (v, r);
            let mut before = VIKNES.kinetic_energy_j(&state);
            for _ in 0..600 {
                state = VIKNES.coast(&state, Vec2::zeros(), 0.5);
                let after = VIKNES.kinetic_energy_j(&state);
                assert!(after <= before, "{before} -> {after}");
                before = after;
            }
        }
    }

    #[test]
    fn mirror_image_is_exact() {
        let mut state = State::ahead(Vec2::new(3.0, 5.0), 0.3, 6.0);
        let mut image = State::ahead(Vec2::new(3.0, -5.0), -0.3, 6.0);
        for k in 0..400 {
            let course = [1.9, -0.4, 3.0, 0.3][k / 100];
            state = sail(state, course, 7.0, 0.5, 0.5);
            image = sail(image, -course, 7.0, 0.5, 0.5);
            assert_eq!(state.position_m.x.to_bits(), image.position_m.x.to_bits());
            assert_eq!(state.position_m.y.to_bits(), (-image.position_m.y).to_bits());
            assert_eq!(state.psi_rad.to_bits(), (-image.psi_rad).to_bits());
        }
    }
}
