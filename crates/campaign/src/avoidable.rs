//! Whether anybody could have avoided the contact in which a run ended.
//!
//! A run is *unavoidable* when no manoeuvre of own ship clears all targets and all hazards (no hull
//! is touched), the other ships and the weather being as they are: none of the grid of the rules
//! specification, section 10, nor keeping course and speed, begun at any beat from the first at
//! which she could act until the contact. She can act from the first track of the target that she
//! hit, or from the start where she ran aground or her planner failed: land is told at the start.
//! Up to that beat the run is what it was, so a planner's own way into the trap counts.
//!
//! A run that ended without a contact was avoidable: it was avoided. The answer is an estimate: the
//! grid has no small alteration and no return to the route, and a planner sees less than the grid
//! knows. Each question is a run of its own, but only a contact asks it, and the first manoeuvre of
//! the first beat answers most.

use record::{Contact, ContactWith, Encounter, Outcome, Trace};
use sim::{Evasions, MakePeer, Manoeuvre, Scratch};
use std::sync::atomic::AtomicU64;

/// Whether the run was unavoidable; `None` where nothing is known of it (no valid encounter, or a
/// planner that took its answer with it). `beat` tells the watchdog that it goes on.
pub fn unavoidable(
    encounter: &Encounter,
    trace: &Trace,
    peers: &mut MakePeer<'_>,
    (scratch, beat): (&mut Scratch, &AtomicU64),
) -> Option<bool> {
    let from = match trace.outcome {
        Outcome::Completed | Outcome::Truncated => return Some(false),
        Outcome::Collision | Outcome::Grounding => first_beat(trace, trace.contact.as_ref()),
        Outcome::PlannerNonFinite | Outcome::PlannerOutOfRange => Some(0),
        Outcome::PlannerPanicked
        | Outcome::PlannerHung
        | Outcome::PlannerCrashed
        | Outcome::PlannerProtocol
        | Outcome::Invalid => return None,
    };
    let evasions = Evasions::new(encounter, &trace.orders);
    // never tracked, there was no beat at which she could have known
    let beats = from.map_or(0..0, |from| from..trace.orders.len() + 1);
    let manoeuvres = || std::iter::once(None).chain(Manoeuvre::ALL.into_iter().map(Some));
    let cleared = beats
        .flat_map(|from| manoeuvres().map(move |one| (from, one)))
        .any(|(from, manoeuvre)| evasions.clears(from, manoeuvre, peers, (&mut *scratch, beat)));
    Some(!cleared)
}

/// The first beat at which own ship could act; absent where she never had a track of the target.
fn first_beat(trace: &Trace, contact: Option<&Contact>) -> Option<usize> {
    match contact.map(|contact| contact.with) {
        Some(ContactWith::Target(target)) => {
            let tracked_s = trace.pairs[usize::from(target)].tracked_s?;
            Some((tracked_s / trace.sample_s).round() as usize)
        }
        Some(ContactWith::Hazard(_)) | None => Some(0),
    }
}
