//! The window of action, and which run in it is the action (section 5).

use super::*;
use Status::{Fail, NotApplicable, Pass, Warn};
use record::Reaction;

fn detected_at(t_s: f64, script: Script, other: Script) -> Judgement {
    let mut trace = Scene::new(script, other).trace();
    trace.pairs[0].detected_s = Some(t_s);
    trace.pairs[0].tracked_s = Some(t_s);
    judge_by(rules(), &trace)
}

/// Smoothing moves the start of a brisk turn seconds before it: the ship herself did not turn
/// before she saw the other.
#[test]
fn an_alteration_begun_in_the_second_of_detection_counts() {
    let judgement = detected_at(100.0, own(6.0).hold(100.0).turn(20.0, 5.0).hold(500.0), head_on());
    expect(&judgement, Check::Turn, Pass, "");
    expect(&judgement, Check::R8Magnitude, Warn, "NOT-APPARENT");
    assert_ne!(judgement.status(Check::R14), Fail);
    let facts = &judgement.pairs[0];
    let turn_deg = geom::units::to_deg(facts.first_turn_rad.unwrap());
    assert!((turn_deg - 20.0).abs() < 1.0, "{turn_deg}");
    let Reaction::After(reaction_s) = facts.reaction else { panic!("{:?}", facts.reaction) };
    assert!((0.0..1.0).contains(&reaction_s), "{reaction_s}");
    // and the planner's latency is counted from no instant before the ship moved
    let time = &verdict(&judgement, Check::R8Time).evidence;
    let t_man = time.iter().find(|e| e.name == "t_man").unwrap().value;
    assert!((100.0..=101.0).contains(&t_man), "{t_man}");
}

#[test]
fn an_alteration_made_before_detection_does_not_count() {
    let judgement = detected_at(100.0, own(6.0).hold(80.0).turn(20.0, 5.0).hold(500.0), head_on());
    expect(&judgement, Check::Turn, NotApplicable, "NO-TURN");
    assert_eq!(judgement.pairs[0].first_turn_rad, None);
}

/// A small alteration that clears, and a larger one back to the route.
#[test]
fn a_way_back_is_not_the_action() {
    let script = own(6.0).hold(45.0).turn(9.2, 3.0).hold(125.0).turn(-12.3, 3.0).hold(300.0);
    let judgement = judge(&Scene::new(script, target(2400.0, -20.0, 180.0, 6.0)));
    expect(&judgement, Check::Turn, Pass, "");
    expect(&judgement, Check::R8Magnitude, Warn, "SMALL");
    assert!(judgement.pairs[0].first_turn_rad.unwrap() > 0.0);
}

/// A departure so slow that it is no run, and a brisk way back from it at the closest point.
#[test]
fn a_way_back_from_a_slow_departure_is_no_action() {
    let script = own(6.0).hold(45.0).turn(-4.0, 0.4).hold(135.0).turn(4.0, 2.0).hold(300.0);
    let judgement = judge(&Scene::new(script, target(2400.0, 120.0, 180.0, 6.0)));
    expect(&judgement, Check::Turn, NotApplicable, "NO-TURN");
    assert_eq!(judgement.pairs[0].first_turn_rad, None);
}

/// A yaw while the pass is predicted clear, and an alteration to the other side of the first
/// course: that is no way back.
#[test]
fn an_alteration_past_the_first_course_is_an_action() {
    let other = target(2400.0, -150.0, 180.0, 6.0);
    let script = own(6.0).hold(45.0).turn(-2.5, 2.0).hold(20.0).turn(40.0, 3.0).hold(500.0);
    let judgement = judge(&Scene::new(script, other));
    expect(&judgement, Check::Turn, Pass, "");
    assert!(judgement.pairs[0].first_turn_rad.unwrap() > deg(35.0));
}

/// Four small turns to starboard, and before the closest point a brisk way back to the line of the
/// route, which goes far past its course: a return all the same.
#[test]
fn a_way_back_past_the_first_course_is_no_action() {
    let small = |script: Script| script.turn(8.5, 3.0).hold(22.0);
    let acted = small(small(small(small(own(6.0).hold(45.0))))).hold(18.0);
    let judgement = judge(&Scene::new(acted.turn(-75.0, 8.0).hold(400.0), head_on()));
    expect(&judgement, Check::Turn, Pass, "");
    let facts = &judgement.pairs[0];
    assert!(facts.first_turn_rad.unwrap() > 0.0, "{facts:#?}");
    assert!(verdict(&judgement, Check::R8Magnitude).status == Pass);
    expect(&judgement, Check::R8Dribble, Fail, "FAIL-8-DRIBBLE");
}

/// Speed that was lost too slowly for a run, and is taken up again when the pass is clear: what she
/// gave up is measured from before she did.
#[test]
fn speed_taken_up_again_is_no_action() {
    let slow = own(6.0).hold(60.0).speed_to(5.2, 0.02).hold(70.0).speed_to(6.0, 0.2);
    let judgement = judge(&Scene::new(slow.hold(400.0), target(2400.0, 130.0, 180.0, 6.0)));
    let found = verdict(&judgement, Check::R8Magnitude);
    let x_u = found.evidence.iter().find(|e| e.name == "x_u").unwrap().value;
    assert!((x_u - 0.8 / 6.0).abs() < 0.01, "{found:#?}");
    assert!(found.t_s.unwrap() < 100.0, "{found:#?}");
}

/// A turn to port before risk opened was free; that she then never went to starboard was not.
#[test]
fn an_early_port_turn_does_not_stand_for_the_starboard_one() {
    let script = own(6.0).hold(2.0).turn(-14.0, 5.0).hold(15.0).turn(14.0, 5.0).hold(500.0);
    let judgement = judge(&Scene::new(script, head_on()));
    expect(&judgement, Check::R14, Fail, "FAIL-14-NOACT");
    let script = own(6.0).hold(2.0).turn(-14.0, 5.0).hold(15.0).turn(14.0, 5.0).hold(40.0);
    let judgement = judge(&Scene::new(script.turn(35.0, 3.0).hold(500.0), head_on()));
    expect(&judgement, Check::R14, Warn, "EARLY");
}
