//! What own ship did before risk opened, where there is no nominal track to judge it by.
//!
//! On a recorded voyage an early action can keep risk from ever opening. Then no rule applied; the
//! class and the side of the turn are told all the same, because the law leaves the choice free and
//! the judge must not lose it. Reference: rules specification, section 5 (RESOLVED_EARLY).

use crate::action::Action;
use crate::case::Case;
use crate::life::PairLife;
use crate::risk::opening_m;
use crate::ruling::Ruling;
use crate::signal::OwnSignals;
use geom::EncounterClass;
use record::{Check, DistanceKind, Status, Verdict};

/// Without a nominal track: own ship was heading into risk and acted before it opened. The class
/// at that moment, where so.
pub(crate) fn resolved_without_nominal(
    life: &PairLife<'_>,
    own: &OwnSignals,
    action: &Action,
) -> Option<EncounterClass> {
    if life.nominal.is_some() || !action.detectable() {
        return None;
    }
    let runs = [action.runs.first().map(|r| r.edge), action.speed_runs.first().map(|r| r.start)];
    let k = runs.into_iter().flatten().min()?;
    let position_m = life.actual.relative(k).0;
    let before_mps = geom::unit(action.heading_0_rad) * action.u_0_mps;
    let velocity_mps = life.actual.target.velocity_mps(k) - before_mps;
    let ahead = geom::cpa(position_m, velocity_mps).tcpa_s.is_some_and(|t| t > 0.0);
    let dcpa_m = match life.trace.distance {
        DistanceKind::Centre => geom::cpa(position_m, velocity_mps).dcpa_m,
        DistanceKind::Hull => life.actual.hull_dcpa_m(k, before_mps),
    };
    let seen = crate::risk::relative(&life.actual, k);
    let by_radar = !life.in_sight_by(k);
    let turned_rad = own.heading_rad[k] - action.heading_0_rad;
    let beta_rad = geom::wrap(seen.beta_rad + turned_rad);
    (ahead && dcpa_m < opening_m(life.rules, by_radar))
        .then(|| geom::classify(beta_rad, seen.alpha_rad, life.rules.head_on()))
}

/// The turn of a ship that resolved the encounter before risk: only the wrong side is told.
pub(crate) fn turn_before_risk(
    life: &PairLife<'_>,
    action: &Action,
    class: Option<EncounterClass>,
) -> Verdict {
    let wrong_side = action.side() < 0.0
        && matches!(class, Some(EncounterClass::HeadOn | EncounterClass::CrossingStbd));
    let status = if wrong_side { Status::Warn } else { Status::NotApplicable };
    let turn_rad = action.turn.map_or(0.0, |turn| turn.size_rad);
    Ruling::new(Check::Turn, life.target, status)
        .detail("RESOLVED_EARLY")
        .at(action.turn_seen_s)
        .radians("turn", turn_rad)
        .say(|| {
            let t_s = action.turn_seen_s.unwrap_or(0.0) as u64;
            let altered = Case::altered(turn_rad);
            let (minutes, seconds) = (t_s / 60, t_s % 60);
            format!("At {minutes:02}:{seconds:02}, before risk opened, own ship {altered}.")
        })
        .done()
}
