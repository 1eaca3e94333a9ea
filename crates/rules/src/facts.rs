//! The facts of a pair, as tables and figures want them: onset, class, reaction.
//! Reference: rules specification, sections 1, 2 and 7.

use crate::action::Action;
use crate::case::role_of;
use crate::life::{Onset, PairLife};
use geom::EncounterClass;
use record::{PairFacts, Reaction, Role};

pub(crate) fn facts(life: &PairLife<'_>, action: &Action) -> PairFacts {
    let onset = life.onset;
    PairFacts {
        target: life.target as u8,
        risk_s: onset.map(|onset| life.time_s(onset.k)),
        class: onset.map(|onset| onset.decides),
        class_by_bearings: onset.map(|onset| onset.class),
        class_by_planner: onset.and_then(|onset| by_planner(life, &onset)),
        role: onset.map_or(Role::None, |onset| role_of(onset.decides)),
        ambiguous: onset.is_some_and(|onset| onset.ambiguous()),
        beta_rad: onset.map(|onset| onset.seen.beta_rad),
        alpha_rad: onset.map(|onset| onset.seen.alpha_rad),
        range_m: onset.map(|onset| onset.seen.range_m),
        cpa_s: life.passed.map(|passed| passed.t_s),
        stages_s: [None; 3],
        released_s: None,
        reaction: reaction(life, action.detectable_s),
        apparent: reaction(life, action.apparent_s),
        first_turn_rad: action.turn.map(|turn| turn.size_rad),
    }
}

/// When own ship did something that could be seen, from the onset of risk (section 7).
fn reaction(life: &PairLife<'_>, seen_s: Option<f64>) -> Reaction {
    let Some(onset) = life.onset else { return Reaction::NoRisk };
    let onset_s = life.time_s(onset.k);
    let clock_s = onset_s.max(life.pair().tracked_s.unwrap_or(0.0));
    match seen_s {
        Some(t_s) if t_s < onset_s => Reaction::Early,
        Some(t_s) => Reaction::After((t_s - clock_s).max(0.0)),
        None if life.passed.is_some() => Reaction::Never,
        None => Reaction::Unknown,
    }
}

/// The class at onset by the head-on sector that the planner states. Whether a ship moves is no
/// matter of the sector.
pub(crate) fn by_planner(life: &PairLife<'_>, onset: &Onset) -> Option<EncounterClass> {
    let sector = life.trace.planner_sector?;
    Some(match onset.class {
        EncounterClass::Static => EncounterClass::Static,
        _ => geom::classify(onset.seen.beta_rad, onset.seen.alpha_rad, sector),
    })
}
