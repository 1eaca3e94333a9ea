//! Makes a failing encounter small while it goes on failing the same way.
//!
//! Targets are taken out one by one, then numbers are rounded, coarsely first; a step is kept when
//! the planner still does what it did. What is left is what the failure needs.

use crate::Event;
use crate::corpus;
use campaign::Error;
use campaign::plan::RulesChoice;
use planner_api::Planner;
use record::{Encounter, Seed};
use std::sync::atomic::AtomicU64;

/// Steps that numbers are rounded to, coarsely first: positions in metres, headings in degrees,
/// speeds in tenths of metres a second.
const POSITIONS_M: [f64; 3] = [100.0, 10.0, 1.0];
const HEADINGS_DEG: [f64; 3] = [10.0, 1.0, 0.1];
const SPEEDS_MPS: [f64; 3] = [1.0, 0.5, 0.1];
const LENGTHS_M: [f64; 3] = [10.0, 1.0, 0.1];

/// The smaller encounter. `make` gives a fresh planner; `kept` is what it must still do.
pub fn shrink(
    encounter: &Encounter,
    kept: &[Event],
    rules: &RulesChoice,
    make: &dyn Fn() -> Result<Box<dyn Planner>, Error>,
) -> Result<Encounter, Error> {
    let still_fails = |trial: &Encounter| -> Result<bool, Error> {
        if sim::check(trial).is_err() {
            return Ok(false);
        }
        let does = corpus::events(trial, make()?.as_mut(), rules, kept, &AtomicU64::new(0))?;
        Ok(does.len() == kept.len())
    };
    let mut small = encounter.clone();
    if !still_fails(&small)? {
        return Err(Error::input(format!(
            "{} does not fail this way; there is nothing to shrink",
            encounter.id
        )));
    }
    let mut attempt = |change: &dyn Fn(&mut Encounter)| -> Result<bool, Error> {
        let mut trial = small.clone();
        change(&mut trial);
        let better = trial != small && still_fails(&trial)?;
        if better {
            small = trial;
        }
        Ok(better)
    };
    // a corpus file holds signed numbers; without noise the seed means nothing
    attempt(&|e| e.seed = Seed(0))?;
    attempt(&|e| e.asked = None)?;
    for index in (0..encounter.targets.len()).rev() {
        attempt(&|e| {
            if e.targets.len() > 1 && index < e.targets.len() {
                e.targets.remove(index);
            }
        })?;
    }
    for index in 0..encounter.targets.len() {
        round_target(&mut attempt, index)?;
    }
    round_first(&mut attempt, &SPEEDS_MPS, &|e, step| {
        e.own.start.speed_mps = to(e.own.start.speed_mps, step);
        e.own.cruise_mps = e.own.start.speed_mps;
    })?;
    round_first(&mut attempt, &POSITIONS_M, &|e, step| {
        for waypoint in &mut e.own.route {
            waypoint.position_m = waypoint.position_m.map(|x| to(x, step));
        }
    })?;
    Ok(small)
}

/// Start, heading, speed and hull of one target, if she is still there.
fn round_target(attempt: Attempt<'_>, index: usize) -> Result<(), Error> {
    round_first(attempt, &POSITIONS_M, &|e, step| {
        if let Some(target) = e.targets.get_mut(index) {
            target.start.position_m = target.start.position_m.map(|x| to(x, step));
        }
    })?;
    round_first(attempt, &HEADINGS_DEG, &|e, step| {
        if let Some(target) = e.targets.get_mut(index) {
            target.start.psi_rad = to(target.start.psi_rad.to_degrees(), step).to_radians();
        }
    })?;
    round_first(attempt, &SPEEDS_MPS, &|e, step| {
        if let Some(target) = e.targets.get_mut(index) {
            target.start.speed_mps = to(target.start.speed_mps, step);
        }
    })?;
    round_first(attempt, &LENGTHS_M, &|e, step| {
        if let Some(target) = e.targets.get_mut(index) {
            let hull = target.hull;
            target.hull = geom::HullOutline::centred(
                to(hull.length_m, step).max(step),
                to(hull.beam_m, step / 10.0).max(step / 10.0),
            );
        }
    })?;
    Ok(())
}

/// Tries a change, and keeps it if the failure stays.
type Attempt<'a> = &'a mut dyn FnMut(&dyn Fn(&mut Encounter)) -> Result<bool, Error>;

/// The coarsest rounding that keeps the failure.
fn round_first(
    attempt: Attempt<'_>,
    steps: &[f64],
    change: &dyn Fn(&mut Encounter, f64),
) -> Result<(), Error> {
    for &step in steps {
        if attempt(&|e| change(e, step))? {
            break;
        }
    }
    Ok(())
}

fn to(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}
