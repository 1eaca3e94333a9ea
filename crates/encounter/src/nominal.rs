//! What an encounter is at its start, if nobody acts.

use crate::wanted::MOVING_MPS_MIN;
use geom::{Cpa, EncounterClass, HeadOnSector, Relative, Vec2, classify, cpa, unit};
use record::{Encounter, Intent, Motion, Waypoint};

/// Closest points of approach at the start, one for each target, from present courses and speeds.
/// A current moves both ships alike and drops out.
pub fn nominal_cpa(encounter: &Encounter) -> Vec<Cpa> {
    let own = &encounter.own.start;
    encounter
        .targets
        .iter()
        .map(|target| cpa(target.start.position_m - own.position_m, closing(own, &target.start)))
        .collect()
}

/// Class of own ship and target `index` at the start; `None` where they do not close.
pub fn class_at_start(
    encounter: &Encounter,
    index: usize,
    head_on: HeadOnSector,
) -> Option<EncounterClass> {
    let (own, target) = (&encounter.own.start, &encounter.targets[index].start);
    let position_m = target.position_m - own.position_m;
    if position_m.dot(&closing(own, target)) >= 0.0 {
        return None;
    }
    if target.speed_mps < MOVING_MPS_MIN {
        return Some(EncounterClass::Static);
    }
    let lie = Relative::new(own.position_m, own.psi_rad, target.position_m, target.psi_rad);
    Some(classify(lie.beta_rad, lie.alpha_rad, head_on))
}

/// Velocity of the target relative to own ship, m/s.
fn closing(own: &Motion, target: &Motion) -> Vec2 {
    unit(target.psi_rad) * target.speed_mps - unit(own.psi_rad) * own.speed_mps
}

/// When the last target has passed its closest point, in seconds, if own ship keeps to her route
/// and the targets to theirs, turning and changing speed at once; 0 if they all draw apart.
pub fn last_cpa_s(encounter: &Encounter) -> f64 {
    let current_mps = encounter.weather.current_mps;
    let own = Track::new(&encounter.own.start, &encounter.own.route, current_mps);
    let track = |target: &record::Target| match &target.intent {
        Intent::Track(waypoints) => Track::new(&target.start, waypoints, current_mps),
        _ => Track::new(&target.start, &[], current_mps),
    };
    encounter.targets.iter().map(|target| own.closest_s(&track(target))).fold(0.0, f64::max)
}

/// Straight legs over ground, the last without an end.
struct Track(Vec<Leg>);

struct Leg {
    from_s: f64,
    from_m: Vec2,
    velocity_mps: Vec2,
}

impl Track {
    fn new(start: &Motion, waypoints: &[Waypoint], current_mps: Vec2) -> Self {
        let water_mps = unit(start.psi_rad) * start.speed_mps;
        let mut velocity_mps = water_mps + current_mps;
        let mut speed_mps = velocity_mps.norm();
        let (mut from_s, mut from_m) = (0.0, start.position_m);
        let mut legs = Vec::with_capacity(waypoints.len() + 1);
        for waypoint in waypoints {
            let way_m = waypoint.position_m - from_m;
            speed_mps = waypoint.speed_mps.unwrap_or(speed_mps);
            if way_m.norm() <= 0.0 {
                continue;
            }
            velocity_mps = way_m.normalize() * speed_mps;
            legs.push(Leg { from_s, from_m, velocity_mps });
            if speed_mps <= 0.0 {
                return Self(legs);
            }
            from_s += way_m.norm() / speed_mps;
            from_m = waypoint.position_m;
        }
        legs.push(Leg { from_s, from_m, velocity_mps });
        Self(legs)
    }

    /// The leg at a time.
    fn at(&self, t_s: f64) -> &Leg {
        let later = self.0.iter().position(|leg| leg.from_s > t_s).unwrap_or(self.0.len());
        &self.0[later.max(1) - 1]
    }

    fn closest_s(&self, other: &Self) -> f64 {
        let mut breaks_s: Vec<f64> = self.0.iter().chain(&other.0).map(|leg| leg.from_s).collect();
        breaks_s.sort_by(f64::total_cmp);
        let mut closest = (f64::INFINITY, 0.0);
        for (i, &from_s) in breaks_s.iter().enumerate() {
            let length_s = breaks_s.get(i + 1).map_or(f64::INFINITY, |to_s| to_s - from_s);
            let (own, target) = (self.at(from_s), other.at(from_s));
            let place_m = |leg: &Leg| leg.from_m + leg.velocity_mps * (from_s - leg.from_s);
            let position_m = place_m(target) - place_m(own);
            let velocity_mps = target.velocity_mps - own.velocity_mps;
            let on_s = cpa(position_m, velocity_mps).tcpa_s.unwrap_or(0.0).clamp(0.0, length_s);
            let distance_m = (position_m + velocity_mps * on_s).norm();
            if distance_m < closest.0 {
                closest = (distance_m, from_s + on_s);
            }
        }
        closest.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn track(north_m: f64, east_m: f64, psi_rad: f64, route: &[(f64, f64, f64)]) -> Track {
        let waypoint = |&(north_m, east_m, speed_mps): &(f64, f64, f64)| Waypoint {
            position_m: Vec2::new(north_m, east_m),
            speed_mps: Some(speed_mps),
        };
        let route: Vec<Waypoint> = route.iter().map(waypoint).collect();
        let position_m = Vec2::new(north_m, east_m);
        Track::new(&Motion { position_m, psi_rad, speed_mps: 10.0 }, &route, Vec2::zeros())
    }

    /// Own ship north at 10 m/s. The target runs beside her 1000 m off for 100 s, then crosses
    /// south-east of her bow: without the turn there is no closest point at all.
    #[test]
    fn a_turn_on_the_route_makes_the_closest_point() {
        let own = track(0.0, 0.0, 0.0, &[]);
        let target = track(1000.0, 1000.0, 0.0, &[(2000.0, 1000.0, 10.0), (2000.0, -5000.0, 10.0)]);
        // from 100 s on: 1000 m ahead and 1000 m to starboard, she goes west and own ship north
        assert!((own.closest_s(&target) - 200.0).abs() < 1e-9);
        assert!((target.closest_s(&own) - 200.0).abs() < 1e-9);
        let parallel = track(1000.0, 1000.0, 0.0, &[]);
        assert!(own.closest_s(&parallel).abs() < 1e-9);
    }

    /// A target that would meet own ship at 100 s, but turns away after 50 s: 1000 m off each way.
    #[test]
    fn a_leg_counts_no_longer_than_it_lasts() {
        let own = track(0.0, 0.0, 0.0, &[]);
        let target = track(2000.0, 0.0, PI, &[(1500.0, 0.0, 10.0), (1500.0, 9000.0, 10.0)]);
        // at 50 s 1000 m ahead and going east, own ship north: closest 50 s later
        assert!((own.closest_s(&target) - 100.0).abs() < 1e-9);
        let away = track(2000.0, 0.0, PI, &[(1500.0, 0.0, 10.0), (9000.0, 0.0, 20.0)]);
        assert!((own.closest_s(&away) - 50.0).abs() < 1e-9);
    }

    #[test]
    fn a_leg_without_speed_ends_the_voyage() {
        let own = track(0.0, 0.0, 0.0, &[]);
        let target = track(1500.0, 800.0, -FRAC_PI_2, &[(1500.0, 300.0, 10.0), (1500.0, 0.0, 0.0)]);
        assert!((own.closest_s(&target) - 150.0).abs() < 1e-9);
    }
}
