//! What a stratum asks for: a class, or a place beside the border between two classes.
//!
//! The classes are those of `geom::classify` (Rules 13 to 15); the borders are where it changes its
//! answer.

use geom::class::OVERTAKING_SECTOR_RAD;
use geom::{EncounterClass, HeadOnSector, wrap};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Below this speed a ship counts as stopped (rules specification, section 2, line 0).
pub const MOVING_MPS_MIN: f64 = 0.2;

/// A border between classes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Border {
    /// The edge of the head-on sector.
    HeadOnCrossing,
    /// The target dead ahead, outside the head-on sector.
    CrossingStbdCrossingPort,
    /// Own ship 22.5 degrees abaft the target's beam.
    CrossingOvertaking,
    /// The target 22.5 degrees abaft own beam.
    CrossingOvertaken,
}

/// The side of a border: as the border's name has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The class named first.
    First,
    /// The class named second.
    Second,
}

/// What one encounter must be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// Whatever the laws give.
    Any,
    /// Of this class.
    Class(EncounterClass),
    /// Beside this border.
    Beside {
        /// Which border.
        border: Border,
        /// Largest angle from it, radians.
        within_rad: f64,
        /// On which side.
        side: Side,
    },
}

/// A part of the circle: at most `half_width_rad` from `centre_rad`, either way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Middle, radians.
    pub centre_rad: f64,
    /// Half of its width, radians; pi or more is the whole circle.
    pub half_width_rad: f64,
}

impl Wanted {
    /// Whether the bearings `beta_rad` and `alpha_rad` of a pair of the given class are wanted.
    pub fn met(
        &self,
        class: EncounterClass,
        beta_rad: f64,
        alpha_rad: f64,
        head_on: HeadOnSector,
    ) -> bool {
        match *self {
            Self::Any => true,
            Self::Class(wanted) => class == wanted,
            Self::Beside { border, within_rad, side } => {
                border.excess_rad(beta_rad, alpha_rad, head_on).abs() <= within_rad
                    && border.has_on(side, class)
            }
        }
    }

    /// A part of the circle that holds every relative course with which the class can be met, when
    /// the miss distance turns the line of sight by at most `offset_rad` at the start. To draw the
    /// course from it alone saves tries and leaves the law of those that are accepted as it is.
    ///
    /// Own velocity is the sum of the target's and of own velocity relative to her, so her
    /// direction lies between the two: with `c` the relative course and `chi` the direction of the
    /// relative velocity, `|chi| + |c| = |chi - c| <= pi`. The line of sight is off `chi` by at
    /// most the offset. Overtaking: `|beta - c| < 67.5 deg`, so `|c| < 67.5 deg + offset`.
    /// Overtaken: `|beta| > 112.5 deg`, so `|chi| > 112.5 deg - offset` and the same bound.
    /// Head-on: `beta - alpha = c - pi` up to whole turns.
    pub fn course_arc(&self, head_on: HeadOnSector, offset_rad: f64) -> Arc {
        let reciprocal = |slack_rad: f64| Arc {
            centre_rad: PI,
            half_width_rad: (2.0 * (head_on.half_angle_rad + slack_rad))
                .min(head_on.reciprocal_rad + 2.0 * slack_rad),
        };
        let astern = |slack_rad: f64| Arc {
            centre_rad: 0.0,
            half_width_rad: PI - OVERTAKING_SECTOR_RAD + offset_rad + slack_rad,
        };
        match *self {
            Self::Any => Arc { centre_rad: 0.0, half_width_rad: PI },
            Self::Class(EncounterClass::HeadOn) => reciprocal(0.0),
            Self::Class(EncounterClass::Overtaking | EncounterClass::Overtaken) => astern(0.0),
            Self::Class(_) => Arc { centre_rad: 0.0, half_width_rad: PI },
            Self::Beside { border, within_rad, .. } => match border {
                Border::HeadOnCrossing => reciprocal(within_rad),
                Border::CrossingStbdCrossingPort => Arc { centre_rad: 0.0, half_width_rad: PI },
                Border::CrossingOvertaking | Border::CrossingOvertaken => astern(within_rad),
            },
        }
    }
}

impl Border {
    /// Signed angle from the border, radians; of the two classes in its name one has it positive.
    /// The distance to the edge of the head-on sector is the larger of the two bearings' ways to
    /// it; to meet a limit of their difference, each goes half the way.
    fn excess_rad(self, beta_rad: f64, alpha_rad: f64, head_on: HeadOnSector) -> f64 {
        match self {
            Self::HeadOnCrossing => {
                let bearings_rad = beta_rad.abs().max(alpha_rad.abs()) - head_on.half_angle_rad;
                let headings_rad = wrap(beta_rad - alpha_rad).abs() - head_on.reciprocal_rad;
                bearings_rad.max(headings_rad / 2.0)
            }
            Self::CrossingStbdCrossingPort => beta_rad,
            Self::CrossingOvertaking => alpha_rad.abs() - OVERTAKING_SECTOR_RAD,
            Self::CrossingOvertaken => beta_rad.abs() - OVERTAKING_SECTOR_RAD,
        }
    }

    /// Whether `class` is the one on this side.
    fn has_on(self, side: Side, class: EncounterClass) -> bool {
        use EncounterClass::{CrossingPort, CrossingStbd, HeadOn, Overtaken, Overtaking};
        let crossing = matches!(class, CrossingPort | CrossingStbd);
        match (self, side) {
            (Self::HeadOnCrossing, Side::First) => class == HeadOn,
            (Self::CrossingStbdCrossingPort, Side::First) => class == CrossingStbd,
            (Self::CrossingStbdCrossingPort, Side::Second) => class == CrossingPort,
            (Self::CrossingOvertaking, Side::Second) => class == Overtaking,
            (Self::CrossingOvertaken, Side::Second) => class == Overtaken,
            (Self::HeadOnCrossing, Side::Second)
            | (Self::CrossingOvertaking | Self::CrossingOvertaken, Side::First) => crossing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::offset_rad;
    use geom::units::deg;
    use geom::{Relative, Vec2, classify, unit};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// The claim of [`Wanted::course_arc`], against the bearings themselves. Courses are drawn
        /// where the bound bites; without the offset it fails.
        #[test]
        fn every_course_of_a_class_lies_in_its_arc(
            own_mps in 1f64..20.0,
            target_mps in 1f64..20.0,
            astern_rad in 1.0f64..1.7,
            reciprocal in proptest::bool::ANY,
            miss_m in -370f64..370.0,
            range_m in 379f64..600.0,
        ) {
            let course_rad = if reciprocal { PI - (astern_rad - 1.0) } else { astern_rad };
            let u = Vec2::new(own_mps, 0.0) - unit(course_rad) * target_mps;
            let ahead = u / u.norm();
            let way_m = (range_m * range_m - miss_m * miss_m).sqrt();
            let place_m = ahead * way_m + Vec2::new(-ahead.y, ahead.x) * miss_m;
            let lie = Relative::new(Vec2::zeros(), 0.0, place_m, course_rad);
            let head_on = HeadOnSector { half_angle_rad: deg(13.0), reciprocal_rad: deg(20.0) };
            let class = classify(lie.beta_rad, lie.alpha_rad, head_on);
            let mut all = vec![Wanted::Class(class)];
            for border in [
                Border::HeadOnCrossing,
                Border::CrossingStbdCrossingPort,
                Border::CrossingOvertaking,
                Border::CrossingOvertaken,
            ] {
                let within_rad = deg(3.0);
                all.push(Wanted::Beside { border, within_rad, side: Side::First });
                all.push(Wanted::Beside { border, within_rad, side: Side::Second });
            }
            for wanted in all {
                if wanted.met(class, lie.beta_rad, lie.alpha_rad, head_on) {
                    let arc = wanted.course_arc(head_on, offset_rad(miss_m, 379.0));
                    let off_rad = wrap(course_rad - arc.centre_rad).abs();
                    prop_assert!(off_rad <= arc.half_width_rad + 1e-9, "{wanted:?} {off_rad}");
                }
            }
        }
    }

    #[test]
    fn the_way_to_the_head_on_sector_is_the_larger_of_both_angles() {
        let wide = HeadOnSector::wide(deg(13.0));
        let excess = |beta_deg: f64, alpha_deg: f64| {
            Border::HeadOnCrossing.excess_rad(deg(beta_deg), deg(alpha_deg), wide)
        };
        assert!((excess(15.0, -15.0) - deg(2.0)).abs() < 1e-12);
        assert!((excess(15.0, 3.0) - deg(2.0)).abs() < 1e-12);
        assert!((excess(1.0, -12.0) - deg(-1.0)).abs() < 1e-12);
    }
}
