//! Makes a failing encounter small while it goes on failing the same way.
//!
//! What can be taken away goes first (hazards, targets, noise, weather, scripts), then the frame is
//! laid along own ship, then numbers are rounded, coarsely first. A change is kept when the planner
//! still does what it did, and the list is gone through until nothing more is kept: what is left is
//! what the failure needs. The order is fixed, so the same failure always gives the same file.
//!
//! The shrinking of `proptest` is not used: it makes smaller what its own strategies drew, and an
//! encounter comes from a campaign.

use campaign::Error;
use geom::{HullOutline, Vec2, angle};
use record::{Encounter, EncounterId, Intent, Seed, Sensing, Vessel, Visibility, Weather};

/// Steps that numbers are rounded to, coarsely first.
const POSITIONS_M: [f64; 6] = [1000.0, 500.0, 100.0, 50.0, 10.0, 1.0];
const HEADINGS_DEG: [f64; 5] = [90.0, 45.0, 10.0, 5.0, 1.0];
const SPEEDS_MPS: [f64; 3] = [5.0, 1.0, 0.1];
const LENGTHS_M: [f64; 4] = [50.0, 10.0, 1.0, 0.1];
const LIMITS: [f64; 3] = [1.0, 0.1, 0.01];
/// A beam is rounded to this share of the step of its length.
const BEAM_PER_LENGTH_STEP: f64 = 0.1;
/// More rounds than any encounter needed.
const ROUNDS_MAX: usize = 6;

/// Whether the planner still does what it did. An encounter that cannot be run is not asked for.
pub type StillFails<'a> = &'a mut dyn FnMut(&Encounter) -> Result<bool, Error>;

/// What is left of an encounter.
#[derive(Clone, Debug, PartialEq)]
pub struct Small {
    /// The smaller encounter.
    pub encounter: Encounter,
    /// Changes that were tried.
    pub tried: u32,
    /// Changes that were kept.
    pub kept: u32,
}

/// The smaller encounter, under the name `name`.
///
/// # Errors
/// The encounter does not fail, or asking failed.
pub fn shrink(
    encounter: &Encounter,
    name: &str,
    still_fails: StillFails<'_>,
) -> Result<Small, Error> {
    if !still_fails(encounter)? {
        return Err(Error::input(format!(
            "{} does not fail this way; there is nothing to shrink",
            encounter.id
        )));
    }
    let small = Small { encounter: encounter.clone(), tried: 0, kept: 0 };
    let mut search = Search { small, still_fails };
    for _ in 0..ROUNDS_MAX {
        let before = search.small.kept;
        search.leave_out(name)?;
        search.lay_along_own_ship()?;
        for index in 0..search.small.encounter.targets.len() {
            search.round_target(index)?;
        }
        search.round_own()?;
        if search.small.kept == before {
            break;
        }
    }
    Ok(search.small)
}

struct Search<'a> {
    small: Small,
    still_fails: StillFails<'a>,
}

impl Search<'_> {
    /// Tries a change, and keeps it if the failure stays.
    fn attempt(&mut self, change: impl Fn(&mut Encounter)) -> Result<bool, Error> {
        let mut trial = self.small.encounter.clone();
        change(&mut trial);
        if trial == self.small.encounter || sim::check(&trial).is_err() {
            return Ok(false);
        }
        self.small.tried += 1;
        let kept = (self.still_fails)(&trial)?;
        if kept {
            self.small.kept += 1;
            self.small.encounter = trial;
        }
        Ok(kept)
    }

    /// The coarsest rounding that keeps the failure.
    fn round(&mut self, steps: &[f64], change: impl Fn(&mut Encounter, f64)) -> Result<(), Error> {
        for &step in steps {
            if self.attempt(|e| change(e, step))? {
                break;
            }
        }
        Ok(())
    }

    fn leave_out(&mut self, name: &str) -> Result<(), Error> {
        for index in (0..self.small.encounter.hazards.len()).rev() {
            self.attempt(|e| drop(e.hazards.remove(index)))?;
        }
        for index in (0..self.small.encounter.targets.len()).rev() {
            if self.small.encounter.targets.len() > 1 {
                self.attempt(|e| drop(e.targets.remove(index)))?;
            }
        }
        self.attempt(|e| e.weather = Weather::default())?;
        self.attempt(|e| e.sensing = Sensing::Perfect { detection_range_m: None })?;
        self.attempt(|e| e.visibility = Visibility::InSight)?;
        for index in 0..self.small.encounter.targets.len() {
            self.attempt(|e| e.targets[index].intent = Intent::HoldCourse)?;
        }
        self.attempt(|e| {
            let goal = e.own.route.split_off(e.own.route.len() - 1);
            e.own.route = goal;
        })?;
        self.attempt(|e| e.own.route.iter_mut().for_each(|w| w.speed_mps = None))?;
        self.attempt(|e| e.own.cruise_mps = e.own.start.speed_mps)?;
        // without noise neither seed nor name changes a bit
        self.attempt(|e| {
            (e.seed, e.id) = (Seed(0), EncounterId::new(name, 0));
            (e.asked, e.weight) = (None, 1.0);
        })?;
        Ok(())
    }

    /// Own ship starts at the origin and heads north.
    fn lay_along_own_ship(&mut self) -> Result<(), Error> {
        self.attempt(|e| {
            let (origin_m, psi_rad) = (e.own.start.position_m, e.own.start.psi_rad);
            let moved = |at_m: Vec2| angle::rotate(at_m - origin_m, -psi_rad);
            for motion in std::iter::once(&mut e.own.start)
                .chain(e.targets.iter_mut().map(|target| &mut target.start))
            {
                motion.position_m = moved(motion.position_m);
                motion.psi_rad = geom::wrap(motion.psi_rad - psi_rad);
            }
            e.own.route.iter_mut().for_each(|w| w.position_m = moved(w.position_m));
            e.hazards.iter_mut().flatten().for_each(|corner_m| *corner_m = moved(*corner_m));
        })?;
        Ok(())
    }

    fn round_own(&mut self) -> Result<(), Error> {
        self.round(&SPEEDS_MPS, |e, step| {
            e.own.start.speed_mps = to(e.own.start.speed_mps, step);
            e.own.cruise_mps = to(e.own.cruise_mps, step);
        })?;
        self.round(&POSITIONS_M, |e, step| {
            e.own.route.iter_mut().for_each(|w| w.position_m = w.position_m.map(|x| to(x, step)));
        })?;
        self.round(&POSITIONS_M, |e, step| {
            e.hazards.iter_mut().flatten().for_each(|corner| *corner = corner.map(|x| to(x, step)));
        })
    }

    /// Hull, limits, speed, start and heading of one target.
    fn round_target(&mut self, index: usize) -> Result<(), Error> {
        self.round(&LENGTHS_M, |e, step| {
            let hull = &mut e.targets[index].hull;
            let beam_step = step * BEAM_PER_LENGTH_STEP;
            let length_m = to(hull.length_m, step).max(step);
            *hull = HullOutline::centred(length_m, to(hull.beam_m, beam_step).max(beam_step));
        })?;
        self.round(&LIMITS, |e, step| {
            if let Vessel::Kinematic { yaw_rate_radps_max, acceleration_mps2_max, speed_mps_max } =
                &mut e.targets[index].vessel
            {
                *speed_mps_max = up_to(*speed_mps_max, 10.0 * step);
                *yaw_rate_radps_max = up_to(*yaw_rate_radps_max, step);
                *acceleration_mps2_max = up_to(*acceleration_mps2_max, step);
            }
        })?;
        self.round(&SPEEDS_MPS, |e, step| {
            let speed_mps = &mut e.targets[index].start.speed_mps;
            *speed_mps = to(*speed_mps, step);
        })?;
        self.round(&HEADINGS_DEG, |e, step| {
            let psi_rad = &mut e.targets[index].start.psi_rad;
            *psi_rad = geom::wrap(to(psi_rad.to_degrees(), step).to_radians());
        })?;
        self.round(&POSITIONS_M, |e, step| {
            let position_m = &mut e.targets[index].start.position_m;
            *position_m = position_m.map(|x| to(x, step));
        })
    }
}

/// The multiple of `step` next to `value`, in its shortest decimal form.
fn to(value: f64, step: f64) -> f64 {
    on_grid(value, step, f64::round)
}

/// The multiple of `step` at or above `value`.
fn up_to(value: f64, step: f64) -> f64 {
    on_grid(value, step, f64::ceil)
}

fn on_grid(value: f64, step: f64, whole: impl Fn(f64) -> f64) -> f64 {
    // 3 * 0.1 is not 0.3, but 3 / 10 is; and no minus before a zero
    let rounded = if step < 1.0 {
        let parts = (1.0 / step).round();
        whole(value * parts) / parts
    } else {
        whole(value / step) * step
    };
    rounded + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::float_cmp, reason = "the shortest decimal form is the point")]
    fn rounded_numbers_have_their_shortest_form() {
        assert_eq!(to(0.299_99, 0.1), 0.3);
        assert_eq!(to(-0.04, 0.1), 0.0);
        assert!(to(-0.04, 0.1).is_sign_positive(), "no minus before a zero");
        assert_eq!(to(1449.0, 100.0), 1400.0);
        assert_eq!(up_to(0.101, 0.1), 0.2);
        assert_eq!(up_to(12.0, 1.0), 12.0);
    }
}
