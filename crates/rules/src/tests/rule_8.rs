//! Rule 8: size, dribble, third ships, time; and Rules 5 to 7.

use super::*;
use Status::{Fail, Inconclusive, NotApplicable, NotEvaluated, Pass, Warn};
use record::Alert;

fn head_on_turn(at_s: f64, angle_deg: f64) -> Judgement {
    judge(&Scene::new(own(6.0).hold(at_s).turn(angle_deg, 3.0).hold(400.0), head_on()))
}

#[test]
fn magnitude_passes_at_thirty_degrees() {
    expect(&head_on_turn(60.0, 30.2), Check::R8Magnitude, Pass, "");
    expect(&head_on_turn(60.0, 29.8), Check::R8Magnitude, Warn, "NOT-APPARENT");
}

#[test]
fn magnitude_below_ten_degrees_depends_on_what_came_of_it() {
    // 8 degrees early: 125 m further off; SAFE passes by her own action
    expect(&head_on_turn(50.0, 8.0), Check::R8Magnitude, Warn, "SMALL");
    expect(&head_on_turn(50.0, 8.0), Check::Safe, Pass, "");
    // 8 degrees late: too close
    expect(&head_on_turn(140.0, 8.0), Check::R8Magnitude, Fail, "FAIL-8-NOT-APPARENT");
    // nothing at all, and a pass at 150 m
    let held = judge(&Scene::new(own(6.0).hold(500.0), target(2400.0, 160.0, 180.0, 6.0)));
    expect(&held, Check::R8Magnitude, Fail, "FAIL-8-NOT-APPARENT");
}

#[test]
fn magnitude_by_speed_alone_suffices() {
    let slowed = |to: f64| {
        judge(&Scene::new(own(6.0).hold(90.0).speed_to(to, 0.3).hold(600.0), from_starboard()))
    };
    expect(&slowed(2.9), Check::R8Magnitude, Pass, "");
    expect(&slowed(3.1), Check::R8Magnitude, Warn, "NOT-APPARENT");
    // gaining speed counts for nothing
    expect(&slowed(9.5), Check::R8Magnitude, Fail, "FAIL-8-NOT-APPARENT");
}

#[test]
fn magnitude_is_no_question_for_a_ship_that_stands_on() {
    let held = judge(&Scene::new(own(6.0).hold(600.0), target(1800.0, -1920.0, 90.0, 6.0)));
    expect(&held, Check::R8Magnitude, NotApplicable, "");
    let acts = judge(&Scene::new(own(6.0).hold(225.0).turn(60.0, 6.0).hold(400.0), from_port()));
    expect(&acts, Check::R8Magnitude, Pass, "");
}

#[test]
fn dribble_counts_small_turns_before_the_course_is_off() {
    let steps = |sizes: &[f64]| {
        let start = own(6.0).hold(50.0);
        let turn = |script: Script, size: &f64| script.turn(*size, 4.0).hold(17.0);
        judge(&Scene::new(sizes.iter().fold(start, turn).hold(400.0), head_on()))
    };
    expect(&steps(&[8.0, 8.0, 8.0, 8.0, 8.0]), Check::R8Dribble, Fail, "FAIL-8-DRIBBLE");
    expect(&steps(&[8.0, 8.0]), Check::R8Dribble, Warn, "DRIBBLE");
    expect(&steps(&[35.0]), Check::R8Dribble, Pass, "");
    // large first: what follows is no dribble
    expect(&steps(&[35.0, 8.0, 8.0, 8.0]), Check::R8Dribble, Pass, "");
    expect(&steps(&[]), Check::R8Dribble, NotApplicable, "");
}

/// The offset of section 6 is one of course: a ship that has halved her speed may still dribble.
#[test]
fn slowing_down_does_not_end_a_dribble() {
    let turn = |script: Script, _| script.turn(8.0, 4.0).hold(17.0);
    let slow = own(6.0).hold(40.0).speed_to(2.5, 0.5).hold(10.0);
    let script = (0..3).fold(slow, turn).hold(400.0);
    let judgement = judge(&Scene::new(script, head_on()));
    expect(&judgement, Check::R8Dribble, Fail, "FAIL-8-DRIBBLE");
}

#[test]
fn time_by_stages() {
    let at = |t_s: f64| {
        judge_by(
            with("react_warn_s", 500.0),
            &Scene::new(own(6.0).hold(t_s).turn(40.0, 4.0).hold(400.0), head_on()).trace(),
        )
    };
    // stage 3 at 142 s, stage 4 at 184 s; the smoothed rate rises two seconds early
    expect(&at(140.0), Check::R8Time, Pass, "");
    expect(&at(148.0), Check::R8Time, Warn, "STAGE-3");
    expect(&at(183.0), Check::R8Time, Warn, "STAGE-3");
    expect(&at(190.0), Check::R8Time, Fail, "FAIL-8-STAGE-4");
    let never = judge(&Scene::new(own(6.0).hold(500.0), target(2400.0, 160.0, 180.0, 6.0)));
    expect(&never, Check::R8Time, Fail, "FAIL-8-NO-ACTION");
    let held = judge(&Scene::new(own(6.0).hold(600.0), target(1800.0, -1920.0, 90.0, 6.0)));
    expect(&held, Check::R8Time, NotApplicable, "");
}

#[test]
fn time_by_reaction() {
    // risk opens at 42 s
    expect(&head_on_turn(70.0, 40.0), Check::R8Time, Pass, "");
    expect(&head_on_turn(78.0, 40.0), Check::R8Time, Warn, "SLOW-REACTION");
    let controls =
        RuleSet::parse(include_str!("../../../../campaigns/rulesets/controls-v1.toml")).unwrap();
    let late = |t_s: f64| {
        let scene = Scene::new(own(6.0).hold(t_s).turn(40.0, 4.0).hold(400.0), head_on());
        judge_by(controls.clone(), &scene.trace())
    };
    expect(&late(85.0), Check::R8Time, Warn, "SLOW-REACTION");
    expect(&late(92.0), Check::R8Time, Fail, "FAIL-8-REACTION");
}

#[test]
fn time_after_a_late_onset_counts_from_onset() {
    // the encounter begins at 600 m, inside stage 3
    let at = |t_s: f64| {
        let other = target(600.0, 5.0, 180.0, 1.5);
        let trace = Scene::new(own(3.0).hold(t_s).turn(60.0, 6.0).hold(300.0), other).trace();
        judge_by(with("react_warn_s", 500.0), &trace)
    };
    expect(&at(20.0), Check::R8Time, Pass, "");
    expect(&at(40.0), Check::R8Time, Warn, "LATE");
    expect(&at(70.0), Check::R8Time, Fail, "FAIL-8-LATE");
}

#[test]
fn what_was_not_done_may_yet_be_done() {
    let cut = judge(&Scene::new(own(6.0).hold(120.0), head_on()));
    expect(&cut, Check::R8Time, Inconclusive, "FAIL-8-NO-ACTION");
    expect(&cut, Check::R8Magnitude, Inconclusive, "FAIL-8-NOT-APPARENT");
    // past stage 4 it is too late
    let too_late = judge(&Scene::new(own(6.0).hold(190.0), head_on()));
    expect(&too_late, Check::R8Time, Fail, "FAIL-8-NO-ACTION");
}

#[test]
fn lookout_reads_declared_alerts_only() {
    let scene = Scene::new(own(6.0).hold(60.0).turn(40.0, 4.0).hold(400.0), head_on());
    expect(&judge(&scene), Check::R5R7, NotEvaluated, "NO-ALERTS-DECLARED");
    let alerted = |t_s: f64| {
        let mut trace = scene.trace();
        trace.alerts = vec![Alert { t_s, target: 0, rule: String::new() }];
        judge_by(rules(), &trace)
    };
    expect(&alerted(50.0), Check::R5R7, Pass, "");
    expect(&alerted(11.0), Check::R5R7, Warn, "MISSED-ALERT");
    let never = Scene::new(own(6.0).hold(600.0), target(1800.0, 900.0, 0.0, 6.0));
    let mut trace = never.trace();
    trace.alerts = vec![Alert { t_s: 50.0, target: 0, rule: String::new() }];
    expect(&judge_by(rules(), &trace), Check::R5R7, Warn, "FALSE-ALERT");
}
