//! Parameter sets of ships that cannot be.

use sim::vessel::{Damping, GUNNERUS, MassMatrix, ThreeDof, VIKNES};

#[test]
fn a_negative_mass_or_damping_is_no_ship() {
    for ship in [VIKNES, GUNNERUS] {
        assert!(ship.is_a_ship(), "{:?}", ship.time_constants_s());
        let mass = ship.mass;
        for mass in [
            MassMatrix { surge: -mass.surge, ..mass },
            MassMatrix { sway: -mass.sway, ..mass },
            MassMatrix { yaw: -mass.yaw, ..mass },
            MassMatrix { surge: f64::NAN, ..mass },
            MassMatrix { yaw: 0.0, ..mass },
        ] {
            assert!(!ThreeDof { mass, ..ship }.is_a_ship(), "{mass:?}");
        }
        for axis in 0..3 {
            for linear in [-ship.damping[axis].linear, 0.0] {
                let mut damping = ship.damping;
                damping[axis] = Damping { linear, ..damping[axis] };
                assert!(!ThreeDof { damping, ..ship }.is_a_ship(), "{damping:?}");
            }
        }
    }
}
