//! Own ship's own motion: her velocity without the yaw of the waves, and the drift of the water.

use geom::{Vec2, angle, units::deg, wrap};
use planner_api::OwnState;
use std::collections::VecDeque;

/// The waves' yaw is gone from a mean over this, seconds.
const MEAN_S: f64 = 12.0;
/// Her heading has changed by this within that time: she turns, and the mean lags behind.
const TURNS_RAD: f64 = deg(8.0);
/// Her speed has, by this share.
const SPEED_SHARE: f64 = 0.15;
/// Two orders that differ by less than this share of the speed are the same.
const SAME_ORDER: f64 = 0.08;
/// An order is carried out after this long, seconds.
const CARRIED_OUT_S: f64 = 20.0;
/// Share of what is new in the estimate of the drift, each beat.
const DRIFT_GAIN: f64 = 0.02;

/// What is remembered of own ship.
#[derive(Clone, Debug, Default)]
pub struct OwnMotion {
    /// (seconds, heading, velocity over ground).
    beats: VecDeque<(f64, f64, Vec2)>,
    drift_mps: Vec2,
    helm_mps: Vec2,
    /// The order that has stood, and since when, seconds.
    standing: Option<(f64, Vec2)>,
    noted: f64,
    noted_helm: f64,
}

impl OwnMotion {
    /// Forgets everything.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Takes in a beat, with the velocity that was ordered on the one before; own ship with her
    /// mean heading and velocity where she is steady.
    pub fn note(&mut self, t_s: f64, own: &OwnState, ordered_mps: Option<Vec2>) -> OwnState {
        self.beats.push_back((t_s, own.psi_rad, own.velocity_mps));
        while self.beats.front().is_some_and(|beat| beat.0 < t_s - MEAN_S) {
            self.beats.pop_front();
        }
        let stands = self.order_stands(t_s, ordered_mps);
        let steady = self.beats.iter().all(|(_, psi_rad, velocity_mps)| {
            let faster_mps = (velocity_mps.norm() - own.sog_mps).abs();
            wrap(psi_rad - own.psi_rad).abs() < TURNS_RAD && faster_mps < SPEED_SHARE * own.sog_mps
        });
        if !steady {
            return *own;
        }
        let through_water_mps = angle::unit(own.psi_rad) * own.stw_mps;
        // the first beats weigh alike, so that there is an estimate from the start
        self.noted += 1.0;
        let gain = DRIFT_GAIN.max(1.0 / self.noted);
        self.drift_mps += (own.velocity_mps - through_water_mps - self.drift_mps) * gain;
        if let Some(ordered_mps) = ordered_mps.filter(|_| stands) {
            self.noted_helm += 1.0;
            let gain = DRIFT_GAIN.max(1.0 / self.noted_helm);
            self.helm_mps += (ordered_mps - through_water_mps - self.helm_mps) * gain;
        }
        let sum_mps: Vec2 = self.beats.iter().map(|beat| beat.2).sum();
        let velocity_mps = sum_mps / self.beats.len() as f64;
        let sog_mps = velocity_mps.norm();
        let cog_rad = if sog_mps > 0.0 { angle::direction(velocity_mps) } else { own.cog_rad };
        let headings: Vec2 = self.beats.iter().map(|beat| angle::unit(beat.1)).sum();
        let psi_rad = angle::direction(headings);
        OwnState { psi_rad, velocity_mps, sog_mps, cog_rad, ..*own }
    }

    /// Whether the order has been the same for long enough to be carried out.
    fn order_stands(&mut self, t_s: f64, ordered_mps: Option<Vec2>) -> bool {
        let (Some(ordered_mps), Some((since_s, standing_mps))) = (ordered_mps, self.standing)
        else {
            self.standing = ordered_mps.map(|ordered_mps| (t_s, ordered_mps));
            return false;
        };
        if (ordered_mps - standing_mps).norm() > SAME_ORDER * standing_mps.norm() {
            self.standing = Some((t_s, ordered_mps));
            return false;
        }
        t_s - since_s >= CARRIED_OUT_S
    }

    /// What own helm takes off an order over ground before it steers, m/s north and east: the part
    /// of the drift that it knows.
    pub fn helm_mps(&self) -> Vec2 {
        self.helm_mps
    }

    /// What current, wind and waves do to a ship here, m/s north and east.
    pub fn drift_mps(&self) -> Vec2 {
        self.drift_mps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn own(psi_deg: f64, drift_mps: Vec2) -> OwnState {
        let psi_rad = deg(psi_deg);
        let velocity_mps = angle::unit(psi_rad) * 6.0 + drift_mps;
        OwnState {
            position_m: Vec2::zeros(),
            psi_rad,
            velocity_mps,
            cog_rad: angle::direction(velocity_mps),
            sog_mps: velocity_mps.norm(),
            stw_mps: 6.0,
            yaw_rate_radps: 0.0,
        }
    }

    #[test]
    fn yaw_is_averaged_out_and_the_drift_is_found() {
        let (mut motion, drift_mps) = (OwnMotion::default(), Vec2::new(0.3, -0.5));
        let mut last = own(0.0, drift_mps);
        for beat in 0..60 {
            let yaw_deg = 3.0 * geom::math::sin(f64::from(beat));
            last = motion.note(f64::from(beat), &own(yaw_deg, drift_mps), None);
        }
        assert!((motion.drift_mps() - drift_mps).norm() < 0.02, "{}", motion.drift_mps());
        let ahead_mps = own(0.0, drift_mps).velocity_mps;
        assert!((last.velocity_mps - ahead_mps).norm() < 0.1, "{}", last.velocity_mps);
    }

    /// A helm that knows half of the drift; an order that has just changed teaches nothing.
    #[test]
    fn what_the_helm_knows_is_found_from_its_orders() {
        let (mut motion, drift_mps) = (OwnMotion::default(), Vec2::new(0.0, 0.8));
        let ordered_mps = |drift_mps: Vec2| Vec2::new(6.0, 0.0) + drift_mps * 0.5;
        for beat in 0..60 {
            motion.note(f64::from(beat), &own(0.0, drift_mps), Some(ordered_mps(drift_mps)));
        }
        let found_mps = motion.helm_mps();
        assert!((found_mps - drift_mps * 0.5).norm() < 1e-9, "{found_mps}");
        motion.note(60.0, &own(0.0, drift_mps), Some(Vec2::new(0.0, 6.0)));
        assert_eq!(motion.helm_mps(), found_mps);
    }

    #[test]
    fn a_turn_is_taken_as_it_is() {
        let mut motion = OwnMotion::default();
        for beat in 0..20 {
            let turning = own(4.0 * f64::from(beat), Vec2::zeros());
            let noted = motion.note(f64::from(beat), &turning, None);
            assert!(beat < 2 || noted == turning, "{beat}");
        }
    }
}
