//! Puts one target so that class, miss distance and time to CPA are what was asked for.
//!
//! The closest point is constructed, not searched: with own velocity relative to the target `u`
//! (speed `W`), time to CPA `T` and signed miss distance `m`, the target starts at
//! `u T + m n`, where `n` is `u` turned to starboard and made a unit. The start range is
//! `sqrt(W^2 T^2 + m^2)`, so a range of start ranges is a range of times.
//!
//! What is given before the loop is kept while the rest is drawn again until the class is right. So
//! the given variables have exactly the laws of the file and are independent of one another; the
//! drawn ones have theirs on the condition that, together with the given ones, they make the class
//! and keep the start range.
//!
//! * In a stratum of a class, own speed, the target's length, the miss distance and the place of
//!   the time to CPA in its range are given; target speed and relative course are drawn.
//! * A further target may have an arrival of her own: then her time to CPA is given, and only
//!   speeds and courses that put her within the start range at it are taken.
//! * Beside a border, own speed, the target's length and the side are given; target speed,
//!   relative course, miss distance and place of the time are drawn, because there miss distance
//!   and angle belong together: not every distance goes with a target dead ahead that crosses.

use crate::Distribution;
use crate::course::Courses;
use crate::spec::GeometrySpec;
use crate::wanted::{MOVING_MPS_MIN, Wanted};
use geom::{EncounterClass, HeadOnSector, Relative, Vec2, classify, math, unit, wrap};
use record::Stream;

/// Tries before a class counts as one that cannot be placed.
pub const TRIES_MAX: u64 = 100_000;

/// What is given before a target is placed.
#[derive(Clone, Copy, Debug)]
pub struct Given {
    /// Own speed, m/s.
    pub own_speed_mps: f64,
    /// Own heading, radians.
    pub own_psi_rad: f64,
    /// Target's length, metres.
    pub length_m: f64,
    /// What the start must be.
    pub wanted: Wanted,
    /// How the target passes; beside a border it is only where the tries begin.
    pub passing: Passing,
}

/// Where and when the target passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passing {
    /// Signed miss distance, metres.
    pub miss_m: f64,
    /// When.
    pub when: When,
}

/// When a target is closest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    /// At this place, 0 to 1, of the times that the start range allows.
    Share(f64),
    /// After so many seconds; speeds and courses are drawn until the start range allows it.
    At(f64),
}

/// Where a target starts, own reference point at the origin.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// Position, metres.
    pub position_m: Vec2,
    /// Heading, radians.
    pub psi_rad: f64,
    /// Speed, m/s.
    pub speed_mps: f64,
    /// Signed miss distance, metres.
    pub miss_m: f64,
    /// Time to CPA, seconds.
    pub tcpa_s: f64,
    /// Class at the start.
    pub class: EncounterClass,
    /// Tries that were refused before.
    pub rejected: u64,
}

/// Tries by what they failed on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Refusals {
    /// No time to CPA in its range gives a start range in its own.
    pub range: u64,
    /// The class was another one.
    pub class: u64,
}

/// The laws of what is drawn in the loop.
#[derive(Clone, Copy, Debug)]
pub struct Laws<'a> {
    /// Ranges of time and distance.
    pub geometry: &'a GeometrySpec,
    /// Head-on sector of the promise.
    pub head_on: HeadOnSector,
    /// Target speed, m/s.
    pub speed_mps: &'a Distribution,
    /// Relative course, degrees.
    pub course_deg: &'a Distribution,
}

impl Passing {
    /// Draws miss distance and place of the time.
    pub fn draw(geometry: &GeometrySpec, stream: &mut Stream) -> Self {
        Self { miss_m: geometry.miss_m.draw(stream), when: When::Share(stream.uniform()) }
    }
}

/// Draws until the target can be placed; what stood in the way if it cannot.
pub fn place(given: &Given, laws: &Laws<'_>, stream: &mut Stream) -> Result<Placed, Refusals> {
    let mut refusals = Refusals::default();
    let nearest_m = laws.geometry.range_m_min_beyond_half_length + given.length_m / 2.0;
    let beside_border = matches!(given.wanted, Wanted::Beside { .. });
    let widest_m = if beside_border {
        let (low_m, high_m) = laws.geometry.miss_m.bounds();
        low_m.abs().max(high_m.abs())
    } else {
        given.passing.miss_m
    };
    let arc = given.wanted.course_arc(laws.head_on, offset_rad(widest_m, nearest_m));
    let courses = Courses::new(laws.course_deg, arc);
    if courses.is_empty() {
        refusals.class = TRIES_MAX;
        return Err(refusals);
    }
    let mut passing = given.passing;
    let mut times = Times::new(laws.geometry, nearest_m, passing.miss_m);
    let own_mps = unit(given.own_psi_rad) * given.own_speed_mps;
    for rejected in 0..TRIES_MAX {
        if beside_border && rejected > 0 {
            passing = Passing::draw(laws.geometry, stream);
            times = Times::new(laws.geometry, nearest_m, passing.miss_m);
        }
        let speed_mps = laws.speed_mps.draw(stream);
        let psi_rad = wrap(given.own_psi_rad + courses.draw(stream));
        let relative_mps = own_mps - unit(psi_rad) * speed_mps;
        let closing_mps = relative_mps.norm();
        let Some(tcpa_s) = times.at(closing_mps, passing.when) else {
            refusals.range += 1;
            continue;
        };
        let (miss_m, target) = (passing.miss_m, (speed_mps, psi_rad));
        let (position_m, lie, class) =
            start(given.own_psi_rad, relative_mps, (miss_m, tcpa_s), target, laws.head_on);
        if given.wanted.met(class, lie.beta_rad, lie.alpha_rad, laws.head_on) {
            return Ok(Placed { position_m, psi_rad, speed_mps, miss_m, tcpa_s, class, rejected });
        }
        refusals.class += 1;
    }
    Err(refusals)
}

/// Where a target of the given speed and heading starts so that she passes as asked for, how the
/// two ships lie to one another then, and the class of that.
fn start(
    own_psi_rad: f64,
    relative_mps: Vec2,
    passing: (f64, f64),
    target: (f64, f64),
    head_on: HeadOnSector,
) -> (Vec2, Relative, EncounterClass) {
    let ((miss_m, tcpa_s), (speed_mps, psi_rad)) = (passing, target);
    let starboard = Vec2::new(-relative_mps.y, relative_mps.x) / relative_mps.norm();
    let position_m = relative_mps * tcpa_s + starboard * miss_m;
    let lie = Relative::new(Vec2::zeros(), own_psi_rad, position_m, psi_rad);
    let class = if speed_mps < MOVING_MPS_MIN {
        EncounterClass::Static
    } else {
        classify(lie.beta_rad, lie.alpha_rad, head_on)
    };
    (position_m, lie, class)
}

/// Largest angle between the relative velocity and the line of sight at the start.
pub(crate) fn offset_rad(miss_m: f64, nearest_m: f64) -> f64 {
    let sine = miss_m.abs() / nearest_m;
    if sine < 1.0 { math::asin(sine) } else { std::f64::consts::PI }
}

/// Places a target of a stratum without a class, whose speed and course are known already.
///
/// # Errors
/// No time to CPA in its range gives a start range in its own.
pub fn place_at(
    given: &Given,
    laws: &Laws<'_>,
    speed_mps: f64,
    psi_rad: f64,
    rejected: u64,
) -> Result<Placed, Refusals> {
    let nearest_m = laws.geometry.range_m_min_beyond_half_length + given.length_m / 2.0;
    let Passing { miss_m, when } = given.passing;
    let relative_mps = unit(given.own_psi_rad) * given.own_speed_mps - unit(psi_rad) * speed_mps;
    let tcpa_s = Times::new(laws.geometry, nearest_m, miss_m)
        .at(relative_mps.norm(), when)
        .ok_or(Refusals { range: 1, class: 0 })?;
    let (target, passing) = ((speed_mps, psi_rad), (miss_m, tcpa_s));
    let (position_m, _, class) =
        start(given.own_psi_rad, relative_mps, passing, target, laws.head_on);
    Ok(Placed { position_m, psi_rad, speed_mps, miss_m, tcpa_s, class, rejected })
}

/// The times to CPA that range and time limits allow, as a function of the relative speed.
struct Times {
    tcpa_s: [f64; 2],
    /// Way to the closest point along the relative motion, metres: from and to.
    way_m: [f64; 2],
}

impl Times {
    fn new(geometry: &GeometrySpec, nearest_m: f64, miss_m: f64) -> Self {
        let way_m = |range_m: f64| (range_m * range_m - miss_m * miss_m).max(0.0).sqrt();
        Self { tcpa_s: geometry.tcpa_s, way_m: [way_m(nearest_m), way_m(geometry.range_m_max)] }
    }

    /// The time at a place of what is allowed, or as asked for; `None` where that is not allowed.
    fn at(&self, closing_mps: f64, when: When) -> Option<f64> {
        match when {
            When::Share(share) => {
                let from_s = self.tcpa_s[0].max(self.way_m[0] / closing_mps);
                let to_s = self.tcpa_s[1].min(self.way_m[1] / closing_mps);
                (from_s < to_s).then_some(from_s + share * (to_s - from_s))
            }
            When::At(tcpa_s) => {
                let way_m = closing_mps * tcpa_s;
                (self.way_m[0] <= way_m && way_m <= self.way_m[1]).then_some(tcpa_s)
            }
        }
    }
}
