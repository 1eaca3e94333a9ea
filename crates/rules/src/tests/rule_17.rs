//! Rule 17: hold, may act, shall act, not to port.

use super::*;
use Status::{Fail, NotApplicable, Pass, Warn};

fn stand_on(script: Script) -> Judgement {
    judge(&Scene::new(script.hold(700.0), from_port()))
}

/// The other passes 70 m astern, so that nobody needs to act.
fn passed_astern(script: Script) -> Judgement {
    judge(&Scene::new(script.hold(600.0), target(1800.0, -1920.0, 90.0, 6.0)))
}

#[test]
fn holding_complies() {
    expect(&passed_astern(own(6.0)), Check::R17Hold, Pass, "");
}

/// Past and clear ends the duty: the way back to where the ships meet again is no breach of it.
#[test]
fn a_turn_after_release_is_no_departure_though_the_ships_meet_closer_later() {
    let she = || Script::new(ship(40.0, 8.0), 1800.0, -2100.0, deg(90.0), 6.0);
    let meets = |again: bool| {
        let own_ship = if again { own(6.0).hold(450.0).turn(140.0, 10.0) } else { own(6.0) };
        let other = if again { she().hold(450.0).speed_to(1.0, 0.5) } else { she() };
        judge(&Scene::new(own_ship.hold(500.0), other.hold(900.0)))
    };
    for again in [false, true] {
        let judgement = meets(again);
        let facts = &judgement.pairs[0];
        let (cpa_s, released_s) = (facts.cpa_s.unwrap(), facts.released_s.unwrap());
        assert!(released_s < 450.0 && (cpa_s > 500.0) == again, "{facts:#?}");
        expect(&judgement, Check::R17Hold, Pass, "");
        expect(&judgement, Check::R8Dribble, NotApplicable, "");
    }
}

#[test]
fn altering_in_stage_2_fails_and_a_small_yaw_warns() {
    // stage 2 begins at 77 s, stage 3 at 218 s
    let turned = |angle: f64| stand_on(own(6.0).hold(100.0).turn(angle, 3.0).hold(60.0));
    expect(&turned(20.0), Check::R17Hold, Fail, "FAIL-17AI");
    expect(&turned(9.8), Check::R17Hold, Warn, "UNSTEADY");
    expect(&turned(10.2), Check::R17Hold, Fail, "FAIL-17AI");
    expect(&turned(1.8), Check::R17Hold, Pass, "");
    let slowed = |to: f64| stand_on(own(6.0).hold(100.0).speed_to(to, 0.2).hold(60.0));
    expect(&slowed(4.4), Check::R17Hold, Fail, "FAIL-17AI");
    expect(&slowed(4.6), Check::R17Hold, Warn, "UNSTEADY");
}

/// She slows before stage 2 and gains speed again in it: what counts is the speed at its entry.
#[test]
fn speed_is_held_against_that_at_the_entry_of_stage_2() {
    let script = own(6.0).hold(70.0).speed_to(4.7, 0.2).hold(30.0).speed_to(6.0, 0.2).hold(60.0);
    expect(&stand_on(script), Check::R17Hold, Fail, "FAIL-17AI");
}

/// Her mean heading is 10 degrees off for a second or two.
#[test]
fn a_departure_of_the_mean_heading_must_be_held() {
    let pulse = |seconds: f64| {
        let script = own(6.0).hold(100.0).turn(10.2, 10.0).hold(seconds).turn(-10.2, 10.0);
        stand_on(script.hold(60.0))
    };
    expect(&pulse(30.0), Check::R17Hold, Warn, "UNSTEADY");
    expect(&pulse(40.0), Check::R17Hold, Fail, "FAIL-17AI");
}

/// The moment needs a pass predicted below the minimum: a metre above it, acting in stage 3 is
/// acting before she may.
#[test]
fn a_pass_predicted_above_the_minimum_gives_no_right_to_act() {
    let script = own(6.0).hold(240.0).turn(60.0, 6.0).hold(500.0);
    let trace = Scene::new(script, target(1800.0, -1950.0, 90.0, 6.0)).trace();
    let planned_m = trace.nominal.as_ref().unwrap().minima[0].hull_m;
    let by = |r_min_m: f64| judge_by(with("r_min_m", r_min_m), &trace);
    let may = by(planned_m + 1.0);
    expect(&may, Check::R17Hold, Pass, "");
    expect(&may, Check::R17May, Pass, "ACTED");
    let may_not = by(planned_m - 1.0);
    expect(&may_not, Check::R17Hold, Fail, "FAIL-17AI");
    expect(&may_not, Check::R17May, NotApplicable, "");
}

#[test]
fn from_stage_3_on_she_may_act() {
    let acted = stand_on(own(6.0).hold(225.0).turn(60.0, 6.0));
    expect(&acted, Check::R17Hold, Pass, "");
    expect(&acted, Check::R17May, Pass, "ACTED");
    // the moment itself is the entry of stage 3, 218 s
    assert_eq!(verdict(&acted, Check::R17May).t_s, Some(218.0));
    // the other gives way in time: the moment never comes
    let gives_way = Script::new(ship(40.0, 8.0), 1800.0, -1800.0, deg(90.0), 6.0)
        .hold(100.0)
        .turn(50.0, 2.0)
        .hold(700.0);
    let trace =
        Scene::new(own(6.0).hold(600.0), gives_way).nominal_targets(vec![from_port().hold(1000.0)]);
    let judgement = judge(&trace);
    expect(&judgement, Check::R17May, NotApplicable, "");
    expect(&judgement, Check::R17Hold, Pass, "");
    // boundary pair: she acts well before and just after it
    let before = stand_on(own(6.0).hold(200.0).turn(60.0, 6.0));
    expect(&before, Check::R17Hold, Fail, "FAIL-17AI");
}

/// The other gives way and then turns back towards own ship without a pause. Risk has closed, and a
/// prediction made from a turn opens none: own ship may not act before the other is steady.
#[test]
fn a_pass_that_a_turn_predicts_gives_no_right_to_act() {
    let other = |rate_degps: f64| {
        Script::new(ship(40.0, 8.0), 1800.0, -1800.0, deg(90.0), 6.0)
            .hold(100.0)
            .turn(30.0, 2.0)
            .hold(60.0)
            .turn(-80.0, rate_degps)
            .hold(500.0)
    };
    let may_act_s = |rate_degps: f64| {
        let scene = Scene::new(own(6.0).hold(600.0), other(rate_degps));
        let judgement = judge(&scene.nominal_targets(vec![from_port().hold(1000.0)]));
        verdict(&judgement, Check::R17May).t_s
    };
    // she turns from 175 s to 255 s, over 80 degrees; risk opens when the turn is over
    let may_s = may_act_s(1.0).expect("she comes on");
    assert!((255.0..265.0).contains(&may_s), "{may_s}");
    // and here she turns on until the pass is wide again
    assert_eq!(may_act_s(2.0), None);
}

/// She may act from 218 s on: a cut of her speed that begins with that second is by right, one that
/// has begun a second before is not.
#[test]
fn what_begins_at_the_moment_is_by_right() {
    let slows_at = |from_s: f64| stand_on(own(6.0).hold(from_s).speed_to(3.0, 2.0).hold(700.0));
    let by_right = slows_at(217.2);
    assert_eq!(verdict(&by_right, Check::R17May).t_s, Some(218.0));
    expect(&by_right, Check::R17Hold, Pass, "");
    let before = slows_at(216.0);
    expect(&before, Check::R17Hold, Fail, "FAIL-17AI");
}

#[test]
fn in_extremis_she_shall_act() {
    // stage 4 at 277 s; five seconds of grace
    expect(&stand_on(own(6.0)), Check::R17Shall, Fail, "FAIL-17B");
    expect(&stand_on(own(6.0).hold(280.0).turn(60.0, 10.0)), Check::R17Shall, Pass, "");
    expect(&stand_on(own(6.0).hold(288.0).turn(60.0, 10.0)), Check::R17Shall, Fail, "FAIL-17B");
    // begun under 17(a)(ii), twelve seconds before stage 4
    expect(&stand_on(own(6.0).hold(265.0).turn(30.0, 2.0)), Check::R17Shall, Pass, "");
    // begun so early that stage 4 never came
    expect(&stand_on(own(6.0).hold(225.0).turn(60.0, 6.0)), Check::R17Shall, NotApplicable, "");
    // to pass at 70 m is no near miss
    expect(&passed_astern(own(6.0)), Check::R17Shall, NotApplicable, "CLEARING");
    let give_way = judge(&Scene::new(own(6.0).hold(700.0), from_starboard()));
    expect(&give_way, Check::R17Shall, NotApplicable, "");
}

#[test]
fn not_to_port_for_a_ship_on_the_port_side() {
    let acted = |angle: f64| stand_on(own(6.0).hold(225.0).turn(angle, 6.0));
    expect(&acted(60.0), Check::R17Port, Pass, "");
    expect(&acted(-60.0), Check::R17Port, Fail, "FAIL-17C");
    expect(&acted(-9.8), Check::R17Port, Warn, "PORT");
    expect(&acted(-10.2), Check::R17Port, Fail, "FAIL-17C");
    let extremis = stand_on(own(6.0).hold(279.0).turn(-40.0, 8.0));
    expect(&extremis, Check::R17Port, Warn, "PORT-IN-EXTREMIS");
    let give_way = judge(&Scene::new(own(6.0).hold(700.0), from_starboard()));
    expect(&give_way, Check::R17Port, NotApplicable, "");
}

/// A yaw too slow for a run had put the other fine on her starboard bow when risk opened: the class
/// is that of the nominal track, and what she did was to starboard.
#[test]
fn a_ship_that_never_altered_to_port_kept_17c() {
    let script = own(6.0).hold(5.0).turn(-5.0, 0.3).hold(240.0).turn(60.0, 6.0).hold(400.0);
    let judgement = judge(&Scene::new(script, target(2400.0, -134.0, 150.0, 0.742)));
    assert_eq!(judgement.pairs[0].class, Some(EncounterClass::CrossingPort));
    assert!(judgement.pairs[0].risk_s.unwrap() > 30.0);
    expect(&judgement, Check::R17Port, Pass, "");
}

/// She acts to starboard by right and turns back before the closest point, the other abaft her beam
/// on the heading of the action: the rule was put to the test and kept.
#[test]
fn a_way_back_to_port_leaves_17c_applied() {
    let script = own(6.0).hold(225.0).turn(75.0, 8.0).hold(50.0).turn(-75.0, 8.0);
    expect(&stand_on(script), Check::R17Port, Pass, "");
}

#[test]
fn a_conservative_rule_set_fails_port_in_stage_4_too() {
    let text = rules().text().replace("port_in_stage_4 = \"warn\"", "port_in_stage_4 = \"fail\"");
    let trace = Scene::new(own(6.0).hold(279.0).turn(-40.0, 8.0).hold(400.0), from_port()).trace();
    let judgement = judge_by(RuleSet::parse(&text).unwrap(), &trace);
    expect(&judgement, Check::R17Port, Fail, "FAIL-17C");
    expect(&judgement, Check::Turn, Fail, "FAIL-17C");
}

/// A yaw of 1 degree rms, period 8 s, is a held course.
#[test]
fn a_yaw_in_a_seaway_is_a_held_course() {
    let mut script = own(6.0);
    for _ in 0..70 {
        script = script.turn(1.4, 0.7).turn(-2.8, 0.7).turn(1.4, 0.7);
    }
    let judgement = judge(&Scene::new(script, target(1800.0, -1920.0, 90.0, 6.0)));
    expect(&judgement, Check::R17Hold, Pass, "");
    expect(&judgement, Check::Turn, NotApplicable, "NO-TURN");
}

/// An encounter that begins inside stage 3: a close pass must have been predicted for 5 s first.
#[test]
fn the_moment_to_act_needs_five_seconds() {
    let other = target(420.0, -420.0, 90.0, 3.0);
    let judgement = judge(&Scene::new(own(3.0).hold(400.0), other));
    expect(&judgement, Check::R17May, Pass, "HELD");
    assert_eq!(verdict(&judgement, Check::R17May).t_s, Some(5.0));
}
