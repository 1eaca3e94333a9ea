//! Two ships on one clock: relative motion and predicted passing distance.
//!
//! Range, closing and time to CPA are those of the reference points; distances (`d`, DCPA, D_risk,
//! r_*) are of the campaign's one kind, hull to hull or between reference points. A predicted
//! hull-to-hull distance keeps velocities and headings. Reference: rules specification, sections 0
//! and 1.

use geom::hull::CORNERS;
use geom::{HullOutline, Vec2, cpa, unit};
use record::{DistanceKind, ShipTrack};

/// Own ship and one target, as they went (or as they would have gone without avoiding).
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairTracks<'a> {
    pub(crate) own: &'a ShipTrack,
    pub(crate) target: &'a ShipTrack,
    pub(crate) kind: DistanceKind,
    /// Sum of the radii around the reference points that hold the hulls, metres.
    pub(crate) radii_m: f64,
    /// Outlines in the body frames, from the reference points, metres.
    own_corners_m: [Vec2; CORNERS],
    target_corners_m: [Vec2; CORNERS],
}

impl<'a> PairTracks<'a> {
    pub(crate) fn new(own: &'a ShipTrack, target: &'a ShipTrack, kind: DistanceKind) -> Self {
        let own_corners_m = own.ship.hull.corners_body_m();
        let target_corners_m = target.ship.hull.corners_body_m();
        let radius = |corners: &[Vec2]| corners.iter().map(|c| c.norm()).fold(0.0, f64::max);
        let radii_m = radius(&own_corners_m) + radius(&target_corners_m);
        Self { own, target, kind, radii_m, own_corners_m, target_corners_m }
    }

    /// Samples that both ships have.
    pub(crate) fn len(&self) -> usize {
        self.own.len().min(self.target.len())
    }

    /// Position and velocity of the target relative to own ship.
    #[inline]
    pub(crate) fn relative(&self, k: usize) -> (Vec2, Vec2) {
        let position_m = self.target.position_m(k) - self.own.position_m(k);
        (position_m, self.target.velocity_mps(k) - self.own.velocity_mps(k))
    }

    /// Distance between reference points, metres.
    pub(crate) fn range_m(&self, k: usize) -> f64 {
        self.relative(k).0.norm()
    }

    /// Whether the range falls at sample `k`.
    #[inline]
    pub(crate) fn closing(&self, k: usize) -> bool {
        let (position_m, velocity_mps) = self.relative(k);
        position_m.dot(&velocity_mps) < 0.0
    }

    /// Signed time to CPA, seconds.
    pub(crate) fn tcpa_s(&self, k: usize) -> Option<f64> {
        let (position_m, velocity_mps) = self.relative(k);
        cpa(position_m, velocity_mps).tcpa_s
    }

    /// Predicted passing distance from sample `k` on, metres, in the campaign's kind.
    pub(crate) fn dcpa_m(&self, k: usize) -> f64 {
        match self.kind {
            DistanceKind::Centre => {
                let (position_m, velocity_mps) = self.relative(k);
                cpa(position_m, velocity_mps).dcpa_m
            }
            DistanceKind::Hull => self.hull_dcpa_m(k, self.own.velocity_mps(k)),
        }
    }

    /// Whether the predicted passing distance is below `limit_m`; the outlines are asked only
    /// where bounds from the reference points do not decide.
    #[inline]
    pub(crate) fn dcpa_below(&self, k: usize, limit_m: f64) -> bool {
        let (position_m, velocity_mps) = self.relative(k);
        let centre_m = cpa(position_m, velocity_mps).dcpa_m;
        match self.kind {
            DistanceKind::Centre => centre_m < limit_m,
            DistanceKind::Hull if centre_m < limit_m => true,
            DistanceKind::Hull if centre_m - self.radii_m >= limit_m => false,
            DistanceKind::Hull => self.hull_dcpa_m(k, self.own.velocity_mps(k)) < limit_m,
        }
    }

    /// Smallest hull-to-hull distance from sample `k` on, metres, with own ship at
    /// `own_velocity_mps` and the target at her present velocity, both on their headings.
    pub(crate) fn hull_dcpa_m(&self, k: usize, own_velocity_mps: Vec2) -> f64 {
        let velocity_mps = self.target.velocity_mps(k) - own_velocity_mps;
        let (position_m, _) = self.relative(k);
        let own_ahead = unit(self.own.psi_rad[k]);
        let target_ahead = unit(self.target.psi_rad[k]);
        let now_m = || {
            let own = self.own_corners_m.map(|corner| turned(corner, own_ahead));
            let target = self.target_corners_m.map(|c| position_m + turned(c, target_ahead));
            outline_distance_m(&own, &target)
        };
        if cpa(position_m, velocity_mps).tcpa_s.is_none() {
            return now_m();
        }
        let along = velocity_mps / velocity_mps.norm();
        let across = Vec2::new(-along.y, along.x);
        // across the relative motion the outlines never change places: the gap there is the
        // passing distance, unless the corners that make it have passed already
        let (own_low, own_high) = extreme_corners(&self.own_corners_m, own_ahead, across);
        let (low, high) = extreme_corners(&self.target_corners_m, target_ahead, across);
        let (target_low, target_high) = (position_m + low, position_m + high);
        let (gap_m, corners) = if across.dot(&(target_low - own_high)) > 0.0 {
            (across.dot(&(target_low - own_high)), target_low - own_high)
        } else if across.dot(&(own_low - target_high)) > 0.0 {
            (across.dot(&(own_low - target_high)), target_high - own_low)
        } else if position_m.dot(&velocity_mps) < 0.0 {
            return 0.0;
        } else {
            return now_m();
        };
        if along.dot(&corners) <= 0.0 { gap_m } else { now_m() }
    }
}

/// A vector of the body frame in the plane, for a ship that heads along `ahead`.
fn turned(body: Vec2, ahead: Vec2) -> Vec2 {
    Vec2::new(ahead.x * body.x - ahead.y * body.y, ahead.y * body.x + ahead.x * body.y)
}

/// The corners furthest against and along a direction, from the reference point.
fn extreme_corners(body: &[Vec2; CORNERS], ahead: Vec2, direction: Vec2) -> (Vec2, Vec2) {
    // the direction as seen from the ship: one turn instead of one for each corner
    let seen = Vec2::new(
        ahead.x * direction.x + ahead.y * direction.y,
        ahead.x * direction.y - ahead.y * direction.x,
    );
    let mut extremes = (body[0], body[0]);
    let mut values = (seen.dot(&body[0]), seen.dot(&body[0]));
    for corner in &body[1..] {
        let value = seen.dot(corner);
        if value < values.0 {
            (values.0, extremes.0) = (value, *corner);
        }
        if value > values.1 {
            (values.1, extremes.1) = (value, *corner);
        }
    }
    (turned(extremes.0, ahead), turned(extremes.1, ahead))
}

/// How far a hull reaches from its reference point in a direction (a unit vector), metres.
pub(crate) fn reach_m(hull: &HullOutline, psi_rad: f64, direction: Vec2) -> f64 {
    extreme_corners(&hull.corners_body_m(), unit(psi_rad), direction).1.dot(&direction)
}

/// Distance between two convex outlines, metres; 0 where they overlap.
pub(crate) fn outline_distance_m(a: &[Vec2], b: &[Vec2]) -> f64 {
    if !separated(a, b) && !separated(b, a) {
        return 0.0;
    }
    corner_to_edge_m(a, b).min(corner_to_edge_m(b, a))
}

/// Whether an edge of `a` (corners clockwise as seen from above) has all of `b` outside.
fn separated(a: &[Vec2], b: &[Vec2]) -> bool {
    (0..a.len()).any(|i| {
        let (from, to) = (a[i], a[(i + 1) % a.len()]);
        // the sign of the area tells inside from outside, whichever way the corners run
        let inside = a[(i + 2) % a.len()];
        let side = (to - from).perp(&(inside - from));
        b.iter().all(|corner| (to - from).perp(&(corner - from)) * side < 0.0)
    })
}

fn corner_to_edge_m(corners: &[Vec2], outline: &[Vec2]) -> f64 {
    let mut least_m = f64::INFINITY;
    for corner in corners {
        for i in 0..outline.len() {
            let (from, to) = (outline[i] - corner, outline[(i + 1) % outline.len()] - corner);
            // from the nearer end: a mirror image runs through its edges the other way round,
            // and the last bits of the distance depend on where the way begins
            let (from, to) =
                if from.norm_squared() <= to.norm_squared() { (from, to) } else { (to, from) };
            least_m = least_m.min(geom::segment_min_distance(from, to).0);
        }
    }
    least_m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Script, ship};
    use geom::units::deg;
    use proptest::prelude::*;

    #[test]
    fn hulls_abreast_pass_at_the_gap_between_their_sides() {
        let own = Script::new(ship(20.0, 4.0), 0.0, 0.0, 0.0, 5.0).hold(10.0).track();
        let target = Script::new(ship(40.0, 8.0), 1000.0, 30.0, deg(180.0), 5.0).hold(10.0).track();
        let pair = PairTracks::new(&own, &target, DistanceKind::Hull);
        assert!((pair.dcpa_m(0) - 24.0).abs() < 1e-9);
        assert!(pair.dcpa_below(0, 24.1) && !pair.dcpa_below(0, 23.9));
        let centres = PairTracks { kind: DistanceKind::Centre, ..pair };
        assert!((centres.dcpa_m(0) - 30.0).abs() < 1e-9);
    }

    /// Close by, where the outlines meet corner to corner and pass while they do: against the
    /// distance at every tenth of a second to come.
    #[test]
    fn predicted_hull_distance_close_by_is_the_smallest_one_met() {
        for psi_deg in (0..360).step_by(40) {
            for bearing_deg in (0..360).step_by(24) {
                let psi_rad = deg(f64::from(psi_deg));
                let at = geom::unit(deg(f64::from(bearing_deg))) * 38.0;
                let own = Script::new(ship(30.0, 7.0), 0.0, 0.0, 0.4, 5.0).hold(2.0).track();
                let target = Script::new(ship(30.0, 12.0), at.x, at.y, psi_rad, 4.0);
                let target = target.hold(2.0).track();
                let pair = PairTracks::new(&own, &target, DistanceKind::Hull);
                let a = own.ship.hull.corners_m(Vec2::zeros(), 0.4);
                let velocity_mps = target.velocity_mps(0) - own.velocity_mps(0);
                let met_m = (0..600)
                    .map(|tenth| at + velocity_mps * (f64::from(tenth) / 10.0))
                    .map(|at| outline_distance_m(&a, &target.ship.hull.corners_m(at, psi_rad)))
                    .fold(f64::INFINITY, f64::min);
                let predicted_m = pair.dcpa_m(0);
                let said = format!("{psi_deg} {bearing_deg}: {predicted_m}, not {met_m}");
                assert!(predicted_m <= met_m + 1e-9 && predicted_m > met_m - 1.0, "{said}");
            }
        }
    }

    /// Against the distances from every corner to every side, where no corner lies inside.
    #[test]
    fn outlines_that_lie_apart_have_a_distance() {
        let to_side_m = |p: Vec2, a: Vec2, b: Vec2| {
            let share = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
            (p - (a + (b - a) * share)).norm()
        };
        let least_m = |one: &[Vec2], other: &[Vec2]| {
            let sides = || (0..other.len()).map(|i| (other[i], other[(i + 1) % other.len()]));
            let all = one.iter().flat_map(|p| sides().map(|(a, b)| to_side_m(*p, a, b)));
            all.fold(f64::INFINITY, f64::min)
        };
        // farther than the half-lengths on any heading
        for psi_deg in 0..120 {
            for bearing_deg in (0..360).step_by(7) {
                let at = geom::unit(deg(f64::from(bearing_deg))) * 31.0;
                let a = ship(30.0, 7.0).hull.corners_m(Vec2::zeros(), 0.0);
                let b = ship(30.0, 12.0).hull.corners_m(at, deg(3.0 * f64::from(psi_deg)));
                let (found_m, expected_m) =
                    (outline_distance_m(&a, &b), least_m(&a, &b).min(least_m(&b, &a)));
                let said = format!("{psi_deg} {bearing_deg}: {found_m}, not {expected_m}");
                assert!((found_m - expected_m).abs() < 1e-9, "{said}");
            }
        }
    }

    proptest! {
        /// An independent way: the distance of two convex outlines in straight motion is a
        /// convex function of time, so a search by thirds finds its minimum.
        #[test]
        fn predicted_hull_distance_is_the_smallest_one_met(
            north in -600f64..600.0, east in -600f64..600.0, psi in -3f64..3.0, psi_t in -3f64..3.0,
            u in 0.5f64..9.0, u_t in 0f64..9.0,
        ) {
            prop_assume!(north.abs() + east.abs() > 120.0);
            let own = Script::new(ship(30.0, 7.0), 0.0, 0.0, psi, u).hold(2.0).track();
            let target = Script::new(ship(60.0, 12.0), north, east, psi_t, u_t).hold(2.0).track();
            let pair = PairTracks::new(&own, &target, DistanceKind::Hull);
            let at = |t: f64| {
                let a = own.ship.hull.corners_m(own.position_m(0) + own.velocity_mps(0) * t, psi);
                let b = target.ship.hull
                    .corners_m(target.position_m(0) + target.velocity_mps(0) * t, psi_t);
                outline_distance_m(&a, &b)
            };
            prop_assume!(pair.tcpa_s(0).is_some());
            let (mut from, mut to) = (0.0, 20_000.0);
            for _ in 0..90 {
                let (a, b) = (from + (to - from) / 3.0, to - (to - from) / 3.0);
                if at(a) <= at(b) { to = b } else { from = a }
            }
            let (met, predicted) = (at(from), pair.dcpa_m(0));
            prop_assert!((predicted - met).abs() < 1e-3, "{predicted}, not {met}");
        }
    }
}
