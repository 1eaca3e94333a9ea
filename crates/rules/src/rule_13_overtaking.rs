//! Rule 13: overtaking. Own ship overtakes.
//!
//! Rule 13(a): "any vessel overtaking any other shall keep out of the way of the vessel being
//! overtaken"; 13(d): "Any subsequent alteration of the bearing ... shall not ... relieve her of
//! the duty of keeping clear of the overtaken vessel until she is finally past and clear."
//! Reading: either side is allowed. 13(a) fails with the passing distance. 13(d) fails when,
//! before release, own ship crosses the other's centre line close ahead of her bow, comes close on
//! her bow while the range falls (which fails 13(a) too, and says more), turns towards her line
//! from forward of the sector of 13(b) so that a close pass is predicted that would have been a
//! wider one, or forces the other to alter: she then leaves her own nominal track by 10 degrees or
//! a quarter of her speed, which only a target that minds own ship can do, and own ship was to pass
//! closer than the least distance when she began. Where there was room she altered of her own will.
//! With several targets it counts where no other ship was nearer to her. Drawing ahead on a steady
//! course is no breach. A run that ends before release cannot show that 13(d) was kept.
//! Source: rules specification, section 8; score after Hagen 2023, equations 25 and 26.

use crate::case::Case;
use crate::crossing_ahead::{Line, crossed_ahead};
use crate::ruling::{Ruling, not_applicable};
use crate::{safe, score};
use geom::class::OVERTAKING_SECTOR_RAD;
use geom::units::deg;
use geom::{EncounterClass, angle, math};
use record::{Check, ShipTrack, Status, Verdict};

/// "Closer than r_min with |alpha| below this while the range falls" (section 8).
const ON_THE_BOW_RAD: f64 = deg(45.0);

struct Breach {
    detail: &'static str,
    t_s: f64,
    what: String,
    margin_m: f64,
}

pub(crate) fn check(case: &Case<'_>) -> Verdict {
    if case.class != EncounterClass::Overtaking || case.restricted {
        return not_applicable(case, Check::R13);
    }
    let until = case.released_s.map_or(case.life.actual.len() - 1, |t_s| case.life.sample(t_s));
    let from = case.onset.k.min(until);
    let breach = comes_close_on_her_bow(case, from, until)
        .or_else(|| keeps_out_of_the_way(case))
        .or_else(|| crosses_ahead(case, from, until))
        .or_else(|| turns_in(case, until))
        .or_else(|| forces_her(case, from, until));
    let (status, detail) = match &breach {
        Some(breach) => (Status::Fail, breach.detail),
        None if case.released_s.is_none() => (Status::Inconclusive, "NOT-RELEASED"),
        None => (Status::Pass, ""),
    };
    let clear_m = case.life.distance_m() - case.rules().distance.r_min_m;
    let margin_m = breach.as_ref().map_or(clear_m, |breach| breach.margin_m);
    Ruling::new(Check::R13, case.life.target, status)
        .detail(detail)
        .margin(margin_m)
        .score(score::overtaking(case))
        .at(breach.as_ref().map(|breach| breach.t_s).or(case.released_s))
        .metres("d", case.life.distance_m())
        .seconds("released", case.released_s)
        .say(|| match &breach {
            Some(breach) => format!("{}, {}. Rule 13.", case.when(breach.t_s), breach.what),
            None => String::new(),
        })
        .done()
}

/// 13(a).
fn keeps_out_of_the_way(case: &Case<'_>) -> Option<Breach> {
    let (distance_m, t_s) = case.life.pair().minimum.of(case.life.trace.distance);
    (safe::level(case.life).0 == Status::Fail).then(|| Breach {
        detail: "FAIL-13A",
        t_s,
        what: format!("own ship, overtaking, passed at {distance_m:.0} m"),
        margin_m: distance_m - case.rules().distance.r_min_m,
    })
}

/// 13(d): the closest that she came there, of the samples before release.
fn comes_close_on_her_bow(case: &Case<'_>, from: usize, until: usize) -> Option<Breach> {
    let life = case.life;
    let least_m = case.rules().distance.r_min_m;
    let k = (from..=until)
        .filter(|&k| life.distance_at_m(k) < least_m && life.actual.closing(k))
        .filter(|&k| cos_alpha(case, k) > math::cos(ON_THE_BOW_RAD))
        .min_by(|&a, &b| life.distance_at_m(a).total_cmp(&life.distance_at_m(b)))?;
    let distance_m = life.distance_at_m(k);
    Some(Breach {
        detail: "FAIL-13D-BOW",
        t_s: life.time_s(k),
        what: format!("own ship, overtaking, closed to {distance_m:.0} m on her bow"),
        margin_m: distance_m - least_m,
    })
}

/// 13(d): across her bow.
fn crosses_ahead(case: &Case<'_>, from: usize, until: usize) -> Option<Breach> {
    let crossing = crossed_ahead(case, Line::Centreline, from, until)?;
    let ahead_m = crossing.ahead_m;
    Some(Breach {
        detail: "FAIL-13D-AHEAD",
        t_s: crossing.t_s,
        what: format!("own ship, overtaking, crossed {ahead_m:.0} m ahead of her bow"),
        margin_m: ahead_m - case.rules().distance.r_pref_m,
    })
}

/// 13(d): a substantial turn towards the other's line, from forward of the overtaking sector, by
/// which a pass becomes close or closer. It is sought to release, past the window of action.
fn turns_in(case: &Case<'_>, until: usize) -> Option<Breach> {
    let life = case.life;
    let d = &case.rules().distance;
    let last = life.actual.len() - 1;
    let towards = case.later_turns.iter().find(|run| {
        let seen = crate::risk::relative(&life.actual, run.start.min(last));
        run.start >= case.onset.k
            && run.start <= until
            && run.size_rad.abs() >= case.rules().manoeuvre.substantial_turn_rad
            && seen.alpha_rad.abs() < OVERTAKING_SECTOR_RAD
            && run.size_rad * seen.alpha_rad < 0.0
            && life.actual.tcpa_s(run.end).is_some_and(|t| t > 0.0)
            && life.actual.dcpa_below(run.end, d.r_min_m)
            && life.actual.dcpa_m(run.end) < life.actual.dcpa_m(run.start.min(last))
    })?;
    let dcpa_m = life.actual.dcpa_m(towards.end);
    let altered = Case::altered(towards.size_rad);
    Some(Breach {
        detail: "FAIL-13D-TURN",
        t_s: life.time_s(towards.start),
        what: format!("own ship, not yet past and clear, {altered}, to pass at {dcpa_m:.0} m"),
        margin_m: dcpa_m - d.r_min_m,
    })
}

/// 13(d): the other was forced to alter. The first held departure from her nominal track for which
/// there was no room.
fn forces_her(case: &Case<'_>, from: usize, until: usize) -> Option<Breach> {
    let life = case.life;
    let m = &case.rules().manoeuvre;
    let (target, planned) = (life.actual.target, life.nominal?.target);
    let last = until.min(planned.len() - 1);
    let off_by = |k: usize, turn_rad: f64, speed_fraction: f64| {
        let turned_rad = geom::wrap(target.psi_rad[k] - planned.psi_rad[k]);
        let speed_mps = planned.sog_mps(k);
        let faster_mps = (target.sog_mps(k) - speed_mps).abs();
        turned_rad.abs() >= turn_rad || faster_mps > 0.0 && faster_mps >= speed_fraction * speed_mps
    };
    let off = |k: usize| off_by(k, m.substantial_turn_rad, m.substantial_speed_fraction);
    let on_her_plan = |k: &usize| !off_by(*k, m.detectable_turn_rad, m.detectable_speed_fraction);
    let held = (m.offset_held_s / life.trace.sample_s).ceil() as usize;
    let own_range_m = |k: usize| (life.actual.own.position_m(k) - target.position_m(k)).norm();
    let another_is_nearer = |k: usize| {
        let range_m = |ship: &ShipTrack| (ship.position_m(k) - target.position_m(k)).norm();
        let ships = life.trace.targets.iter().enumerate();
        ships.filter(|(i, _)| *i != life.target).any(|(_, ship)| range_m(ship) < own_range_m(k))
    };
    let had_room = |k: usize| !life.actual.dcpa_below(k, case.rules().distance.r_min_m);
    // off before there was risk, or by another, or with room: not by own ship
    let k = (from..(last + 1).saturating_sub(held))
        .filter(|&k| k == 0 || !off(k - 1))
        .filter(|&k| (k..=k + held).all(off))
        .filter(|&k| !(0..k).rev().find(on_her_plan).is_some_and(had_room))
        .find(|&k| !another_is_nearer(k))?;
    let own_m = own_range_m(k);
    Some(Breach {
        detail: "FAIL-13D-FORCED",
        t_s: life.time_s(k),
        what: format!("own ship, overtaking, came to {own_m:.0} m and the other had to alter"),
        margin_m: -case.rules().distance.r_min_m,
    })
}

fn cos_alpha(case: &Case<'_>, k: usize) -> f64 {
    let to_own = -case.life.actual.relative(k).0;
    angle::unit(case.life.actual.target.psi_rad[k]).dot(&to_own) / to_own.norm().max(1e-9)
}
