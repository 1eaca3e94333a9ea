//! Hull outlines and the distance between two of them.
//!
//! The distance is parry's (Gilbert, Johnson and Keerthi, warm-started from the last call of the
//! same pair), in the frame of the first hull.

use crate::pose::Pose;
use geom::{HullOutline, Vec2, hull::CORNERS};
use rapier2d_f64::math::{Pose as RapierPose, Rotation, Vector};
use rapier2d_f64::parry::query::sweep_toi::{
    SimplexCache, Sweep, SweepToiStatus, ToiProxy, proxy_distance, sweep_time_of_impact,
};

/// A convex outline, or one edge of a hazard, ready for distance queries.
#[derive(Clone, Debug)]
pub struct Hull {
    corners: [Vector; CORNERS],
    count: usize,
    /// Radius of the circle around the reference point that holds the outline, metres.
    pub radius_m: f64,
}

/// What is known of one pair from its last query.
#[derive(Clone, Copy, Debug, Default)]
pub struct Warm(SimplexCache);

/// How two hulls lie to one another at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Gap {
    /// Distance, metres; 0 where they overlap.
    pub distance_m: f64,
    /// How fast the gap opens, m/s; 0 where they overlap.
    pub opening_mps: f64,
    /// Unit vector from the first hull to the second, north and east; zero where they overlap.
    pub normal: Vec2,
    /// The point of the first hull that is nearest to the second, north and east of her
    /// reference point, metres.
    pub own_arm_m: Vec2,
    /// The same of the second hull, off her own reference point.
    pub other_arm_m: Vec2,
}

/// Separation at which the sweep calls two hulls in contact, metres. It must be positive for the
/// search to end; a millimetre is below anything that a verdict looks at.
pub const CONTACT_SLOP_M: f64 = 1e-3;

pub(crate) fn vector(v: Vec2) -> Vector {
    Vector::new(v.x, v.y)
}

pub(crate) fn rapier_pose(pose: &Pose) -> RapierPose {
    let rotation = Rotation::from_cos_sin_unchecked(pose.heading.x, pose.heading.y);
    RapierPose::from_parts(vector(pose.position_m), rotation)
}

fn turn(heading: Vec2, v: Vector) -> Vec2 {
    Vec2::new(heading.x * v.x - heading.y * v.y, heading.y * v.x + heading.x * v.y)
}

impl Hull {
    /// The outline of a ship.
    pub fn new(outline: &HullOutline) -> Self {
        let corners = outline.corners_body_m().map(vector);
        Self { corners, count: CORNERS, radius_m: outline.radius_m() }
    }

    /// The edge from `-half_m` to `half_m` (north and east) about its reference point.
    pub fn of_edge(half_m: Vec2) -> Self {
        let mut corners = [Vector::ZERO; CORNERS];
        (corners[0], corners[1]) = (vector(-half_m), vector(half_m));
        Self { corners, count: 2, radius_m: half_m.norm() }
    }

    pub(crate) fn corners(&self) -> &[Vector] {
        &self.corners[..self.count]
    }

    fn proxy(&self) -> ToiProxy<'_> {
        ToiProxy::from_points(self.corners(), 0.0)
    }

    /// The gap between this hull at `own` and the `other` one at `at`.
    pub fn gap(&self, own: &Pose, other: &Self, at: &Pose, warm: &mut Warm) -> Gap {
        let (h, k) = (own.heading, at.heading);
        let offset = at.position_m - own.position_m;
        // the second hull in the frame of the first; parry's own product of poses is the same
        let rotation =
            Rotation::from_cos_sin_unchecked(h.x * k.x + h.y * k.y, h.x * k.y - h.y * k.x);
        let translation =
            Vector::new(h.x * offset.x + h.y * offset.y, h.x * offset.y - h.y * offset.x);
        let relative = RapierPose::from_parts(translation, rotation);
        let out = proxy_distance(&relative, &self.proxy(), &other.proxy(), false, &mut warm.0);
        let normal = turn(h, out.normal);
        let own_arm_m = turn(h, out.point_a);
        let other_arm_m = turn(h, out.point_b) - offset;
        let relative_mps = at.velocity_at_mps(other_arm_m) - own.velocity_at_mps(own_arm_m);
        Gap {
            distance_m: out.distance,
            opening_mps: relative_mps.dot(&normal),
            normal,
            own_arm_m,
            other_arm_m,
        }
    }

    /// The first fraction (0 to 1) of a step at which the hulls touch, if they do, where each
    /// goes straight from its first pose to its second.
    pub fn first_touch(
        &self,
        own: (&Pose, &Pose),
        other: &Self,
        at: (&Pose, &Pose),
    ) -> Option<f64> {
        let sweep = |(from, to): (&Pose, &Pose)| {
            Sweep::from_poses(&rapier_pose(from), &rapier_pose(to), Vector::ZERO)
        };
        let (a, b) = (self.proxy(), other.proxy());
        let out = sweep_time_of_impact(&a, &sweep(own), &b, &sweep(at), 1.0, CONTACT_SLOP_M);
        matches!(out.status, SweepToiStatus::Hit | SweepToiStatus::Overlapped)
            .then_some(out.fraction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    pub(crate) fn at(x: f64, y: f64, psi_rad: f64) -> Pose {
        Pose {
            position_m: Vec2::new(x, y),
            velocity_mps: Vec2::zeros(),
            heading: geom::unit(psi_rad),
            yaw_rate_radps: 0.0,
        }
    }

    /// Distance of two convex polygons by brute force: every corner against every edge.
    fn brute_force_m(a: &[Vec2], b: &[Vec2]) -> f64 {
        let one_way = |p: &[Vec2], q: &[Vec2]| {
            let mut least = f64::INFINITY;
            for corner in p {
                for k in 0..q.len() {
                    let (from, to) = (q[k] - corner, q[(k + 1) % q.len()] - corner);
                    least = least.min(geom::segment_min_distance(from, to).0);
                }
            }
            least
        };
        one_way(a, b).min(one_way(b, a))
    }

    fn gap(a: (&HullOutline, &Pose), b: (&HullOutline, &Pose)) -> Gap {
        Hull::new(a.0).gap(a.1, &Hull::new(b.0), b.1, &mut Warm::default())
    }

    proptest! {
        #[test]
        fn distance_is_that_of_brute_force(
            bearing in -3.1f64..3.1, range in 40f64..300.0,
            psi in -3.1f64..3.1, other_psi in -3.1f64..3.1,
        ) {
            let outline = HullOutline::centred(8.45, 2.71);
            let other = HullOutline::centred(60.0, 11.0);
            let place = geom::unit(bearing) * range;
            let (own, target) = (at(0.0, 0.0, psi), at(place.x, place.y, other_psi));
            let distance_m = gap((&outline, &own), (&other, &target)).distance_m;
            let expected_m = brute_force_m(
                &outline.corners_m(Vec2::zeros(), psi),
                &other.corners_m(place, other_psi),
            );
            prop_assert!((distance_m - expected_m).abs() < 1e-9, "{distance_m} {expected_m}");
        }

        #[test]
        fn opening_speed_is_the_derivative(
            bearing in -3.1f64..3.1, range in 60f64..200.0,
            v in -9f64..9.0, w in -9f64..9.0, r in -0.3f64..0.3,
        ) {
            let (a, b) = (HullOutline::centred(20.0, 5.0), HullOutline::centred(60.0, 11.0));
            let place = geom::unit(bearing) * range;
            let moving = |pose: Pose, velocity_mps, yaw_rate_radps| Pose {
                velocity_mps,
                yaw_rate_radps,
                ..pose
            };
            let own = moving(at(0.0, 0.0, 0.3), Vec2::new(v, w), r);
            let target = moving(at(place.x, place.y, 2.0), Vec2::new(-w, 2.0), -r);
            let later = |p: &Pose, dt: f64| Pose {
                position_m: p.position_m + p.velocity_mps * dt,
                heading: geom::angle::rotate(p.heading, p.yaw_rate_radps * dt),
                ..*p
            };
            let after = |dt| gap((&a, &later(&own, dt)), (&b, &later(&target, dt))).distance_m;
            let opening = gap((&a, &own), (&b, &target)).opening_mps;
            let dt = 1e-5;
            let (left, right) = ((after(0.0) - after(-dt)) / dt, (after(dt) - after(0.0)) / dt);
            // where the nearest corner changes the derivative jumps, and lies between both sides
            let (low, high) = (left.min(right) - 1e-3, left.max(right) + 1e-3);
            prop_assert!(low <= opening && opening <= high, "{left} {opening} {right}");
        }
    }
}
