//! Section V.A of the paper, equations (19) to (23): which edge of the cone, and how far to it.
//!
//! The four printed cases of each class are two rules (exact, by the sine law): head-on takes the
//! right edge; everything else the right edge if B moves to own left, else the left one.

use geom::{EncounterClass, math};

/// The paper's side: -1 for the right edge (B stays to port of the relative motion), +1 for the
/// left one. (19)/(20) `alpha <= beta` and (22)/(23) `alpha >= phi` are both
/// `sin(beta - alpha) >= 0` once angles wrap. For a target at rest it follows a course that does
/// not exist; [`side`] does not.
pub fn paper_side(class: EncounterClass, alpha: f64, beta: f64) -> f64 {
    if class == EncounterClass::HeadOn || math::sin(beta - alpha) >= 0.0 { -1.0 } else { 1.0 }
}

/// [`paper_side`] with the right edge for a target at rest, where beta means nothing.
pub fn side(class: EncounterClass, alpha: f64, beta: f64) -> f64 {
    if class == EncounterClass::Static { -1.0 } else { paper_side(class, alpha, beta) }
}

/// (19) to (23) letter by letter: `gamma` is a modulus, angles are compared as they stand.
///
/// The paper has no row for a ship that is being overtaken, nor for one at rest: Rule 13's rows
/// (19)/(20) serve the former, the crossing rows (22)/(23) the latter.
pub fn dgamma_as_printed(class: EncounterClass, angles: PrintedAngles) -> f64 {
    let PrintedAngles { alpha, beta, theta, phi, mu, gamma } = angles;
    let right_edge = match class {
        EncounterClass::HeadOn => true,
        EncounterClass::Overtaking | EncounterClass::Overtaken => alpha <= beta,
        EncounterClass::CrossingStbd | EncounterClass::CrossingPort | EncounterClass::Static => {
            alpha >= phi
        }
    };
    match (right_edge, phi >= theta) {
        (true, true) => -(mu + gamma),
        (true, false) => -(mu - gamma),
        (false, true) => mu - gamma,
        (false, false) => mu + gamma,
    }
}

/// What the printed rows compare: raw angles in radians; `gamma` without sign.
#[derive(Clone, Copy, Debug)]
pub struct PrintedAngles {
    /// Own course.
    pub alpha: f64,
    /// The obstacle's course.
    pub beta: f64,
    /// Line of sight.
    pub theta: f64,
    /// Heading of dV.
    pub phi: f64,
    /// Half-angle of the cone.
    pub mu: f64,
    /// Modulus of the angle between dV and the line of sight.
    pub gamma: f64,
}

/// The sign of a change of course in words.
pub fn turn_name(dalpha: f64) -> &'static str {
    if dalpha > 0.0 {
        "port"
    } else if dalpha < 0.0 {
        "starboard"
    } else {
        "none"
    }
}
