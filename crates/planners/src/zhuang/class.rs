//! The encounter sectors that stand in for the paper's missing Fig. 1 (Rules 13 to 15).
//!
//! Not `geom::classify`: the seed planner's head-on sector bounds the bearing of B and the
//! departure from reciprocal courses, and leaves the contact angle free up to the sum of both.

use geom::{EncounterClass, class::OVERTAKING_SECTOR_RAD, wrap};
use std::f64::consts::PI;

/// A target below this speed is not moving; the judge's own number.
pub const STATIC_SPEED_MPS: f64 = 0.2;

/// Room for the rounding of wrapped differences, so that a target exactly on the border of the
/// head-on sector is inside it: Rule 14(c) resolves doubt that way.
const EDGE_RAD: f64 = 1e-12;

/// The class of a pair on courses `alpha` and `beta`, B on the line of sight `theta` at speed
/// `v_b` in m/s, with the head-on half-angle `h`; all angles counter-clockwise, in radians.
/// Whether the two close is for the caller to say.
pub fn sector(alpha: f64, v_b: f64, beta: f64, theta: f64, h: f64) -> EncounterClass {
    let own_rb = wrap(theta - alpha);
    let tgt_rb = wrap(theta + PI - beta);
    let departure = wrap(beta - alpha - PI);
    if v_b < STATIC_SPEED_MPS {
        EncounterClass::Static
    } else if tgt_rb.abs() > OVERTAKING_SECTOR_RAD {
        EncounterClass::Overtaking
    } else if own_rb.abs() > OVERTAKING_SECTOR_RAD {
        EncounterClass::Overtaken
    } else if own_rb.abs() <= h + EDGE_RAD && departure.abs() <= h + EDGE_RAD {
        EncounterClass::HeadOn
    } else if own_rb > 0.0 {
        EncounterClass::CrossingPort
    } else {
        EncounterClass::CrossingStbd
    }
}
