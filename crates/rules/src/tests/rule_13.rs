//! Rule 13: overtaking, and its persistence.

use super::*;
use Status::{Fail, Inconclusive, NotApplicable, Pass};

fn overtake(angle_deg: f64) -> Script {
    own(8.0).hold(40.0).turn(angle_deg, 3.0).hold(150.0).turn(-angle_deg, 3.0)
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
        let script = overtake(20.0).hold(600.0);
        judge(&Scene::new(script, she(angle_deg)).nominal_targets(vec![planned.hold(400.0)]))
    };
    expect(&meets(-25.0, slow_ahead()), Check::R13, Fail, "FAIL-13D-FORCED");
    expect(&meets(-8.0, slow_ahead()), Check::R13, Pass, "");
    // her own plan
    expect(&meets(-25.0, she(-25.0)), Check::R13, Pass, "");
}

#[test]
fn does_not_apply_to_other_classes() {
    for (speed, other) in [(6.0, head_on()), (6.0, from_starboard()), (3.0, fast_astern())] {
        let judgement = judge(&Scene::new(own(speed).hold(900.0), other));
        expect(&judgement, Check::R13, NotApplicable, "");
    }
}
