//! The planner under test on the bridge: what it is told, and what becomes of a call that fails.

use crate::ship::Ship;
use planner_api::{FailureKind, Mission, Planner, PlannerFailure};
use record::{Encounter, Outcome, PlannerEvents, Purpose, Streams};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};

/// The planner behind its three hazards: it may panic, it may not return, it may order nonsense.
pub(crate) struct Pilot<'a> {
    pub(crate) planner: &'a mut dyn Planner,
    pub(crate) beat: &'a AtomicU64,
    pub(crate) mission: Mission,
    /// What it said of its own failure.
    pub(crate) last_words: Option<String>,
}

/// Longest last words of a planner that are kept, bytes.
const LAST_WORDS_MAX: usize = 2000;

impl Pilot<'_> {
    /// Asks it; a panic becomes the outcome that it stands for.
    pub(crate) fn call<T>(
        &mut self,
        f: impl FnOnce(&mut dyn Planner, &Mission) -> T,
    ) -> Result<T, Outcome> {
        self.beat.fetch_add(1, Ordering::Relaxed);
        let answer = catch_unwind(AssertUnwindSafe(|| f(self.planner, &self.mission)));
        self.beat.fetch_add(1, Ordering::Relaxed);
        answer.map_err(|payload| {
            let (outcome, words) = end_of_planner(payload.as_ref());
            self.last_words =
                words.map(|words| words[..words.floor_char_boundary(LAST_WORDS_MAX)].to_owned());
            outcome
        })
    }

    /// What it counted of itself.
    pub(crate) fn events(&mut self) -> PlannerEvents {
        let events = self.call(|planner, _| planner.events()).unwrap_or_default();
        PlannerEvents {
            inner_loop_cap: events.inner_loop_cap,
            limited: events.limited,
            inside_called_safe: events.inside_called_safe,
            class_changes: events.class_changes,
            receding_flagged: events.receding_flagged,
            passes: events.passes,
        }
    }
}

/// How an unwinding ends a run, and what the planner said.
fn end_of_planner(payload: &(dyn Any + Send)) -> (Outcome, Option<&str>) {
    let Some(failure) = payload.downcast_ref::<PlannerFailure>() else {
        let text = payload.downcast_ref::<String>().map(String::as_str);
        let words = text.or(payload.downcast_ref::<&str>().copied());
        return (Outcome::PlannerPanicked, words);
    };
    let outcome = match failure.kind {
        FailureKind::Hung => Outcome::PlannerHung,
        FailureKind::Crashed => Outcome::PlannerCrashed,
        FailureKind::Protocol => Outcome::PlannerProtocol,
        FailureKind::NonFinite => Outcome::PlannerNonFinite,
    };
    (outcome, Some(failure.detail.as_str()))
}

/// What the planner is told once.
pub(crate) fn mission(encounter: &Encounter, own: &Ship) -> Mission {
    let limits = own.model.limits();
    let mut stream = Streams::new(encounter.seed, &encounter.id).stream(Purpose::Planner, 0);
    Mission {
        own: planner_api::OwnShip {
            length_m: own.outline.length_m,
            beam_m: own.outline.beam_m,
            speed_mps_max: limits.speed_mps_max,
            yaw_rate_radps_max: limits.yaw_rate_radps_max,
            acceleration_mps2_max: limits.acceleration_mps2_max,
        },
        route: encounter
            .own
            .route
            .iter()
            .map(|w| planner_api::Waypoint { position_m: w.position_m, speed_mps: w.speed_mps })
            .collect(),
        cruise_mps: encounter.own.cruise_mps,
        safety_radius_m: encounter.safety_radius_m,
        between_centres: encounter.distance == record::DistanceKind::Centre,
        beat_s: encounter.run.beat_s,
        hazards: encounter.hazards.clone(),
        stream_seed: stream.next_u64(),
    }
}
