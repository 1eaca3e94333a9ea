//! Rule 19, and the last-minute margin.

use super::*;
use Status::{Fail, Inconclusive, NotApplicable, NotEvaluated, Pass, Warn};
use record::{LastInstant, LastMinute, Role, Visibility};

fn fog(mut scene: Scene, visual_range_m: f64) -> Judgement {
    scene.visibility = Visibility::Restricted { visual_range_m };
    judge(&scene)
}

#[test]
fn in_fog_to_starboard_for_a_ship_ahead_complies() {
    let scene = Scene::new(own(6.0).hold(60.0).turn(40.0, 3.0).hold(500.0), head_on());
    let judgement = fog(scene, 50.0);
    expect(&judgement, Check::R19, Pass, "");
    expect(&judgement, Check::R14, NotApplicable, "");
    expect(&judgement, Check::Turn, NotApplicable, "");
    assert_eq!(judgement.pairs[0].role, Role::None);
}

#[test]
fn in_fog_to_port_for_a_ship_ahead_fails() {
    let turned = |angle: f64| {
        fog(Scene::new(own(6.0).hold(60.0).turn(angle, 3.0).hold(500.0), head_on()), 50.0)
    };
    expect(&turned(-40.0), Check::R19, Fail, "FAIL-19D-I");
    // boundary pair
    let wide = |angle: f64| {
        let scene = Scene::new(
            own(6.0).hold(60.0).turn(angle, 3.0).hold(500.0),
            target(2400.0, 180.0, 180.0, 6.0),
        );
        fog(scene, 50.0)
    };
    expect(&wide(-9.7), Check::R19, Warn, "FAIL-19D-I");
    expect(&wide(-10.3), Check::R19, Fail, "FAIL-19D-I");
}

/// Close quarters at 400 m: a pass at 300 m is no risk in sight of one another (200 m), but by
/// radar alone 19(d) asks for action in ample time, and forbids port.
#[test]
fn in_fog_close_quarters_open_the_duty() {
    let passes = |visual_range_m: Option<f64>, turn_deg: f64| {
        let own = own(6.0).hold(60.0).turn(turn_deg, 3.0).hold(500.0);
        let mut scene = Scene::new(own, target(2400.0, 300.0, 180.0, 6.0));
        if let Some(visual_range_m) = visual_range_m {
            scene.visibility = Visibility::Restricted { visual_range_m };
        }
        judge_by(with("close_quarters_m", 400.0), &scene.trace())
    };
    let to_port = passes(Some(50.0), -40.0);
    expect(&to_port, Check::R19, Fail, "FAIL-19D-I");
    expect(&passes(Some(50.0), 40.0), Check::R19, Pass, "");
    expect(&passes(Some(50.0), 15.0), Check::R8Magnitude, Fail, "FAIL-8-NOT-APPARENT");
    // in sight, and seen before the range of stage 2, the risk of Rule 7 alone opens anything
    for sight in [None, Some(2200.0)] {
        let seen = passes(sight, -40.0);
        assert_eq!(seen.pairs[0].risk_s, None);
        expect(&seen, Check::R19, NotApplicable, "");
    }
    // a larger distance of risk is not narrowed by close quarters
    let kept = fog(Scene::new(own(6.0).hold(400.0), target(2400.0, 180.0, 180.0, 6.0)), 20.0);
    assert!(kept.pairs[0].risk_s.is_some());
}

#[test]
fn in_fog_towards_a_ship_abaft_the_beam_fails() {
    let astern = || target(-1100.0, 1000.0, -30.0, 8.0);
    let turned = |angle: f64| {
        fog(Scene::new(own(3.0).hold(30.0).turn(angle, 3.0).hold(700.0), astern()), 20.0)
    };
    expect(&turned(40.0), Check::R19, Fail, "FAIL-19D-II");
    assert_ne!(verdict(&turned(-40.0), Check::R19).detail, "FAIL-19D-II");
}

#[test]
fn in_fog_she_takes_her_way_off_at_close_quarters() {
    let kept = fog(Scene::new(own(6.0).hold(400.0), target(2400.0, 80.0, 180.0, 6.0)), 20.0);
    expect(&kept, Check::R19, Fail, "FAIL-19E");
    let slowed = Scene::new(
        own(6.0).hold(60.0).speed_to(1.5, 0.2).hold(500.0),
        target(2400.0, 80.0, 180.0, 6.0),
    );
    expect(&fog(slowed, 20.0), Check::R19, Pass, "");
}

#[test]
fn rule_19_does_not_apply_in_sight() {
    let judgement = judge(&Scene::new(own(6.0).hold(500.0), head_on()));
    expect(&judgement, Check::R19, NotApplicable, "");
}

/// Named in section 16: the ships come in sight at 500 m.
#[test]
fn on_coming_in_sight_the_rules_change() {
    // 500 m apart at 2400 - 12 t = 500, 158.4 s; she turns to port in sight
    let scene = Scene::new(own(6.0).hold(165.0).turn(-40.0, 8.0).hold(400.0), head_on());
    let judgement = fog(scene, 500.0);
    expect(&judgement, Check::R14, Fail, "FAIL-14-PORT");
    expect(&judgement, Check::Turn, Fail, "FAIL-14-PORT");
    assert_ne!(verdict(&judgement, Check::R19).detail, "FAIL-19D-I");
    assert_eq!((judgement.pairs[0].risk_s, judgement.pairs[0].role), (Some(42.0), Role::Both));
    // and to port out of sight
    let before = Scene::new(own(6.0).hold(100.0).turn(-40.0, 8.0).hold(400.0), head_on());
    expect(&fog(before, 500.0), Check::R19, Fail, "FAIL-19D-I");
}

/// A pass too narrow to close the risk that was there, and too wide to open one, is no new onset.
#[test]
fn what_was_settled_by_radar_opens_no_risk_in_sight() {
    let seen_after = |turn_deg: f64| {
        let scene = Scene::new(own(6.0).hold(60.0).turn(turn_deg, 3.0).hold(400.0), head_on());
        let mut wide = scene.trace();
        wide.visibility = Visibility::Restricted { visual_range_m: 500.0 };
        (wide.pairs[0].minimum.hull_m, judge_by(rules(), &wide))
    };
    let (wide_m, settled) = seen_after(16.0);
    assert!((200.0..240.0).contains(&wide_m), "{wide_m}");
    assert_eq!(settled.pairs[0].role, Role::None);
    let (near_m, open) = seen_after(13.0);
    assert!((150.0..200.0).contains(&near_m), "{near_m}");
    assert_ne!(open.pairs[0].role, Role::None);
}

fn last_minute(own_last: LastInstant, act_at_s: f64) -> Judgement {
    let mut trace =
        Scene::new(own(6.0).hold(act_at_s).turn(40.0, 4.0).hold(400.0), head_on()).trace();
    let never = LastInstant::NeverCritical;
    trace.last_minute = Some(vec![Some(LastMinute {
        own: own_last,
        own_any_turn: own_last,
        own_near_miss: never,
        target: never,
    })]);
    judge_by(rules(), &trace)
}

#[test]
fn last_minute_margin_is_read_from_the_trace() {
    // the smoothed rate reaches its threshold about two seconds before the turn at 80 s
    expect(&last_minute(LastInstant::At(150.0), 80.0), Check::LastMinute, Pass, "");
    expect(&last_minute(LastInstant::At(85.0), 80.0), Check::LastMinute, Warn, "LAST-MINUTE");
    expect(&last_minute(LastInstant::At(70.0), 80.0), Check::LastMinute, Fail, "IN-EXTREMIS");
    expect(
        &last_minute(LastInstant::At(70.0), 80.0),
        Check::R8Time,
        Fail,
        "FAIL-8-AFTER-LAST-INSTANT",
    );
    expect(&last_minute(LastInstant::NeverCritical, 80.0), Check::LastMinute, NotApplicable, "");
    expect(
        &last_minute(LastInstant::BeforeStart, 80.0),
        Check::LastMinute,
        Inconclusive,
        "TOO-LATE-AT-START",
    );
    expect(
        &last_minute(LastInstant::Indicative(150.0), 80.0),
        Check::LastMinute,
        Pass,
        "INDICATIVE",
    );
    let without = judge(&Scene::new(own(6.0).hold(500.0), head_on()));
    expect(&without, Check::LastMinute, NotEvaluated, "NO-LAST-MINUTE-DATA");
}

/// A ship that crosses from port goes straight on; own ship turns at a time. Stage 4 is at 277 s.
fn shall_act(target_last: LastInstant, act_at_s: f64) -> Judgement {
    let mut trace =
        Scene::new(own(6.0).hold(act_at_s).turn(60.0, 10.0).hold(700.0), from_port()).trace();
    let never = LastInstant::NeverCritical;
    trace.last_minute = Some(vec![Some(LastMinute {
        own: never,
        own_any_turn: never,
        own_near_miss: never,
        target: target_last,
    })]);
    judge_by(rules(), &trace)
}

#[test]
fn she_shall_act_from_the_targets_last_instant_or_stage_4() {
    expect(&shall_act(LastInstant::At(262.0), 255.0), Check::R17Shall, Pass, "");
    expect(&shall_act(LastInstant::At(262.0), 275.0), Check::R17Shall, Fail, "FAIL-17B");
    // never the later of the two
    expect(&shall_act(LastInstant::Indicative(290.0), 279.0), Check::R17Shall, Pass, "");
    expect(&shall_act(LastInstant::Indicative(290.0), 288.0), Check::R17Shall, Fail, "FAIL-17B");
    // helpless from the start: the duty waits for the onset of risk
    let helpless = shall_act(LastInstant::BeforeStart, 280.0);
    expect(&helpless, Check::R17Shall, Fail, "FAIL-17B");
    assert_eq!(verdict(&helpless, Check::R17Shall).t_s, helpless.pairs[0].risk_s);
}

#[test]
fn what_nothing_could_help_is_not_held_against_her() {
    let late = last_minute(LastInstant::At(70.0), 80.0);
    expect(&late, Check::R8Time, Fail, "FAIL-8-AFTER-LAST-INSTANT");
    let never = last_minute(LastInstant::BeforeStart, 80.0);
    assert_ne!(verdict(&never, Check::R8Time).status, Fail);
}
