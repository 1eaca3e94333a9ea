//! One pair judged under one class: role, stages, the moments from which a stand-on ship may and
//! shall act, and release. Every check reads a case and nothing else.
//! Reference: rules specification, sections 2, 3 and 9 (Rule 17).

use crate::action::Action;
use crate::life::{Onset, PairLife};
use crate::risk::Interval;
use crate::ruleset::{RuleSet, StageMode};
use crate::runs::TurnRun;
use crate::signal::OwnSignals;
use geom::{EncounterClass, Vec2, angle, math};
use record::{LastInstant, LastMinute, Role, StageClock};
use std::ops::Range;

/// What a check may look at.
#[derive(Debug)]
pub(crate) struct Case<'a> {
    pub(crate) life: &'a PairLife<'a>,
    pub(crate) own: &'a OwnSignals,
    pub(crate) action: &'a Action,
    pub(crate) onset: &'a Onset,
    /// The class that decides here.
    pub(crate) class: EncounterClass,
    pub(crate) role: Role,
    /// Not in sight of one another: Rule 19 instead of 11 to 18.
    pub(crate) restricted: bool,
    /// Entries of stages 2, 3 and 4, in samples.
    pub(crate) stages: [Option<usize>; 3],
    /// `limit_2`, `limit_3` and `limit_4` at those entries (at onset where not entered), metres.
    pub(crate) limits_m: [f64; 3],
    /// `t_17a`: from when a stand-on ship may act, in samples.
    pub(crate) may_act: Option<usize>,
    /// Finally past and clear, seconds.
    pub(crate) released_s: Option<f64>,
    /// Another target to which own ship owed giving way when she first turned.
    pub(crate) forced_by: Option<usize>,
    /// Every course run of own ship, whatever target it answers and whenever it was.
    pub(crate) later_turns: &'a [TurnRun],
    /// Acted before risk opened, and by that kept it from opening.
    pub(crate) resolved_early: bool,
    /// When risk is open on the way that was really gone, in samples, from the onset on; absent
    /// in restricted visibility, where no rule asks.
    pub(crate) open: Option<&'a [Interval]>,
    /// Every other target, for what an action does to them.
    pub(crate) others: &'a [PairLife<'a>],
}

impl<'a> Case<'a> {
    pub(crate) fn rules(&self) -> &'a RuleSet {
        self.life.rules
    }

    pub(crate) fn gives_way(&self) -> bool {
        matches!(self.role, Role::GiveWay | Role::Both)
    }

    pub(crate) fn stands_on(&self) -> bool {
        self.role == Role::StandOn
    }

    /// The run went past the closest point of this pair, or its encounter was over before.
    pub(crate) fn complete(&self) -> bool {
        self.life.passed.is_some() || !self.restricted && self.released_s.is_some()
    }

    pub(crate) fn onset_s(&self) -> f64 {
        self.life.time_s(self.onset.k)
    }

    /// From when the planner's clock runs: risk open and the track confirmed.
    pub(crate) fn clock_s(&self) -> f64 {
        self.onset_s().max(self.life.pair().tracked_s.unwrap_or(0.0))
    }

    /// The last sample of stages, actions and duties: the closest point, the release if the ships
    /// came closest in another meeting after it, or where the run was cut.
    pub(crate) fn end(&self) -> usize {
        self.action.window.1
    }

    pub(crate) fn stage_s(&self, stage: usize) -> Option<f64> {
        self.stages[stage - 2].map(|k| self.life.time_s(k))
    }

    pub(crate) fn may_act_s(&self) -> Option<f64> {
        self.may_act.map(|k| self.life.time_s(k))
    }

    /// Whether the turn that counts was begun before risk opened.
    pub(crate) fn turned_early(&self) -> bool {
        self.action.turn.is_some_and(|turn| turn.start < self.onset.k)
    }

    /// The last instant at which own ship alone could still clear, seconds. Absent where she never
    /// could: that is held against nobody (section 10 calls it inconclusive).
    pub(crate) fn own_last_s(&self) -> Option<f64> {
        match self.life.last_minute()?.own {
            LastInstant::NeverCritical | LastInstant::BeforeStart => None,
            LastInstant::At(t_s) | LastInstant::Indicative(t_s) => Some(t_s),
        }
    }

    /// Whether nothing that own ship was allowed to do from then on cleared.
    pub(crate) fn had_no_choice(&self, t_s: f64) -> bool {
        let never = |last: &LastMinute| last.own == LastInstant::BeforeStart;
        self.life.last_minute().is_some_and(never) || self.own_last_s().is_some_and(|s| t_s > s)
    }

    /// From when the target alone could no longer avoid contact, seconds; not before own ship can
    /// know that there is risk.
    pub(crate) fn target_helpless_s(&self) -> Option<f64> {
        let last_s = match self.life.last_minute()?.target {
            LastInstant::NeverCritical => return None,
            LastInstant::BeforeStart => 0.0,
            LastInstant::At(t_s) | LastInstant::Indicative(t_s) => t_s,
        };
        Some(last_s.max(self.clock_s()))
    }

    /// Another target to which own ship owes giving way at every sample of a range (the first of
    /// them, where they take turns).
    pub(crate) fn gives_way_throughout(&self, mut range: Range<usize>) -> Option<usize> {
        let owed = |k: usize| {
            let here = |other: &&PairLife<'_>| {
                let until = other.passed.map_or(other.actual.len() - 1, |passed| passed.k);
                other.target != self.life.target
                    && other.in_sight_by(k)
                    && other.onset.is_some_and(|onset| {
                        let role = role_of(onset.decides);
                        let gives_way = matches!(role, Role::GiveWay | Role::Both);
                        gives_way && !onset.own_stopped && (onset.k..=until).contains(&k)
                    })
            };
            self.others.iter().find(here).map(|other| other.target)
        };
        let first = owed(range.start);
        first.filter(|_| range.all(|k| owed(k).is_some()))
    }

    /// Range between reference points at a time, metres.
    pub(crate) fn range_at_m(&self, t_s: f64) -> f64 {
        self.life.actual.range_m(self.life.sample(t_s))
    }

    /// Finds everything that hangs on the class.
    pub(crate) fn new(
        life: &'a PairLife<'a>,
        own: &'a OwnSignals,
        action: &'a Action,
        onset: &'a Onset,
        class: EncounterClass,
        others: &'a [PairLife<'a>],
        open: Option<&'a [Interval]>,
    ) -> Self {
        let mut case = Self {
            life,
            own,
            action,
            onset,
            class,
            role: role_of(class),
            restricted: false,
            stages: [None; 3],
            limits_m: [0.0; 3],
            may_act: None,
            released_s: None,
            forced_by: None,
            later_turns: &[],
            resolved_early: false,
            open,
            others,
        };
        if onset.own_stopped {
            case.role = Role::None;
        }
        case.enter_stages();
        if case.stands_on() {
            case.may_act = case.find_may_act();
        }
        case.released_s = release(life, onset.k, class).map(|k| life.time_s(k));
        case
    }

    /// By what the limits of the stages are found: always by time for the overtaking roles.
    pub(crate) fn stages_by(&self) -> StageClock {
        let overtaking =
            matches!(self.class, EncounterClass::Overtaking | EncounterClass::Overtaken);
        match self.rules().stages.mode {
            StageMode::Range if !overtaking => StageClock::Range,
            _ => StageClock::Time,
        }
    }

    /// `limit_2`, `limit_3` and `limit_4` at a sample, metres.
    fn limits_at_m(&self, k: usize) -> [f64; 3] {
        let s = &self.rules().stages;
        if self.stages_by() == StageClock::Range {
            return [s.r2_m, s.r3_m, s.r4_m];
        }
        let (position_m, velocity_mps) = self.life.actual.relative(k);
        let closing_mps = (-position_m.dot(&velocity_mps) / position_m.norm()).max(0.0);
        let r_pref_m = self.rules().distance.r_pref_m;
        [
            s.r2_m.max(closing_mps * s.t2_s),
            (2.0 * r_pref_m).max(closing_mps * s.t3_s),
            r_pref_m.max(closing_mps * s.t4_s),
        ]
    }

    fn enter_stages(&mut self) {
        let last = self.life.actual.len() - 1;
        self.limits_m = self.limits_at_m(self.onset.k.min(last));
        if self.onset.own_stopped {
            return;
        }
        let mut next = 0;
        for k in self.onset.k..=self.end() {
            let (position_m, velocity_mps) = self.life.actual.relative(k);
            if position_m.dot(&velocity_mps) >= 0.0 {
                continue;
            }
            let limits_m = self.limits_at_m(k);
            let squared = position_m.norm_squared();
            while next < 3 && squared <= limits_m[next] * limits_m[next] {
                self.stages[next] = Some(k);
                self.limits_m[next] = limits_m[next];
                next += 1;
            }
            if next == 3 {
                break;
            }
        }
    }

    /// `t_17a`: the first sample from stage 3 on at which risk has been open and a close pass
    /// predicted for a while, on the way that was really gone. It looks back, as a ship must. Risk
    /// that closed on a wide pass stays closed while either ship turns, however close the pass
    /// that is predicted from a turn.
    fn find_may_act(&self) -> Option<usize> {
        let s = &self.rules().stand_on;
        let samples = |t_s: f64| (t_s / self.life.trace.sample_s).ceil() as usize;
        let needed = samples(s.may_act_persistence_s) + 1;
        let stage_2 = self.stages[0]?;
        let early = (s.may_act_early && self.rules().stages.mode == StageMode::Time)
            .then(|| stage_2 + samples(s.may_act_early_s))
            .filter(|&k| k <= self.end() && !self.target_has_acted(stage_2, k));
        let by_range = self.stages[1].and_then(|stage_3| {
            let begin = (stage_3 + 1).saturating_sub(needed).max(self.onset.k);
            let mut stretch = 0;
            (begin..=self.end()).find(|&k| {
                let close = self.at_risk(k)
                    && self.life.actual.closing(k)
                    && self.life.actual.dcpa_below(k, self.rules().distance.r_min_m);
                stretch = if close { stretch + 1 } else { 0 };
                stretch >= needed && k >= stage_3
            })
        });
        [early, by_range].into_iter().flatten().min()
    }

    /// Whether risk is open at a sample, as it was sailed; where that is not known, it is.
    pub(crate) fn at_risk(&self, k: usize) -> bool {
        self.open.is_none_or(|open| open.iter().any(|&(from, until)| (from..until).contains(&k)))
    }

    /// Whether the target altered detectably between two samples.
    fn target_has_acted(&self, from: usize, to: usize) -> bool {
        let (m, target) = (&self.rules().manoeuvre, self.life.actual.target);
        let speed_mps = target.sog_mps(from);
        let turn_rad = geom::wrap(target.psi_rad[to] - target.psi_rad[from]);
        turn_rad.abs() >= m.detectable_turn_rad
            || (target.sog_mps(to) - speed_mps).abs() >= m.detectable_speed_fraction * speed_mps
    }
}

/// Finally past and clear (13(d) has no number): held for a while, first after the onset. What
/// comes after that sample is another encounter, even where the ships then meet closer.
pub(crate) fn release(life: &PairLife<'_>, from: usize, class: EncounterClass) -> Option<usize> {
    let needed = (life.rules.release.held_s / life.trace.sample_s).ceil() as usize + 1;
    let mut stretch = 0;
    (from..life.actual.len()).find(|&k| {
        stretch = if clear_at(life, k, class) { stretch + 1 } else { 0 };
        stretch == needed
    })
}

fn clear_at(life: &PairLife<'_>, k: usize, class: EncounterClass) -> bool {
    let (position_m, velocity_mps) = life.actual.relative(k);
    let opening =
        position_m.dot(&velocity_mps) > 0.0 && life.actual.tcpa_s(k).is_some_and(|t| t < 0.0);
    if !opening || life.distance_at_m(k) <= life.rules.distance.r_pref_m {
        return false;
    }
    let r = &life.rules.release;
    let range_m = position_m.norm();
    if range_m > r.beyond_r2_factor * life.rules.stages.r2_m {
        return true;
    }
    // cosines of beta and alpha, without the arc tangents
    let cosine = |psi_rad: f64, to: Vec2| angle::unit(psi_rad).dot(&to) / range_m;
    let cos_beta = cosine(life.actual.own.psi_rad[k], position_m);
    let cos_alpha = cosine(life.actual.target.psi_rad[k], -position_m);
    match class {
        EncounterClass::Overtaking => cos_alpha > math::cos(r.overtaker_ahead_rad),
        EncounterClass::Overtaken => cos_beta > math::cos(r.overtaker_ahead_rad),
        _ => cos_beta.min(cos_alpha) < math::cos(r.abaft_rad),
    }
}

/// The role that goes with a class.
pub(crate) const fn role_of(class: EncounterClass) -> Role {
    match class {
        EncounterClass::HeadOn => Role::Both,
        EncounterClass::CrossingStbd | EncounterClass::Overtaking => Role::GiveWay,
        EncounterClass::CrossingPort | EncounterClass::Overtaken => Role::StandOn,
        EncounterClass::Static => Role::None,
    }
}
