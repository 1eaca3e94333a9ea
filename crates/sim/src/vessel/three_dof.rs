//! Surge, sway and yaw of a displacement hull with its autopilot.
//!
//! `M nu' + C(nu) nu + D(nu) nu = tau` in the body frame, relative to the water (Fossen 2011,
//! Handbook of Marine Craft Hydrodynamics and Motion Control, section 6.5: with a constant
//! irrotational current the relative velocity obeys the same equation). M holds rigid body and
//! added mass; C follows from M, so that it does no work. A rudder or steered thruster at
//! `rudder_arm_m` gives moment and side force together.
//!
//! Integrated by the classical fourth-order Runge-Kutta rule with the autopilot inside the
//! derivative: a zero-order hold would add a delay of half a step to every manoeuvre. Where a limit
//! begins or ceases to hold the derivative has a kink, at which the rule is of second order only; a
//! step that meets one is taken again in [`KINK_PIECES`] pieces (docs/adr/0010).

use super::autopilot::Autopilot;
use super::slew::{Rates, Reach, Steering, reach};
use super::windage::Windage;
use super::{Actuators, Helm, Limits, State};
use geom::{Vec2, math};

/// A parameter set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThreeDof {
    /// Displacement, kg: the mass in a contact.
    pub displacement_kg: f64,
    /// Moment of inertia of the rigid body, kg m^2: likewise.
    pub inertia_kgm2: f64,
    /// Rigid body and added mass.
    pub mass: MassMatrix,
    /// Damping in surge, sway and yaw.
    pub damping: [Damping; 3],
    /// Thrust and rudder.
    pub propulsion: Propulsion,
    /// What the wind finds above the water.
    pub windage: Windage,
    /// Gains.
    pub autopilot: Autopilot,
    /// Declared largest yaw rate, rad/s; the autopilot asks for no more.
    pub yaw_rate_radps_max: f64,
    /// Declared largest speed, m/s.
    pub speed_mps_max: f64,
    /// Slowest speed at which she steers, m/s, where her source declares one.
    pub steerage_mps: Option<f64>,
}

/// Rigid body plus added mass, symmetric: kg, kg m, kg m^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassMatrix {
    /// Surge.
    pub surge: f64,
    /// Sway.
    pub sway: f64,
    /// Coupling of sway and yaw.
    pub sway_yaw: f64,
    /// Yaw.
    pub yaw: f64,
}

/// Damping force (N) or moment (N m) along one axis: `(linear + quadratic |x| + cubic x^2) x`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damping {
    /// First power.
    pub linear: f64,
    /// Second.
    pub quadratic: f64,
    /// Third.
    pub cubic: f64,
}

/// Actuators.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Propulsion {
    /// Largest thrust ahead, N.
    pub thrust_n_max: f64,
    /// Largest thrust astern, N, as a positive number.
    pub astern_n_max: f64,
    /// Largest side force of the rudder or steered thruster, N.
    pub side_n_max: f64,
    /// Where it acts, metres forward of the origin (negative: aft).
    pub rudder_arm_m: f64,
    /// How an angle of the steering becomes a side force, for trials with a given angle.
    pub steering: Steering,
    /// How fast the forces change; absent where the source gives none: at once.
    pub rates: Option<Rates>,
}

/// No ship forgets a motion slower, seconds. A laden tanker coasts for half an hour.
const TIME_CONSTANT_S_MAX: f64 = 3600.0;

/// Pieces of a step in which a limit begins or ceases to hold.
const KINK_PIECES: u32 = 8;

/// An actuator lags where it is further from the wish than it moves in this share of a step. The
/// small jump that each new order brings is no kink worth pieces.
const LAG_SHARE: f64 = 0.05;

/// Body velocities or their derivatives: surge, sway, yaw.
pub(super) type Nu = [f64; 3];

/// Thrust and side force (N), and which limits hold, a bit each: three pairs of the autopilot,
/// then the rates of engine and steering.
pub(super) type Forces = (f64, f64, u8);

impl MassMatrix {
    fn inverse(&self) -> Self {
        let determinant = self.sway * self.yaw - self.sway_yaw * self.sway_yaw;
        Self {
            surge: 1.0 / self.surge,
            sway: self.yaw / determinant,
            sway_yaw: -self.sway_yaw / determinant,
            yaw: self.sway / determinant,
        }
    }
}

impl Damping {
    #[inline]
    fn force(&self, x: f64) -> f64 {
        (self.linear + self.quadratic * x.abs() + self.cubic * (x * x)) * x
    }
}

impl ThreeDof {
    /// What the model declares. The largest speed is the declared one or, if that is less, the
    /// speed at which full thrust meets the resistance.
    pub fn limits(&self) -> Limits {
        let thrust_n = self.propulsion.thrust_n_max.min(self.propulsion.astern_n_max);
        Limits {
            yaw_rate_radps_max: self.yaw_rate_radps_max,
            speed_mps_max: self.speed_mps_max.min(self.speed_at_full_thrust_mps()),
            acceleration_mps2_max: thrust_n / self.mass.surge,
            steerage_mps: self.steerage_mps,
        }
    }

    /// Time constants of surge, sway and yaw at rest, seconds: mass over linear damping. They tell
    /// a slip of a unit in a parameter set from a ship.
    pub fn time_constants_s(&self) -> [f64; 3] {
        let masses = [self.mass.surge, self.mass.sway, self.mass.yaw];
        std::array::from_fn(|axis| masses[axis] / self.damping[axis].linear)
    }

    /// Whether a ship could have these time constants: over a tenth of a second, and no more than
    /// [`TIME_CONSTANT_S_MAX`].
    pub fn is_a_ship(&self) -> bool {
        self.time_constants_s().iter().all(|t_s| (0.1..=TIME_CONSTANT_S_MAX).contains(t_s))
    }

    /// Speed at which full thrust ahead meets the resistance, m/s, by bisection.
    fn speed_at_full_thrust_mps(&self) -> f64 {
        let (mut low, mut high) = (0.0, 100.0);
        for _ in 0..64 {
            let middle = 0.5 * (low + high);
            if self.damping[0].force(middle) < self.propulsion.thrust_n_max {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Moves through `dt_s` seconds.
    pub fn step(&self, state: &State, helm: &Helm, current_mps: Vec2, dt_s: f64) -> State {
        self.step_with(state, current_mps, dt_s, |nu, heading| self.autopilot_n(nu, heading, helm))
    }

    /// Moves through `dt_s` seconds under the forces that `wish(nu, heading)` asks for, as far as
    /// the actuators follow.
    ///
    /// An actuator is where the wish is, or as near to it as its rate allows since the start of the
    /// step. So the wish stays inside the derivative, as it is where no rate is given.
    #[inline]
    pub(super) fn step_with(
        &self,
        state: &State,
        current_mps: Vec2,
        dt_s: f64,
        wish: impl Fn(&Nu, Vec2) -> Forces,
    ) -> State {
        let (next, kinked) = self.piece(state, current_mps, dt_s, &wish);
        if !kinked {
            return next;
        }
        let piece_s = dt_s / f64::from(KINK_PIECES);
        (0..KINK_PIECES).fold(*state, |s, _| self.piece(&s, current_mps, piece_s, &wish).0)
    }

    /// A step, or a piece of one, and whether a limit began or ceased to hold in it.
    #[inline]
    fn piece(
        &self,
        state: &State,
        current_mps: Vec2,
        dt_s: f64,
        wish: &impl Fn(&Nu, Vec2) -> Forces,
    ) -> (State, bool) {
        let Some(rates) = self.propulsion.rates else {
            return self.integrate(state, current_mps, dt_s, |nu, heading, _| wish(nu, heading));
        };
        let from = state.actuators;
        let follow = |nu: &Nu, heading: Vec2, after_s: f64| {
            let (thrust_n, side_n, limits) = wish(nu, heading);
            let thrust = Reach { from: from.engine, rate: rates.thrust_nps };
            let side = Reach { from: from.steering, rate: rates.side_nps };
            let (engine_n, steering_n) =
                (reach(thrust, thrust_n, after_s), reach(side, side_n, after_s));
            let lags = |is_n: f64, wish_n: f64, nps: f64| {
                u8::from((wish_n - is_n).abs() > LAG_SHARE * nps * dt_s)
            };
            let rates = lags(engine_n, thrust_n, rates.thrust_nps) << 6
                | lags(steering_n, side_n, rates.side_nps) << 7;
            (engine_n, steering_n, limits | rates)
        };
        let (next, kinked) = self.integrate(state, current_mps, dt_s, follow);
        let nu = [next.surge_mps, next.sway_mps, next.yaw_rate_radps];
        let (engine, steering, _) = follow(&nu, next.heading, dt_s);
        (State { actuators: Actuators { engine, steering }, ..next }, kinked)
    }

    /// The state with the thrust that holds its speed.
    pub(super) fn settled(&self, state: State) -> State {
        if self.propulsion.rates.is_none() {
            return state;
        }
        let engine = self.damping[0].force(state.surge_mps);
        State { actuators: Actuators { engine, steering: 0.0 }, ..state }
    }

    /// Thrust that holds a speed straight ahead, N.
    pub(super) fn thrust_at_n(&self, speed_mps: f64) -> f64 {
        self.damping[0].force(speed_mps)
    }

    /// Leeway (m/s to starboard) in air that moves past her at these speeds ahead and to starboard.
    pub fn leeway_mps(&self, air_mps: [f64; 2]) -> f64 {
        let sway = &self.damping[1];
        self.windage.leeway_mps(air_mps, sway.linear, sway.quadratic)
    }

    /// Moves through `dt_s` seconds with engine and rudder off.
    pub fn coast(&self, state: &State, current_mps: Vec2, dt_s: f64) -> State {
        self.integrate(state, current_mps, dt_s, |_, _, _| (0.0, 0.0, 0)).0
    }

    /// Kinetic energy relative to the water, added mass included, J.
    pub fn kinetic_energy_j(&self, state: &State) -> f64 {
        let (u, v, r) = (state.surge_mps, state.sway_mps, state.yaw_rate_radps);
        let m = &self.mass;
        0.5 * (m.surge * u * u + m.sway * v * v + 2.0 * m.sway_yaw * v * r + m.yaw * r * r)
    }

    /// One Runge-Kutta step under thrust and side force from `control(nu, heading, after_s)`, and
    /// whether not the same limits held all the way.
    #[inline]
    fn integrate(
        &self,
        state: &State,
        current_mps: Vec2,
        dt_s: f64,
        control: impl Fn(&Nu, Vec2, f64) -> Forces,
    ) -> (State, bool) {
        let start = [state.surge_mps, state.sway_mps, state.yaw_rate_radps];
        let inverse = self.mass.inverse();
        let (mut nu, mut heading) = (start, state.heading);
        let (mut nu_sum, mut path_sum) = ([0.0; 3], Vec2::zeros());
        let mut turn_sum_radps = 0.0;
        let mut at = 0.0;
        let (mut all, mut any) = (u8::MAX, 0);
        for (share, reach) in [(1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 0.0)] {
            let (thrust_n, side_n, limits) = control(&nu, heading, at * dt_s);
            (all, any) = (all & limits, any | limits);
            at = reach;
            let rate = self.acceleration(&nu, thrust_n, side_n, &inverse);
            let [u, v, r] = nu;
            path_sum.x += share * (heading.x * u - heading.y * v);
            path_sum.y += share * (heading.y * u + heading.x * v);
            turn_sum_radps += share * r;
            for axis in 0..3 {
                nu_sum[axis] += share * rate[axis];
                nu[axis] = start[axis] + reach * dt_s * rate[axis];
            }
            if reach > 0.0 {
                heading = turned(state.heading, reach * dt_s * r);
            }
        }
        let sixth_s = dt_s / 6.0;
        let psi_rad = geom::wrap(state.psi_rad + sixth_s * turn_sum_radps);
        let next = State {
            position_m: state.position_m + (path_sum * sixth_s + current_mps * dt_s),
            psi_rad,
            heading: geom::unit(psi_rad),
            surge_mps: start[0] + sixth_s * nu_sum[0],
            sway_mps: start[1] + sixth_s * nu_sum[1],
            yaw_rate_radps: start[2] + sixth_s * nu_sum[2],
            actuators: state.actuators,
        };
        (next, all != any)
    }

    /// Coriolis and damping, as they stand on the left-hand side: `C(nu) nu + D(nu) nu`.
    #[inline]
    pub(super) fn resistance(&self, nu: &Nu) -> Nu {
        let [u, v, r] = *nu;
        let m = &self.mass;
        let lateral = m.sway * v + m.sway_yaw * r;
        [
            self.damping[0].force(u) - lateral * r,
            self.damping[1].force(v) + m.surge * u * r,
            self.damping[2].force(r) + lateral * u - m.surge * u * v,
        ]
    }

    #[inline]
    fn acceleration(&self, nu: &Nu, thrust_n: f64, side_n: f64, inverse: &MassMatrix) -> Nu {
        let resistance = self.resistance(nu);
        let lateral_n = side_n - resistance[1];
        let moment_nm = side_n * self.propulsion.rudder_arm_m - resistance[2];
        [
            (thrust_n - resistance[0]) * inverse.surge,
            inverse.sway * lateral_n + inverse.sway_yaw * moment_nm,
            inverse.sway_yaw * lateral_n + inverse.yaw * moment_nm,
        ]
    }
}

/// `heading` turned by `angle_rad`. Within a step the angle is small, where a short power series
/// is exact to the last bit or two; larger angles take the library's sine.
#[inline]
fn turned(heading: Vec2, angle_rad: f64) -> Vec2 {
    let (sin, cos) = if angle_rad.abs() < 0.25 {
        let x2 = angle_rad * angle_rad;
        let sin = 1.0 + x2 * (SIN[0] + x2 * (SIN[1] + x2 * (SIN[2] + x2 * (SIN[3] + x2 * SIN[4]))));
        let cos = 1.0 + x2 * (COS[0] + x2 * (COS[1] + x2 * (COS[2] + x2 * (COS[3] + x2 * COS[4]))));
        (angle_rad * sin, cos)
    } else {
        math::sin_cos(angle_rad)
    };
    Vec2::new(cos * heading.x - sin * heading.y, sin * heading.x + cos * heading.y)
}

/// Coefficients of sin(x) / x in x^2, from the second on.
const SIN: [f64; 5] =
    [-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0, -1.0 / 39_916_800.0];
/// Coefficients of cos(x) in x^2, from the second on.
const COS: [f64; 5] = [-1.0 / 2.0, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0, -1.0 / 3_628_800.0];

#[cfg(test)]
mod tests {
    use super::*;

    /// The SR108 set of commonocean-vessel-models 1.0.0 (BSD): damping lost three powers of ten, so
    /// that sway lives for 65 hours and yaw for 25.
    #[test]
    fn parameter_sets_that_no_ship_has_are_refused() {
        let viknes = crate::vessel::VIKNES;
        assert!(viknes.is_a_ship(), "{:?}", viknes.time_constants_s());
        let linear = |linear| Damping { linear, quadratic: 0.0, cubic: 0.0 };
        let sr108 = ThreeDof {
            mass: MassMatrix {
                surge: 24_562_069.875 + 1_799_893.025,
                sway: 24_562_069.875 + 26_543_765.987,
                sway_yaw: 0.0,
                yaw: 54_996_070_984.667 + 44_854_701_237.090,
            },
            damping: [linear(150_639.788), linear(218.603), linear(1_113_465.738)],
            ..viknes
        };
        let [surge_s, sway_s, yaw_s] = sr108.time_constants_s();
        assert!((surge_s - 175.0).abs() < 1.0, "{surge_s}");
        assert!((sway_s / 3600.0 - 65.0).abs() < 0.5, "{sway_s}");
        assert!((yaw_s / 3600.0 - 25.0).abs() < 0.5, "{yaw_s}");
        assert!(!sr108.is_a_ship());
    }

    /// The tanker of the same source (its `vessel_2`, 304.8 m) has the same slip: sway lives for
    /// 117 hours. CyberShip II at the scale of the model, 1.255 m, has the constants of a ship.
    #[test]
    fn the_other_sets_of_the_source() {
        let hours = |mass: f64, damping: f64| mass / damping / 3600.0;
        let tanker_sway_h = hours(63_417_860.87 + 67_881_333.765_2, 311.296_240_396);
        let tanker_yaw_h = hours(429_505_809_549.96 + 406_272_307_922.226, 5_184_423.652);
        assert!((tanker_sway_h - 117.0).abs() < 0.5, "{tanker_sway_h}");
        assert!((tanker_yaw_h - 44.8).abs() < 0.1, "{tanker_yaw_h}");
        assert!(tanker_sway_h * 3600.0 > TIME_CONSTANT_S_MAX);
        let model_s = [25.8 / 0.722_53, 33.8 / 0.889_65, 2.76 / 1.9];
        assert!(model_s.iter().all(|t_s| (0.1..=TIME_CONSTANT_S_MAX).contains(t_s)), "{model_s:?}");
    }

    #[test]
    fn short_series_is_the_sine() {
        for k in -250..=250 {
            let angle_rad = f64::from(k) * 1e-3;
            let gap = (turned(Vec2::new(1.0, 0.0), angle_rad) - geom::unit(angle_rad)).norm();
            assert!(gap < 3e-16, "{angle_rad}: {gap}");
        }
    }
}
