//! The judge itself: one trace in, one judgement out.
//!
//! Signals of own ship once, then each pair: life cycle, action, every check; where the class is in
//! doubt, under every class within it. Several targets are judged pair by pair (section 11); a run
//! of own ship belongs to the targets whose risk it can answer (section 5).

use crate::action::Action;
use crate::before_risk::{resolved_without_nominal, turn_before_risk};
use crate::case::{Case, release, role_of};
use crate::facts::{by_planner, facts};
use crate::flaws::{own_flaw, target_flaw, unreadable};
use crate::life::PairLife;
use crate::other_class::{complete_planner_class, excuse, note_planner_class};
use crate::risk::RiskScanner;
use crate::ruleset::RuleSet;
use crate::ruling::Ruling;
use crate::runs::{SpeedRun, TurnRun, speed_runs, turn_runs};
use crate::scope::{ends_at_closest, in_sight_only};
use crate::signal::OwnSignals;
use crate::{
    last_minute, rule_05_07_lookout, rule_06_safe_speed, rule_08_dribble, rule_08_magnitude,
    rule_08_third_ship, rule_08_time, rule_13_overtaking, rule_14_head_on, rule_15_crossing,
    rule_16_give_way, rule_17_hold, rule_17_may_act, rule_17_port, rule_17_shall_act,
    rule_19_restricted, rule_19_safe_speed, safe, turn,
};
use geom::EncounterClass;
use record::{Check, Judgement, PairFacts, Reaction, Role, Status, Trace, Verdict, Visibility};

/// Judges traces under one rule set; keeps its memory between them.
#[derive(Debug)]
pub struct Judge {
    rules: RuleSet,
    own: OwnSignals,
    scanner: RiskScanner,
    turns: Vec<TurnRun>,
    speeds: Vec<SpeedRun>,
}

impl Judge {
    /// A judge of this rule set.
    pub fn new(rules: RuleSet) -> Self {
        Self {
            rules,
            own: OwnSignals::default(),
            scanner: RiskScanner::default(),
            turns: Vec::new(),
            speeds: Vec::new(),
        }
    }

    /// The rule set that this judge applies.
    pub fn rules(&self) -> &RuleSet {
        &self.rules
    }

    /// Judges one run: the facts of each pair, and a verdict for every check of every pair.
    ///
    /// Nothing is invented: samples that are missing or not finite, and a run cut before the
    /// closest point, make `inconclusive`; an absent input makes `not_evaluated`.
    pub fn judge(&mut self, trace: &Trace) -> Judgement {
        self.read(trace, true)
    }

    /// The facts of each pair alone, at a part of the cost: what must be known before the last safe
    /// instants are looked for.
    pub fn pairs(&mut self, trace: &Trace) -> Vec<PairFacts> {
        self.read(trace, false).pairs
    }

    fn read(&mut self, trace: &Trace, checks: bool) -> Judgement {
        let targets = trace.targets.len();
        let mut judgement = Judgement {
            pairs: Vec::with_capacity(targets),
            verdicts: Vec::with_capacity(targets * Check::COUNT),
            by_planner_class: None,
        };
        if let Some(flaw) = own_flaw(trace) {
            for target in 0..targets {
                unreadable(trace, target, flaw, &mut judgement);
            }
            return judgement;
        }
        let nominal = trace.nominal.as_ref().map(|nominal| &nominal.own);
        self.own.fill(&trace.own, nominal, trace.sample_s, &self.rules);
        turn_runs(&self.own, &trace.own.ship, trace.sample_s, &self.rules, &mut self.turns);
        speed_runs(&self.own, trace.sample_s, &self.rules, &mut self.speeds);
        let flaws: Vec<_> =
            (0..targets).map(|target| target_flaw(trace, target, &self.rules)).collect();
        let mut lives = Vec::with_capacity(targets);
        for target in (0..targets).filter(|&target| flaws[target].is_none()) {
            lives.push(PairLife::new(trace, &self.rules, target, &mut self.scanner));
        }
        let (own, turns, speeds) = (&self.own, &self.turns, &self.speeds);
        let bench = Bench { own, turns, speeds, lives: &lives, checks };
        let mut readable = lives.iter();
        for (target, flaw) in flaws.into_iter().enumerate() {
            match flaw {
                Some(flaw) => unreadable(trace, target, flaw, &mut judgement),
                None => {
                    let life = readable.next().expect("every readable target has its life");
                    bench.judge_pair(life, &mut self.scanner, &mut judgement);
                }
            }
        }
        complete_planner_class(&mut judgement);
        judgement
    }
}

/// What the pairs of one run share.
struct Bench<'a> {
    own: &'a OwnSignals,
    turns: &'a [TurnRun],
    speeds: &'a [SpeedRun],
    lives: &'a [PairLife<'a>],
    /// Whether there is more to say than the facts.
    checks: bool,
}

impl<'a> Bench<'a> {
    fn all_checks(&self, case: &Case<'_>) -> Vec<Verdict> {
        if self.checks { all_checks(case) } else { Vec::new() }
    }

    fn judge_pair(&self, life: &PairLife<'_>, scanner: &mut RiskScanner, out: &mut Judgement) {
        let tracked = life.sample(life.pair().tracked_s.unwrap_or(0.0));
        let sight = in_sight_at(life);
        let released = life.onset.filter(|_| sight == Some(0));
        let released = released.and_then(|onset| release(life, onset.k, onset.decides));
        let action = self.action(life, (tracked, released));
        if life.onset.is_none() {
            self.judge_without_risk(life, &action, out);
            return;
        }
        let mut facts = facts(life, &action);
        if sight == Some(0) {
            let roles = self.judge_roles(life, &action, scanner, &mut facts);
            out.verdicts.extend(roles.verdicts);
            note_planner_class(out, roles.by_planner_class);
        } else {
            facts.role = Role::None;
            let mut verdicts = self.judge_restricted(life, &action, &mut facts);
            if let Some(k) = sight {
                let life = life.in_sight_from(k, scanner);
                if let Some(onset) = life.onset {
                    let released = release(&life, onset.k, onset.decides);
                    let action = self.action(&life, (k.max(tracked), released));
                    facts.class = Some(onset.decides);
                    facts.class_by_bearings = Some(onset.class);
                    facts.ambiguous = onset.ambiguous();
                    facts.class_by_planner = by_planner(&life, &onset);
                    let seen = self.judge_roles(&life, &action, scanner, &mut facts);
                    for (verdict, seen) in verdicts.iter_mut().zip(seen.verdicts) {
                        if in_sight_only(verdict.check) {
                            *verdict = seen;
                        }
                    }
                    let theirs = seen.by_planner_class.into_iter().flatten();
                    let theirs = theirs.filter(|verdict| in_sight_only(verdict.check)).collect();
                    note_planner_class(out, Some(theirs).filter(|v: &Vec<_>| !v.is_empty()));
                }
            }
            out.verdicts.extend(verdicts);
        }
        out.pairs.push(facts);
    }

    /// Own ship's action for one target, from a sample to another where there is one.
    fn action(&self, life: &PairLife<'_>, within: (usize, Option<usize>)) -> Action {
        let belongs = |start: usize| self.belongs(life, start);
        let turns = self.turns.iter().copied().filter(|run| belongs(run.start));
        let speeds = self.speeds.iter().copied().filter(|run| belongs(run.start));
        Action::new(life, self.own, turns, speeds, within)
    }

    /// Whether a run that starts at sample `k` can answer this target (section 5).
    fn belongs(&self, life: &PairLife<'_>, k: usize) -> bool {
        if self.lives.len() == 1 {
            return true;
        }
        let lead = self.lead(life);
        if life.near_risk(k, lead) {
            return true;
        }
        if self.lives.iter().any(|other| other.near_risk(k, lead)) {
            return false;
        }
        let next = |l: &PairLife<'_>| l.risk.iter().map(|&(from, _)| from).find(|&from| from > k);
        match self.lives.iter().filter_map(next).min() {
            Some(soonest) => next(life) == Some(soonest),
            // nothing lies ahead: it can only answer what is not yet passed
            None => life.onset.is_some() && life.passed.is_none_or(|passed| passed.k >= k),
        }
    }

    fn lead(&self, life: &PairLife<'_>) -> usize {
        (life.rules.manoeuvre.attribution_lead_s / life.trace.sample_s) as usize
    }

    /// Another target that own ship owed giving way when she turned or slowed, if she owed this one
    /// nothing.
    fn forced_by(
        &self,
        life: &PairLife<'_>,
        class: EncounterClass,
        action: &Action,
    ) -> Option<usize> {
        let slowed = action.speed_runs.first().map(|run| run.start);
        let start = action.turn.map(|turn| turn.start).or(slowed)?;
        if role_of(class) != Role::StandOn {
            return None;
        }
        let owed = |other: &&PairLife<'_>| {
            let class = other.onset.map(|onset| onset.decides);
            let role = class.map_or(Role::None, role_of);
            other.target != life.target
                && matches!(role, Role::GiveWay | Role::Both)
                && other.near_risk(start, self.lead(life))
        };
        self.lives.iter().find(owed).map(|other| other.target)
    }

    /// Judges under the class that decides, and under every other within the doubt: a failure that
    /// another role would not have is a warning.
    fn judge_roles(
        &self,
        life: &PairLife<'_>,
        action: &Action,
        scanner: &mut RiskScanner,
        facts: &mut PairFacts,
    ) -> Roles {
        let onset = life.onset.as_ref().expect("only a pair at risk has roles");
        let resolved_early = self.resolved_early(life, action, scanner);
        let open = life.open_as_sailed(onset.k, scanner);
        let case_of = |class: EncounterClass| {
            let mut case = Case::new(life, self.own, action, onset, class, self.lives, Some(&open));
            case.later_turns = self.turns;
            case.forced_by = self.forced_by(life, class, action);
            case.resolved_early = resolved_early;
            case
        };
        let case = case_of(onset.decides);
        facts.role = case.role;
        facts.stages_s = case.stages.map(|k| k.map(|k| life.time_s(k)));
        facts.released_s = case.released_s;
        let mut verdicts = self.all_checks(&case);
        if onset.ambiguous() && verdicts.iter().any(|verdict| verdict.status == Status::Fail) {
            for other in EncounterClass::ALL {
                if onset.reachable[other as usize] && other != onset.decides {
                    excuse(&mut verdicts, &all_checks(&case_of(other)));
                }
            }
        }
        let theirs = facts.class_by_planner.filter(|&class| self.checks && class != onset.decides);
        let by_planner_class = theirs.map(|class| all_checks(&case_of(class)));
        Roles { verdicts, by_planner_class }
    }

    fn judge_restricted(
        &self,
        life: &PairLife<'_>,
        action: &Action,
        facts: &mut PairFacts,
    ) -> Vec<Verdict> {
        let onset = life.onset.as_ref().expect("only a pair at risk is judged by Rule 19");
        let mut case = Case::new(life, self.own, action, onset, onset.decides, self.lives, None);
        case.restricted = true;
        case.role = Role::None;
        facts.stages_s = case.stages.map(|k| k.map(|k| life.time_s(k)));
        self.all_checks(&case)
    }

    /// Whether an action before onset kept risk from ever opening on the actual track.
    fn resolved_early(
        &self,
        life: &PairLife<'_>,
        action: &Action,
        scanner: &mut RiskScanner,
    ) -> bool {
        let onset_s = life.onset.map_or(0.0, |onset| life.time_s(onset.k));
        if life.nominal.is_none() || action.detectable_s.is_none_or(|t_s| t_s >= onset_s) {
            return false;
        }
        let mut opened = Vec::new();
        scanner.scan(&life.actual, life.trace.sample_s, life.rules, false, &mut opened);
        opened.is_empty()
    }

    fn judge_without_risk(&self, life: &PairLife<'_>, action: &Action, out: &mut Judgement) {
        let early = resolved_without_nominal(life, self.own, action);
        let mut facts = facts(life, action);
        if let Some(class) = early {
            (facts.class, facts.class_by_bearings) = (Some(class), Some(class));
            facts.reaction = Reaction::Early;
        } else {
            facts.first_turn_rad = None;
        }
        for check in Check::ALL {
            let nothing = Ruling::new(check, life.target, Status::NotApplicable);
            out.verdicts.push(match check {
                Check::Safe => safe::without_risk(life),
                Check::R5R7 => rule_05_07_lookout::without_risk(life),
                Check::R6 => rule_06_safe_speed::without_risk(life),
                Check::Turn if early.is_some() => turn_before_risk(life, action, early),
                _ if early.is_some() => nothing.detail("RESOLVED_EARLY").done(),
                _ => nothing.done(),
            });
        }
        out.pairs.push(facts);
    }
}

/// The verdicts of a pair in sight.
struct Roles {
    verdicts: Vec<Verdict>,
    /// The same under the class of the planner's own sector, where it is another.
    by_planner_class: Option<Vec<Verdict>>,
}

/// Every check of one case; SAFE last, because a stand-on ship's depends on her own breaches.
fn all_checks(case: &Case<'_>) -> Vec<Verdict> {
    let mut verdicts: Vec<Verdict> =
        Check::ALL.into_iter().map(|check| settle(case, one_check(case, check))).collect();
    let breach = verdicts.iter().any(|verdict| verdict.status == Status::Fail);
    verdicts[Check::Safe as usize] = settle(case, safe::check(case, breach));
    verdicts
}

fn one_check(case: &Case<'_>, check: Check) -> Verdict {
    if case.onset.own_stopped && check != Check::Safe {
        let status = Status::NotEvaluated;
        return Ruling::new(check, case.life.target, status).detail("OWN-STOPPED").done();
    }
    // section 3: the clock of these rules ends at the closest point
    if case.onset.k > case.end() && case.complete() && ends_at_closest(check) {
        let status = Status::NotApplicable;
        return Ruling::new(check, case.life.target, status).detail("PASSED-BEFORE-RISK").done();
    }
    match check {
        // filled in by the caller
        Check::Safe => Ruling::new(check, case.life.target, Status::NotEvaluated).done(),
        Check::Turn => turn::check(case),
        Check::R5R7 => rule_05_07_lookout::check(case),
        Check::R6 => rule_06_safe_speed::check(case),
        Check::R8Magnitude => rule_08_magnitude::check(case),
        Check::R8Dribble => rule_08_dribble::check(case),
        Check::R8Third => rule_08_third_ship::check(case),
        Check::R8Time => rule_08_time::check(case),
        Check::R13 => rule_13_overtaking::check(case),
        Check::R14 => rule_14_head_on::check(case),
        Check::R15 => rule_15_crossing::check(case),
        Check::R16 => rule_16_give_way::check(case),
        Check::R17Hold => rule_17_hold::check(case),
        Check::R17May => rule_17_may_act::check(case),
        Check::R17Shall => rule_17_shall_act::check(case),
        Check::R17Port => rule_17_port::check(case),
        Check::R19 => rule_19_restricted::check(case),
        Check::R19Speed => rule_19_safe_speed::check(case),
        Check::LastMinute => last_minute::check(case),
    }
}

/// A run cut before the closest point can have failed, but nothing else is settled. A ship that
/// acted before risk and so kept it from opening is not failed for what she then left undone.
fn settle(case: &Case<'_>, mut verdict: Verdict) -> Verdict {
    verdict.stages_by = Some(case.stages_by());
    let decided = matches!(verdict.status, Status::Pass | Status::Warn);
    // these two ask for the closest point of the whole run
    let to_the_end = matches!(verdict.check, Check::Safe | Check::R14);
    let complete = case.life.passed.is_some() || !to_the_end && case.complete();
    if !complete && decided && verdict.check != Check::R5R7 {
        verdict.status = Status::Inconclusive;
        verdict.sentence = None;
    }
    use Check::{LastMinute, R6, R8Third, R19Speed, Safe};
    let excusable = !matches!(verdict.check, Safe | LastMinute | R8Third | R6 | R19Speed);
    if case.resolved_early && excusable && verdict.status == Status::Fail {
        verdict.status = Status::Warn;
        verdict.detail = "RESOLVED_EARLY".into();
    }
    verdict
}

/// The first sample at which the ships see one another; 0 where they always do.
fn in_sight_at(life: &PairLife<'_>) -> Option<usize> {
    let onset = life.onset.map_or(0, |onset| onset.k);
    match life.trace.visibility {
        Visibility::InSight => Some(0),
        Visibility::Restricted { visual_range_m } => {
            let last = life.passed.map_or(life.actual.len() - 1, |passed| passed.k);
            let seen = (0..=last).find(|&k| life.actual.range_m(k) <= visual_range_m)?;
            // seen before there was any risk: Rule 19 never applied
            Some(if seen <= onset { 0 } else { seen })
        }
    }
}
