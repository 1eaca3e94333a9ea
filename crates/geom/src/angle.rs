//! Angles, wrapped to (-pi, pi].

use crate::{Vec2, math};
use std::f64::consts::{PI, TAU};

/// Wraps an angle in radians to (-pi, pi].
///
/// Values within one turn of the range are moved by a single addition, so that the wrap of a
/// negated angle is the negated wrap (but for pi itself). Non-finite input gives NaN.
#[inline]
pub fn wrap(angle_rad: f64) -> f64 {
    if angle_rad > -PI && angle_rad <= PI {
        return angle_rad;
    }
    if angle_rad > PI && angle_rad <= 3.0 * PI {
        return angle_rad - TAU;
    }
    if angle_rad <= -PI && angle_rad > -3.0 * PI {
        return angle_rad + TAU;
    }
    let turns = ((angle_rad + PI) / TAU).floor();
    let wrapped = angle_rad - turns * TAU;
    if wrapped <= -PI { wrapped + TAU } else { wrapped }
}

/// The unit vector in direction `angle_rad`, clockwise from north.
#[inline]
pub fn unit(angle_rad: f64) -> Vec2 {
    let (sin, cos) = math::sin_cos(angle_rad);
    Vec2::new(cos, sin)
}

/// The direction of `v`, clockwise from north; 0 for the zero vector.
#[inline]
pub fn direction(v: Vec2) -> f64 {
    math::atan2(v.y, v.x)
}

/// Turns `v` clockwise by `angle_rad` (to starboard).
#[inline]
pub fn rotate(v: Vec2, angle_rad: f64) -> Vec2 {
    let (sin, cos) = math::sin_cos(angle_rad);
    Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn wraps_at_the_border() {
        assert_eq!(wrap(PI).to_bits(), PI.to_bits());
        assert_eq!(wrap(-PI).to_bits(), PI.to_bits());
        assert!((wrap(359f64.to_radians()) - (-1f64).to_radians()).abs() < 1e-15);
        assert!(wrap(f64::NAN).is_nan());
    }

    proptest! {
        #[test]
        fn wrapped_angle_is_in_range_and_congruent(a in -1e4f64..1e4) {
            let w = wrap(a);
            prop_assert!(w > -PI && w <= PI);
            let turns = (a - w) / TAU;
            prop_assert!((turns - turns.round()).abs() < 1e-9);
        }

        #[test]
        fn rotation_keeps_length_and_adds_angles(
            x in -1e3f64..1e3, y in -1e3f64..1e3, a in -7f64..7.0,
        ) {
            prop_assume!(x.abs() + y.abs() > 1e-3);
            let v = Vec2::new(x, y);
            let r = rotate(v, a);
            prop_assert!((r.norm() - v.norm()).abs() < 1e-9);
            prop_assert!(wrap(direction(r) - direction(v) - a).abs() < 1e-9);
        }
    }
}
