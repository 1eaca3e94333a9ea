//! Nomoto's first-order equation of steering, with Norrbin's cubic term: `T r' + r + n3 r^3 = K d`.
//!
//! Yaw rate `r` and rudder angle `d` alone: no sway, so that course and heading are one, and no
//! loss of speed in a turn. K, T and n3 depend on the speed (linear between the speeds of the
//! source, constant above). The engine is first order as well, within an acceleration. This is the
//! model of a ship of which only steering trials are known (Nomoto 1957; Norrbin 1963; Fossen 2011,
//! Handbook of Marine Craft Hydrodynamics and Motion Control, section 7.2).

use super::slew::{Reach, reach};
use super::{Actuators, Helm, Limits, State};
use geom::{Vec2, angle, math};

/// A parameter set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nomoto {
    /// K, T and n3 at some speeds, slowest first.
    pub at_speed: &'static [Gains],
    /// Largest rudder angle, radians.
    pub rudder_rad_max: f64,
    /// Largest rate of the rudder, rad/s.
    pub rudder_radps_max: f64,
    /// Time constant of the speed, seconds.
    pub surge_s: f64,
    /// Largest acceleration and deceleration, m/s^2.
    pub acceleration_mps2_max: f64,
    /// Ordered yaw rate for each radian of course error, 1/s.
    pub course: f64,
    /// Yaw acceleration for each rad/s of yaw rate error, 1/s.
    pub yaw_rate: f64,
}

/// The coefficients at one speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// Speed, m/s.
    pub speed_mps: f64,
    /// K, 1/s.
    pub gain_per_s: f64,
    /// T, seconds.
    pub time_s: f64,
    /// n3, s^2/rad^2.
    pub cubic_s2: f64,
}

/// Speed, heading (an angle from the start of the step) and yaw rate.
type Course = [f64; 3];

impl Nomoto {
    /// What the model declares: the yaw rate of full rudder at the fastest speed of the source.
    pub fn limits(&self) -> Limits {
        let fastest = self.at_speed.last().expect("a parameter set has a speed");
        Limits {
            yaw_rate_radps_max: steady_radps(fastest, self.rudder_rad_max),
            speed_mps_max: fastest.speed_mps,
            acceleration_mps2_max: self.acceleration_mps2_max,
            steerage_mps: self.at_speed.first().map(|slowest| slowest.speed_mps),
        }
    }

    /// Time constants of surge and yaw, seconds; there is no sway. The one of yaw is the longest
    /// over all speeds.
    pub fn time_constants_s(&self) -> [f64; 2] {
        [self.surge_s, self.at_speed.iter().map(|gains| gains.time_s).fold(0.0, f64::max)]
    }

    /// The coefficients at a speed. Below the slowest speed of the source the gain falls with the
    /// speed and the time constant grows, as both do for a hull that keeps its form of motion
    /// (K = K' U / L, T = T' L / U).
    pub fn gains(&self, speed_mps: f64) -> Gains {
        let slowest = &self.at_speed[0];
        if speed_mps <= slowest.speed_mps {
            let share = (speed_mps / slowest.speed_mps).clamp(SPEED_SHARE_MIN, 1.0);
            let (gain_per_s, time_s) = (slowest.gain_per_s * share, slowest.time_s / share);
            return Gains { speed_mps, gain_per_s, time_s, ..*slowest };
        }
        let Some(above) = self.at_speed.iter().position(|gains| gains.speed_mps >= speed_mps)
        else {
            return self.at_speed[self.at_speed.len() - 1];
        };
        let (low, high) = (&self.at_speed[above - 1], &self.at_speed[above]);
        let share = (speed_mps - low.speed_mps) / (high.speed_mps - low.speed_mps);
        let mix = |a: f64, b: f64| a + share * (b - a);
        Gains {
            speed_mps,
            gain_per_s: mix(low.gain_per_s, high.gain_per_s),
            time_s: mix(low.time_s, high.time_s),
            cubic_s2: mix(low.cubic_s2, high.cubic_s2),
        }
    }

    /// Moves through `dt_s` seconds.
    pub fn step(&self, state: &State, helm: &Helm, current_mps: Vec2, dt_s: f64) -> State {
        let wish_mps = helm.speed_mps.min(self.limits().speed_mps_max);
        let error_rad = turn_rad(state.heading, helm.direction);
        self.step_with(state, current_mps, dt_s, |gains, &[u, turned_rad, r]| {
            let rudder_rad = self.autopilot_rad(gains, error_rad - turned_rad, r);
            (rudder_rad, (wish_mps - u) / self.surge_s)
        })
    }

    /// One Runge-Kutta step; `wish` gives rudder angle and acceleration, as far as they are had.
    pub(super) fn step_with(
        &self,
        state: &State,
        current_mps: Vec2,
        dt_s: f64,
        wish: impl Fn(&Gains, &Course) -> (f64, f64),
    ) -> State {
        let rudder = Reach { from: state.actuators.steering, rate: self.rudder_radps_max };
        let (most_rad, most_mps2) = (self.rudder_rad_max, self.acceleration_mps2_max);
        let start = [state.surge_mps, 0.0, state.yaw_rate_radps];
        let rudder_rad = |gains: &Gains, course: &Course, after_s: f64| {
            let (rudder_rad, acceleration_mps2) = wish(gains, course);
            let rudder_rad = reach(rudder, rudder_rad.clamp(-most_rad, most_rad), after_s);
            (rudder_rad, acceleration_mps2.clamp(-most_mps2, most_mps2))
        };
        let (mut course, mut heading) = (start, state.heading);
        let (mut sum, mut path, mut at) = ([0.0; 3], Vec2::zeros(), 0.0);
        for (share, ahead) in [(1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 0.0)] {
            let gains = self.gains(course[0].abs());
            let (rudder_rad, acceleration_mps2) = rudder_rad(&gains, &course, at * dt_s);
            let [u, _, r] = course;
            let moment = gains.gain_per_s * rudder_rad - r - gains.cubic_s2 * r * r * r;
            let rate = [acceleration_mps2, r, moment / gains.time_s];
            path += heading * (share * u);
            for axis in 0..3 {
                sum[axis] += share * rate[axis];
                course[axis] = start[axis] + ahead * dt_s * rate[axis];
            }
            heading = angle::rotate(state.heading, course[1]);
            at = ahead;
        }
        let sixth_s = dt_s / 6.0;
        let end: Course = std::array::from_fn(|axis| start[axis] + sixth_s * sum[axis]);
        let psi_rad = geom::wrap(state.psi_rad + end[1]);
        let (steering, _) = rudder_rad(&self.gains(end[0].abs()), &end, dt_s);
        State {
            position_m: state.position_m + (path * sixth_s + current_mps * dt_s),
            psi_rad,
            heading: geom::unit(psi_rad),
            surge_mps: end[0],
            sway_mps: 0.0,
            yaw_rate_radps: end[2],
            actuators: Actuators { steering, ..state.actuators },
        }
    }

    /// Rudder angle for an error of the course: the one that gives the yaw acceleration asked for.
    fn autopilot_rad(&self, gains: &Gains, error_rad: f64, r: f64) -> f64 {
        let most_radps = steady_radps(gains, self.rudder_rad_max);
        let wish_radps = (self.course * error_rad).clamp(-most_radps, most_radps);
        let wish = gains.time_s * self.yaw_rate * (wish_radps - r) + r + gains.cubic_s2 * r * r * r;
        wish / gains.gain_per_s
    }
}

/// Steerage is never quite lost, so that the equations stay finite.
const SPEED_SHARE_MIN: f64 = 0.05;

/// Yaw rate that a rudder angle holds: `r + n3 r^3 = K d`, by Newton's method from above.
fn steady_radps(gains: &Gains, rudder_rad: f64) -> f64 {
    let wish = gains.gain_per_s * rudder_rad;
    let mut r = wish;
    for _ in 0..60 {
        r -= (r + gains.cubic_s2 * r * r * r - wish) / (1.0 + 3.0 * gains.cubic_s2 * r * r);
    }
    r
}

/// Angle from one direction to another, positive clockwise.
fn turn_rad(from: Vec2, to: Vec2) -> f64 {
    math::atan2(from.x * to.y - from.y * to.x, from.dot(&to))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::units::deg;

    const LINEAR: Nomoto = Nomoto {
        at_speed: &[
            Gains { speed_mps: 5.0, gain_per_s: 0.1, time_s: 20.0, cubic_s2: 0.0 },
            Gains { speed_mps: 10.0, gain_per_s: 0.2, time_s: 10.0, cubic_s2: 0.0 },
        ],
        rudder_rad_max: 0.6,
        rudder_radps_max: 1e3,
        surge_s: 50.0,
        acceleration_mps2_max: 0.1,
        course: 0.05,
        yaw_rate: 0.2,
    };

    /// `r = K d (1 - exp(-t / T))` after a step of the rudder.
    #[test]
    fn step_of_the_rudder_has_its_closed_form_and_the_order_is_four() {
        let error = |dt_s: f64| {
            let mut state = State::ahead(Vec2::zeros(), 0.0, 10.0);
            state.actuators.steering = 0.3;
            for _ in 0..(20.0 / dt_s) as usize {
                state = LINEAR.step_with(&state, Vec2::zeros(), dt_s, |_, _| (0.3, 0.0));
            }
            (state.yaw_rate_radps - 0.06 * (1.0 - math::exp(-2.0))).abs()
        };
        assert!(error(0.5) < 1e-9, "{}", error(0.5));
        let order = error(2.0) / error(1.0);
        assert!((13.0..20.0).contains(&order), "{order}");
    }

    #[test]
    fn coefficients_are_linear_between_speeds_and_fade_below_them() {
        let gains = LINEAR.gains(7.5);
        assert!((gains.gain_per_s - 0.15).abs() < 1e-12 && (gains.time_s - 15.0).abs() < 1e-12);
        let slow = LINEAR.gains(2.5);
        assert!((slow.gain_per_s - 0.05).abs() < 1e-12 && (slow.time_s - 40.0).abs() < 1e-12);
        assert!((LINEAR.gains(12.0).gain_per_s - 0.2).abs() < 1e-12);
    }

    #[test]
    fn steady_turn_solves_norrbin() {
        let gains = Gains { speed_mps: 9.0, gain_per_s: 0.18, time_s: 27.0, cubic_s2: 1970.0 };
        let r = steady_radps(&gains, 0.5);
        assert!((r + 1970.0 * r * r * r - 0.09).abs() < 1e-12, "{r}");
    }

    #[test]
    fn settles_on_course_and_speed_either_way() {
        for course_rad in [deg(60.0), deg(-60.0), deg(175.0)] {
            let helm = Helm::over_ground(course_rad, 7.0, Vec2::zeros());
            let mut state = State::ahead(Vec2::zeros(), 0.0, 10.0);
            for _ in 0..800 {
                state = LINEAR.step(&state, &helm, Vec2::zeros(), 0.5);
            }
            assert!((state.psi_rad - course_rad).abs() < 1e-3, "{}", state.psi_rad);
            assert!((state.surge_mps - 7.0).abs() < 1e-2);
        }
    }
}
