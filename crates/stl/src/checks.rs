//! For each check, when it applies and which columns its formula reads.

use crate::action::{Action, Deviation};
use crate::formula::{Formula, Signals};
use crate::life::{Duty, Life};
use crate::params::Params;
use crate::phi::{self, column as c};
use crate::risk::{released, samples_of};
use crate::runs::Run;
use crate::signals::{ABAFT_THE_BEAM_RAD, Course, PairSignals, crossing_ahead_m};
use record::{Check, EncounterClass, LastInstant, Trace};
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

/// A formula with its signals, or why there is none.
#[derive(Clone, Debug)]
pub enum Claim {
    /// The antecedent was never true.
    NotApplicable,
    /// An input is missing.
    NotEvaluated,
    /// To be evaluated at the first sample.
    Formula {
        /// What is claimed.
        formula: Formula,
        /// Of what.
        signals: Signals,
        /// Whether the window of the formula lies inside the run.
        complete: bool,
    },
}

/// One pair with everything that the checks need.
#[derive(Debug)]
pub struct Case<'a> {
    pub(crate) trace: &'a Trace,
    pub(crate) params: &'a Params,
    pub(crate) lives: &'a [Life<'a>],
    pub(crate) deviation: &'a Deviation,
    pub(crate) target: usize,
    pub(crate) hold: usize,
    in_sight: Option<(&'a Duty, Action)>,
    by_radar: Option<(&'a Duty, Action)>,
    breached: bool,
}

impl<'a> Case<'a> {
    /// The pair of own ship and `target`.
    pub fn new(
        trace: &'a Trace,
        params: &'a Params,
        lives: &'a [Life<'a>],
        deviation: &'a Deviation,
        target: usize,
    ) -> Self {
        let act = |duty: &Duty| Action::of(deviation, lives, target, duty, params, trace.sample_s);
        let life = &lives[target];
        Self {
            trace,
            params,
            lives,
            deviation,
            target,
            hold: samples_of(params.offset_hold_s, trace.sample_s),
            in_sight: life.in_sight.as_ref().map(|duty| (duty, act(duty))),
            by_radar: life.by_radar.as_ref().map(|duty| (duty, act(duty))),
            breached: false,
        }
    }

    /// What a later check needs to know of an earlier one.
    pub fn remember(&mut self, check: Check, status: crate::Finding) {
        self.breached |= check != Check::Safe && status == crate::Finding::Violated;
    }

    /// The formula of a check, where there is one.
    pub fn claim(&self, check: Check) -> Claim {
        let owed = match check {
            Check::Safe => return self.safe(),
            Check::R19 => self.by_radar.as_ref(),
            Check::R8Magnitude => self.by_radar.as_ref().or(self.in_sight.as_ref()),
            _ => self.in_sight.as_ref(),
        };
        let Some((duty, action)) = owed else { return Claim::NotApplicable };
        if duty.own_stopped {
            return Claim::NotEvaluated;
        }
        let claim = match (check, duty.class) {
            (Check::R8Magnitude, _) => self.apparent(duty, action),
            (Check::R13, EncounterClass::Overtaking) => self.overtaking(duty),
            (Check::R14, EncounterClass::HeadOn) => self.head_on(duty, action),
            (Check::R15, EncounterClass::CrossingStbd) => self.crossing(duty),
            (Check::R17Hold, _) if duty.stands_on() => self.stand_on(duty),
            (Check::R17Port, EncounterClass::CrossingPort) => self.not_to_port(duty, action),
            (Check::R19, _) => self.not_by_radar(duty, action),
            _ => Claim::NotApplicable,
        };
        self.unless_settled(claim, duty, action)
    }

    /// Own ship acted before there was any risk, and there never was: nothing is left to break.
    fn unless_settled(&self, claim: Claim, duty: &Duty, action: &Action) -> Claim {
        let in_sight = self.by_radar.is_none() && self.trace.nominal.is_some();
        let settled = in_sight && duty.never_opened && self.seen_before(duty.onset + 1, action);
        match claim {
            Claim::Formula { formula, signals, complete } if settled => Claim::Formula {
                formula: phi::unless_settled(formula),
                signals: signals.with(c::SETTLED_EARLY, self.flags(|_| true)),
                complete,
            },
            claim => claim,
        }
    }

    fn life(&self) -> &Life<'a> {
        &self.lives[self.target]
    }

    pub(crate) fn pair(&self) -> &PairSignals<'a> {
        &self.life().actual
    }

    /// No columns yet, up to the end of the clock and as long as an offset that was made by then
    /// must be held: what follows has no say.
    pub(crate) fn signals_of(&self, duty: &Duty) -> Signals {
        Signals::new((duty.end + 1 + self.hold).min(self.pair().samples()))
    }

    /// Where an offset that was made within `range` has been held: it counts by when it was made.
    pub(crate) fn made_in(&self, range: Range<usize>) -> Vec<f64> {
        self.flags(|k| k.checked_sub(self.hold).is_some_and(|made| range.contains(&made)))
    }

    pub(crate) fn flags(&self, holds: impl Fn(usize) -> bool) -> Vec<f64> {
        (0..self.pair().samples()).map(|k| if holds(k) { 1.0 } else { -1.0 }).collect()
    }

    /// Distances as the trace has them: lower bounds far away are raised to the minimum, which is
    /// exact and stands at its own sample.
    fn distances(&self) -> Vec<f64> {
        let pair = &self.trace.pairs[self.target];
        let (minimum_m, at_s) = pair.minimum.of(self.trace.distance);
        let mut distance_m: Vec<f64> = match self.trace.distance {
            record::DistanceKind::Hull => pair.hull_m.clone(),
            record::DistanceKind::Centre => self.pair().range_m.clone(),
        };
        for entry in &mut distance_m {
            *entry = entry.max(minimum_m);
        }
        let at = samples_of(at_s, self.trace.sample_s).min(distance_m.len() - 1);
        distance_m[at] = minimum_m;
        distance_m
    }

    fn touched(&self) -> bool {
        let contact = self.trace.contact.is_some_and(|contact| {
            let own = |target: u8| usize::from(target) == self.target;
            matches!(contact.with, record::ContactWith::Target(target) if own(target))
        });
        contact || self.trace.pairs[self.target].minimum.hull_m <= 0.0
    }

    fn with_distance(&self, signals: Signals) -> Signals {
        let touched = self.touched();
        let contact = self.flags(|_| touched);
        signals.with(c::DISTANCE_M, self.distances()).with(c::CONTACT, contact)
    }

    /// A stand-on ship without a breach of her own may be passed as close as a near miss.
    fn safe(&self) -> Claim {
        let life = self.life();
        let stands_on =
            self.in_sight.as_ref().filter(|(duty, _)| duty.stands_on() && !duty.own_stopped);
        let blameless = stands_on
            .is_some_and(|(duty, action)| !self.breached && !self.shall_act_breached(duty, action));
        let p = self.params;
        let limit_m = if blameless { p.near_miss_m } else { p.minimum_m };
        Claim::Formula {
            formula: phi::safe(limit_m, p),
            signals: self.with_distance(Signals::new(self.pair().samples())),
            complete: life.cpa_passed,
        }
    }

    /// Rule 17(b) has no formula; whether it was broken decides whether SAFE is lenient.
    fn shall_act_breached(&self, duty: &Duty, action: &Action) -> bool {
        let Some(shall_act) = duty.shall_act else {
            return false;
        };
        let own = self.trace.last_minute.as_ref().and_then(|all| all.get(self.target)?.as_ref());
        // nothing could help from the start on: that sets no time
        let own_last = own
            .filter(|last| last.own != LastInstant::BeforeStart)
            .and_then(|last| instant(last.own, self.trace.sample_s));
        let grace = samples_of(self.params.shall_act_grace_s, self.trace.sample_s);
        let deadline = own_last.unwrap_or(usize::MAX).min(shall_act + grace).min(duty.end);
        !action.begun_by(deadline, &self.deviation.speed_mps, self.params)
            && self.pair().predicted_hull_within(deadline, self.params.near_miss_m)
    }

    fn apparent(&self, duty: &Duty, own: &Action) -> Claim {
        let p = self.params;
        let radar = self.by_radar.is_some();
        // a ship that stands on is asked for size once she acts from the moment at which she may:
        // what can be seen at that sample was made before it
        let by_right = duty.may_act.is_some_and(|may| {
            !self.seen_before(may + 1, own) && self.seen_before(duty.end + 1, own)
        });
        if !radar && duty.stands_on() && !by_right {
            return Claim::NotApplicable;
        }
        let over = own.returns.unwrap_or(usize::MAX);
        let action = own.turn_rad.iter().map(|turn| own.side * turn).collect();
        let passed_m = self.trace.pairs[self.target].minimum.of(self.trace.distance).0;
        let planned = self.trace.nominal.as_ref().and_then(|n| n.minima.get(self.target));
        let gained = planned.is_none_or(|m| passed_m > m.of(self.trace.distance).0);
        let small_did = !self.touched() && gained && passed_m >= p.minimum_m;
        // By radar there is no allowance for what an eye would see.
        let turn_rad = if radar { p.turn_apparent_rad } else { p.turn_action_rad };
        Claim::Formula {
            formula: phi::apparent(turn_rad, self.hold, p),
            signals: self
                .signals_of(duty)
                .with(c::CLOCK, self.made_in(own.from..duty.end + 1))
                .with(c::TURN_CLOCK, self.made_in(own.from..over.min(duty.end + 1)))
                .with(c::ACTION_RAD, action)
                .with(c::SPEED_CUT, own.speed_cut.clone())
                .with(c::SMALL_DID, self.flags(|_| small_did)),
            complete: duty.complete,
        }
    }

    fn head_on(&self, duty: &Duty, action: &Action) -> Claim {
        let p = self.params;
        let counts = |run: &&Run| run.change >= p.turn_action_rad;
        let starboard = action.turns.iter().find(counts).map_or(usize::MAX, |run| run.start);
        // What was turned to port before risk opened was free.
        let early = self.turned_early(duty, action);
        let end = duty.end + 1;
        let before = if early { action.from..action.from } else { action.from..starboard.min(end) };
        Claim::Formula {
            formula: phi::head_on(self.hold, p),
            signals: self
                .signals_of(duty)
                .with(c::CLOCK, self.made_in(action.from..end))
                .with(c::PORT_CLOCK, self.made_in(before))
                .with(c::TURN_RAD, action.turn_rad.clone()),
            complete: duty.complete,
        }
    }

    /// Whether an alteration that can be seen in a sample before `end` was held. What is seen in
    /// one was made before it.
    fn seen_before(&self, end: usize, action: &Action) -> bool {
        let last = action.turn_rad.len().saturating_sub(self.hold + 1);
        let held = |values: &[f64], side: f64, least: f64| {
            let seen = |x: &f64| side * x >= least;
            // a run that ended sooner than that holds nothing
            let window = |k: usize| values.get(k..=k + self.hold);
            let lasts = |k: usize| window(k).is_some_and(|w| w.iter().all(seen));
            (action.from + 1..end.min(last + 1)).any(lasts)
        };
        let p = self.params;
        [1.0, -1.0].into_iter().any(|side| {
            held(&action.turn_rad, side, p.turn_detectable_rad)
                || held(&action.speed_cut, side, p.speed_detectable)
        })
    }

    /// Whether the turn that counts was begun before risk opened.
    pub(crate) fn turned_early(&self, duty: &Duty, action: &Action) -> bool {
        action.counted.is_some_and(|run| run.start < duty.onset)
    }

    fn crossing(&self, duty: &Duty) -> Claim {
        let p = self.params;
        // A crossing lies between a sample and the one before.
        let open =
            |k: usize| duty.open.iter().any(|o| o.contains(&k) || o.contains(&k.saturating_sub(1)));
        Claim::Formula {
            formula: phi::crossing(p),
            signals: self
                .signals_of(duty)
                .with(c::CLOCK, self.flags(|k| (duty.onset + 1..=duty.end).contains(&k)))
                .with(c::CLEAR, self.flags(|k| k >= duty.end && duty.complete))
                .with(c::OPEN, self.flags(open))
                .with(c::AHEAD_M, self.ahead_m(Course::MadeGood)),
            complete: duty.complete,
        }
    }

    /// The margin of crossing ahead: from her bow to own hull where distances are hull to hull.
    fn ahead_m(&self, course: Course) -> Vec<f64> {
        let hulls = self.trace.distance == record::DistanceKind::Hull;
        crossing_ahead_m(self.pair(), course, self.params.preferred_m, hulls)
    }

    fn overtaking(&self, duty: &Duty) -> Claim {
        let p = self.params;
        let pair = self.pair();
        let release =
            released(pair, duty.class, p, self.trace.sample_s, duty.onset, &self.distances());
        let last = release.unwrap_or(usize::MAX);
        let alpha: Vec<f64> = (0..pair.samples()).map(|k| pair.alpha_rad(k).abs()).collect();
        // Not only the runs that belong to the risk: this duty outlives it.
        let ends: Vec<usize> = self
            .deviation
            .turns
            .iter()
            .filter(|run| run.start >= duty.onset && self.turns_in(run, &alpha))
            .map(|run| run.end)
            .collect();
        let turned_in = |k: usize| ends.contains(&k);
        let signals = self
            .with_distance(Signals::new(pair.samples()))
            .with(c::CLOCK, self.flags(|k| (duty.onset..=last).contains(&k)))
            .with(c::AHEAD_M, self.ahead_m(Course::Heading))
            .with(c::CLOSING, self.flags(|k| pair.range_rate_mps[k] < 0.0))
            .with(c::TURNED_IN, self.flags(turned_in))
            .with(c::FORCED, self.forced(duty.onset))
            .with(c::ALPHA_RAD, alpha);
        Claim::Formula { formula: phi::overtaking(p), signals, complete: release.is_some() }
    }

    /// A turn toward the overtaken ship's track that makes the prediction too close.
    fn turns_in(&self, run: &Run, alpha_rad: &[f64]) -> bool {
        let p = self.params;
        let pair = self.pair();
        let (_, abeam_m) = pair.ahead_and_abeam_m(run.start, Course::Heading);
        // her own turn is none of own ship's
        let hers_rad = self.trace.targets[self.target].psi_rad[run.start];
        let course = |k: usize| libm::sin(self.trace.own.psi_rad[k] - hers_rad);
        run.change.abs() >= p.turn_action_rad
            && alpha_rad[run.start] < ABAFT_THE_BEAM_RAD
            && (course(run.end) - course(run.start)) * abeam_m < 0.0
            && pair.tcpa_s[run.end] > 0.0
            && pair.predicted_m(run.end) < pair.predicted_m(run.start)
            && pair.predicted_within(run.end, p.minimum_m)
    }

    fn not_by_radar(&self, duty: &Duty, own: &Action) -> Claim {
        let p = self.params;
        let pair = self.pair();
        let too_late =
            self.trace.last_minute.as_ref().and_then(|all| all.get(self.target)?.as_ref());
        let too_late = too_late.and_then(|last| instant(last.own, self.trace.sample_s));
        let latest = |k: usize| {
            own.turns
                .iter()
                .rfind(|run| run.start <= k)
                .filter(|run| too_late.is_none_or(|late| run.start <= late))
                .map(|run| (run.start, pair.beta_rad(run.start)))
        };
        let overtaking = duty.class == EncounterClass::Overtaking;
        let forward =
            |k: usize| !overtaking && latest(k).is_some_and(|(_, beta)| beta.abs() < FRAC_PI_2);
        let heading = &self.deviation.heading_rad;
        let toward = |k: usize| match latest(k) {
            Some((start, beta)) if beta.abs() >= FRAC_PI_2 => {
                beta.signum() * (heading[k] - heading[start])
            }
            _ => 0.0,
        };
        let signals = self
            .signals_of(duty)
            .with(c::CLOCK, self.made_in(duty.begin..duty.end + 1))
            .with(c::PORT_TURN, self.flags(forward))
            .with(c::TURN_RAD, own.turn_rad.clone())
            .with(c::TOWARD_RAD, (0..pair.samples()).map(toward).collect());
        Claim::Formula { formula: phi::by_radar(self.hold, p), signals, complete: duty.complete }
    }
}

fn instant(last: LastInstant, sample_s: f64) -> Option<usize> {
    match last {
        LastInstant::At(t) | LastInstant::Indicative(t) => Some(samples_of(t, sample_s)),
        LastInstant::BeforeStart => Some(0),
        LastInstant::NeverCritical => None,
    }
}
