//! The choice of a manoeuvre: candidates from the exact edge of each cone and from a fan of
//! apparent alterations, each checked against every target.

use super::encounter::Encounter;
use super::land::Land;
use super::path::{Agility, Path, Trial};
use crate::zhuang::{equations, planner::ccw};
use geom::{EncounterClass, Vec2, angle, cpa, math, units::deg, wrap};
use planner_api::OwnState;

/// Step of the fan, degrees.
const FAN_STEP_DEG: f64 = 5.0;
/// The fan ends here: beyond it own ship would sail back.
const FAN_DEG_MAX: f64 = 150.0;
/// Shares of the speed at the start of the manoeuvre: as it is; a cut of more than half, which is
/// readily apparent; nearly stopped, with way enough to hold the heading.
const SPEED_SHARES: [f64; 3] = [1.0, 0.45, 0.1];
/// Cost of one metre that lacks to the planned distance, in degrees of alteration: distance
/// comes first.
const SHORTFALL_COST: f64 = 10.0;
/// Cost of stopping, in degrees of alteration.
const STOP_COST_DEG: f64 = 90.0;
/// Cost of port, where it is admitted at all.
const PORT_COST_DEG: f64 = 20.0;
/// Cost of every minute until the wish is clear again: or own ship would rather sail beside a
/// target for an hour than slow down and pass astern of it.
const MINUTE_COST_DEG: f64 = 5.0;
/// Longer than this is not looked at, minutes.
const MINUTES_MAX: u32 = 10;
/// Cost of passing a head-on or crossing target on the wrong hand.
const WRONG_HAND_COST_DEG: f64 = 400.0;

/// A target as the search sees it.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Relative to own ship, metres.
    pub from_own_m: Vec2,
    /// m/s.
    pub velocity_mps: Vec2,
    /// Planned distance between reference points, metres.
    pub plan_m: f64,
    /// The encounter, if it is one.
    pub encounter: Option<Encounter>,
}

/// From where offsets count: heading and speed through the water at the start of the manoeuvre. It
/// is the heading that the other ship sees; a course over ground kept at half the speed in a
/// current would be a turn.
#[derive(Clone, Copy, Debug)]
pub struct Reference {
    /// Radians clockwise from north.
    pub psi_rad: f64,
    /// Metres a second.
    pub stw_mps: f64,
    /// What the water does, m/s north and east.
    pub drift_mps: Vec2,
    /// Smallest alteration, radians.
    pub alteration_rad: f64,
    /// The velocity to return to, m/s north and east.
    pub wish_mps: Vec2,
}

impl Reference {
    /// The order over ground that makes this offset of the heading at this share of the speed.
    fn trial(&self, offset_rad: f64, share: f64) -> Trial {
        let through_water_mps = angle::unit(self.psi_rad + offset_rad) * (self.stw_mps * share);
        let velocity_mps = through_water_mps + self.drift_mps;
        Trial { course_rad: angle::direction(velocity_mps), speed_mps: velocity_mps.norm() }
    }
}

/// A manoeuvre with its cost and the distance by which it misses the plan (0 if it keeps it).
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// The order.
    pub trial: Trial,
    /// In degrees of alteration.
    pub cost: f64,
    /// Metres.
    pub shortfall_m: f64,
}

/// The largest lack of distance to any target or to land on the path, metres, and whether a target
/// that has to be left to port is not.
pub fn judge(path: &Path, targets: &[Target], land: &Land) -> (f64, bool) {
    let mut shortfall_m = land.lack_m(path);
    let mut wrong_hand = false;
    for target in targets {
        let passing = path.passing(target.from_own_m, target.velocity_mps);
        // a target that is too near already is not held against a path that only opens the range
        let plan_m = target.plan_m.min(target.from_own_m.norm());
        shortfall_m = shortfall_m.max(plan_m - passing.range_m_min);
        let to_port = target.encounter.is_some_and(|e| e.may_act && e.wants_target_to_port());
        wrong_hand |= to_port && !passing.target_to_port;
    }
    (shortfall_m, wrong_hand)
}

/// The cheapest manoeuvre from here.
pub fn cheapest(
    own: &OwnState,
    reference: Reference,
    (targets, land): (&[Target], &Land),
    agility: Agility,
    path: &mut Path,
) -> Choice {
    let encounters = || targets.iter().filter_map(|target| target.encounter);
    let port = encounters().all(|e| e.admits_port());
    let straight = encounters().all(|e| !e.may_act || e.class != EncounterClass::HeadOn);
    let mut best: Option<Choice> = None;
    for share in SPEED_SHARES {
        let slows = share < 1.0;
        let mut consider = |offset_rad: f64| {
            let trial = reference.trial(offset_rad, share);
            let port_cost = if offset_rad < 0.0 { PORT_COST_DEG } else { 0.0 };
            let effort = offset_rad.abs().to_degrees() + (1.0 - share) * STOP_COST_DEG + port_cost;
            if best.is_some_and(|b| effort >= b.cost) {
                return;
            }
            path.predict(own, trial, agility);
            let (shortfall_m, wrong_hand) = judge(path, targets, land);
            let hand_cost = if wrong_hand { WRONG_HAND_COST_DEG } else { 0.0 };
            let minutes = minutes_until_clear(path, reference.wish_mps, targets);
            let cost = effort
                + SHORTFALL_COST * shortfall_m
                + MINUTE_COST_DEG * f64::from(minutes)
                + hand_cost;
            if best.is_none_or(|b| cost < b.cost) {
                best = Some(Choice { trial, cost, shortfall_m });
            }
        };
        if slows && straight {
            consider(0.0);
        }
        for offset_rad in exact_offsets(reference, share, targets) {
            let large = offset_rad.abs() >= reference.alteration_rad;
            if large && (port || offset_rad > 0.0) {
                consider(offset_rad);
            }
        }
        let mut offset_rad = reference.alteration_rad;
        while offset_rad <= deg(FAN_DEG_MAX) {
            consider(offset_rad);
            if port {
                consider(-offset_rad);
            }
            offset_rad += deg(FAN_STEP_DEG);
        }
    }
    best.expect("the fan is never empty")
}

/// Whole minutes on the straight part of the path until a return to the wish would keep the planned
/// distance to every target.
fn minutes_until_clear(path: &Path, wish_mps: Vec2, targets: &[Target]) -> u32 {
    let clear_after = |minute: &u32| {
        let (t_s, own_m) = path.straight_at(60.0 * f64::from(*minute));
        targets.iter().all(|target| {
            let los_m = target.from_own_m + target.velocity_mps * t_s - own_m;
            let approach = cpa(los_m, target.velocity_mps - wish_mps);
            approach.dcpa_m >= target.plan_m.min(los_m.norm())
        })
    };
    (0..MINUTES_MAX).find(clear_after).unwrap_or(MINUTES_MAX)
}

/// Offsets that put the relative velocity exactly on an edge of a target's cone at this speed,
/// to starboard of it and to port; seed planner specification, section 1.3.
fn exact_offsets(
    reference: Reference,
    share: f64,
    targets: &[Target],
) -> impl Iterator<Item = f64> + '_ {
    let alpha = ccw(reference.psi_rad);
    targets.iter().filter(|target| target.encounter.is_some()).flat_map(move |target| {
        let theta = math::atan2(target.from_own_m.x, target.from_own_m.y);
        let mu = equations::mu(target.plan_m, target.from_own_m.norm());
        [-1.0, 1.0].into_iter().filter_map(move |s| {
            // through the water, where own speed does not depend on the course
            let velocity_mps = target.velocity_mps - reference.drift_mps;
            let beta = math::atan2(velocity_mps.x, velocity_mps.y);
            let (stw_mps, v_b) = (reference.stw_mps * share, velocity_mps.norm());
            let edge = theta + s * mu;
            let exact = equations::exact_heading_only(stw_mps, alpha, v_b, beta, edge)?;
            // clockwise offset from the reference heading
            Some(wrap(alpha - exact))
        })
    })
}
