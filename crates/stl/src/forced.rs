//! Rule 13(d): whether own ship, overtaking, forced the other to alter.
//!
//! A target that minds nobody keeps to her own nominal track; one that leaves it was forced, if a
//! pass under the minimum distance was predicted when she last was on it. Which of several ships
//! forced her is not recorded: the nearest one did.

use crate::checks::Case;
use crate::signals::wrapped_rad;
use record::ShipTrack;

impl Case<'_> {
    /// Flag: the target has been off her own plan for as long as an offset must be held, since a
    /// sample at or after `onset`, at which own ship was the nearest to her.
    pub(crate) fn forced(&self, onset: usize) -> Vec<f64> {
        let samples = self.pair().samples();
        let planned = self.trace.nominal.as_ref().and_then(|n| n.targets.get(self.target));
        let Some(planned) = planned else { return vec![-1.0; samples] };
        let ship = &self.trace.targets[self.target];
        let p = self.params;
        let off = |k: usize, turn_rad: f64, speed: f64| {
            k < planned.len() && departs(ship, planned, k, turn_rad, speed)
        };
        let (mut since, mut kept): (Option<usize>, Option<usize>) = (None, None);
        (0..samples)
            .map(|k| {
                if !off(k, p.turn_detectable_rad, p.speed_detectable) {
                    kept = Some(k);
                }
                since = off(k, p.turn_action_rad, p.speed_action).then(|| since.unwrap_or(k));
                let held = since.is_some_and(|from| {
                    from >= onset
                        && k >= from + self.hold
                        && kept.is_none_or(|k| self.pair().predicted_within(k, p.minimum_m))
                        && self.own_is_nearest(from)
                });
                if held { 1.0 } else { -1.0 }
            })
            .collect()
    }

    fn own_is_nearest(&self, k: usize) -> bool {
        let ship = &self.trace.targets[self.target];
        let range_m = |other: &ShipTrack| (other.position_m(k) - ship.position_m(k)).norm();
        let own_m = range_m(&self.trace.own);
        self.trace
            .targets
            .iter()
            .enumerate()
            .all(|(i, other)| i == self.target || range_m(other) >= own_m)
    }
}

/// Whether her heading or speed is off her plan by as much.
fn departs(ship: &ShipTrack, planned: &ShipTrack, k: usize, turn_rad: f64, share: f64) -> bool {
    let speed = planned.sog_mps(k);
    let changed = (ship.sog_mps(k) - speed).abs();
    wrapped_rad(ship.psi_rad[k] - planned.psi_rad[k]).abs() >= turn_rad
        || (changed > 0.0 && changed >= share * speed)
}
