//! Rules 6 and 19(b): a declared stopping distance against what there is.

use super::*;
use record::Status::{Fail, NotApplicable, NotEvaluated, Pass};
use record::Stopping;
use record::Visibility;

/// Stops in `v^2 / 2a` metres from speeds up to 16 m/s.
fn stopping(deceleration_mps2: f64) -> Stopping {
    let speed = |i: usize| 16.0 * (i + 1) as f64 / Stopping::STEPS as f64;
    let reach_m = std::array::from_fn(|i| speed(i) * speed(i) / (2.0 * deceleration_mps2));
    Stopping { speed_mps_max: 16.0, reach_m }
}

/// Head-on from 1500 m, own ship at 7 m/s.
fn judged(deceleration_mps2: Option<f64>, visibility: Visibility) -> Judgement {
    let mut scene = Scene::new(own(7.0).hold(30.0).turn(40.0, 3.0).hold(200.0), head_on());
    scene.visibility = visibility;
    let mut trace = scene.trace();
    trace.own.ship.stopping = deceleration_mps2.map(stopping);
    judge_by(rules(), &trace)
}

#[test]
fn safe_speed_needs_a_stopping_model() {
    let fog = Visibility::Restricted { visual_range_m: 100.0 };
    for check in [Check::R6, Check::R19Speed] {
        expect(&judged(None, fog), check, NotEvaluated, "NO-STOPPING-MODEL");
    }
}

#[test]
fn a_speed_is_safe_from_which_she_stops_in_the_distance_there_is() {
    let quick = judged(Some(0.5), Visibility::InSight);
    expect(&quick, Check::R6, Pass, "");
    let range_m = quick.pairs[0].range_m.unwrap();
    // 14 x 14 = 196 m^2/s^2 over twice the deceleration, less and more than the range at onset
    let just = 49.0 / (2.0 * (range_m - 20.0));
    expect(&judged(Some(1.03 * just), Visibility::InSight), Check::R6, Pass, "");
    let slow = judged(Some(0.97 * just), Visibility::InSight);
    expect(&slow, Check::R6, Fail, "FAIL-6");
    let sentence = verdict(&slow, Check::R6).sentence.as_deref().unwrap();
    assert!(sentence.contains("at 7.0 m/s needed") && sentence.ends_with("Rule 6."), "{sentence}");
}

#[test]
fn without_risk_there_is_nothing_to_stop_for() {
    let far = Scene::new(own(7.0).hold(200.0), target(1500.0, 900.0, 180.0, 5.0).hold(200.0));
    let mut trace = far.trace();
    trace.own.ship.stopping = Some(stopping(0.001));
    expect(&judge_by(rules(), &trace), Check::R6, NotApplicable, "");
}

#[test]
fn in_fog_she_stops_within_half_of_what_she_sees() {
    let fog = |visual_range_m: f64| Visibility::Restricted { visual_range_m };
    // 49 m^2/s^2 over 1 m/s^2: 49 m and a little, by straight lines between the declared speeds
    expect(&judged(Some(0.5), fog(110.0)), Check::R19Speed, Pass, "");
    let fast = judged(Some(0.5), fog(90.0));
    expect(&fast, Check::R19Speed, Fail, "FAIL-19B");
    let sentence = verdict(&fast, Check::R19Speed).sentence.as_deref().unwrap();
    assert!(sentence.contains("could see 90 m. Rule 19(b)."), "{sentence}");
    expect(&judged(Some(0.5), Visibility::InSight), Check::R19Speed, NotApplicable, "");
}

/// The last safe instants are looked for where stage 3 was reached, in fog too.
#[test]
fn the_stages_are_known_in_fog() {
    let fog = judged(None, Visibility::Restricted { visual_range_m: 100.0 });
    let clear = judged(None, Visibility::InSight);
    assert!(clear.pairs[0].stages_s[1].is_some());
    assert_eq!(fog.pairs[0].stages_s, clear.pairs[0].stages_s);
}
