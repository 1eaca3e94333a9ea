//! A ship without inertia in yaw: she turns and accelerates at once, at constant rates, and stops
//! turning exactly on the ordered heading.
//!
//! This is the vessel of laboratory scenes and of targets whose dynamics nobody knows.

use super::{Helm, State};
use geom::Vec2;
use std::f64::consts::PI;

/// Rates and limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinematic {
    /// Turn rate, rad/s.
    pub yaw_rate_radps_max: f64,
    /// Acceleration and deceleration, m/s^2.
    pub acceleration_mps2_max: f64,
    /// Largest speed through the water, m/s.
    pub speed_mps_max: f64,
}

impl Kinematic {
    /// Moves through `dt_s` seconds. She turns the shorter way; a turn of exactly pi goes to
    /// starboard. The path is exact where the speed or the heading is constant, and by Simpson's
    /// rule (error of fourth order in the angle turned) where both change.
    pub fn step(&self, state: &State, helm: &Helm, current_mps: Vec2, dt_s: f64) -> State {
        let turn_rad = geom::wrap(helm.psi_rad - state.psi_rad);
        let ordered_mps = helm.speed_mps.clamp(0.0, self.speed_mps_max);
        let gain_mps = ordered_mps - state.surge_mps;
        let drift_m = current_mps * dt_s;
        if turn_rad.abs() <= 0.0 && gain_mps.abs() <= 0.0 {
            let path_m = state.heading * (state.surge_mps * dt_s);
            let position_m = state.position_m + (path_m + drift_m);
            return State { position_m, yaw_rate_radps: 0.0, ..*state };
        }
        let turning_s = turn_rad.abs() / self.yaw_rate_radps_max;
        let gaining_s = gain_mps.abs() / self.acceleration_mps2_max;
        let rate_radps = self.yaw_rate_radps_max.copysign(turn_rad);
        let acceleration_mps2 = self.acceleration_mps2_max.copysign(gain_mps);

        let mut next = *state;
        let mut t_s = 0.0;
        for end_s in [turning_s.min(gaining_s).min(dt_s), turning_s.max(gaining_s).min(dt_s), dt_s]
        {
            let lasts_s = end_s - t_s;
            if lasts_s > 0.0 {
                let turns = if t_s < turning_s { rate_radps } else { 0.0 };
                let gains = if t_s < gaining_s { acceleration_mps2 } else { 0.0 };
                next = arc(&next, turns, gains, lasts_s);
            }
            if end_s >= turning_s {
                (next.psi_rad, next.heading) = (helm.psi_rad, helm.direction);
            }
            if end_s >= gaining_s {
                next.surge_mps = ordered_mps;
            }
            t_s = end_s;
        }
        next.position_m += drift_m;
        next.yaw_rate_radps = if turning_s > dt_s { rate_radps } else { 0.0 };
        next
    }

    /// Moves through `dt_s` seconds at a share of the largest turn rate and of the largest
    /// acceleration, both from -1 to 1; she does not go astern.
    pub(super) fn by_hand(&self, state: &State, turn: f64, gain: f64, dt_s: f64) -> State {
        let rate_radps = turn.clamp(-1.0, 1.0) * self.yaw_rate_radps_max;
        let acceleration_mps2 = gain.clamp(-1.0, 1.0) * self.acceleration_mps2_max;
        let stops = -state.surge_mps / dt_s;
        let next = arc(state, rate_radps, acceleration_mps2.max(stops), dt_s);
        State { yaw_rate_radps: rate_radps, ..next }
    }
}

/// Constant turn rate and acceleration for `dt_s` seconds.
fn arc(from: &State, rate_radps: f64, acceleration_mps2: f64, dt_s: f64) -> State {
    let surge_mps = from.surge_mps + acceleration_mps2 * dt_s;
    let middle_mps = 0.5 * (from.surge_mps + surge_mps);
    if rate_radps.abs() <= 0.0 {
        let position_m = from.position_m + from.heading * (middle_mps * dt_s);
        return State { position_m, surge_mps, ..*from };
    }
    let half_rad = 0.5 * (rate_radps * dt_s);
    let middle = geom::unit(from.psi_rad + half_rad);
    let psi_rad = geom::wrap(from.psi_rad + 2.0 * half_rad);
    let heading = geom::unit(psi_rad);
    // chord of a circle at constant speed; the change of speed adds its part by Simpson's rule
    let chord_m = middle * (middle_mps * dt_s * sinc(half_rad));
    let gain_m = (heading - from.heading) * ((surge_mps - from.surge_mps) * dt_s / 12.0);
    let position_m = from.position_m + chord_m + gain_m;
    State { position_m, psi_rad, heading, surge_mps, ..*from }
}

/// sin(x) / x for an angle within half a turn.
fn sinc(x_rad: f64) -> f64 {
    debug_assert!(x_rad.abs() <= 2.0 * PI, "one step turns by {x_rad} rad");
    if x_rad.abs() < 1e-4 { 1.0 - x_rad * x_rad / 6.0 } else { geom::math::sin(x_rad) / x_rad }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::units::deg;

    const SHIP: Kinematic =
        Kinematic { yaw_rate_radps_max: 0.1, acceleration_mps2_max: 0.5, speed_mps_max: 12.0 };

    fn sail(course_rad: f64, speed_mps: f64, dt_s: f64, steps: usize) -> State {
        let helm = Helm::over_ground(course_rad, speed_mps, Vec2::zeros());
        (0..steps).fold(State::ahead(Vec2::zeros(), 0.0, 8.0), |state, _| {
            SHIP.step(&state, &helm, Vec2::zeros(), dt_s)
        })
    }

    /// Radius 80 m: a quarter turn ends 80 m north and 80 m east, then 40 m east in five seconds.
    #[test]
    fn quarter_turn_is_a_quarter_circle_and_ends_on_the_order() {
        for (dt_s, steps) in [(0.1, 207), (0.5, 41), (1.0, 20)] {
            let state = sail(deg(90.0), 8.0, dt_s, steps);
            let straight_m = 8.0 * (dt_s * steps as f64 - deg(90.0) / 0.1);
            let expected = Vec2::new(80.0, 80.0 + straight_m);
            assert!((state.position_m - expected).norm() < 1e-9, "{dt_s}: {:?}", state.position_m);
            assert_eq!(state.psi_rad.to_bits(), deg(90.0).to_bits());
            assert_eq!(state.yaw_rate_radps.to_bits(), 0f64.to_bits());
        }
    }

    #[test]
    fn turns_the_shorter_way_and_a_half_turn_to_starboard() {
        assert!(sail(deg(-170.0), 8.0, 0.5, 1).psi_rad < 0.0);
        assert!(sail(PI, 8.0, 0.5, 1).psi_rad > 0.0);
        assert!(sail(geom::wrap(-PI), 8.0, 0.5, 1).psi_rad > 0.0);
    }

    #[test]
    fn speed_is_limited_in_value_and_rate() {
        let braking = sail(0.0, 2.0, 0.5, 10);
        assert!((braking.surge_mps - 5.5).abs() < 1e-12);
        // 8 t - t^2/4 after 5 s
        assert!((braking.position_m.x - (40.0 - 6.25)).abs() < 1e-9);
        assert!((sail(0.0, 99.0, 0.5, 100).surge_mps - 12.0).abs() < 1e-12);
    }

    /// Turning and braking at once, against a path integrated in steps of a millisecond.
    #[test]
    fn spiral_does_not_depend_on_the_step() {
        let fine = sail(deg(60.0), 4.0, 0.001, 10_000);
        for (dt_s, steps) in [(0.25, 40), (0.5, 20), (1.0, 10)] {
            let gap_m = (sail(deg(60.0), 4.0, dt_s, steps).position_m - fine.position_m).norm();
            assert!(gap_m < 1e-4 * dt_s, "{gap_m} m at {dt_s} s");
        }
    }
}
