//! How two ships lie to one another (rules specification, section 0).

use crate::{Vec2, angle, wrap};

/// Range and bearings of a pair; angles in radians, clockwise, wrapped to (-pi, pi].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relative {
    /// Distance between the two reference points, in metres.
    pub range_m: f64,
    /// True bearing of the target from own ship.
    pub bearing_rad: f64,
    /// `beta`: relative bearing, the target as seen from own ship's bow.
    pub beta_rad: f64,
    /// `alpha`: contact angle, own ship as seen from the target's bow.
    pub alpha_rad: f64,
}

impl Relative {
    /// From positions in metres and headings in radians.
    #[inline]
    pub fn new(own_m: Vec2, own_psi_rad: f64, target_m: Vec2, target_psi_rad: f64) -> Self {
        let los_m = target_m - own_m;
        let bearing_rad = angle::direction(los_m);
        // the opposite bearing from the negated vector, so that exchanging the ships is exact
        let back_rad = angle::direction(-los_m);
        Self {
            range_m: los_m.norm(),
            bearing_rad,
            beta_rad: wrap(bearing_rad - own_psi_rad),
            alpha_rad: wrap(back_rad - target_psi_rad),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::deg;
    use proptest::prelude::*;

    #[test]
    fn target_on_the_starboard_bow_crossing_from_starboard() {
        let r = Relative::new(Vec2::zeros(), 0.0, Vec2::new(1000.0, 1000.0), deg(-90.0));
        assert!((r.beta_rad - deg(45.0)).abs() < 1e-12);
        assert!((r.alpha_rad - deg(-45.0)).abs() < 1e-12);
        assert!((r.range_m - 1000.0 * 2f64.sqrt()).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn mirroring_negates_the_angles_bit_for_bit(
            x in -2e3f64..2e3, y in -2e3f64..2e3, psi in -3f64..3.0, psi_t in -3f64..3.0,
        ) {
            prop_assume!(x.abs() > 1.0 && y.abs() > 1.0);
            let r = Relative::new(Vec2::new(0.0, 0.0), psi, Vec2::new(x, y), psi_t);
            let m = Relative::new(Vec2::new(0.0, 0.0), -psi, Vec2::new(x, -y), -psi_t);
            prop_assert_eq!(r.range_m.to_bits(), m.range_m.to_bits());
            prop_assert_eq!(r.beta_rad.to_bits(), (-m.beta_rad).to_bits());
            prop_assert_eq!(r.alpha_rad.to_bits(), (-m.alpha_rad).to_bits());
        }
    }
}
