//! When a run is over: past and clear of every target, or at the goal as well.
//!
//! "Finally past and clear" (Rules 8(d), 13(d)) has no number in the treaty, and the judge's own
//! release condition depends on its rule set. The run must go on until that condition can be seen
//! in the trace, so the condition here is the stronger one, for every target and for 10 s without
//! a break:
//!
//! * the range opens and the time to the closest point is in the past;
//! * the distance exceeds twice the safety radius, and 300 m for an own ship of up to 30 m or
//!   2,000 m for a larger one (the preferred distances of the usual profiles are 200 m and
//!   1,852 m);
//! * the geometry is that of a passed ship: one is more than 112.5 degrees off the other's bow;
//!   and if own ship came up from the target's stern sector, own ship is forward of 67.5 degrees
//!   off the target's bow, or the other way round if the target came up from own ship's;
//! * or, in place of the last two, the distance exceeds 2,000 m (own ship up to 30 m) or 5,300 m.
//!
//! Distances are from hull to hull (the lower bound: centre distance less both radii) or between
//! reference points, as the encounter says.

use crate::pose::Pose;
use geom::{class::OVERTAKING_SECTOR_RAD, math, units};
use record::{DistanceKind, Encounter, RunUntil};

/// How long the ships must be past and clear, seconds (rules specification, section 2).
const HELD_S: f64 = 10.0;
/// Longest own ship that is judged by the small-craft profiles, metres.
const SMALL_M: f64 = 30.0;
/// Forward of the beam by the width of the stern sector, radians.
const FORWARD_RAD: f64 = units::deg(67.5);
/// Slowest relative speed at which there is a closest point, m/s (rules specification, section 1).
const RELATIVE_MPS_MIN: f64 = 0.05;

/// Watches one run.
#[derive(Clone, Debug)]
pub struct Ending {
    until: RunUntil,
    distance: DistanceKind,
    clear_m: f64,
    far_m: f64,
    cos_stern: f64,
    cos_forward: f64,
    seen: Vec<Seen>,
    clear_since_s: Option<f64>,
    capture_m: f64,
    goal_reached: bool,
}

/// From which stern sector the other ship was seen while the range closed.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    own_overtook: bool,
    own_was_overtaken: bool,
}

/// A target at a beat.
#[derive(Clone, Copy, Debug)]
pub struct Other<'a> {
    /// Where she is.
    pub pose: &'a Pose,
    /// Radii of both hulls, metres.
    pub radii_m: f64,
}

impl Ending {
    /// For one run; `yaw_rate_radps_max` is own ship's. A goal counts as reached within her
    /// turning radius at cruise speed, two lengths, or the way of two beats, whichever is most.
    pub fn new(encounter: &Encounter, yaw_rate_radps_max: f64) -> Self {
        let own = &encounter.own;
        let turning_radius_m = own.cruise_mps / yaw_rate_radps_max;
        let small = own.hull.length_m <= SMALL_M;
        let (least_m, far_m) = if small { (300.0, 2000.0) } else { (2000.0, 5300.0) };
        let two_beats_m = 2.0 * own.cruise_mps * encounter.run.beat_s;
        Self {
            until: encounter.run.until,
            distance: encounter.distance,
            clear_m: (2.0 * encounter.safety_radius_m).max(least_m),
            far_m: (4.0 * encounter.safety_radius_m).max(far_m),
            cos_stern: math::cos(OVERTAKING_SECTOR_RAD),
            cos_forward: math::cos(FORWARD_RAD),
            seen: vec![Seen::default(); encounter.targets.len()],
            clear_since_s: None,
            capture_m: turning_radius_m.max(2.0 * own.hull.length_m).max(two_beats_m),
            goal_reached: false,
        }
    }

    /// Whether own ship has been at her goal at any beat so far.
    pub fn goal_reached(&self) -> bool {
        self.goal_reached
    }

    /// Looks at the beat at `t_s`; whether the run is over. `to_goal_m` is own ship's distance
    /// from the last waypoint.
    pub fn is_over<'a>(
        &mut self,
        t_s: f64,
        own: &Pose,
        others: impl Iterator<Item = Other<'a>>,
        to_goal_m: f64,
    ) -> bool {
        let mut clear = true;
        let mut alone = true;
        for (index, other) in others.enumerate() {
            alone = false;
            clear &= self.is_clear_of(index, own, &other);
        }
        self.goal_reached |= to_goal_m <= self.capture_m;
        if !clear {
            self.clear_since_s = None;
            return false;
        }
        let since_s = *self.clear_since_s.get_or_insert(t_s);
        let held = t_s - since_s >= HELD_S;
        match self.until {
            // with hazards alone there is nobody to be clear of
            RunUntil::PastAndClear => held && (!alone || self.goal_reached),
            RunUntil::GoalReached => held && self.goal_reached,
            RunUntil::TimeIsUp => false,
        }
    }

    fn is_clear_of(&mut self, index: usize, own: &Pose, other: &Other<'_>) -> bool {
        let offset = other.pose.position_m - own.position_m;
        let relative_mps = other.pose.velocity_mps - own.velocity_mps;
        let range_m = offset.norm();
        // cosines of the relative bearing and of the contact angle
        let cos_beta = own.heading.dot(&offset) / range_m;
        let cos_alpha = -other.pose.heading.dot(&offset) / range_m;
        let opening = offset.dot(&relative_mps) > 0.0;
        let seen = &mut self.seen[index];
        if !opening {
            seen.own_overtook |= cos_alpha < self.cos_stern;
            seen.own_was_overtaken |= cos_beta < self.cos_stern;
            return false;
        }
        if relative_mps.norm() < RELATIVE_MPS_MIN {
            return false;
        }
        let distance_m = match self.distance {
            DistanceKind::Hull => range_m - other.radii_m,
            DistanceKind::Centre => range_m,
        };
        let passed = (cos_beta < self.cos_stern || cos_alpha < self.cos_stern)
            && (!seen.own_overtook || cos_alpha > self.cos_forward)
            && (!seen.own_was_overtaken || cos_beta > self.cos_forward);
        distance_m > self.far_m || (distance_m > self.clear_m && passed)
    }
}
