//! Risk of collision (Rule 7), the class of an encounter (Rules 13 to 15) and its release.
//!
//! Rules specification, sections 1 to 3. Each condition that must last is a stretch of samples
//! whose first sample counts: `always[0, hold] condition` in the words of section 12.

use crate::params::{Params, StageClock};
use crate::runs::smoothed;
use crate::signals::{ABAFT_THE_BEAM_RAD, PairSignals};
use record::{EncounterClass, ShipTrack};
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

/// Samples at which risk is open, as half-open ranges. `forced` opens it at that sample at the
/// latest: the onset on the nominal track binds whatever own ship has done since. `within_m` is the
/// predicted distance that opens it.
pub fn risk_open(
    pair: &PairSignals<'_>,
    params: &Params,
    within_m: f64,
    sample_s: f64,
    forced: Option<usize>,
) -> Vec<Range<usize>> {
    risk_open_anew(None, pair, params, within_m, sample_s, forced)
}

/// The same for those who look anew at sample `seen`: what would not open then, is not open.
pub fn risk_open_anew(
    seen: Option<usize>,
    pair: &PairSignals<'_>,
    params: &Params,
    within_m: f64,
    sample_s: f64,
    forced: Option<usize>,
) -> Vec<Range<usize>> {
    let samples = pair.samples();
    let hold = samples_of(params.risk_hold_s, sample_s);
    let unsteady = [pair.own, pair.target].map(|ship| unsteady(ship, samples, params, sample_s));
    let steady = |k: usize| unsteady.iter().all(|ship| !ship.get(k).is_some_and(|turns| *turns));
    let mut open: Vec<Range<usize>> = Vec::new();
    let mut from: Option<usize> = None;
    let mut streak = 0;
    for k in 0..samples {
        if seen == Some(k) && steady(k) && !opens(pair, params, within_m, k) {
            from = None;
            streak = 0;
        }
        if forced == Some(k) && from.is_none() {
            from = Some(k);
            streak = 0;
        }
        let wanted = steady(k)
            && if from.is_some() {
                closes(pair, params, within_m, k)
            } else {
                opens(pair, params, within_m, k)
            };
        streak = if wanted { streak + 1 } else { 0 };
        if streak <= hold {
            continue;
        }
        let first = k - hold;
        match from.take() {
            // A stretch that began before risk was forced open does not close it earlier.
            Some(begin) => open.push(begin..first.max(begin)),
            None => from = Some(first),
        }
        streak = 0;
    }
    if let Some(begin) = from {
        open.push(begin..samples);
    }
    open
}

/// Where a ship manoeuvres: a seaway or a restless helm yaws her faster than that all the time, so
/// that the rate is smoothed as it is for the runs. Empty where she never does.
fn unsteady(ship: &ShipTrack, samples: usize, params: &Params, sample_s: f64) -> Vec<bool> {
    // a track that goes on alone says nothing of the pair
    let rates = &ship.yaw_rate_radps[..samples];
    let turns = |rate: &f64| rate.abs() > params.manoeuvring_yaw_rate_radps;
    if !rates.iter().any(turns) {
        return Vec::new();
    }
    let smooth = smoothed(rates, params.run.smoothing_s, sample_s);
    smooth.iter().map(turns).collect()
}

fn opens(pair: &PairSignals<'_>, params: &Params, within_m: f64, k: usize) -> bool {
    let tcpa_s = pair.tcpa_s[k];
    tcpa_s > 0.0
        && tcpa_s <= params.risk_tcpa_s
        && inside_stage_2(pair, params, k)
        && pair.predicted_within(k, within_m)
}

fn closes(pair: &PairSignals<'_>, params: &Params, within_m: f64, k: usize) -> bool {
    let receding = pair.tcpa_s[k] < 0.0 && pair.range_rate_mps[k] > 0.0;
    receding || !pair.predicted_within(k, params.risk_close_factor * within_m)
}

/// Before the class is locked, the limit is that of the role the ships would have now.
fn inside_stage_2(pair: &PairSignals<'_>, params: &Params, k: usize) -> bool {
    let range_m = pair.range_m[k];
    range_m < params.stage_range_m[0]
        || (range_m < -pair.range_rate_mps[k] * params.stage_time_s[0]
            && (params.stage_clock == StageClock::Time || pair.overtaking_geometry(k)))
}

/// Range at which a stage begins, metres (section 3): `stage` 0, 1 and 2 for stages 2, 3 and 4.
pub fn stage_limit_m(params: &Params, stage: usize, range_rate_mps: f64, by_time: bool) -> f64 {
    if !by_time {
        return params.stage_range_m[stage];
    }
    let floor_m = match stage {
        0 => params.stage_range_m[0],
        1 => 2.0 * params.preferred_m,
        _ => params.preferred_m,
    };
    floor_m.max((-range_rate_mps).max(0.0) * params.stage_time_s[stage])
}

/// The class of two moving ships that close, by direction alone (section 2).
pub fn class_by_direction(beta_rad: f64, alpha_rad: f64, params: &Params) -> EncounterClass {
    let ahead = params.head_on_half_angle_rad;
    match (beta_rad, alpha_rad) {
        (_, alpha) if alpha.abs() > ABAFT_THE_BEAM_RAD => EncounterClass::Overtaking,
        (beta, _) if beta.abs() > ABAFT_THE_BEAM_RAD => EncounterClass::Overtaken,
        // Both bearings are small here, so their difference needs no wrapping.
        (beta, alpha)
            if beta.abs() <= ahead
                && alpha.abs() <= ahead
                && (beta - alpha).abs() <= params.head_on_reciprocal_rad =>
        {
            EncounterClass::HeadOn
        }
        (beta, _) if beta < 0.0 => EncounterClass::CrossingPort,
        _ => EncounterClass::CrossingStbd,
    }
}

/// The class whose role decides: that of the directions, unless within the band of doubt
/// Rules 13(c) and 14(c), or a bearing close to the bow, prefer another (section 2, AMBIGUOUS).
pub fn class_that_decides(beta_rad: f64, alpha_rad: f64, params: &Params) -> EncounterClass {
    let plain = class_by_direction(beta_rad, alpha_rad, params);
    let doubt = [-params.doubt_rad, 0.0, params.doubt_rad];
    let reachable = |wanted: EncounterClass| {
        doubt.iter().any(|db| {
            doubt
                .iter()
                .any(|da| class_by_direction(beta_rad + db, alpha_rad + da, params) == wanted)
        })
    };
    let crossing = matches!(plain, EncounterClass::CrossingStbd | EncounterClass::CrossingPort);
    if crossing && reachable(EncounterClass::Overtaking) {
        EncounterClass::Overtaking
    } else if crossing && reachable(EncounterClass::HeadOn) {
        EncounterClass::HeadOn
    } else if plain == EncounterClass::CrossingPort && beta_rad.abs() <= params.doubt_rad {
        EncounterClass::CrossingStbd
    } else {
        plain
    }
}

/// The first sample, at or after `from`, of the stretch in which the ships are finally past and
/// clear (section 2). `distance_m` is the campaign's kind of distance.
pub fn released(
    pair: &PairSignals<'_>,
    class: EncounterClass,
    params: &Params,
    sample_s: f64,
    from: usize,
    distance_m: &[f64],
) -> Option<usize> {
    let hold = samples_of(params.release_hold_s, sample_s);
    let mut streak = 0;
    for (k, distance_m) in distance_m.iter().enumerate().skip(from) {
        let clear = pair.tcpa_s[k] < 0.0
            && pair.range_rate_mps[k] > 0.0
            && *distance_m > params.preferred_m
            && (pair.range_m[k] > params.release_range_factor * params.stage_range_m[0]
                || past(pair, class, params, k));
        streak = if clear { streak + 1 } else { 0 };
        if streak > hold {
            return Some(k - hold);
        }
    }
    None
}

fn past(pair: &PairSignals<'_>, class: EncounterClass, params: &Params, k: usize) -> bool {
    match class {
        EncounterClass::Overtaking => pair.alpha_rad(k).abs() < params.release_overtaking_rad,
        EncounterClass::Overtaken => pair.beta_rad(k).abs() < params.release_overtaking_rad,
        // A ship that does not move has no bow to pass: abaft own beam is past.
        EncounterClass::Static => pair.beta_rad(k).abs() > FRAC_PI_2,
        EncounterClass::HeadOn | EncounterClass::CrossingStbd | EncounterClass::CrossingPort => {
            pair.beta_rad(k).abs() > params.release_abaft_rad
                || pair.alpha_rad(k).abs() > params.release_abaft_rad
        }
    }
}

/// The number of sample intervals that cover `seconds`.
pub fn samples_of(seconds: f64, sample_s: f64) -> usize {
    let intervals = (seconds / sample_s - 1e-9).ceil();
    if intervals > 0.0 { intervals as usize } else { 0 }
}
