//! Rules 14, 15 and 16.

use super::*;
use Status::{Fail, Inconclusive, NotApplicable, Pass, Warn};

fn meet(script: Script) -> Judgement {
    judge(&Scene::new(script.hold(500.0), head_on()))
}

fn cross(script: Script) -> Judgement {
    judge(&Scene::new(script.hold(700.0), from_starboard()))
}

#[test]
fn head_on_to_starboard_complies() {
    let judgement = meet(own(6.0).hold(60.0).turn(35.0, 3.0));
    expect(&judgement, Check::R14, Pass, "");
    assert!(verdict(&judgement, Check::R14).score.unwrap() > 0.3);
}

#[test]
fn head_on_to_port_fails() {
    expect(&meet(own(6.0).hold(60.0).turn(-35.0, 3.0)), Check::R14, Fail, "FAIL-14-PORT");
}

#[test]
fn head_on_by_speed_alone_fails() {
    expect(&meet(own(6.0).hold(60.0).speed_to(1.0, 0.3)), Check::R14, Fail, "FAIL-14-NOACT");
}

/// Boundary pair at 10 degrees to starboard.
#[test]
fn head_on_needs_ten_degrees() {
    expect(&meet(own(6.0).hold(45.0).turn(9.8, 3.0)), Check::R14, Fail, "FAIL-14-NOACT");
    let small = meet(own(6.0).hold(45.0).turn(10.2, 3.0));
    expect(&small, Check::R14, Warn, "SMALL");
}

#[test]
fn head_on_with_a_yaw_to_port_first_is_a_warning() {
    let yawed = meet(own(6.0).hold(50.0).turn(-4.0, 2.0).hold(8.0).turn(45.0, 3.0));
    expect(&yawed, Check::R14, Warn, "YAW-TO-PORT");
}

#[test]
fn head_on_does_not_apply_to_a_crossing() {
    expect(&cross(own(6.0).hold(90.0).turn(35.0, 3.0)), Check::R14, NotApplicable, "");
}

#[test]
fn crossing_astern_complies_by_course_or_speed() {
    expect(&cross(own(6.0).hold(90.0).turn(40.0, 3.0)), Check::R15, Pass, "");
    expect(&cross(own(6.0).hold(90.0).speed_to(2.0, 0.3)), Check::R15, Pass, "");
}

#[test]
fn crossing_ahead_fails() {
    // gains speed and passes close ahead of her
    let judgement = cross(own(6.0).hold(90.0).speed_to(7.0, 0.3));
    expect(&judgement, Check::R15, Fail, "FAIL-15-AHEAD");
    let text = verdict(&judgement, Check::R15).sentence.clone().unwrap();
    assert!(text.contains("m ahead of her bow. Rule 15."), "{text}");
}

/// Boundary pair: the preferred distance on either side of how far ahead she crossed.
#[test]
fn crossing_ahead_counts_within_the_preferred_distance() {
    let trace =
        Scene::new(own(6.0).hold(90.0).speed_to(7.0, 0.3).hold(700.0), from_starboard()).trace();
    let ahead = |rules: RuleSet| judge_by(rules, &trace);
    let found = ahead(rules());
    let evidence = &verdict(&found, Check::R15).evidence;
    let ahead_m = evidence.iter().find(|e| e.name == "ahead_of_bow").unwrap().value;
    assert!((101.0..199.0).contains(&ahead_m), "{ahead_m}");
    expect(&ahead(with("r_pref_m", ahead_m + 0.5)), Check::R15, Fail, "FAIL-15-AHEAD");
    expect(&ahead(with("r_pref_m", ahead_m - 0.5)), Check::R15, Pass, "");
}

/// Named in section 16: the give-way ship turns to port but passes astern.
#[test]
fn a_port_turn_that_passes_astern_is_a_warning() {
    // nearly round to port and behind her
    let judgement = cross(own(6.0).hold(90.0).turn(-100.0, 6.0));
    expect(&judgement, Check::R15, Warn, "PORT");
    expect(&judgement, Check::Turn, Warn, "PORT");
}

#[test]
fn crossing_rules_do_not_apply_to_the_stand_on_ship() {
    let judgement = judge(&Scene::new(own(6.0).hold(700.0), from_port()));
    expect(&judgement, Check::R15, NotApplicable, "");
    expect(&judgement, Check::R16, NotApplicable, "");
}

#[test]
fn give_way_is_early_substantial_and_well_clear() {
    let good = cross(own(6.0).hold(90.0).turn(40.0, 3.0));
    expect(&good, Check::R16, Pass, "");
    assert!((verdict(&good, Check::R16).score.unwrap() - 1.0).abs() < 1e-9);
    expect(&cross(own(6.0)), Check::R16, Fail, "FAIL-8-NO-ACTION");
    let late = cross(own(6.0).hold(245.0).turn(60.0, 6.0));
    assert_ne!(verdict(&late, Check::R16).status, Pass);
    // boundary pair: the size of Rule 8(b)
    expect(&cross(own(6.0).hold(90.0).turn(29.8, 3.0)), Check::R16, Warn, "NOT-APPARENT");
    expect(&cross(own(6.0).hold(90.0).turn(30.2, 3.0)), Check::R16, Pass, "");
    // both ships of a head-on encounter alter, but none is the give-way vessel
    expect(&meet(own(6.0).hold(60.0).turn(35.0, 3.0)), Check::R16, NotApplicable, "");
    let cut = judge(&Scene::new(own(6.0).hold(120.0), from_starboard()));
    assert_eq!(verdict(&cut, Check::R16).status, Inconclusive);
}

/// She turns away to port before the other's bow and draws ahead: the range grows and risk is over
/// when she crosses the other's track. She stops there, and is passed closer than before.
#[test]
fn crossing_ahead_when_risk_is_over_is_no_breach_of_rule_15() {
    let script = |crosses_at_once: bool| {
        let comes = Script::new(ship(10.0, 3.0), 0.0, -600.0, deg(90.0), 8.0).hold(60.0);
        let away = if crosses_at_once { comes } else { comes.turn(-90.0, 6.0).hold(10.0) };
        let over = away.turn(if crosses_at_once { -30.0 } else { 30.0 }, 3.0).hold(8.0);
        over.turn(-30.0, 6.0).speed_to(0.3, 0.5).hold(100.0)
    };
    let judged = |at_once| judge(&Scene::new(script(at_once), target(-375.0, 0.0, 0.0, 5.0)));
    let over = judged(false);
    assert_eq!(over.pairs[0].class, Some(geom::EncounterClass::CrossingStbd));
    assert!(over.pairs[0].cpa_s.unwrap() > 115.0, "{over:#?}");
    expect(&over, Check::R15, Warn, "PORT");
    expect(&over, Check::Turn, Warn, "PORT");
    expect(&judged(true), Check::R15, Fail, "FAIL-15-AHEAD");
}
