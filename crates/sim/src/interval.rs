//! One step of a pair of ships: the closest point inside it, and the first touch.
//!
//! Between its ends a ship follows the cubic of [`Pose::between`]. A step that starts closing and
//! ends opening holds a minimum inside, which is found as the root of the opening speed.
//!
//! Known limit: where a ship turns, another corner may become the nearest one, and the distance may
//! fall and rise again within a step at both ends of which the ships open. That minimum is not
//! found. At 15 deg/s it was 0.13 m below the ends of a step of 1 s; it shrinks with the step.

use crate::hull::{CONTACT_SLOP_M, Gap, Hull, Warm};
use crate::pose::Pose;

/// One step, or one interval of samples, of a pair.
#[derive(Clone, Copy, Debug)]
pub struct Interval<'a> {
    /// Start, seconds.
    pub start_s: f64,
    /// Length, seconds.
    pub dt_s: f64,
    /// Own ship at both ends.
    pub own: [&'a Pose; 2],
    /// The other ship at both ends.
    pub target: [&'a Pose; 2],
}

impl Interval<'_> {
    fn own_at(&self, fraction: f64) -> Pose {
        Pose::between(self.own[0], self.own[1], self.dt_s, fraction)
    }

    fn target_at(&self, fraction: f64) -> Pose {
        Pose::between(self.target[0], self.target[1], self.dt_s, fraction)
    }

    /// Both ships at `fraction`, 0 to 1.
    pub fn at(&self, fraction: f64) -> (Pose, Pose) {
        (self.own_at(fraction), self.target_at(fraction))
    }

    pub(crate) fn time_s(&self, fraction: f64) -> f64 {
        self.start_s + fraction * self.dt_s
    }
}

/// The two hulls of a pair.
#[derive(Clone, Copy, Debug)]
pub struct Hulls<'a> {
    /// Own ship's.
    pub own: &'a Hull,
    /// The other ship's.
    pub target: &'a Hull,
}

impl Hulls<'_> {
    pub(crate) fn radii_m(&self) -> f64 {
        self.own.radius_m + self.target.radius_m
    }

    pub(crate) fn gap(&self, own: &Pose, target: &Pose, warm: &mut Warm) -> Gap {
        self.own.gap(own, self.target, target, warm)
    }
}

/// Centre distance at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Centre {
    pub(crate) range_m: f64,
    /// Range times range rate, m^2/s: negative while the ships close.
    pub(crate) closing: f64,
}

impl Centre {
    pub(crate) fn of(own: &Pose, target: &Pose) -> Self {
        let offset = target.position_m - own.position_m;
        let relative_mps = target.velocity_mps - own.velocity_mps;
        Self { range_m: offset.norm(), closing: offset.dot(&relative_mps) }
    }
}

/// Smallest hull distance of one interval and its fraction; a contact at its first touch.
pub(crate) fn closest_in(step: &Interval<'_>, hulls: Hulls<'_>, start_only: bool) -> (f64, f64) {
    let mut warm = Warm::default();
    let before = hulls.gap(step.own[0], step.target[0], &mut warm);
    if start_only || before.distance_m <= 0.0 {
        return (before.distance_m, 0.0);
    }
    let after = hulls.gap(step.own[1], step.target[1], &mut warm);
    let mut least = (before.distance_m, 0.0);
    if after.distance_m < least.0 {
        least = (after.distance_m, 1.0);
    }
    if before.opening_mps < 0.0 && after.opening_mps > 0.0 {
        let inside = closest_hull(step, hulls, [&before, &after], warm);
        if inside.0 < least.0 {
            least = inside;
        }
    }
    if may_touch(step, hulls, [before.distance_m, after.distance_m])
        && let Some(fraction) = first_touch(step, hulls)
    {
        return (0.0, fraction);
    }
    least
}

pub(crate) fn first_touch(step: &Interval<'_>, hulls: Hulls<'_>) -> Option<f64> {
    let [own, next_own] = step.own;
    let [target, next_target] = step.target;
    hulls.own.first_touch((own, next_own), hulls.target, (target, next_target))
}

/// Whether the hulls can meet within the interval: no point of either moves faster, relative to
/// the other ship, than the larger relative speed of the two ends plus what the yaw rates add.
pub(crate) fn may_touch(step: &Interval<'_>, hulls: Hulls<'_>, distances_m: [f64; 2]) -> bool {
    // room for a speed that is larger between the ends than at either
    const ROOM: f64 = 1.25;
    let relative_mps = |k: usize| (step.target[k].velocity_mps - step.own[k].velocity_mps).norm();
    let swing_mps = |pose: &Pose, hull: &Hull| pose.yaw_rate_radps.abs() * hull.radius_m;
    let fastest_mps = |k: usize| {
        relative_mps(k)
            + swing_mps(step.own[k], hulls.own)
            + swing_mps(step.target[k], hulls.target)
    };
    let reach_m = ROOM * step.dt_s * fastest_mps(0).max(fastest_mps(1));
    distances_m[0] + distances_m[1] <= reach_m + 4.0 * CONTACT_SLOP_M
}

/// Smallest centre distance inside an interval that starts closing and ends opening.
pub(crate) fn closest_centre(step: &Interval<'_>) -> (f64, f64) {
    let mut least = (f64::INFINITY, 0.0);
    let start = Centre::of(step.own[0], step.target[0]).closing;
    let end = Centre::of(step.own[1], step.target[1]).closing;
    find_root(start, end, |fraction| {
        let (own, target) = step.at(fraction);
        let centre = Centre::of(&own, &target);
        if centre.range_m < least.0 {
            least = (centre.range_m, fraction);
        }
        centre.closing
    });
    least
}

/// Smallest hull distance inside an interval that starts closing and ends opening. The distance of
/// convex hulls in straight motion is convex in time, so there is one minimum.
pub(crate) fn closest_hull(
    step: &Interval<'_>,
    hulls: Hulls<'_>,
    ends: [&Gap; 2],
    mut warm: Warm,
) -> (f64, f64) {
    let mut least = (f64::INFINITY, 0.0);
    find_root(ends[0].opening_mps, ends[1].opening_mps, |fraction| {
        let (own, target) = step.at(fraction);
        let gap = hulls.gap(&own, &target, &mut warm);
        if gap.distance_m < least.0 {
            least = (gap.distance_m, fraction);
        }
        gap.opening_mps
    });
    least
}

/// Finds the change of sign of `rate` in (0, 1) between `start < 0` and `end > 0`, by false
/// position with the Illinois rule.
fn find_root(start: f64, end: f64, mut rate: impl FnMut(f64) -> f64) {
    const TRIES: usize = 24;
    const FRACTION_TOLERANCE: f64 = 1e-7;
    let (mut low, mut low_rate, mut high, mut high_rate) = (0.0, start, 1.0, end);
    let mut last = 0;
    for _ in 0..TRIES {
        let fraction = (low * high_rate - high * low_rate) / (high_rate - low_rate);
        let value = rate(fraction);
        if value < 0.0 {
            (low, low_rate) = (fraction, value);
            if last < 0 {
                high_rate *= 0.5;
            }
            last = -1;
        } else if value > 0.0 {
            (high, high_rate) = (fraction, value);
            if last > 0 {
                low_rate *= 0.5;
            }
            last = 1;
        } else {
            return;
        }
        if high - low < FRACTION_TOLERANCE {
            return;
        }
    }
}
