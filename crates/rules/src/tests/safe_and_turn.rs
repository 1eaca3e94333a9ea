//! SAFE and TURN, classes, reaction.

use super::*;
use Status::{Fail, Inconclusive, NotApplicable, Pass, Warn};
use geom::EncounterClass;
use record::{Reaction, Role};

#[test]
fn safe_passes_at_the_preferred_distance_and_fails_on_contact() {
    let clear = judge(&Scene::new(own(6.0).hold(60.0).turn(35.0, 3.0).hold(400.0), head_on()));
    expect(&clear, Check::Safe, Pass, "EXCELLENT");
    let hit = judge(&Scene::new(own(6.0).hold(500.0), target(2400.0, 2.0, 180.0, 6.0)));
    expect(&hit, Check::Safe, Fail, "FAIL-COLLISION");
    assert_eq!(verdict(&hit, Check::Safe).score, Some(0.0));
    let text = verdict(&hit, Check::Safe).sentence.clone().unwrap();
    assert!(text.starts_with("At 03:1") && text.contains("meeting head-on"), "{text}");
}

/// Boundary pair: the same voyage, the limit a centimetre on either side of its distance.
#[test]
fn safe_turns_at_the_minimum_distance() {
    let trace = Scene::new(own(6.0).hold(150.0).turn(35.0, 3.0).hold(300.0), head_on()).trace();
    let d = trace.pairs[0].minimum.hull_m;
    assert!(d > 50.0 && d < 190.0, "{d}");
    expect(&judge_by(with("r_min_m", d - 0.01), &trace), Check::Safe, Pass, "");
    expect(&judge_by(with("r_min_m", d + 0.01), &trace), Check::Safe, Fail, "FAIL-8D");
    let near = with("r_min_m", d + 2.0).with("r_nm_m", d + 0.01).unwrap();
    expect(&judge_by(near, &trace), Check::Safe, Fail, "FAIL-NEARMISS");
}

#[test]
fn a_stand_on_ship_is_not_failed_for_the_others_choice() {
    // passes 70 m astern of own ship, who holds as she must
    let close = Scene::new(own(6.0).hold(600.0), target(1800.0, -1920.0, 90.0, 6.0));
    let trace = close.trace();
    assert!((50.0..100.0).contains(&trace.pairs[0].minimum.hull_m), "{:?}", trace.pairs[0].minimum);
    expect(&judge(&close), Check::Safe, Warn, "CLOSE-BY-OTHER");
    // the mirror image has to give way
    let give_way = Scene::new(own(6.0).hold(600.0), target(1800.0, 1920.0, 270.0, 6.0));
    expect(&judge(&give_way), Check::Safe, Fail, "FAIL-8D");
}

/// The whole table of TURN for a turn of 35 degrees before stage 3.
#[test]
fn turn_direction_by_class_and_side() {
    let table = [
        (EncounterClass::HeadOn, 6.0, head_on(), 60.0, (Pass, ""), (Fail, "FAIL-14-PORT")),
        (EncounterClass::CrossingStbd, 6.0, from_starboard(), 90.0, (Pass, ""), (Warn, "PORT")),
        (EncounterClass::Overtaking, 8.0, slow_ahead(), 40.0, (Pass, ""), (Pass, "")),
        (
            EncounterClass::Overtaken,
            3.0,
            fast_astern(),
            40.0,
            (Warn, "BEFORE-17A"),
            (Warn, "BEFORE-17A"),
        ),
        (
            EncounterClass::CrossingPort,
            6.0,
            from_port(),
            90.0,
            (Warn, "BEFORE-17A"),
            (Fail, "FAIL-17C"),
        ),
        (EncounterClass::Static, 6.0, target(1500.0, 5.0, 90.0, 0.0), 40.0, (Pass, ""), (Pass, "")),
    ];
    for (class, speed, other, at, starboard, port) in table {
        for (angle, (status, detail)) in [(35.0, starboard), (-35.0, port)] {
            let scene = Scene::new(own(speed).hold(at).turn(angle, 3.0).hold(600.0), other.clone());
            let judgement = judge(&scene);
            assert_eq!(judgement.pairs[0].class, Some(class));
            expect(&judgement, Check::Turn, status, detail);
            let turn = judgement.pairs[0].first_turn_rad.unwrap();
            assert!((turn - deg(angle)).abs() < deg(0.5));
        }
    }
}

#[test]
fn a_stand_on_ship_may_turn_to_starboard_once_she_may_act() {
    // stage 3 at 218 s, and the other comes on
    let late = judge(&Scene::new(own(6.0).hold(225.0).turn(60.0, 6.0).hold(400.0), from_port()));
    expect(&late, Check::Turn, Pass, "");
    let port = judge(&Scene::new(own(6.0).hold(225.0).turn(-60.0, 6.0).hold(400.0), from_port()));
    expect(&port, Check::Turn, Fail, "FAIL-17C");
    // stage 4 at 277 s: "such action as will best aid"
    let extremis =
        judge(&Scene::new(own(6.0).hold(279.0).turn(-40.0, 8.0).hold(400.0), from_port()));
    expect(&extremis, Check::Turn, Warn, "PORT-IN-EXTREMIS");
}

#[test]
fn a_port_turn_for_a_ship_to_starboard_fails_when_it_crosses_ahead() {
    let scene = Scene::new(
        own(6.0).hold(130.0).turn(-12.0, 3.0).hold(600.0),
        target(1800.0, 1800.0, 270.0, 6.0),
    );
    let judgement = judge(&scene);
    expect(&judgement, Check::Turn, Fail, "FAIL-15-AHEAD");
    let text = verdict(&judgement, Check::Turn).sentence.clone().unwrap();
    let told = "a vessel crossing from starboard, own ship altered 12 degrees to port and passed";
    assert!(text.contains(told), "{text}");
    assert!(text.ends_with("m ahead of her bow. Rule 15."), "{text}");
}

/// Boundary pair: a port turn of just less and just more than 10 degrees in a head-on encounter.
#[test]
fn a_small_turn_to_the_wrong_side_is_a_warning() {
    let turned = |angle: f64| {
        judge(&Scene::new(own(6.0).hold(60.0).turn(angle, 3.0).hold(500.0), head_on()))
    };
    expect(&turned(-9.7), Check::Turn, Warn, "SMALL");
    expect(&turned(-10.3), Check::Turn, Fail, "FAIL-14-PORT");
}

/// The first run of 10 degrees decides, not a smaller one before it.
#[test]
fn a_yaw_before_the_turn_does_not_decide() {
    let scene = own(6.0).hold(60.0).turn(-5.0, 3.0).hold(30.0).turn(40.0, 3.0).hold(400.0);
    expect(&judge(&Scene::new(scene, head_on())), Check::Turn, Pass, "");
}

#[test]
fn turn_does_not_apply_without_a_turn() {
    let slower =
        judge(&Scene::new(own(6.0).hold(90.0).speed_to(2.0, 0.2).hold(600.0), from_starboard()));
    expect(&slower, Check::Turn, NotApplicable, "NO-TURN");
    assert!(matches!(slower.pairs[0].reaction, Reaction::After(s) if (8.0..18.0).contains(&s)));
    let none = judge(&Scene::new(own(6.0).hold(600.0), target(1800.0, 900.0, 0.0, 6.0)));
    expect(&none, Check::Turn, NotApplicable, "");
    assert_eq!(none.pairs[0].reaction, Reaction::NoRisk);
    expect(&none, Check::Safe, Pass, "EXCELLENT");
}

#[test]
fn reaction_runs_from_onset_to_two_degrees_and_to_thirty() {
    // risk opens at 42 s (2400 - 12 t < 1900); 2 degrees at 3 deg/s take 0.67 s, 30 take 10 s
    let scene = Scene::new(own(6.0).hold(60.0).turn(35.0, 3.0).hold(400.0), head_on());
    let facts = judge(&scene).pairs[0].clone();
    assert_eq!((facts.risk_s, facts.role), (Some(42.0), Role::Both));
    let Reaction::After(reaction_s) = facts.reaction else { panic!("{facts:?}") };
    let Reaction::After(apparent_s) = facts.apparent else { panic!("{facts:?}") };
    assert!((reaction_s - 18.667).abs() < 0.1, "{reaction_s}");
    assert!((apparent_s - 28.0).abs() < 0.1, "{apparent_s}");
    // late confirmation of the track moves the clock
    let mut trace = scene.trace();
    trace.pairs[0].tracked_s = Some(55.0);
    let late = judge_by(rules(), &trace).pairs[0].clone();
    assert!(matches!(late.reaction, Reaction::After(s) if (s - 5.667).abs() < 0.1), "{late:?}");
}

#[test]
fn never_and_unknown_differ() {
    let never = judge(&Scene::new(own(6.0).hold(500.0), target(2400.0, 80.0, 180.0, 6.0)));
    assert_eq!(never.pairs[0].reaction, Reaction::Never);
    let cut = judge(&Scene::new(own(6.0).hold(100.0), target(2400.0, 80.0, 180.0, 6.0)));
    assert_eq!(cut.pairs[0].reaction, Reaction::Unknown);
    expect(&cut, Check::Safe, Inconclusive, "EXCELLENT");
    expect(&cut, Check::Turn, Inconclusive, "NO-TURN");
}
