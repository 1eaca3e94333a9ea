//! Rule 13(d): whether own ship, overtaking, forced the other to alter.
//!
//! A target that minds nobody keeps to her own nominal track; one that leaves it was forced. Which
//! of several ships forced her is not recorded: the nearest one did.

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
        let mut since: Option<usize> = None;
        (0..samples)
            .map(|k| {
                since = (k < planned.len() && self.is_off(ship, planned, k))
                    .then(|| since.unwrap_or(k));
                let held = since.is_some_and(|from| {
                    from >= onset && k >= from + self.hold && self.own_is_nearest(from)
                });
                if held { 1.0 } else { -1.0 }
            })
            .collect()
    }

    fn is_off(&self, ship: &ShipTrack, planned: &ShipTrack, k: usize) -> bool {
        let (p, speed) = (self.params, planned.sog_mps(k));
        let turned = wrapped_rad(ship.psi_rad[k] - planned.psi_rad[k]).abs();
        let changed = (ship.sog_mps(k) - speed).abs();
        turned >= p.turn_action_rad || (changed > 0.0 && changed >= p.speed_action * speed)
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
