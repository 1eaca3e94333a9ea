//! Truth tables of the rules: voyages written by hand, and what the judge must say of them.

mod can_differ;
mod dnv_labels;
mod edge_cases;
mod laws;
mod limits;
mod pinned;
mod planner_class;
mod rule_13;
mod rule_17;
mod rule_19_and_last_minute;
mod rule_8;
mod rule_sets;
mod rules_14_15_16;
mod safe_and_turn;
mod safe_speed;
mod several_targets;
mod window;

use crate::testing::{Scene, Script, rules, ship};
use crate::{Judge, RuleSet};
use geom::EncounterClass;
use geom::units::deg;
use record::{Check, Judgement, StageClock, Status, Trace, Verdict};

fn judge(scene: &Scene) -> Judgement {
    judge_by(rules(), &scene.trace())
}

fn judge_by(rules: RuleSet, trace: &Trace) -> Judgement {
    Judge::new(rules).judge(trace)
}

/// The default rule set with one number changed.
fn with(key: &str, value: f64) -> RuleSet {
    rules().with(key, value).unwrap()
}

#[track_caller]
fn verdict(judgement: &Judgement, check: Check) -> &Verdict {
    judgement.worst(check).unwrap()
}

#[track_caller]
fn expect(judgement: &Judgement, check: Check, status: Status, detail: &str) {
    let verdict = verdict(judgement, check);
    assert_eq!((verdict.status, verdict.detail.as_ref()), (status, detail), "{verdict:#?}");
    let told = matches!(status, Status::Fail | Status::Warn);
    assert_eq!(
        verdict.sentence.is_some(),
        told,
        "a sentence for failures and warnings: {verdict:?}"
    );
}

/// Own ship: 10 m, at the origin, heading north.
fn own(speed_mps: f64) -> Script {
    Script::new(ship(10.0, 3.0), 0.0, 0.0, 0.0, speed_mps)
}

/// A target of 40 m.
fn target(north_m: f64, east_m: f64, psi_deg: f64, speed_mps: f64) -> Script {
    Script::new(ship(40.0, 8.0), north_m, east_m, deg(psi_deg), speed_mps).hold(900.0)
}

/// Meets own ship of 6 m/s head-on: risk at 42 s, stage 3 at 142 s, stage 4 at 184 s, CPA at 200 s.
fn head_on() -> Script {
    target(2400.0, 10.0, 180.0, 6.0)
}

/// Crosses own ship of 6 m/s from starboard: risk at 77 s, stage 3 at 218 s, stage 4 at 277 s,
/// CPA at 300 s.
fn from_starboard() -> Script {
    target(1800.0, 1800.0, 270.0, 6.0)
}

/// The mirror image of `from_starboard`.
fn from_port() -> Script {
    target(1800.0, -1800.0, 90.0, 6.0)
}

/// Is overtaken by own ship of 8 m/s: risk from the start, stage 3 at 220 s, CPA at 300 s.
fn slow_ahead() -> Script {
    target(1500.0, 5.0, 0.0, 3.0)
}

/// Overtakes own ship of 3 m/s from right astern.
fn fast_astern() -> Script {
    target(-1500.0, 5.0, 0.0, 8.0)
}
