//! The velocity obstacle of one target, without trigonometry.

use crate::clearance::Clearance;
use geom::Vec2;
use planner_api::TargetTrack;

/// A target as a cone in velocity space with its apex at the target's velocity.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// Target's position relative to own ship, metres north and east.
    pub los_m: Vec2,
    /// Target's velocity, m/s.
    pub velocity_mps: Vec2,
    radius_squared_m2: f64,
    range_squared_m2: f64,
}

impl Cone {
    /// From a track; R grows by `sigmas` standard deviations of the position (root mean square of
    /// the two axes, so that a turn of the scene changes nothing).
    pub fn new(own_m: Vec2, track: &TargetTrack, clearance: Clearance, sigmas: f64) -> Self {
        let los_m = track.position_m - own_m;
        let variance_m2 = 0.5 * (track.covariance[0][0] + track.covariance[1][1]);
        let radius_m = clearance.radius_m(track) + sigmas * variance_m2.max(0.0).sqrt();
        Self {
            los_m,
            velocity_mps: track.velocity_mps,
            radius_squared_m2: radius_m * radius_m,
            range_squared_m2: los_m.norm_squared(),
        }
    }

    /// Time in seconds until own ship at this velocity meets the disc; none if she does not, or
    /// moves away. 0 inside the disc while closing.
    #[inline]
    pub fn time_to_hit_s(&self, velocity_mps: Vec2) -> Option<f64> {
        let relative_mps = velocity_mps - self.velocity_mps;
        let along = self.los_m.dot(&relative_mps);
        if along <= 0.0 {
            return None;
        }
        if self.range_squared_m2 <= self.radius_squared_m2 {
            return Some(0.0);
        }
        let speed_squared = relative_mps.norm_squared();
        let across = self.los_m.perp(&relative_mps);
        let inside = self.radius_squared_m2 * speed_squared - across * across;
        (inside >= 0.0).then(|| (along - inside.sqrt()) / speed_squared)
    }

    /// Region V1 of Kuwata et al.: not moving away, and passing with the target on own starboard
    /// hand (the relative velocity points to port of the line of sight).
    #[inline]
    pub fn keeps_target_to_starboard(&self, velocity_mps: Vec2) -> bool {
        let relative_mps = velocity_mps - self.velocity_mps;
        self.los_m.dot(&relative_mps) >= 0.0 && self.los_m.perp(&relative_mps) < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::{angle, math};
    use planner_api::{Mission, OwnShip};
    use proptest::prelude::*;

    fn cone(x: f64, y: f64, vx: f64, vy: f64) -> Cone {
        let mission = Mission {
            own: OwnShip {
                length_m: 8.0,
                beam_m: 3.0,
                speed_mps_max: 12.0,
                yaw_rate_radps_max: 0.1,
                acceleration_mps2_max: 0.5,
            },
            route: Vec::new(),
            cruise_mps: 8.0,
            safety_radius_m: 150.0,
            between_centres: true,
            beat_s: 1.0,
            hazards: Vec::new(),
            stream_seed: 1,
        };
        let track = TargetTrack {
            id: 1,
            position_m: Vec2::new(x, y),
            velocity_mps: Vec2::new(vx, vy),
            cog_rad: 0.0,
            sog_mps: 0.0,
            psi_rad: None,
            length_m: None,
            beam_m: None,
            covariance: [[0.0; 4]; 4],
            age_s: 0.0,
            since_update_s: 0.0,
        };
        let kind = crate::clearance::RadiusKind::Mission;
        Cone::new(Vec2::zeros(), &track, Clearance::new(&mission, kind, 0.0), 0.0)
    }

    #[test]
    fn head_on_hits_when_the_gap_is_closed() {
        let time_s = cone(1550.0, 0.0, -6.0, 0.0).time_to_hit_s(Vec2::new(8.0, 0.0)).unwrap();
        assert!((time_s - 100.0).abs() < 1e-9);
        assert_eq!(cone(1550.0, 0.0, 9.0, 0.0).time_to_hit_s(Vec2::new(8.0, 0.0)), None);
    }

    /// A target ahead and own ship to port of its line: it would be left to starboard.
    #[test]
    fn v1_is_the_port_side() {
        let ahead = cone(1000.0, 0.0, 0.0, 0.0);
        assert!(ahead.keeps_target_to_starboard(Vec2::new(8.0, -3.0)));
        assert!(!ahead.keeps_target_to_starboard(Vec2::new(8.0, 3.0)));
        assert!(!ahead.keeps_target_to_starboard(Vec2::new(-1.0, -3.0)), "V3: moving away");
    }

    proptest! {
        /// Against the definition of the seed planner: |gamma| <= asin(R/D), and the distance at
        /// the time of the hit is R.
        #[test]
        fn agrees_with_the_angles(
            range in 160f64..3e3, bearing in -3f64..3.0, vx in -9f64..9.0, vy in -9f64..9.0,
            ux in -9f64..9.0, uy in -9f64..9.0,
        ) {
            let los = angle::unit(bearing) * range;
            let (target, own) = (Vec2::new(vx, vy), Vec2::new(ux, uy));
            let relative = own - target;
            prop_assume!(relative.norm() > 0.1);
            let gamma = geom::wrap(angle::direction(relative) - bearing);
            let mu = math::asin(150.0 / range);
            prop_assume!((gamma.abs() - mu).abs() > 1e-6);
            let hit = cone(los.x, los.y, vx, vy).time_to_hit_s(own);
            prop_assert_eq!(hit.is_some(), gamma.abs() < mu);
            if let Some(t) = hit {
                prop_assert!(((los - relative * t).norm() - 150.0).abs() < 1e-6);
            }
        }
    }
}
