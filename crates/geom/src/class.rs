//! The classes of an encounter between two power-driven vessels (Rules 13 to 15).
//!
//! One formula for everybody who needs a label: the generator that is asked for a class, the judge
//! that decides on it, the planners that believe one. Each brings its own half-angle, because
//! "nearly reciprocal" carries no number in the treaty.

use crate::{units, wrap};
use serde::{Deserialize, Serialize};

/// "More than 22.5 degrees abaft her beam" (Rule 13(b)): the one number that is law.
pub const OVERTAKING_SECTOR_RAD: f64 = units::deg(112.5);

/// What an encounter is to own ship.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EncounterClass {
    /// Rule 14: both give way.
    HeadOn,
    /// Rule 15, the target on own starboard side: own ship gives way.
    CrossingStbd,
    /// Rules 15 and 17, the target on own port side: own ship stands on.
    CrossingPort,
    /// Rule 13: own ship overtakes and gives way.
    Overtaking,
    /// Rules 13 and 17: own ship is overtaken and stands on.
    Overtaken,
    /// The target does not move.
    Static,
}

impl EncounterClass {
    /// Every class, in the order of reports.
    pub const ALL: [Self; 6] = [
        Self::HeadOn,
        Self::CrossingStbd,
        Self::CrossingPort,
        Self::Overtaking,
        Self::Overtaken,
        Self::Static,
    ];

    /// The word used in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::HeadOn => "head_on",
            Self::CrossingStbd => "crossing_stbd",
            Self::CrossingPort => "crossing_port",
            Self::Overtaking => "overtaking",
            Self::Overtaken => "overtaken",
            Self::Static => "static",
        }
    }

    /// The class with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|class| class.name() == name)
    }

    /// The same encounter seen in a mirror.
    pub const fn mirrored(self) -> Self {
        match self {
            Self::CrossingStbd => Self::CrossingPort,
            Self::CrossingPort => Self::CrossingStbd,
            other => other,
        }
    }
}

/// The width of the head-on sector, both in radians.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeadOnSector {
    /// `H`: largest relative bearing and contact angle.
    pub half_angle_rad: f64,
    /// `H_rec`: largest departure from reciprocal headings, |beta - alpha|.
    pub reciprocal_rad: f64,
}

impl HeadOnSector {
    /// `H` with `H_rec = 2 H`, which adds no condition.
    pub const fn wide(half_angle_rad: f64) -> Self {
        Self { half_angle_rad, reciprocal_rad: 2.0 * half_angle_rad }
    }
}

/// The class of a closing pair of moving ships from the relative bearing `beta_rad` and the
/// contact angle `alpha_rad` (rules specification, section 2). Whether they close, and whether one
/// of them is stopped, is for the caller to say.
pub fn classify(beta_rad: f64, alpha_rad: f64, head_on: HeadOnSector) -> EncounterClass {
    if alpha_rad.abs() > OVERTAKING_SECTOR_RAD {
        EncounterClass::Overtaking
    } else if beta_rad.abs() > OVERTAKING_SECTOR_RAD {
        EncounterClass::Overtaken
    } else if beta_rad.abs() <= head_on.half_angle_rad
        && alpha_rad.abs() <= head_on.half_angle_rad
        && wrap(beta_rad - alpha_rad).abs() <= head_on.reciprocal_rad
    {
        EncounterClass::HeadOn
    } else if beta_rad >= 0.0 {
        EncounterClass::CrossingStbd
    } else {
        EncounterClass::CrossingPort
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::deg;
    use proptest::prelude::*;

    #[test]
    fn the_overtaking_sector_is_strict() {
        let h = HeadOnSector::wide(deg(13.0));
        let at = OVERTAKING_SECTOR_RAD;
        assert_eq!(classify(0.0, at, h), EncounterClass::CrossingStbd);
        assert_eq!(classify(0.0, at + 1e-9, h), EncounterClass::Overtaking);
        assert_eq!(classify(at, 0.1, h), EncounterClass::CrossingStbd);
        assert_eq!(classify(-at - 1e-9, 0.1, h), EncounterClass::Overtaken);
    }

    #[test]
    fn reciprocal_limit_narrows_the_head_on_sector() {
        let seed = HeadOnSector { half_angle_rad: deg(10.0), reciprocal_rad: deg(10.0) };
        assert_eq!(classify(deg(8.0), deg(-8.0), seed), EncounterClass::CrossingStbd);
        let wide = HeadOnSector::wide(deg(10.0));
        assert_eq!(classify(deg(8.0), deg(-8.0), wide), EncounterClass::HeadOn);
    }

    proptest! {
        #[test]
        fn mirror_exchanges_the_crossings(
            beta in -3.1f64..3.1, alpha in -3.1f64..3.1, h in 0.05f64..0.4,
        ) {
            prop_assume!(beta != 0.0);
            let h = HeadOnSector::wide(h);
            prop_assert_eq!(classify(-beta, -alpha, h), classify(beta, alpha, h).mirrored());
        }
    }
}
