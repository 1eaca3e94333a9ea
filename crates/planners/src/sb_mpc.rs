//! `sb-mpc`: simulation-based model-predictive control after Johansen, Perez & Cristofaro 2016
//! (IEEE Trans. Intell. Transp. Syst. 17(12):3407-3422).
//!
//! A few control behaviours (a course offset and a propulsion command) are predicted, and the one
//! of least hazard is taken:
//! `H^k = max_i max_t [ C_i(t) R_i(t) + kappa mu_i(t) ] + f(P, chi_ca)`.
//! The cost's structure was checked against two public re-implementations; its parameters vary
//! between them, and each option names the value taken. mu penalises predicted states with the
//! target to *starboard* under Rules 14 and 15, so that it is passed to port.

use crate::clearance::{Clearance, RadiusKind, UNKNOWN_LENGTH_M};
use crate::guidance::{Guidance, Wish};
use geom::{Vec2, angle, math, units::deg, wrap};
use planner_api::{Command, Mission, OwnShip, OwnState, Planner, Situation, TargetTrack};
use serde::{Deserialize, Serialize};

/// Course offsets, degrees: none, then alternately to starboard and port, so that of equal
/// behaviours the one to starboard wins.
const OFFSETS_DEG: [f64; 13] =
    [0.0, 15.0, -15.0, 30.0, -30.0, 45.0, -45.0, 60.0, -60.0, 75.0, -75.0, 90.0, -90.0];
/// Propulsion commands: nominal, slow ahead, stop.
const PROPULSIONS: [f64; 3] = [1.0, 0.5, 0.0];
/// A target below this speed takes no part in Rule 14, m/s.
const MOVING_MPS: f64 = 0.05;

/// Its options; the symbols are the paper's.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SbMpcOptions {
    /// Horizon T, seconds (paper: 300 to 600).
    pub horizon_s: f64,
    /// Step of the prediction, seconds (0.5 to 5).
    pub step_s: f64,
    /// Time from one decision to the next, seconds (paper: 5).
    pub replan_s: f64,
    /// p: decay of the hazard with time.
    pub p: u32,
    /// q: growth of the hazard with nearness.
    pub q: u32,
    /// d_close: rules apply to targets nearer than this, metres (200 to 1000).
    pub d_close_m: f64,
    /// d_safe is R of the target plus this, metres (40 to 200 in all for small craft).
    pub d_safe_beyond_radius_m: f64,
    /// K_coll: cost of a collision per squared relative speed.
    pub k_coll: f64,
    /// kappa: cost of breaking a rule (3 to 10).
    pub kappa: f64,
    /// phi_ahead, degrees (15 to 68.5).
    pub phi_ahead_deg: f64,
    /// phi_HO, degrees.
    pub phi_head_on_deg: f64,
    /// phi_CR = phi_OT, degrees.
    pub phi_crossing_deg: f64,
    /// k_P: cost of slowing down.
    pub k_p: f64,
    /// k_chi to starboard (0.9 to 1.5).
    pub k_chi_starboard: f64,
    /// k_chi to port (1.3 to 30).
    pub k_chi_port: f64,
    /// k_dP: cost of changing the propulsion.
    pub k_dp: f64,
    /// k_dchi to starboard (0.9 to 1.0).
    pub k_dchi_starboard: f64,
    /// k_dchi to port (1.2 to 1.4).
    pub k_dchi_port: f64,
    /// What R is.
    pub radius: RadiusKind,
    /// Length, metres, of a target that does not report one.
    pub unknown_length_m: f64,
}

impl Default for SbMpcOptions {
    fn default() -> Self {
        Self {
            horizon_s: 300.0,
            step_s: 2.5,
            replan_s: 5.0,
            p: 1,
            q: 4,
            d_close_m: 1000.0,
            d_safe_beyond_radius_m: 50.0,
            k_coll: 0.5,
            kappa: 3.0,
            phi_ahead_deg: 68.5,
            phi_head_on_deg: 22.5,
            phi_crossing_deg: 68.5,
            k_p: 2.5,
            k_chi_starboard: 1.3,
            k_chi_port: 10.0,
            k_dp: 2.0,
            k_dchi_starboard: 0.9,
            k_dchi_port: 1.2,
            radius: RadiusKind::Mission,
            unknown_length_m: UNKNOWN_LENGTH_M,
        }
    }
}

impl SbMpcOptions {
    /// What is wrong with the values, and what would be right.
    pub fn check(&self) -> Result<(), String> {
        let (horizon_s, step_s) = (self.horizon_s, self.step_s);
        if !(0.1..=60.0).contains(&step_s) || !(step_s..=3600.0).contains(&horizon_s) {
            return Err(format!(
                "`step_s` is {step_s} and `horizon_s` {horizon_s}; they must be from 0.1 to 60 and \
                 from one step to 3600"
            ));
        }
        if self.p > 8 || self.q > 8 {
            return Err("`p` and `q` must be at most 8".to_owned());
        }
        Ok(())
    }
}

/// A control behaviour.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Behaviour {
    offset_rad: f64,
    propulsion: f64,
}

const STRAIGHT_ON: Behaviour = Behaviour { offset_rad: 0.0, propulsion: 1.0 };

/// The limits of the decision's cosines.
#[derive(Clone, Copy, Debug)]
struct Cosines {
    ahead: f64,
    head_on: f64,
    crossing: f64,
}

/// A target for the prediction: straight on at its present velocity.
#[derive(Clone, Copy, Debug)]
struct Straight {
    from_own_m: Vec2,
    velocity_mps: Vec2,
    speed_mps: f64,
    d_safe_m: f64,
    hulls_m: f64,
}

/// The planner.
#[derive(Clone, Debug)]
pub struct SbMpc {
    options: SbMpcOptions,
    cosines: Cosines,
    guidance: Guidance,
    own: Option<OwnShip>,
    clearance: Option<Clearance>,
    last: Behaviour,
    decided_s: Option<f64>,
    targets: Vec<Straight>,
    path: Vec<Predicted>,
}

/// One step of own ship's predicted motion.
#[derive(Clone, Copy, Debug)]
struct Predicted {
    from_own_m: Vec2,
    velocity_mps: Vec2,
    speed_mps: f64,
}

impl SbMpc {
    /// With these parameters.
    pub fn new(options: SbMpcOptions) -> Self {
        let cosines = Cosines {
            ahead: math::cos(deg(options.phi_ahead_deg)),
            head_on: math::cos(deg(options.phi_head_on_deg)),
            crossing: math::cos(deg(options.phi_crossing_deg)),
        };
        Self {
            options,
            cosines,
            guidance: Guidance::default(),
            own: None,
            clearance: None,
            last: STRAIGHT_ON,
            decided_s: None,
            targets: Vec::new(),
            path: Vec::new(),
        }
    }

    fn decide(&mut self, own: &OwnState, wish: Wish) -> Behaviour {
        let mut best = (f64::INFINITY, STRAIGHT_ON);
        for offset_deg in OFFSETS_DEG {
            for propulsion in PROPULSIONS {
                let behaviour = Behaviour { offset_rad: deg(offset_deg), propulsion };
                let manoeuvre = self.manoeuvre_cost(behaviour);
                if manoeuvre >= best.0 {
                    continue;
                }
                self.predict(own, wish, behaviour);
                let cost = manoeuvre + self.hazard(best.0 - manoeuvre);
                if cost < best.0 {
                    best = (cost, behaviour);
                }
            }
        }
        best.1
    }

    /// f(P, chi_ca).
    fn manoeuvre_cost(&self, Behaviour { offset_rad, propulsion }: Behaviour) -> f64 {
        let o = &self.options;
        let by_side = |angle_rad: f64, starboard, port| {
            angle_rad * angle_rad * if angle_rad < 0.0 { port } else { starboard }
        };
        o.k_p * (1.0 - propulsion)
            + by_side(offset_rad, o.k_chi_starboard, o.k_chi_port)
            + o.k_dp * (propulsion - self.last.propulsion).abs()
            + by_side(offset_rad - self.last.offset_rad, o.k_dchi_starboard, o.k_dchi_port)
    }

    /// Own ship turns and accelerates at her limits towards the behaviour's course and speed.
    fn predict(&mut self, own: &OwnState, wish: Wish, behaviour: Behaviour) {
        let ship = self.own.expect("reset comes before the first beat");
        let dt_s = self.options.step_s;
        let steps = (self.options.horizon_s / dt_s) as usize;
        let goal_rad = wrap(wish.course_rad() + behaviour.offset_rad);
        let goal_mps = wish.speed_mps * behaviour.propulsion;
        let turn_rad = ship.yaw_rate_radps_max * dt_s;
        let change_mps = ship.acceleration_mps2_max * dt_s;
        let (mut course_rad, mut speed_mps) = (own.cog_rad, own.sog_mps);
        let mut direction = angle::unit(course_rad);
        let mut from_own_m = Vec2::zeros();
        self.path.clear();
        for _ in 0..steps {
            let left_rad = wrap(goal_rad - course_rad);
            if left_rad.abs() > 0.0 {
                course_rad = if left_rad.abs() <= turn_rad {
                    goal_rad
                } else {
                    wrap(course_rad + turn_rad.copysign(left_rad))
                };
                direction = angle::unit(course_rad);
            }
            speed_mps += (goal_mps - speed_mps).clamp(-change_mps, change_mps);
            let velocity_mps = direction * speed_mps;
            from_own_m += velocity_mps * dt_s;
            self.path.push(Predicted { from_own_m, velocity_mps, speed_mps });
        }
    }

    /// max_i max_t [ C_i R_i + kappa mu_i ]; stops once it is past `limit`.
    fn hazard(&self, limit: f64) -> f64 {
        let o = &self.options;
        let mut worst = 0.0f64;
        for target in &self.targets {
            for (step, own) in self.path.iter().enumerate() {
                let t_s = (step + 1) as f64 * o.step_s;
                let los_m = target.from_own_m + target.velocity_mps * t_s - own.from_own_m;
                let range_m = los_m.norm();
                let mut cost = 0.0;
                let d_m = (range_m - target.hulls_m).max(1.0);
                if d_m <= target.d_safe_m {
                    let relative_mps = own.velocity_mps - target.velocity_mps;
                    let c = o.k_coll * relative_mps.norm_squared();
                    cost += c * power(target.d_safe_m / d_m, o.q) / power(t_s, o.p);
                }
                if d_m <= o.d_close_m && self.breaks_rule(own, target, los_m, range_m) {
                    cost += o.kappa;
                }
                worst = worst.max(cost);
            }
            if worst >= limit {
                break;
            }
        }
        worst
    }

    /// mu: RULE14 or RULE15, with the target to starboard of the predicted course.
    fn breaks_rule(&self, own: &Predicted, target: &Straight, los_m: Vec2, range_m: f64) -> bool {
        if own.velocity_mps.perp(&los_m) <= 0.0 {
            return false;
        }
        let speeds = own.speed_mps * target.speed_mps;
        let dot = own.velocity_mps.dot(&target.velocity_mps);
        let head_on = target.speed_mps > MOVING_MPS
            && dot < -self.cosines.head_on * speeds
            && own.velocity_mps.dot(&los_m) > self.cosines.ahead * own.speed_mps * range_m;
        let crossed = dot < self.cosines.crossing * speeds;
        let overtaken = dot > self.cosines.crossing * speeds && target.speed_mps > own.speed_mps;
        head_on || (crossed && !overtaken)
    }
}

fn power(base: f64, exponent: u32) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}

impl Planner for SbMpc {
    fn reset(&mut self, mission: &Mission) {
        let SbMpcOptions { radius, unknown_length_m, .. } = self.options;
        self.clearance = Some(Clearance::new(mission, radius, unknown_length_m));
        self.own = Some(mission.own);
        self.guidance.reset(mission);
        self.last = STRAIGHT_ON;
        self.decided_s = None;
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let own = &situation.own;
        let wish = self.guidance.wish(own.position_m);
        let due = self.decided_s.is_none_or(|t| situation.t_s - t >= self.options.replan_s - 1e-6);
        if due {
            let clearance = self.clearance.expect("reset comes before the first beat");
            let beyond_m = self.options.d_safe_beyond_radius_m;
            let straight = |track: &TargetTrack| {
                let hulls_m = clearance.hulls_m(track);
                Straight {
                    from_own_m: track.position_m - own.position_m,
                    velocity_mps: track.velocity_mps,
                    speed_mps: track.sog_mps,
                    d_safe_m: clearance.radius_m(track) - hulls_m + beyond_m,
                    hulls_m,
                }
            };
            self.targets.clear();
            self.targets.extend(situation.tracks.iter().map(straight));
            self.last = self.decide(own, wish);
            self.decided_s = Some(situation.t_s);
        }
        let course_rad = wrap(wish.course_rad() + self.last.offset_rad);
        Command::course_speed(course_rad, wish.speed_mps * self.last.propulsion)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rules as seen by own ship northbound at 8 m/s.
    fn breaks(from_own_m: (f64, f64), course_deg: f64, speed_mps: f64) -> bool {
        let velocity = |course_deg: f64, speed_mps| angle::unit(deg(course_deg)) * speed_mps;
        let own = Predicted {
            from_own_m: Vec2::zeros(),
            velocity_mps: velocity(0.0, 8.0),
            speed_mps: 8.0,
        };
        let los_m = Vec2::new(from_own_m.0, from_own_m.1);
        let target = Straight {
            from_own_m: los_m,
            velocity_mps: velocity(course_deg, speed_mps),
            speed_mps,
            d_safe_m: 200.0,
            hulls_m: 0.0,
        };
        SbMpc::new(SbMpcOptions::default()).breaks_rule(&own, &target, los_m, los_m.norm())
    }

    /// One re-implementation inverts these between two frames: starboard is east here.
    #[test]
    fn rules_14_and_15_want_the_target_to_port() {
        assert!(breaks((800.0, 50.0), 180.0, 6.0), "head-on to starboard");
        assert!(!breaks((800.0, -50.0), 180.0, 6.0), "head-on to port");
        assert!(breaks((500.0, 500.0), -90.0, 6.0), "crossing from starboard");
        assert!(!breaks((500.0, -500.0), 90.0, 6.0), "crossing from port");
        assert!(!breaks((-500.0, 300.0), -10.0, 11.0), "being overtaken");
    }

    #[test]
    fn port_costs_more_than_starboard() {
        let planner = SbMpc::new(SbMpcOptions::default());
        let cost = |offset_deg: f64| {
            planner.manoeuvre_cost(Behaviour { offset_rad: deg(offset_deg), propulsion: 1.0 })
        };
        assert!(cost(-30.0) > cost(30.0) && cost(30.0) > cost(0.0));
        // k_chi chi^2 + k_dchi (chi - 0)^2
        assert!((cost(30.0) - (1.3 + 0.9) * deg(30.0) * deg(30.0)).abs() < 1e-12);
    }
}
