//! The least that an encounter can cost: its vessels integrated by a bare loop.
//!
//! What `speed` compares the simulator with, at the same step and on the same machine; no planner,
//! no hulls, no sensing, no trace.

use crate::vessel::{Helm, Model, State};
use geom::{Vec2, unit};
use record::{Encounter, Motion};

/// Integrates own ship and the first target for the longest time that the encounter allows, each
/// holding its first course and speed. Returns where they end, `None` for a vessel that has no
/// model, or an encounter without a target.
pub fn floor(encounter: &Encounter) -> Option<[Vec2; 2]> {
    let model = Model::of(&encounter.own.vessel)?;
    let starts = [&encounter.own.start, &encounter.targets.first()?.start];
    let mut ships = starts.map(|s| State::ahead(s.position_m, s.psi_rad, s.speed_mps));
    let ahead = |s: &Motion| Helm {
        psi_rad: s.psi_rad,
        direction: unit(s.psi_rad),
        speed_mps: s.speed_mps,
    };
    let helms = starts.map(ahead);
    let run = &encounter.run;
    let beats = (run.duration_s_max / run.beat_s) as usize;
    let steps = (run.beat_s / run.step_s).round() as usize;
    for _ in 0..beats * steps {
        for (ship, helm) in ships.iter_mut().zip(&helms) {
            *ship = model.step(ship, helm, Vec2::zeros(), run.step_s);
        }
    }
    Some(ships.map(|ship| ship.position_m))
}
