//! Rule 13: overtaking, and its persistence.

use super::*;
use Status::{Fail, Inconclusive, NotApplicable, Pass};

fn overtake(angle_deg: f64) -> Script {
    own(8.0).hold(40.0).turn(angle_deg, 3.0).hold(150.0).turn(-angle_deg, 3.0)
}

/// Holds on astern of her to 350 m, then alters and passes clear all the same.
pub(super) fn late() -> Script {
    own(8.0).hold(230.0).turn(40.0, 6.0).hold(80.0).turn(-40.0, 6.0).hold(600.0)
}

#[test]
fn either_side_complies() {
    for side in [1.0, -1.0] {
        let judgement = judge(&Scene::new(overtake(side * 20.0).hold(600.0), slow_ahead()));
        expect(&judgement, Check::R13, Pass, "");
        assert!(judgement.pairs[0].released_s.is_some());
    }
}

#[test]
fn keeping_too_close_is_13a() {
    let judgement = judge(&Scene::new(overtake(2.5).hold(600.0), slow_ahead()));
    expect(&judgement, Check::R13, Fail, "FAIL-13A");
}

#[test]
fn a_run_that_ends_before_release_shows_nothing_of_13d() {
    // CPA at about 300 s, past and clear later
    let judgement = judge(&Scene::new(overtake(20.0).hold(100.0), slow_ahead()));
    assert!(judgement.pairs[0].cpa_s.is_some());
    expect(&judgement, Check::R13, Inconclusive, "NOT-RELEASED");
}

/// Past and clear ends the duty: the ships may meet again, and that is another encounter.
#[test]
fn a_second_meeting_is_no_part_of_the_first() {
    // long past and clear she goes nearer to the other's line, stops, and is met again
    let nearer = overtake(20.0).hold(300.0).turn(-90.0, 3.0);
    let script = nearer.speed_to(0.3, 0.5).hold(400.0);
    let judgement = judge(&Scene::new(script, slow_ahead()));
    let facts = &judgement.pairs[0];
    assert!(facts.cpa_s.unwrap() > 600.0 && facts.released_s.unwrap() < 600.0, "{facts:#?}");
    expect(&judgement, Check::R13, Pass, "");
}

/// Named in section 16: overtaking, then drawing across her bow.
#[test]
fn overtaking_then_crossing_her_bow_is_13d() {
    // past her beam to starboard at 250 m, then back across ahead of her
    let script = own(8.0).hold(40.0).turn(15.0, 3.0).hold(288.0).turn(-75.0, 6.0).hold(500.0);
    let judgement = judge(&Scene::new(script, slow_ahead()));
    let found = verdict(&judgement, Check::R13);
    assert_eq!((found.status, found.detail.as_ref()), (Fail, "FAIL-13D-AHEAD"), "{found:#?}");
    let text = found.sentence.clone().unwrap();
    assert!(text.contains("own ship, overtaking, crossed") && text.ends_with("Rule 13."), "{text}");
    assert_eq!(judgement.pairs[0].class, Some(geom::EncounterClass::Overtaking));
}

/// Boundary pair: the same crossing ahead, the preferred distance a metre on either side of it.
#[test]
fn crossing_ahead_counts_within_the_preferred_distance() {
    let script = own(8.0).hold(40.0).turn(15.0, 3.0).hold(288.0).turn(-75.0, 6.0).hold(500.0);
    let trace = Scene::new(script, slow_ahead()).trace();
    let found = judge_by(rules(), &trace);
    let ahead_m = 200.0 + verdict(&found, Check::R13).margin.unwrap();
    assert!((101.0..199.0).contains(&ahead_m), "{ahead_m}");
    let inside = judge_by(with("r_pref_m", ahead_m + 1.0), &trace);
    expect(&inside, Check::R13, Fail, "FAIL-13D-AHEAD");
    let outside = judge_by(with("r_pref_m", ahead_m - 1.0), &trace);
    assert_ne!(verdict(&outside, Check::R13).detail, "FAIL-13D-AHEAD");
}

/// Own ship on the quarter of a ship of 3 m/s, 420 m off her line to `side`: abeam of her 17 s
/// after 95 s of holding on, past and clear of her 50 s later.
fn beside(side: f64, hold_s: f64) -> Script {
    overtake(side * 20.0).hold(hold_s)
}

/// Swerves `angle_deg` to starboard, and back before she comes near.
fn swerve(script: Script, angle_deg: f64) -> Trace {
    let back_deg = 1.1 * angle_deg;
    Scene::new(script.turn(angle_deg, 6.0).hold(4.0).turn(-back_deg, 6.0).hold(500.0), slow_ahead())
        .trace()
}

#[test]
fn turning_in_on_her_before_release_is_13d() {
    for side in [1.0, -1.0] {
        let judgement = judge_by(rules(), &swerve(beside(side, 95.0), -side * 50.0));
        expect(&judgement, Check::R13, Fail, "FAIL-13D-TURN");
        let text = verdict(&judgement, Check::R13).sentence.clone().unwrap();
        let to = if side > 0.0 { "port" } else { "starboard" };
        let told = format!("not yet past and clear, altered 50 degrees to {to}, to pass at");
        assert!(text.contains(&told), "{text}");
        // and nothing else: she never came near
        expect(&judgement, Check::Safe, Pass, "EXCELLENT");
        // away from her
        expect(&judge_by(rules(), &swerve(beside(side, 95.0), side * 50.0)), Check::R13, Pass, "");
    }
}

/// Boundary pairs: the size of the turn, and the pass that it leads to, on either side of the
/// limits; then where it is made.
#[test]
fn turning_in_counts_from_a_size_into_a_pass_and_forward_of_her_quarter() {
    let trace = swerve(beside(1.0, 95.0), -50.0);
    let found = judge_by(rules(), &trace);
    let found = verdict(&found, Check::R13);
    assert_eq!(found.t_s, Some(298.0));
    let pass_m = 100.0 + found.margin.unwrap();
    assert!((55.0..75.0).contains(&pass_m), "{pass_m}");
    let above = |key: &str, value: f64| {
        let rules = with("apparent_turn_deg", 60.0).with(key, value).unwrap();
        judge_by(rules, &trace)
    };
    expect(&above("substantial_turn_deg", 49.0), Check::R13, Fail, "FAIL-13D-TURN");
    expect(&above("substantial_turn_deg", 51.0), Check::R13, Pass, "");
    expect(&above("r_min_m", pass_m + 1.0), Check::R13, Fail, "FAIL-13D-TURN");
    expect(&above("r_min_m", pass_m - 1.0), Check::R13, Pass, "");
    // at 40 s she is still in the sector of 13(b), at 165 s she is past and clear
    for (hold_s, angle_deg) in [(40.0, -33.0), (165.0, -102.0)] {
        let trace = swerve(beside(1.0, hold_s), angle_deg);
        expect(&judge_by(rules(), &trace), Check::R13, Pass, "");
    }
}

/// "So that": a turn by which the pass becomes wider is no breach, though it is towards her line
/// and the pass still a close one. She would have gone 26 m ahead of her, and goes 70 m astern.
#[test]
fn a_turn_that_makes_the_pass_wider_is_none() {
    let converging = |turn_deg: f64| {
        Script::new(ship(10.0, 3.0), 0.0, 0.0, deg(-40.0), 8.0)
            .hold(126.0)
            .turn(turn_deg, 6.0)
            .hold(3.0)
            .turn(80.0 - turn_deg, 6.0)
            .hold(500.0)
    };
    let meets = |turn_deg: f64| {
        let judgement = judge(&Scene::new(converging(turn_deg), target(487.0, -900.0, 0.0, 3.0)));
        assert_eq!(judgement.pairs[0].class, Some(EncounterClass::Overtaking));
        expect(&judgement, Check::Safe, Pass, "");
        judgement
    };
    expect(&meets(-30.0), Check::R13, Pass, "");
    // half of it leads into her
    expect(&meets(-15.0), Check::R13, Fail, "FAIL-13D-TURN");
}

/// On her bow while the range falls: 13(a) fails too, and this says more. Abeam, or drawing ahead,
/// it is 13(a) alone (`keeping_too_close_is_13a`).
#[test]
fn coming_close_on_her_bow_is_13d() {
    let swerve = own(8.0).hold(308.0).turn(-60.0, 10.0).hold(4.0).turn(60.0, 10.0).hold(500.0);
    let trace = Scene::new(swerve, target(1500.0, -112.0, 0.0, 3.0)).trace();
    let judgement = judge_by(rules(), &trace);
    expect(&judgement, Check::R13, Fail, "FAIL-13D-BOW");
    let found = verdict(&judgement, Check::R13);
    let closest_m = 100.0 + found.margin.unwrap();
    assert!((0.0..2.0).contains(&(closest_m - trace.pairs[0].minimum.hull_m)), "{found:#?}");
    let told = format!("closed to {closest_m:.0} m on her bow. Rule 13.");
    assert!(found.sentence.clone().unwrap().ends_with(&told), "{found:#?}");
}

/// A target that minds own ship leaves her nominal track.
#[test]
fn forcing_the_overtaken_ship_to_alter_is_13d() {
    let she = |angle_deg: f64| {
        Script::new(ship(40.0, 8.0), 1500.0, 5.0, 0.0, 3.0)
            .hold(200.0)
            .turn(angle_deg, 2.0)
            .hold(700.0)
    };
    let meets = |angle_deg: f64, planned: Script| {
        judge(&Scene::new(late(), she(angle_deg)).nominal_targets(vec![planned.hold(400.0)]))
    };
    expect(&meets(-25.0, slow_ahead()), Check::R13, Fail, "FAIL-13D-FORCED");
    expect(&meets(-8.0, slow_ahead()), Check::R13, Pass, "");
    // her own plan
    expect(&meets(-25.0, she(-25.0)), Check::R13, Pass, "");
}

#[test]
fn she_is_forced_off_her_speed_too() {
    let slows = |speed_mps: f64| {
        let she = Script::new(ship(40.0, 8.0), 1500.0, 5.0, 0.0, 3.0).hold(200.0);
        let scene = Scene::new(late(), she.speed_to(speed_mps, 0.1).hold(700.0));
        judge(&scene.nominal_targets(vec![slow_ahead().hold(400.0)]))
    };
    for speed_mps in [2.2, 3.8] {
        expect(&slows(speed_mps), Check::R13, Fail, "FAIL-13D-FORCED");
    }
    for speed_mps in [2.3, 3.7] {
        expect(&slows(speed_mps), Check::R13, Pass, "");
    }
}

/// What she did before there was risk, what she took back at once, and what she did for a ship that
/// was nearer is not laid to own ship.
#[test]
fn own_ship_forced_nothing_else() {
    let she = |north_m: f64| Script::new(ship(40.0, 8.0), north_m, 5.0, 0.0, 3.0);
    let plan = |north_m: f64| she(north_m).hold(1300.0);
    // risk opens at 1900 m, at 140 s
    let later = || own(8.0).hold(420.0).turn(40.0, 6.0).hold(80.0).turn(-40.0, 6.0).hold(600.0);
    let early = she(2600.0).hold(100.0).turn(-25.0, 2.0).hold(1100.0);
    let judgement = judge(&Scene::new(later(), early).nominal_targets(vec![plan(2600.0)]));
    assert!(judgement.pairs[0].risk_s.is_some_and(|t_s| t_s > 120.0), "{judgement:#?}");
    expect(&judgement, Check::R13, Pass, "");
    // off by 10 degrees or more for 3 s, and for 8 s
    let jinks = |hold_s: f64| {
        let she = she(1500.0).hold(200.0).turn(-11.0, 11.0).hold(hold_s).turn(11.0, 11.0);
        let scene = Scene::new(late(), she.hold(700.0));
        judge(&scene.nominal_targets(vec![plan(1500.0)]))
    };
    expect(&jinks(3.0), Check::R13, Pass, "");
    expect(&jinks(8.0), Check::R13, Fail, "FAIL-13D-FORCED");
    // a third ship abreast of her, at 200 m or at 800 m
    let beside = |east_m: f64| {
        let third = || Script::new(ship(40.0, 8.0), 1500.0, east_m, 0.0, 3.0).hold(1300.0);
        let she = she(1500.0).hold(200.0).turn(-25.0, 2.0).hold(700.0);
        let scene = Scene::new(late(), she).and(third());
        judge(&scene.nominal_targets(vec![plan(1500.0), third()]))
    };
    expect(&beside(-200.0), Check::R13, Pass, "");
    expect(&beside(-900.0), Check::R13, Fail, "FAIL-13D-FORCED");
}

/// Own ship has made room before she alters; the room is measured when she last was on her plan,
/// before a slow turn has made more of it.
#[test]
fn she_who_had_room_was_not_forced() {
    let meets = |from_s: f64, rate_deg: f64| {
        let she = Script::new(ship(40.0, 8.0), 1500.0, 5.0, 0.0, 3.0).hold(from_s);
        let scene = Scene::new(late(), she.turn(-25.0, rate_deg).hold(700.0));
        judge(&scene.nominal_targets(vec![slow_ahead().hold(400.0)]))
    };
    expect(&meets(225.0, 3.0), Check::R13, Fail, "FAIL-13D-FORCED");
    expect(&meets(225.0, 1.0), Check::R13, Fail, "FAIL-13D-FORCED");
    expect(&meets(245.0, 3.0), Check::R13, Pass, "");
    expect(&meets(245.0, 1.0), Check::R13, Pass, "");
}

/// She goes off her plan with room and comes back to it, and later has to go off it again.
#[test]
fn she_who_had_room_once_may_be_forced_later() {
    let meets = |off_again: bool| {
        let own_ship = own(8.0).turn(15.0, 3.0).hold(70.0).turn(-18.0, 3.0).hold(160.0);
        let she = Script::new(ship(40.0, 8.0), 1500.0, 5.0, 0.0, 3.0).hold(30.0);
        let she = she.turn(-25.0, 3.0).hold(15.0).turn(25.0, 3.0).hold(130.0);
        let she = if off_again { she.turn(-25.0, 3.0) } else { she };
        let scene = Scene::new(own_ship.turn(40.0, 3.0).hold(700.0), she.hold(700.0));
        judge(&scene.nominal_targets(vec![slow_ahead().hold(400.0)]))
    };
    expect(&meets(false), Check::R13, Pass, "");
    expect(&meets(true), Check::R13, Fail, "FAIL-13D-FORCED");
}

#[test]
fn does_not_apply_to_other_classes() {
    for (speed, other) in [(6.0, head_on()), (6.0, from_starboard()), (3.0, fast_astern())] {
        let judgement = judge(&Scene::new(own(speed).hold(900.0), other));
        expect(&judgement, Check::R13, NotApplicable, "");
    }
}
