//! The gap between two hulls on their present courses, as it will be.

use geom::{HullOutline, Vec2, angle};
use planner_api::{OwnState, TargetTrack};
use std::f64::consts::FRAC_PI_2;

/// Beam of a target that reports its length alone, as a share of it.
const BEAM_PER_LENGTH: f64 = 0.2;
/// The hulls may come closest this long before or after the reference points do, seconds ...
const AROUND_S: f64 = 40.0;
/// ... looked at in steps of this, seconds, and then once more around the closest.
const STEP_S: f64 = 4.0;
/// Step of the second look, seconds.
const FINE_STEP_S: f64 = 1.0;
/// First step of the search for the widest gap, radians; halved until it means centimetres.
const AXIS_STEP_RAD: f64 = 0.3;
const HALVINGS: u32 = 9;

/// Own ship and a target; the distance is between reference points where there are no hulls.
#[derive(Clone, Copy, Debug)]
pub struct Gap<'a> {
    /// Own ship.
    pub own: &'a OwnState,
    /// The target; a length that is not known counts as none.
    pub track: &'a TargetTrack,
    /// Own ship's hull, where distances are from hull to hull.
    pub hulls: Option<HullOutline>,
}

impl Gap<'_> {
    /// The smallest around the closest point of the reference points, from now on, metres.
    pub fn least_m(&self, tcpa_s: f64) -> f64 {
        let Some(own_hull) = self.hulls else {
            return self.los_m(tcpa_s).norm();
        };
        let steps = |from_s: f64, to_s: f64, step_s: f64| {
            let count = ((to_s - from_s) / step_s) as u32;
            (0..=count).map(move |step| (from_s + f64::from(step) * step_s).max(0.0))
        };
        let mut nearest = (f64::INFINITY, 0.0);
        for t_s in steps(tcpa_s - AROUND_S, tcpa_s + AROUND_S, STEP_S) {
            let gap_m = self.roughly_m(own_hull, t_s).0;
            if gap_m < nearest.0 {
                nearest = (gap_m, t_s);
            }
        }
        steps(nearest.1 - STEP_S, nearest.1 + STEP_S, FINE_STEP_S)
            .map(|t_s| self.at_m(own_hull, t_s))
            .fold(f64::INFINITY, f64::min)
    }

    fn los_m(&self, after_s: f64) -> Vec2 {
        let velocity_mps = self.track.velocity_mps - self.own.velocity_mps;
        self.track.position_m - self.own.position_m + velocity_mps * after_s
    }

    /// Distance from hull to hull after this time, metres; 0 where they touch. It is the widest gap
    /// between two parallel lines with a hull on either side.
    fn at_m(&self, own_hull: HullOutline, after_s: f64) -> f64 {
        let (mut widest_m, mut axis) = self.roughly_m(own_hull, after_s);
        let los_m = self.los_m(after_s);
        let mut step_rad = AXIS_STEP_RAD;
        for _ in 0..HALVINGS {
            for turned in [step_rad, -step_rad].map(|by_rad| angle::rotate(axis, by_rad)) {
                let gap_m = self.gap_m(own_hull, los_m, turned);
                if gap_m > widest_m {
                    (widest_m, axis) = (gap_m, turned);
                }
            }
            step_rad *= 0.5;
        }
        widest_m.max(0.0)
    }

    /// The widest of the gaps along the line of sight and abeam of either ship, metres, with its
    /// direction: at most the distance, and nearly it.
    fn roughly_m(&self, own_hull: HullOutline, after_s: f64) -> (f64, Vec2) {
        let los_m = self.los_m(after_s);
        let towards = |axis: Vec2| if axis.dot(&los_m) < 0.0 { -axis } else { axis };
        let abeam = |psi_rad| towards(angle::rotate(angle::unit(psi_rad), FRAC_PI_2));
        let (own_rad, target_rad) = self.headings_rad();
        let along = los_m / los_m.norm().max(f64::MIN_POSITIVE);
        let axes = [along, abeam(own_rad), abeam(target_rad)];
        let gaps = axes.map(|axis| (self.gap_m(own_hull, los_m, axis), axis));
        gaps.into_iter().fold((f64::NEG_INFINITY, along), |a, b| if b.0 > a.0 { b } else { a })
    }

    /// Between the hulls in one direction, metres; negative where they overlap in it.
    fn gap_m(&self, own_hull: HullOutline, los_m: Vec2, axis: Vec2) -> f64 {
        let length_m = self.track.length_m.unwrap_or(0.0);
        let beam_m = self.track.beam_m.unwrap_or(BEAM_PER_LENGTH * length_m);
        let target_hull = HullOutline::centred(length_m, beam_m);
        let (own_rad, target_rad) = self.headings_rad();
        los_m.dot(&axis)
            - reach_m(own_hull, own_rad, axis)
            - reach_m(target_hull, target_rad, -axis)
    }

    fn headings_rad(&self) -> (f64, f64) {
        (self.own.psi_rad, self.track.psi_rad.unwrap_or(self.track.cog_rad))
    }
}

/// How far a hull reaches in a direction, metres from its reference point.
fn reach_m(hull: HullOutline, psi_rad: f64, direction: Vec2) -> f64 {
    let in_body = angle::rotate(direction, -psi_rad);
    hull.corners_body_m().iter().map(|corner| corner.dot(&in_body)).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ship_abeam_takes_half_her_beam_and_one_ahead_half_her_length() {
        let own = OwnState::steady(Vec2::zeros(), 0.0, 8.0);
        let track = TargetTrack {
            id: 1,
            position_m: Vec2::new(1000.0, 90.0),
            velocity_mps: Vec2::new(-2.0, 0.0),
            cog_rad: std::f64::consts::PI,
            sog_mps: 2.0,
            psi_rad: None,
            length_m: Some(100.0),
            beam_m: Some(20.0),
            covariance: [[0.0; 4]; 4],
            age_s: 0.0,
            since_update_s: 0.0,
        };
        let hull = HullOutline::centred(8.0, 3.0);
        let gap = Gap { own: &own, track: &track, hulls: Some(hull) };
        let abeam_m = gap.at_m(hull, 100.0);
        // the broadest parts are not quite abreast of one another
        assert!((0.0..0.2).contains(&(abeam_m - (90.0 - 10.0 - 1.5))), "{abeam_m}");
        assert!((gap.least_m(100.0) - 78.5).abs() < 0.5, "{}", gap.least_m(100.0));
        let ahead =
            Gap { track: &TargetTrack { position_m: Vec2::new(1000.0, 0.0), ..track }, ..gap };
        assert!((ahead.at_m(hull, 0.0) - (1000.0 - 50.0 - 4.0)).abs() < 1e-9);
        let centres = Gap { hulls: None, ..gap };
        assert!((centres.least_m(100.0) - 90.0).abs() < 1e-9);
        // against every corner and edge of the two, in poses where neither axis is the right one
        for (bearing_rad, psi_rad) in [(0.4, 0.9), (1.1, -0.6), (2.5, 2.0), (-1.9, 0.3)] {
            let position_m = angle::unit(bearing_rad) * 190.0;
            let track = TargetTrack { position_m, psi_rad: Some(psi_rad), ..track };
            let gap = Gap { track: &track, ..gap };
            let theirs = HullOutline::centred(100.0, 20.0).corners_m(position_m, psi_rad);
            let exact_m = between_m(&hull.corners_m(own.position_m, own.psi_rad), &theirs);
            assert!((gap.at_m(hull, 0.0) - exact_m).abs() < 0.05, "{bearing_rad}: {exact_m}");
        }
    }

    /// Smallest distance between the edges of two outlines.
    fn between_m(a: &[Vec2], b: &[Vec2]) -> f64 {
        let mut least_m = f64::INFINITY;
        for (corners, edges) in [(a, b), (b, a)] {
            for corner in corners {
                for [from, to] in geom::polygon::edges(edges) {
                    let (distance_m, _) = geom::segment_min_distance(from - corner, to - corner);
                    least_m = least_m.min(distance_m);
                }
            }
        }
        least_m
    }
}
