//! The life of a pair's encounter: onset, class, clock and stages (rules specification, 1 to 3).
//!
//! Onset and class come from the nominal track where the trace has one, so that they are the same
//! for every planner; everything after the onset is read from what own ship did.

use crate::params::{Params, StageClock};
use crate::risk::{
    class_by_direction, class_that_decides, released, risk_open, risk_open_anew, samples_of,
    stage_limit_m,
};
use crate::signals::PairSignals;
use record::{DistanceKind, EncounterClass, LastInstant, ShipTrack, Trace, Visibility};
use std::ops::Range;

/// One pair from the start to the end of the run.
#[derive(Clone, Debug)]
pub struct Life<'a> {
    /// What happened.
    pub actual: PairSignals<'a>,
    /// Last sample that is not after the closest point of the run.
    pub cpa: usize,
    /// Whether the run went past it.
    pub cpa_passed: bool,
    /// Risk intervals that an alteration can answer, in samples.
    pub attention: Vec<Range<usize>>,
    /// What Rule 19 asks for, while the ships do not see one another.
    pub by_radar: Option<Duty>,
    /// What Rules 13 to 17 ask for, in sight of one another.
    pub in_sight: Option<Duty>,
}

/// What own ship owes, from the onset of risk to the closest point.
#[derive(Clone, Debug)]
pub struct Duty {
    /// The class, locked at the onset.
    pub class: EncounterClass,
    /// First sample of the window of action.
    pub begin: usize,
    /// Onset of risk.
    pub onset: usize,
    /// Last sample of the clock.
    pub end: usize,
    /// Whether the clock ran out within the run.
    pub complete: bool,
    /// Risk as it was on the actual track, forced open at the onset.
    pub open: Vec<Range<usize>>,
    /// Risk never opened on the actual track: own ship had settled it before.
    pub never_opened: bool,
    /// Entries of stages 2, 3 and 4.
    pub stages: [Option<usize>; 3],
    /// `t_17a`: from here a stand-on ship may act.
    pub may_act: Option<usize>,
    /// `t_17b`: from here a stand-on ship shall act.
    pub shall_act: Option<usize>,
    /// Own ship lay stopped at the onset.
    pub own_stopped: bool,
    /// Course and speed at this sample are the reference, whatever was done before.
    pub reference: Option<usize>,
}

impl Duty {
    /// Whether own ship gives way: Rule 13 as the overtaker, Rules 14 and 15.
    pub const fn gives_way(&self) -> bool {
        matches!(
            self.class,
            EncounterClass::Overtaking | EncounterClass::HeadOn | EncounterClass::CrossingStbd
        )
    }

    /// Whether own ship stands on.
    pub const fn stands_on(&self) -> bool {
        matches!(self.class, EncounterClass::Overtaken | EncounterClass::CrossingPort)
    }
}

/// The lives of all pairs.
pub fn lives<'a>(trace: &'a Trace, params: &Params) -> Vec<Life<'a>> {
    (0..trace.targets.len()).map(|target| life(trace, target, params)).collect()
}

fn life<'a>(trace: &'a Trace, target: usize, params: &Params) -> Life<'a> {
    let sample_s = trace.sample_s;
    let actual = PairSignals::new(&trace.own, &trace.targets[target], trace.distance);
    let nominal = trace.nominal.as_ref().and_then(|n| Some((&n.own, n.targets.get(target)?)));
    let (cpa, cpa_passed) = closest(trace, target, &actual);
    let own_risk = risk_open(&actual, params, params.risk_distance_m, sample_s, None);
    let (own, other) = nominal.unwrap_or((&trace.own, &trace.targets[target]));
    let judged = nominal.map(|(own, other)| PairSignals::new(own, other, trace.distance));
    let judged = judged.as_ref().unwrap_or(&actual);
    let open_within = |within_m: f64| risk_open(judged, params, within_m, sample_s, None);
    let seen = sighted(trace.visibility, &actual);
    // what a radar alone shows to come closer than close quarters binds too, until she is seen
    let close_m = params.risk_distance_m.max(params.close_quarters_m);
    let by_radar = (seen != Some(0))
        .then(|| open_within(close_m))
        .filter(|open| open.first().is_some_and(|o| seen.is_none_or(|k| k > o.start)));
    let attention = by_radar.unwrap_or_else(|| open_within(params.risk_distance_m));
    let first = attention.first().map(|o| (o.start, at_onset(judged, own, other, params, o.start)));
    let mut life = Life { actual, cpa, cpa_passed, attention, by_radar: None, in_sight: None };
    // a run begins after its first sample: one begun in the second of detection is her action
    let tracked = trace.pairs[target].tracked_s.map_or(0, |t| (t / sample_s) as usize);
    let first = first.filter(|(onset, _)| *onset <= cpa);
    if let Some((onset, start)) = first {
        let clock = Clock {
            onset,
            begin: tracked.min(cpa),
            end: cpa,
            complete: cpa_passed,
            never_opened: own_risk.iter().all(|open| open.start > cpa),
            reference: None,
        };
        match seen {
            Some(k) if k <= onset => {
                life.in_sight =
                    Some(duty(trace, target, &life.actual, (start, true), clock, params));
            }
            _ => {
                let end = seen.map_or(cpa, |k| k.min(cpa));
                let complete = cpa_passed || seen.is_some();
                let clock = Clock { end, complete, ..clock };
                life.by_radar =
                    Some(duty(trace, target, &life.actual, (start, false), clock, params));
            }
        }
    }
    if life.by_radar.is_some()
        && let Some(k) = seen.filter(|k| *k <= cpa)
    {
        life.in_sight = on_coming_in_sight(trace, target, &life, k, params);
    }
    life
}

/// What the onset itself decides.
#[derive(Clone, Copy, Debug)]
struct AtOnset {
    class: EncounterClass,
    own_stopped: bool,
}

#[derive(Clone, Copy, Debug)]
struct Clock {
    onset: usize,
    begin: usize,
    end: usize,
    complete: bool,
    never_opened: bool,
    reference: Option<usize>,
}

fn at_onset(
    pair: &PairSignals<'_>,
    own: &ShipTrack,
    target: &ShipTrack,
    params: &Params,
    k: usize,
) -> AtOnset {
    let speed = |track: &ShipTrack| {
        let (north, east) = (track.vel_north_mps[k], track.vel_east_mps[k]);
        (north * north + east * east).sqrt()
    };
    let class = if speed(target) < params.stopped_mps {
        EncounterClass::Static
    } else {
        class_that_decides(pair.beta_rad(k), pair.alpha_rad(k), params)
    };
    AtOnset { class, own_stopped: speed(own) < params.stopped_mps }
}

/// The closest point of the run: its last sample, and whether the run went past it. It did where
/// contact ended it, or where the prediction at the last sample does not undercut it. A run that is
/// still to come closer has its clock run on to its end.
fn closest(trace: &Trace, target: usize, actual: &PairSignals<'_>) -> (usize, bool) {
    let last = actual.samples() - 1;
    let minimum = &trace.pairs[target].minimum;
    let (least_m, at_s) = minimum.of(trace.distance);
    let cpa = ((at_s / trace.sample_s + 1e-9).floor().max(0.0) as usize).min(last);
    let touched = trace.contact.is_some_and(|contact| {
        contact.with == record::ContactWith::Target(u8::try_from(target).unwrap_or(u8::MAX))
    });
    let receding = actual.range_rate_mps[last] >= 0.0;
    let passed = touched || receding || actual.predicted_m(last) >= least_m;
    (if passed { cpa } else { last }, passed)
}

fn duty(
    trace: &Trace,
    target: usize,
    actual: &PairSignals<'_>,
    (start, in_sight): (AtOnset, bool),
    clock: Clock,
    params: &Params,
) -> Duty {
    let Clock { onset, begin, mut end, mut complete, never_opened, reference } = clock;
    if in_sight && let Some(k) = released_at(trace, target, actual, start.class, onset, params) {
        // the ships came closest in a later meeting, which is another encounter
        (end, complete) = (end.min(k), true);
    }
    let open = risk_open(actual, params, params.risk_distance_m, trace.sample_s, Some(onset));
    let by_time = params.stage_clock == StageClock::Time
        || matches!(start.class, EncounterClass::Overtaking | EncounterClass::Overtaken);
    let stages = [0, 1, 2].map(|stage| {
        (onset..=end).find(|k| {
            let rate = actual.range_rate_mps[*k];
            actual.range_m[*k] <= stage_limit_m(params, stage, rate, by_time)
                && (rate < 0.0 || *k == onset)
        })
    });
    let hold = samples_of(params.may_act_hold_s, trace.sample_s);
    let unanswered = |k: usize| {
        open.iter().any(|o| o.contains(&k)) && actual.predicted_within(k, params.minimum_m)
    };
    let stands_on = matches!(start.class, EncounterClass::Overtaken | EncounterClass::CrossingPort);
    let may_act = stages[1].filter(|_| stands_on).and_then(|stage_3| {
        let mut streak = 0;
        // The seconds before stage 3 count: what she has seen then she has seen.
        (stage_3.saturating_sub(hold).max(onset)..=end).find(|k| {
            streak = if unanswered(*k) { streak + 1 } else { 0 };
            *k >= stage_3 && streak > hold
        })
    });
    let alone =
        trace.last_minute.as_ref().and_then(|all| all.get(target)?.as_ref()).and_then(|last| {
            match last.target {
                LastInstant::At(t) | LastInstant::Indicative(t) => {
                    Some(samples_of(t, trace.sample_s))
                }
                LastInstant::BeforeStart => Some(0),
                LastInstant::NeverCritical => None,
            }
        });
    // own ship owes nothing before she can know of the risk
    let alone = alone.map(|k| k.max(onset).max(begin));
    let shall_act = [alone, stages[2]].into_iter().flatten().min().filter(|k| *k <= end);
    Duty {
        class: start.class,
        begin,
        onset,
        end,
        complete,
        open,
        never_opened,
        stages,
        may_act,
        shall_act,
        own_stopped: start.own_stopped,
        reference,
    }
}

/// The sample at which they have been past and clear for as long as it takes.
fn released_at(
    trace: &Trace,
    target: usize,
    actual: &PairSignals<'_>,
    class: EncounterClass,
    onset: usize,
    params: &Params,
) -> Option<usize> {
    let distance_m = match trace.distance {
        DistanceKind::Hull => &trace.pairs[target].hull_m,
        DistanceKind::Centre => &actual.range_m,
    };
    let since = released(actual, class, params, trace.sample_s, onset, distance_m)?;
    Some(since + samples_of(params.release_hold_s, trace.sample_s))
}

/// First sample at which the ships see one another.
fn sighted(visibility: Visibility, actual: &PairSignals<'_>) -> Option<usize> {
    match visibility {
        Visibility::InSight => Some(0),
        Visibility::Restricted { visual_range_m } => {
            actual.range_m.iter().position(|range_m| *range_m <= visual_range_m)
        }
    }
}

/// New onset, new class, and the heading of that moment as the reference (section 9, R19).
fn on_coming_in_sight(
    trace: &Trace,
    target: usize,
    life: &Life<'_>,
    seen: usize,
    params: &Params,
) -> Option<Duty> {
    let within_m = params.risk_distance_m;
    let open = risk_open_anew(Some(seen), &life.actual, params, within_m, trace.sample_s, None);
    let onset = open.iter().find(|open| open.end > seen)?.start.max(seen);
    if onset > life.cpa {
        return None;
    }
    let start = at_onset(&life.actual, &trace.own, &trace.targets[target], params, onset);
    let clock = Clock {
        onset,
        begin: seen,
        end: life.cpa,
        complete: life.cpa_passed,
        never_opened: false,
        reference: Some(seen),
    };
    Some(duty(trace, target, &life.actual, (start, true), clock, params))
}

/// The class at a sample by direction alone, for those who check that a locked role stays.
pub fn class_now(pair: &PairSignals<'_>, params: &Params, k: usize) -> EncounterClass {
    class_by_direction(pair.beta_rad(k), pair.alpha_rad(k), params)
}
