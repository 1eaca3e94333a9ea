//! The way of one last-minute manoeuvre, and another ship going straight past it.
//!
//! Part of [`crate::escapes`]: the way is sailed once through the water in the ship's own frame;
//! how near another ship comes to it is decided by rectangles and circles wherever they settle it.

use crate::hull::Hull;
use crate::interval::{Hulls, Interval, closest_in};
use crate::pose::Pose;
use crate::vessel::{Helm, Model, State};
use geom::{HullOutline, Vec2, math, units::deg};
use std::f64::consts::{FRAC_PI_2, PI};

/// A way is straight from here on at the latest, seconds.
const WAY_S_MAX: f64 = 1800.0;
/// A heading is reached within this, rad.
const HEADING_REACHED_RAD: f64 = deg(0.2);
/// ... and this yaw rate, rad/s.
const STEADY_RADPS: f64 = deg(0.005);
/// A speed is reached within this, m/s. What is left of it is lost from the way: with time
/// constants of half a minute, some centimetres.
const SPEED_REACHED_MPS: f64 = 0.001;

/// To which side a ship turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// To the right.
    Starboard,
    /// To the left.
    Port,
}

/// A last-minute manoeuvre of one ship alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manoeuvre {
    /// Hard over until the heading has changed by 90 degrees, then steady.
    QuarterTurn(Side),
    /// Hard over until it has changed by 180 degrees, then steady.
    HalfTurn(Side),
    /// Hard over until it has changed by 90 degrees, engine full astern until stopped.
    TurnAndStop(Side),
    /// Engine full astern until stopped, on the old heading.
    CrashStop,
}

impl Manoeuvre {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::QuarterTurn(Side::Starboard),
        Self::QuarterTurn(Side::Port),
        Self::HalfTurn(Side::Starboard),
        Self::HalfTurn(Side::Port),
        Self::TurnAndStop(Side::Starboard),
        Self::TurnAndStop(Side::Port),
        Self::CrashStop,
    ];

    /// To which side it turns; absent where it does not.
    pub const fn side(self) -> Option<Side> {
        match self {
            Self::QuarterTurn(side) | Self::HalfTurn(side) | Self::TurnAndStop(side) => Some(side),
            Self::CrashStop => None,
        }
    }

    /// Heading and speed on which it ends, for a ship that was heading north at `surge_mps`.
    fn end(self, surge_mps: f64) -> (f64, f64) {
        let turn_rad = match self {
            Self::QuarterTurn(_) | Self::TurnAndStop(_) => FRAC_PI_2,
            Self::HalfTurn(_) => PI,
            Self::CrashStop => 0.0,
        };
        let stops = matches!(self, Self::TurnAndStop(_) | Self::CrashStop);
        let sign = if self.side() == Some(Side::Port) { -1.0 } else { 1.0 };
        (sign * turn_rad, if stops { 0.0 } else { surge_mps })
    }
}

/// Beat and step of the run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    pub(crate) beat_s: f64,
    pub(crate) step_s: f64,
}

impl Clock {
    fn steps_a_beat(self) -> usize {
        (self.beat_s / self.step_s).round() as usize
    }
}

/// A hull, and the rectangle around it.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    pub(crate) hull: Hull,
    pub(crate) midships_m: Vec2,
    pub(crate) half_length_m: f64,
    pub(crate) half_beam_m: f64,
}

impl Body {
    pub(crate) fn new(outline: &HullOutline) -> Self {
        Self {
            hull: Hull::new(outline),
            midships_m: Vec2::new(outline.midships_forward_m, outline.midships_starboard_m),
            half_length_m: outline.length_m / 2.0,
            half_beam_m: outline.beam_m / 2.0,
        }
    }

    /// Distance from a point, `offset_m` off the reference point, to the rectangle, metres.
    fn distance_m(&self, heading: Vec2, offset_m: Vec2) -> f64 {
        let forward_m = heading.dot(&offset_m) - self.midships_m.x;
        let abeam_m = heading.x * offset_m.y - heading.y * offset_m.x - self.midships_m.y;
        let x_m = (forward_m.abs() - self.half_length_m).max(0.0);
        let y_m = (abeam_m.abs() - self.half_beam_m).max(0.0);
        math::length(x_m, y_m)
    }
}

/// The way of one manoeuvre through the water, from the origin and heading north: a pose a step,
/// as many as a run looks at, in whole beats, and straight on from the last one.
#[derive(Debug)]
pub(crate) struct Way {
    pub(crate) manoeuvre: Manoeuvre,
    pub(crate) surge_mps: f64,
    pub(crate) poses: Vec<Pose>,
    /// The last one, going straight as ordered.
    pub(crate) after: Pose,
    pub(crate) fastest_mps: f64,
    /// Fastest turn, rad/s.
    pub(crate) turns_radps: f64,
}

impl Way {
    /// Sails a manoeuvre from this speed, `lag_s` after the order.
    pub(crate) fn sail(
        model: &Model,
        manoeuvre: Manoeuvre,
        surge_mps: f64,
        lag_s: f64,
        clock: Clock,
    ) -> Self {
        let (end_rad, end_mps) = manoeuvre.end(surge_mps);
        let mut state = State::ahead(Vec2::zeros(), 0.0, surge_mps);
        let pose = |state: &State| Pose::of(state, Vec2::zeros());
        let mut poses = vec![pose(&state)];
        for beat in 0..(WAY_S_MAX / clock.beat_s) as usize {
            let waits = (beat as f64) * clock.beat_s < lag_s;
            if !waits && has_reached(&state, end_rad, end_mps) {
                break;
            }
            let helm = if waits { helm(0.0, surge_mps) } else { order(&state, end_rad, end_mps) };
            for _ in 0..clock.steps_a_beat() {
                state = model.step(&state, &helm, Vec2::zeros(), clock.step_s);
                poses.push(pose(&state));
            }
        }
        let speed_mps = |pose: &Pose| pose.velocity_mps.norm();
        let last = poses[poses.len() - 1];
        let velocity_mps = geom::unit(end_rad) * end_mps;
        Self {
            manoeuvre,
            surge_mps,
            fastest_mps: poses.iter().map(speed_mps).fold(0.0, f64::max),
            turns_radps: poses.iter().map(|p| p.yaw_rate_radps.abs()).fold(0.0, f64::max),
            after: Pose { velocity_mps, yaw_rate_radps: 0.0, ..last },
            poses,
        }
    }
}

fn helm(psi_rad: f64, speed_mps: f64) -> Helm {
    Helm { psi_rad, direction: geom::unit(psi_rad), speed_mps }
}

/// The order of a beat: a quarter of a circle ahead of her until no more than that is left, so that
/// she turns to the right side.
fn order(state: &State, end_rad: f64, end_mps: f64) -> Helm {
    let far = end_rad.abs() > FRAC_PI_2 && state.heading.x > 0.0;
    let ahead_rad = geom::wrap(state.psi_rad + FRAC_PI_2.copysign(end_rad));
    helm(if far { ahead_rad } else { geom::wrap(end_rad) }, end_mps)
}

fn has_reached(state: &State, end_rad: f64, end_mps: f64) -> bool {
    let steady = state.yaw_rate_radps.abs() <= STEADY_RADPS
        && (state.surge_mps - end_mps).abs() <= SPEED_REACHED_MPS;
    // a ship that has stopped may have no steerage left for the rest of her turn
    let on_course = geom::wrap(end_rad - state.psi_rad).abs() <= HEADING_REACHED_RAD;
    steady && (on_course || end_mps <= 0.0)
}

/// A way, and the other ship going straight past it, in the frame of the way.
pub(crate) struct Passing<'a> {
    pub(crate) way: &'a Way,
    pub(crate) body: &'a Body,
    pub(crate) other: &'a Body,
    pub(crate) start: Pose,
    pub(crate) clock: Clock,
}

impl Passing<'_> {
    fn other_at(&self, t_s: f64) -> Pose {
        Pose { position_m: self.start.position_m + self.start.velocity_mps * t_s, ..self.start }
    }

    /// How much more than `than_m` the hulls stay apart at least; `None` where they do not. Hull
    /// geometry is left out in every beat for which the rectangle around the larger hull and the
    /// circle around the smaller one settle it.
    pub(crate) fn slack_m(&self, than_m: f64) -> Option<f64> {
        let Clock { beat_s, .. } = self.clock;
        let steps = self.clock.steps_a_beat();
        let closing_mps = self.closing_mps();
        let mut slack_m = f64::INFINITY;
        let mut before_m = self.bound_m(0);
        for from in (0..self.way.poses.len() - 1).step_by(steps) {
            let after_m = self.bound_m(from + steps);
            let mut least_m = 0.5 * (before_m + after_m - closing_mps * beat_s);
            if least_m <= than_m {
                least_m = self.least_of_beat_m(from, than_m);
            }
            if least_m <= than_m {
                return None;
            }
            slack_m = slack_m.min(least_m - than_m);
            before_m = after_m;
        }
        let least_m = self.least_after_m(than_m);
        (least_m > than_m).then(|| slack_m.min(least_m - than_m))
    }

    /// Smallest hull distance of the beat that begins at pose `from`, metres, or one that is no
    /// more than `than_m`: hull by hull from step to step, as a run looks.
    fn least_of_beat_m(&self, from: usize, than_m: f64) -> f64 {
        let mut least_m = f64::INFINITY;
        for k in from..from + self.clock.steps_a_beat() {
            let own = [&self.way.poses[k], &self.way.poses[k + 1]];
            least_m = least_m.min(self.exact_m((k, self.clock.step_s), own));
            if least_m <= than_m {
                break;
            }
        }
        least_m
    }

    /// A lower bound of the hull distance at pose `k`, metres.
    fn bound_m(&self, k: usize) -> f64 {
        let pose = &self.way.poses[k];
        let to_other_m = self.start.position_m - pose.position_m
            + self.start.velocity_mps * (k as f64 * self.clock.step_s);
        if self.bound_is_of_other() {
            self.other.distance_m(self.start.heading, -to_other_m) - self.body.hull.radius_m
        } else {
            self.body.distance_m(pose.heading, to_other_m) - self.other.hull.radius_m
        }
    }

    /// Whether the rectangle is the other ship's.
    fn bound_is_of_other(&self) -> bool {
        self.body.hull.radius_m <= self.other.hull.radius_m
    }

    /// How fast that bound can change, m/s.
    fn closing_mps(&self) -> f64 {
        let relative_mps = self.way.fastest_mps + self.start.velocity_mps.norm();
        if self.bound_is_of_other() {
            relative_mps
        } else {
            relative_mps + self.way.turns_radps * self.body.hull.radius_m
        }
    }

    /// Smallest hull distance of an interval that starts at pose `from`, metres.
    fn exact_m(&self, (from, dt_s): (usize, f64), own: [&Pose; 2]) -> f64 {
        let start_s = from as f64 * self.clock.step_s;
        let others = [self.other_at(start_s), self.other_at(start_s + dt_s)];
        let target = [&others[0], &others[1]];
        let hulls = Hulls { own: &self.body.hull, target: &self.other.hull };
        closest_in(&Interval { start_s, dt_s, own, target }, hulls, false).0
    }

    /// Smallest hull distance, or a bound above `than_m`, from the end of the way on, where both
    /// ships go straight.
    fn least_after_m(&self, than_m: f64) -> f64 {
        let from = self.way.poses.len() - 1;
        let after = &self.way.after;
        let other = self.other_at(from as f64 * self.clock.step_s);
        let offset_m = other.position_m - after.position_m;
        let relative_mps = other.velocity_mps - after.velocity_mps;
        let closest = geom::cpa(offset_m, relative_mps);
        let radii_m = self.body.hull.radius_m + self.other.hull.radius_m;
        if closest.dcpa_m - radii_m > than_m {
            return closest.dcpa_m - radii_m;
        }
        // the hulls are nearest within the time in which they pass each other's length
        let passing_s = closest
            .tcpa_s
            .map_or(0.0, |tcpa_s| tcpa_s.max(0.0) + 2.0 * (radii_m + than_m) / relative_mps.norm());
        let later =
            Pose { position_m: after.position_m + after.velocity_mps * passing_s, ..*after };
        self.exact_m((from, passing_s.max(self.clock.beat_s)), [after, &later])
    }
}
