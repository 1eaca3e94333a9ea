//! Closest point of approach of two points in straight motion (rules specification, section 1).

use crate::Vec2;

/// Below this relative speed there is no meaningful time to CPA: the ships keep their distance.
const RELATIVE_SPEED_MIN_MPS: f64 = 0.05;

/// A predicted closest point of approach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cpa {
    /// Distance at the closest point from now on, in metres (a CPA in the past gives the present).
    pub dcpa_m: f64,
    /// Signed time to the closest point, in seconds; negative once it has passed, `None` when the
    /// relative speed is under 0.05 m/s. It is never 0 or infinite for want of a value.
    pub tcpa_s: Option<f64>,
}

/// CPA from the target's position and velocity relative to own ship, in metres and m/s.
#[inline]
pub fn cpa(relative_position_m: Vec2, relative_velocity_mps: Vec2) -> Cpa {
    let speed_squared = relative_velocity_mps.norm_squared();
    if speed_squared < RELATIVE_SPEED_MIN_MPS * RELATIVE_SPEED_MIN_MPS {
        return Cpa { dcpa_m: relative_position_m.norm(), tcpa_s: None };
    }
    let tcpa_s = -relative_position_m.dot(&relative_velocity_mps) / speed_squared;
    let closest = relative_position_m + relative_velocity_mps * tcpa_s.max(0.0);
    Cpa { dcpa_m: closest.norm(), tcpa_s: Some(tcpa_s) }
}

/// Smallest distance from the origin to the segment from `from_m` to `to_m`, and where on it
/// (0 to 1). With relative positions this is the refined minimum between two samples.
#[inline]
pub fn segment_min_distance(from_m: Vec2, to_m: Vec2) -> (f64, f64) {
    let step = to_m - from_m;
    let length_squared = step.norm_squared();
    let fraction = if length_squared > 0.0 {
        (-from_m.dot(&step) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    ((from_m + step * fraction).norm(), fraction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn closing_pair_has_positive_time() {
        let c = cpa(Vec2::new(1500.0, 0.0), Vec2::new(-14.0, 0.0));
        assert!((c.tcpa_s.unwrap() - 107.142_857_142_857_14).abs() < 1e-12);
        assert!(c.dcpa_m < 1e-9);
    }

    #[test]
    fn past_cpa_keeps_its_sign_and_the_present_distance() {
        let c = cpa(Vec2::new(100.0, 30.0), Vec2::new(5.0, 0.0));
        assert!(c.tcpa_s.unwrap() < 0.0);
        assert!((c.dcpa_m - Vec2::new(100.0, 30.0).norm()).abs() < 1e-12);
    }

    #[test]
    fn equal_velocities_have_no_time() {
        assert_eq!(cpa(Vec2::new(3.0, 4.0), Vec2::new(0.03, 0.0)).tcpa_s, None);
    }

    proptest! {
        #[test]
        fn cpa_is_minimal(
            x in -3e3f64..3e3, y in -3e3f64..3e3,
            vx in -20f64..20.0, vy in -20f64..20.0, t in 0f64..600.0,
        ) {
            let (r, w) = (Vec2::new(x, y), Vec2::new(vx, vy));
            let c = cpa(r, w);
            prop_assert!(c.dcpa_m <= (r + w * t).norm() + 1e-6 || c.tcpa_s.is_none());
        }

        #[test]
        fn segment_minimum_is_minimal(
            x in -3e2f64..3e2, y in -3e2f64..3e2,
            dx in -20f64..20.0, dy in -20f64..20.0, s in 0f64..1.0,
        ) {
            let (a, d) = (Vec2::new(x, y), Vec2::new(dx, dy));
            let (min, at) = segment_min_distance(a, a + d);
            prop_assert!((0.0..=1.0).contains(&at));
            prop_assert!(min <= (a + d * s).norm() + 1e-9);
        }
    }
}
