//! The planner's step: Fig. 13 and Steps 1 to 10 of section V.B.
//!
//! Here is the boundary between the project's clockwise angles and the paper's counter-clockwise
//! ones ([`ccw`], its own inverse). Targets keep course and speed by assumption; there is no
//! horizon in (3), so every tracked target counts, however far.

use super::class::sector;
use super::equations;
use super::memory::{Latch, TargetMemory};
use super::options::{Equations, Memory, Reference, Resume, ZhuangOptions};
use super::strategy::{self, PrintedAngles};
use crate::clearance::Clearance;
use crate::guidance::Guidance;
use geom::{EncounterClass, HeadOnSector, math, units, wrap};
use planner_api::{Command, Mission, Planner, PlannerEvents, Situation};
use std::f64::consts::FRAC_PI_2;

/// `consistent` aims this far past the edge, so that `<=` in (3) is false there; seed planner
/// specification, section 1.3.
const EDGE_MARGIN_RAD: f64 = 1e-6;
/// `consistent` divides (18) by at least this speed, m/s.
const V_A_MIN_MPS: f64 = 0.1;
/// `consistent` turns by at most this in one pass; a step of (18) is trustworthy far below it.
const DALPHA_MAX_RAD: f64 = FRAC_PI_2;

/// Compass course to the paper's angle, and back.
pub fn ccw(compass_rad: f64) -> f64 {
    wrap(FRAC_PI_2 - compass_rad)
}

/// The seed planner.
#[derive(Clone, Debug)]
pub struct Zhuang {
    options: ZhuangOptions,
    /// -1 in the negative control that exchanges the edges of the cone.
    side_sign: f64,
    clearance: Option<Clearance>,
    v_a_max: f64,
    guidance: Guidance,
    obstacles: Vec<Obstacle>,
    memory: TargetMemory,
    calls: u32,
    held: Velocity,
    noted: BeatNotes,
    events: PlannerEvents,
}

/// Own velocity in the paper's polar form: V_A in m/s, alpha counter-clockwise in radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Velocity {
    v_a: f64,
    alpha: f64,
}

/// What does not change about an obstacle within a beat.
#[derive(Clone, Copy, Debug)]
struct Obstacle {
    id: u32,
    v_b: f64,
    beta: f64,
    theta: f64,
    d: f64,
    r: f64,
    mu: f64,
    class: Option<EncounterClass>,
}

/// Steps 3 and 4 for one obstacle and one velocity.
#[derive(Clone, Copy, Debug)]
struct Look {
    v_s: f64,
    v_theta: f64,
    gamma: f64,
    flag: bool,
}

/// What happened within the beat, for the counts.
#[derive(Clone, Copy, Debug, Default)]
struct BeatNotes {
    capped: bool,
    limited: bool,
    inside_called_safe: bool,
    class_changed: bool,
    receding_flagged: bool,
}

impl Planner for Zhuang {
    fn reset(&mut self, mission: &Mission) {
        let ZhuangOptions { radius, unknown_length_m, .. } = self.options;
        self.clearance = Some(Clearance::new(mission, radius, unknown_length_m));
        self.v_a_max = mission.own.speed_mps_max;
        self.guidance.reset(mission);
        self.memory.clear();
        self.calls = 0;
        self.held = Velocity::default();
        self.events = PlannerEvents::default();
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        if self.calls.is_multiple_of(self.options.beat_calls) {
            self.noted = BeatNotes::default();
            self.held = self.beat(situation);
            self.count();
        }
        self.calls = self.calls.wrapping_add(1);
        Command::course_speed(ccw(self.held.alpha), self.held.v_a)
    }

    fn events(&self) -> PlannerEvents {
        self.events
    }

    fn head_on_sector(&self) -> Option<HeadOnSector> {
        let half_angle_rad = units::deg(self.options.head_on_half_angle_deg);
        Some(HeadOnSector { half_angle_rad, reciprocal_rad: half_angle_rad })
    }
}

impl Zhuang {
    /// With these readings; [`ZhuangOptions::check`] says whether the values make sense.
    pub fn new(options: ZhuangOptions) -> Self {
        Self {
            options,
            side_sign: 1.0,
            clearance: None,
            v_a_max: 0.0,
            guidance: Guidance::default(),
            obstacles: Vec::new(),
            memory: TargetMemory::default(),
            calls: 0,
            held: Velocity::default(),
            noted: BeatNotes::default(),
            events: PlannerEvents::default(),
        }
    }

    /// A planner broken on purpose: port and starboard are exchanged in every choice of a side.
    /// Only for `equations = consistent`.
    pub fn with_sides_exchanged(mut self) -> Self {
        self.side_sign = -1.0;
        self
    }

    fn side(&self, class: EncounterClass, alpha: f64, beta: f64) -> f64 {
        self.side_sign * strategy::side(class, alpha, beta)
    }

    /// One beat of the paper: Steps 1 to 10 under the chosen `resume`.
    fn beat(&mut self, situation: &Situation<'_>) -> Velocity {
        let wish = self.guidance.wish(situation.own.position_m);
        let goal = Velocity { v_a: wish.speed_mps, alpha: ccw(wish.course_rad()) };
        let present = Velocity { v_a: situation.own.sog_mps, alpha: ccw(situation.own.cog_rad) };
        let mut obstacles = std::mem::take(&mut self.obstacles);
        self.observe(situation, &mut obstacles);
        if self.options.memory == Memory::Latched {
            self.release(&obstacles, present, goal);
        }
        let resume = self.options.resume;
        let velocity = match resume {
            Resume::Hold if self.is_safe(&obstacles, goal) => goal,
            Resume::WhenSafe if self.is_safe(&obstacles, present) => goal,
            Resume::GoalFirst => self.avoid(&mut obstacles, goal),
            Resume::Hold | Resume::WhenSafe => self.avoid(&mut obstacles, present),
        };
        self.obstacles = obstacles;
        if velocity.v_a > self.v_a_max {
            self.noted.limited = true;
            return Velocity { v_a: self.v_a_max, ..velocity };
        }
        velocity
    }

    /// Step 1. In the order of track numbers, so that the order of the tracks decides nothing.
    fn observe(&mut self, situation: &Situation<'_>, obstacles: &mut Vec<Obstacle>) {
        obstacles.clear();
        let clearance = self.clearance.expect("reset comes before the first beat");
        for track in situation.tracks {
            let los_m = track.position_m - situation.own.position_m;
            let d = los_m.norm();
            let r = clearance.radius_m(track) * self.options.radius_factor;
            obstacles.push(Obstacle {
                id: track.id,
                v_b: track.sog_mps,
                beta: ccw(track.cog_rad),
                theta: math::atan2(los_m.x, los_m.y),
                d,
                r,
                mu: match self.options.equations {
                    Equations::AsPrinted => equations::mu_as_printed(r, d),
                    Equations::Consistent => equations::mu(r, d),
                },
                class: None,
            });
        }
        obstacles.sort_unstable_by_key(|obstacle| obstacle.id);
        self.memory.keep(|id| obstacles.binary_search_by_key(&id, |o| o.id).is_ok());
    }

    /// Finally past and clear: opening with the present and the goal velocity, and D > R.
    fn release(&mut self, obstacles: &[Obstacle], present: Velocity, goal: Velocity) {
        let opening = |o: &Obstacle, v: Velocity| {
            equations::los_rates(v.v_a, v.alpha, o.v_b, o.beta, o.theta).0 < 0.0
        };
        for o in obstacles {
            if o.d > o.r && opening(o, present) && opening(o, goal) {
                self.memory.of(o.id).latch = None;
            }
        }
    }

    fn is_safe(&mut self, obstacles: &[Obstacle], velocity: Velocity) -> bool {
        // every obstacle is looked at, so that the counts do not depend on their order
        let mut safe = true;
        for o in obstacles {
            safe &= !self.look(o, velocity).flag;
        }
        safe
    }

    /// Steps 2 to 10 from velocity `a`.
    fn avoid(&mut self, obstacles: &mut [Obstacle], mut a: Velocity) -> Velocity {
        let start = a;
        for _ in 0..self.options.inner_loop_cap {
            let mut reference: Option<(f64, equations::PolarChange)> = None;
            for o in obstacles.iter_mut() {
                let look = self.look(o, a);
                if !look.flag {
                    continue;
                }
                let change = self.change(o, look, a, start);
                let rank = self.rank(o, look, change);
                if reference.is_none_or(|(highest, _)| rank.total_cmp(&highest).is_gt()) {
                    reference = Some((rank, change));
                }
            }
            let Some((_, (d_alpha, d_va))) = reference else {
                return a;
            };
            self.events.passes += 1;
            a = self.apply(a, d_alpha, d_va);
        }
        self.noted.capped = true;
        a
    }

    /// Step 8: the obstacle of the highest rank is the reference of the pass.
    fn rank(&self, o: &Obstacle, look: Look, change: equations::PolarChange) -> f64 {
        match self.options.reference {
            // NaN counts as the largest, or it would pass as safe
            Reference::LargestChange => change.0.abs(),
            Reference::MostUrgent => {
                -equations::tcpa(o.d, look.v_s, math::length(look.v_s, look.v_theta))
            }
        }
    }

    /// Steps 3 and 4.
    fn look(&mut self, o: &Obstacle, a: Velocity) -> Look {
        let (v_s, v_theta) = equations::los_rates(a.v_a, a.alpha, o.v_b, o.beta, o.theta);
        match self.options.equations {
            Equations::AsPrinted => {
                let gamma = equations::gamma_as_printed(v_s, v_theta);
                let flag = gamma.abs() <= o.mu;
                self.noted.inside_called_safe |= o.mu.is_nan() && v_s > 0.0;
                self.noted.receding_flagged |= flag && v_s <= 0.0;
                Look { v_s, v_theta, gamma, flag }
            }
            Equations::Consistent => {
                let closing = v_s > 0.0 && math::length(v_s, v_theta) >= equations::DV_MIN_MPS;
                let gamma = if closing { equations::gamma(v_s, v_theta) } else { f64::NAN };
                let flag = closing && equations::collision(v_s, gamma, o.mu);
                Look { v_s, v_theta, gamma, flag }
            }
        }
    }

    /// Step 5: (19) to (23), then (18).
    fn change(
        &mut self,
        o: &mut Obstacle,
        look: Look,
        a: Velocity,
        start: Velocity,
    ) -> equations::PolarChange {
        let kept = self.class_and_side(o, a, start);
        match self.options.equations {
            Equations::AsPrinted => {
                let phi = equations::phi(a.v_a, a.alpha, o.v_b, o.beta);
                let angles = PrintedAngles {
                    alpha: a.alpha,
                    beta: o.beta,
                    theta: o.theta,
                    phi,
                    mu: o.mu,
                    gamma: look.gamma.abs(),
                };
                let dgamma = match kept.s {
                    Some(s) => equations::dgamma(s, o.mu, look.gamma),
                    None => strategy::dgamma_as_printed(kept.class, angles),
                };
                let dv = equations::dv(a.v_a, a.alpha, o.v_b, o.beta);
                equations::step(a.v_a, dv, dgamma, a.alpha - phi)
            }
            Equations::Consistent => {
                let s = kept.s.unwrap_or_else(|| self.side(kept.class, a.alpha, o.beta));
                let dgamma = equations::dgamma(s, o.mu + EDGE_MARGIN_RAD, look.gamma);
                let dv = math::length(look.v_s, look.v_theta);
                let varphi = equations::varphi(a.alpha, o.theta + look.gamma);
                equations::step(a.v_a.max(V_A_MIN_MPS), dv, dgamma, varphi)
            }
        }
    }

    /// The class under the chosen `memory`, and the side where it is kept.
    fn class_and_side(&mut self, o: &mut Obstacle, a: Velocity, start: Velocity) -> Kept {
        let h = units::deg(self.options.head_on_half_angle_deg);
        let class_at = |v: Velocity| sector(v.alpha, o.v_b, o.beta, o.theta, h);
        let first_of_beat = o.class.is_none();
        let sign = self.side_sign;
        let remembered = self.memory.of(o.id);
        let kept = match self.options.memory {
            Memory::None => Kept { class: class_at(a), s: None },
            Memory::ClassInBeat => Kept { class: o.class.unwrap_or(class_at(start)), s: None },
            Memory::Latched => {
                let latch = remembered.latch.get_or_insert_with(|| {
                    let class = class_at(start);
                    Latch { class, s: sign * strategy::side(class, start.alpha, o.beta) }
                });
                Kept { class: latch.class, s: Some(latch.s) }
            }
        };
        if first_of_beat {
            self.noted.class_changed |= remembered.note_class(kept.class);
            o.class = Some(kept.class);
        }
        kept
    }

    /// Step 9: (24).
    fn apply(&mut self, a: Velocity, d_alpha: f64, d_va: f64) -> Velocity {
        match self.options.equations {
            Equations::AsPrinted => Velocity { v_a: a.v_a + d_va, alpha: a.alpha + d_alpha },
            Equations::Consistent => {
                let turn = d_alpha.clamp(-DALPHA_MAX_RAD, DALPHA_MAX_RAD);
                let v_a = (a.v_a + d_va).clamp(0.0, self.v_a_max);
                let cut = (turn - d_alpha).abs() + (v_a - (a.v_a + d_va)).abs();
                self.noted.limited |= cut > 0.0;
                Velocity { v_a, alpha: wrap(a.alpha + turn) }
            }
        }
    }

    fn count(&mut self) {
        let BeatNotes { capped, limited, inside_called_safe, class_changed, receding_flagged } =
            self.noted;
        self.events.inner_loop_cap += u32::from(capped);
        self.events.limited += u32::from(limited);
        self.events.inside_called_safe += u32::from(inside_called_safe);
        self.events.class_changes += u32::from(class_changed);
        self.events.receding_flagged += u32::from(receding_flagged);
    }
}

/// The class that rules, and the side where it is not to be found anew.
#[derive(Clone, Copy, Debug)]
struct Kept {
    class: EncounterClass,
    s: Option<f64>,
}
