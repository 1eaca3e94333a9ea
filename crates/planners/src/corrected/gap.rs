//! The gap between two hulls on their present courses, as it will be.

use geom::{HullOutline, Vec2, angle};
use planner_api::{OwnState, TargetTrack};
use std::f64::consts::FRAC_PI_2;

/// Beam of a target that reports its length alone, as a share of it.
const BEAM_PER_LENGTH: f64 = 0.2;
/// The hulls may come closest this long before or after the reference points do, seconds ...
const AROUND_S: f64 = 40.0;
/// ... looked at in steps of this, seconds.
const STEP_S: f64 = 4.0;

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
    /// Distance after this time, metres; 0 where the hulls may touch. From hull to hull it is the
    /// widest of the gaps along the line of sight and abeam of either ship: any gap between two
    /// parallel lines is at most the distance, and one of these is nearly it.
    pub fn at_m(&self, after_s: f64) -> f64 {
        let velocity_mps = self.track.velocity_mps - self.own.velocity_mps;
        let los_m = self.track.position_m - self.own.position_m + velocity_mps * after_s;
        let range_m = los_m.norm();
        let Some(own_hull) = self.hulls.filter(|_| range_m > 0.0) else {
            return range_m;
        };
        let length_m = self.track.length_m.unwrap_or(0.0);
        let beam_m = self.track.beam_m.unwrap_or(BEAM_PER_LENGTH * length_m);
        let target_hull = HullOutline::centred(length_m, beam_m);
        let (own_rad, target_rad) =
            (self.own.psi_rad, self.track.psi_rad.unwrap_or(self.track.cog_rad));
        let towards = |axis: Vec2| if axis.dot(&los_m) < 0.0 { -axis } else { axis };
        let abeam = |psi_rad| towards(angle::rotate(angle::unit(psi_rad), FRAC_PI_2));
        let axes = [los_m / range_m, abeam(own_rad), abeam(target_rad)];
        let gap_m = |axis: Vec2| {
            let hulls_m =
                reach_m(own_hull, own_rad, axis) + reach_m(target_hull, target_rad, -axis);
            los_m.dot(&axis) - hulls_m
        };
        axes.into_iter().map(gap_m).fold(0.0, f64::max)
    }

    /// The smallest around the closest point of the reference points, from now on, metres.
    pub fn least_m(&self, tcpa_s: f64) -> f64 {
        if self.hulls.is_none() {
            return self.at_m(tcpa_s);
        }
        let steps = (2.0 * AROUND_S / STEP_S) as u32;
        let times = (0..=steps).map(|step| tcpa_s - AROUND_S + f64::from(step) * STEP_S);
        times.map(|t_s| self.at_m(t_s.max(0.0))).fold(f64::INFINITY, f64::min)
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
        let own = OwnState {
            position_m: Vec2::zeros(),
            psi_rad: 0.0,
            velocity_mps: Vec2::new(8.0, 0.0),
            cog_rad: 0.0,
            sog_mps: 8.0,
            stw_mps: 8.0,
            yaw_rate_radps: 0.0,
        };
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
        let hulls = Some(HullOutline::centred(8.0, 3.0));
        let gap = Gap { own: &own, track: &track, hulls };
        assert!((gap.at_m(100.0) - (90.0 - 10.0 - 1.5)).abs() < 0.1, "{}", gap.at_m(100.0));
        assert!((gap.least_m(100.0) - 78.5).abs() < 2.0, "{}", gap.least_m(100.0));
        let ahead =
            Gap { track: &TargetTrack { position_m: Vec2::new(1000.0, 0.0), ..track }, ..gap };
        assert!((ahead.at_m(0.0) - (1000.0 - 50.0 - 4.0)).abs() < 1e-9);
        let centres = Gap { hulls: None, ..gap };
        assert!((centres.least_m(100.0) - 90.0).abs() < 1e-9);
    }
}
