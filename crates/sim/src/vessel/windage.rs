//! Leeway: what the wind on the projected areas of a hull makes of her.
//!
//! The cross force is Blendermann's (1994, Parameter identification of wind loads on ships, Journal
//! of Wind Engineering and Industrial Aerodynamics 51, in the form of Fossen 2011, section 8.1),
//! from the air that moves past the ship. She drifts at the speed at which her damping in sway
//! takes the same force: a balance, without the few seconds in which she comes to it. Her engine
//! and her steering hold speed and heading against the rest of the wind load.

/// Areas above the water and coefficients of the wind load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Windage {
    /// Projected area seen from ahead, m^2.
    pub frontal_m2: f64,
    /// Projected area seen from abeam, m^2.
    pub lateral_m2: f64,
    /// Drag coefficient of the frontal area in wind from ahead.
    pub head_drag: f64,
    /// The same in wind from astern.
    pub stern_drag: f64,
    /// Drag coefficient of the lateral area in wind from abeam.
    pub cross_drag: f64,
    /// Blendermann's cross-force parameter.
    pub cross_force: f64,
}

/// Density of air, kg/m^3.
const AIR_KGPM3: f64 = 1.225;

/// Rounds in which force and leeway come together; each makes the error ten times smaller or more.
const ROUNDS: usize = 3;

impl Windage {
    /// Force to starboard, N, of air that moves past the ship at `ahead_mps` towards her bow and
    /// `abeam_mps` to starboard.
    pub fn side_n(&self, ahead_mps: f64, abeam_mps: f64) -> f64 {
        let speed2 = ahead_mps * ahead_mps + abeam_mps * abeam_mps;
        if speed2 <= 0.0 {
            return 0.0;
        }
        let from_ahead = ahead_mps < 0.0;
        let along_drag = if from_ahead { self.head_drag } else { self.stern_drag };
        let along_drag = along_drag * self.frontal_m2 / self.lateral_m2;
        let sin_double = 2.0 * (ahead_mps * abeam_mps) / speed2;
        let oblique = 0.5 * self.cross_force * (1.0 - along_drag / self.cross_drag);
        let coefficient = self.cross_drag / (1.0 - oblique * (sin_double * sin_double));
        0.5 * AIR_KGPM3 * self.lateral_m2 * coefficient * (speed2.sqrt() * abeam_mps)
    }

    /// Speed to starboard, m/s, at which a damping in sway of `linear` (N s/m) and `quadratic`
    /// (N s^2/m^2) balances the wind. `air_mps` is the air past a hull that makes no leeway: ahead
    /// and to starboard.
    pub(super) fn leeway_mps(&self, air_mps: [f64; 2], linear: f64, quadratic: f64) -> f64 {
        let [ahead_mps, abeam_mps] = air_mps;
        (0..ROUNDS).fold(0.0, |leeway_mps, _| {
            let side_n = self.side_n(ahead_mps, abeam_mps - leeway_mps);
            2.0 * side_n / (linear + (linear * linear + 4.0 * quadratic * side_n.abs()).sqrt())
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::vessel::{GUNNERUS, ThreeDof, VIKNES};

    /// Wind abeam has the drag coefficient alone: 1/2 1.225 0.85 13.31 m^2 (10 m/s)^2.
    #[test]
    fn force_abeam_is_that_of_the_drag_coefficient() {
        let side_n = VIKNES.windage.side_n(0.0, 10.0);
        assert!((side_n - 0.5 * 1.225 * 0.85 * 13.308_75 * 100.0).abs() < 1e-9, "{side_n}");
        // 45 degrees from ahead: sin 2 gamma = 1, C_Y = 0.85 sqrt(1/2) / (1 - 0.3 (1 - C_l / 0.85))
        let along_drag = 0.55 * 9.485 / 13.308_75;
        let side_n = VIKNES.windage.side_n(-8.0, -8.0);
        let coefficient = 0.85 * 0.5f64.sqrt() / (1.0 - 0.3 * (1.0 - along_drag / 0.85));
        assert!((side_n + 0.5 * 1.225 * 13.308_75 * 128.0 * coefficient).abs() < 1e-9, "{side_n}");
    }

    /// Balances found by bisection, with sines and arc tangents, outside this program.
    #[test]
    fn leeway_is_where_damping_balances_the_wind() {
        for (ship, air_mps, expected_mps) in BALANCES {
            let leeway_mps = ship.leeway_mps(air_mps);
            assert!((leeway_mps / expected_mps - 1.0).abs() < 2e-3, "{air_mps:?}: {leeway_mps}");
        }
    }

    #[test]
    fn wind_along_the_ship_makes_no_leeway_and_calm_none() {
        for ahead_mps in [-12.0, 0.0, 9.0] {
            assert!(VIKNES.leeway_mps([ahead_mps, 0.0]).abs() <= 0.0);
        }
    }

    /// Mirrored to the last bit, to leeward, and slower than the wind.
    #[test]
    fn leeway_is_mirrored_and_slower_than_the_wind() {
        for ship in [&VIKNES, &GUNNERUS] {
            for ahead_mps in [-17.0, -3.0, 0.0, 0.5, 8.0] {
                for abeam_mps in [0.01, 0.7, 4.0, 25.0] {
                    let starboard = ship.leeway_mps([ahead_mps, abeam_mps]);
                    let port = ship.leeway_mps([ahead_mps, -abeam_mps]);
                    assert_eq!(starboard.to_bits(), (-port).to_bits());
                    assert!(starboard > 0.0 && starboard < abeam_mps, "{starboard}");
                }
            }
        }
    }

    const BALANCES: [(&ThreeDof, [f64; 2], f64); 8] = [
        (&VIKNES, [0.0, 10.0], 0.510_764_650_7),
        (&VIKNES, [-7.0, 8.0], 0.514_994_488_2),
        (&VIKNES, [-15.0, 3.0], 0.332_192_992_2),
        (&VIKNES, [5.0, 5.0], 0.314_838_663_8),
        (&GUNNERUS, [0.0, 10.0], 0.511_482_832_7),
        (&GUNNERUS, [-7.0, 8.0], 0.552_842_997_2),
        (&GUNNERUS, [-15.0, 3.0], 0.286_428_932_7),
        (&GUNNERUS, [-5.0, -0.5], -0.020_808_919_06),
    ];
}
