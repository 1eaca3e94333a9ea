//! Limits that no other voyage here comes near: tracks that end early, what a target does once she
//! is classified, samples that are missing, and what a rule set may say.

use super::*;
use Status::{Fail, Inconclusive, Pass, Warn};

/// Judged with stages by time, and the moment to act 30 s after stage 2.
fn early_rules() -> RuleSet {
    let text = rules().text().replace("mode = \"range\"", "mode = \"time\"");
    RuleSet::parse(&text.replace("may_act_early = false", "may_act_early = true")).unwrap()
}

/// A ship from starboard whose track is not where she heads: what own ship crosses is her track.
#[test]
fn rule_15_looks_along_her_course_made_good() {
    // makes good 6 m/s to the west, heading 60 degrees to the right of it or to the left
    let crosses = |psi_deg: f64, north_mps: f64, east_mps: f64| {
        let she = Script::new(ship(40.0, 8.0), 1800.0, 1970.0, deg(psi_deg), 6.0);
        let she = she.drift(north_mps, east_mps).hold(900.0);
        let judgement = judge(&Scene::new(own(6.0).hold(700.0), she));
        assert_eq!(judgement.pairs[0].class, Some(EncounterClass::CrossingStbd));
        let found = verdict(&judgement, Check::R15);
        assert_eq!((found.status, &*found.detail), (Fail, "FAIL-15-AHEAD"), "{found:#?}");
        found.evidence.iter().find(|e| e.name == "ahead_of_bow").unwrap().value
    };
    let upright_m = crosses(270.0, 0.0, 0.0);
    assert!((140.0..150.0).contains(&upright_m), "{upright_m}");
    // 300 degrees through the water: her bow reaches less far along her track
    let crabbing_m = crosses(300.0, -3.0, -6.0 + 6.0 * 0.866_025_403_784_438_6);
    assert!((0.0..6.0).contains(&(crabbing_m - upright_m)), "{crabbing_m} {upright_m}");
}

/// She stops 20 s before own ship is there: then her line is that of her heading.
#[test]
fn rule_15_looks_along_the_heading_of_a_ship_that_stopped() {
    let starts = || Script::new(ship(40.0, 8.0), 2358.0, 1702.0, deg(250.0), 6.0);
    let she = starts().hold(262.0).speed_to(0.0, 0.3).hold(400.0);
    let scene = Scene::new(own(6.0).hold(500.0), she);
    let judgement = judge(&scene.nominal_targets(vec![starts().hold(900.0)]));
    assert_eq!(judgement.pairs[0].class, Some(EncounterClass::CrossingStbd));
    expect(&judgement, Check::R15, Fail, "FAIL-15-AHEAD");
    let ahead_m = verdict(&judgement, Check::R15).margin.unwrap() + 200.0;
    assert!((150.0..160.0).contains(&ahead_m), "{ahead_m}");
}

/// Ahead of her bow twice: the nearer crossing counts, whichever came first.
#[test]
fn of_two_crossings_ahead_the_nearer_counts() {
    let across = |waits_s: f64| {
        let script = Script::new(ship(10.0, 3.0), 0.0, 140.0, 0.0, 8.0).hold(326.0);
        let script = script.turn(-60.0, 6.0).hold(16.0).turn(60.0, 6.0).speed_to(1.0, 2.0);
        let script = script.hold(waits_s).speed_to(6.0, 2.0).turn(80.0, 8.0).hold(300.0);
        let judgement = judge(&Scene::new(script, slow_ahead()));
        expect(&judgement, Check::R13, Fail, "FAIL-13D-AHEAD");
        let found = verdict(&judgement, Check::R13);
        (found.t_s.unwrap().round(), (found.margin.unwrap() + 200.0).round())
    };
    // the first at 157 m; she comes up while own ship waits, to 159 m or to 139 m
    assert_eq!(across(25.0), (350.0, 157.0));
    assert_eq!(across(35.0), (416.0, 139.0));
}

/// By the early reading she may act once the other has done nothing for 30 s: 5 % of her speed is
/// nothing, 9 % is something.
#[test]
fn a_target_that_slows_has_acted() {
    let may_act_s = |share: f64| {
        let she = Script::new(ship(40.0, 8.0), 1800.0, -1800.0, deg(90.0), 6.0).hold(50.0);
        let she = she.hold(40.0).speed_to(6.0 * (1.0 - share), 0.2).hold(800.0);
        let scene = Scene::new(own(6.0).hold(250.0), she).nominal_targets(vec![from_port()]);
        verdict(&judge_by(early_rules(), &scene.trace()), Check::R17May).t_s
    };
    let nothing_s = may_act_s(0.0).unwrap();
    assert_eq!(may_act_s(0.05), Some(nothing_s));
    assert!(may_act_s(0.09).is_none_or(|t_s| t_s > nothing_s + 20.0), "{:?}", may_act_s(0.09));
}

/// Speed lost too slowly for a run and taken up again, a little past the plan: no action. Well past
/// it she goes faster, and that is one.
#[test]
fn faster_than_the_plan_is_an_action() {
    let manoeuvre_from_s = |to_mps: f64| {
        let slow = own(6.0).hold(60.0).speed_to(5.2, 0.02).hold(70.0).speed_to(to_mps, 0.2);
        let judgement = judge(&Scene::new(slow.hold(400.0), target(2400.0, 130.0, 180.0, 6.0)));
        verdict(&judgement, Check::R8Magnitude)
            .evidence
            .iter()
            .find(|e| e.name == "x_u")
            .unwrap()
            .value
    };
    assert!((manoeuvre_from_s(6.2) - 0.8 / 6.0).abs() < 0.01, "{}", manoeuvre_from_s(6.2));
    assert!(manoeuvre_from_s(6.6).abs() < 0.01, "{}", manoeuvre_from_s(6.6));
}

/// Overtaking, stages are by time: at 11 m/s of closing risk opens 190 s away, 2090 m.
#[test]
fn risk_opens_farther_away_for_a_fast_overtaker() {
    let ahead = target(3000.0, 5.0, 0.0, 1.0);
    let judgement = judge(&Scene::new(own(12.0).hold(500.0), ahead));
    assert_eq!(judgement.pairs[0].class, Some(EncounterClass::Overtaking));
    let risk_s = judgement.pairs[0].risk_s.unwrap();
    assert!((risk_s - 910.0 / 11.0).abs() < 4.0, "{risk_s}");
}

/// An alert in time, and another long after there was any risk.
#[test]
fn an_alert_too_many_is_told() {
    let alerts = |times_s: &[f64]| {
        let script = own(6.0).hold(60.0).turn(40.0, 3.0).hold(640.0);
        let mut trace = Scene::new(script, head_on()).trace();
        let alert = |&t_s: &f64| record::Alert { t_s, target: 0, rule: String::new() };
        trace.alerts = times_s.iter().map(alert).collect();
        judge_by(rules(), &trace)
    };
    expect(&alerts(&[50.0]), Check::R5R7, Pass, "");
    expect(&alerts(&[50.0, 600.0]), Check::R5R7, Warn, "FALSE-ALERT");
}

/// One number that is none is enough.
#[test]
fn a_pair_without_its_distances_is_open() {
    let trace = Scene::new(own(6.0).hold(60.0).turn(35.0, 3.0).hold(400.0), head_on()).trace();
    let mut hull = trace.clone();
    hull.pairs[0].minimum.hull_m = f64::NAN;
    let mut centre = trace.clone();
    centre.pairs[0].minimum.centre_m = f64::NAN;
    let mut sample = trace;
    sample.pairs[0].hull_m[7] = f64::NAN;
    for flawed in [hull, centre, sample] {
        let judgement = judge_by(rules(), &flawed);
        assert!(judgement.verdicts.iter().all(|v| v.status == Inconclusive), "{judgement:#?}");
    }
}

/// She leaves her plan in the very second in which risk opens: that is own ship's doing. So is it
/// where she had swung off and back before, and then has to alter.
#[test]
fn forced_in_the_second_in_which_risk_opens() {
    let own_ship = || own(8.0).hold(420.0).turn(40.0, 6.0).hold(80.0).turn(-40.0, 6.0).hold(600.0);
    let she = || Script::new(ship(40.0, 8.0), 2600.0, 5.0, 0.0, 3.0);
    let judged = |she: Script| {
        let plan = Script::new(ship(40.0, 8.0), 2600.0, 5.0, 0.0, 3.0).hold(1300.0);
        judge(&Scene::new(own_ship(), she.hold(900.0)).nominal_targets(vec![plan]))
    };
    let risk_s = judged(she()).pairs[0].risk_s.unwrap();
    let at = |from_s: f64| judged(she().hold(from_s).turn(-11.0, 22.0).hold(9.0).turn(11.0, 22.0));
    expect(&at(risk_s - 0.7), Check::R13, Fail, "FAIL-13D-FORCED");
    expect(&at(risk_s - 2.0), Check::R13, Pass, "");
    let swung = she().hold(risk_s - 3.0).turn(-11.0, 22.0).hold(2.0).turn(11.0, 22.0);
    let swung = swung.hold(60.0).turn(-25.0, 2.0);
    expect(&judged(swung), Check::R13, Fail, "FAIL-13D-FORCED");
}

/// Off her plan for 3 samples, or for 9, with a sample every two seconds: 5 s are three intervals.
#[test]
fn forced_is_held_in_seconds_and_not_in_samples() {
    let jinks = |hold_s: f64| {
        let she = Script::new(ship(40.0, 8.0), 1500.0, 5.0, 0.0, 3.0).hold(200.0);
        let she = she.turn(-11.0, 11.0).hold(hold_s).turn(11.0, 11.0).hold(700.0);
        let script = super::rule_13::late();
        let plan = Script::new(ship(40.0, 8.0), 1500.0, 5.0, 0.0, 3.0).hold(1300.0);
        let mut trace = Scene::new(script, she).nominal_targets(vec![plan]).trace();
        super::pinned::in_slow_motion(&mut trace);
        judge_by(rules(), &trace)
    };
    expect(&jinks(8.0), Check::R13, Fail, "FAIL-13D-FORCED");
    expect(&jinks(2.0), Check::R13, Pass, "");
}

/// Off her plan from the first sample of the run on, with risk open: nothing came before it.
#[test]
fn forced_from_the_first_sample_on() {
    let she = Script::new(ship(40.0, 8.0), 1500.0, 5.0, deg(-11.0), 3.0).hold(900.0);
    let judgement =
        judge(&Scene::new(super::rule_13::late(), she).nominal_targets(vec![slow_ahead()]));
    assert_eq!(judgement.pairs[0].risk_s, Some(0.0));
    expect(&judgement, Check::R13, Fail, "FAIL-13D-FORCED");
}

/// A plan that ends before the run goes on as it ended; of what she did, its time is known.
#[test]
fn a_plan_may_end_before_the_run() {
    let meets = |from_s: f64, samples: usize| {
        let she = Script::new(ship(40.0, 8.0), 1500.0, 5.0, 0.0, 3.0);
        let she = she.hold(from_s).turn(-11.0, 22.0).hold(800.0);
        let mut trace =
            Scene::new(super::rule_13::late(), she).nominal_targets(vec![slow_ahead()]).trace();
        let nominal = trace.nominal.as_mut().unwrap();
        for track in nominal.targets.iter_mut().chain([&mut nominal.own]) {
            for signal in track.signals_mut() {
                signal.truncate(samples);
            }
        }
        judge_by(rules(), &trace)
    };
    let (whole, short) = (meets(100.0, 900), meets(100.0, 200));
    for judgement in [&whole, &short] {
        expect(judgement, Check::R13, Fail, "FAIL-13D-FORCED");
    }
    assert_eq!(whole.pairs[0].first_turn_rad, short.pairs[0].first_turn_rad);
    // off it from the sample at 194 s to the last one at 199 s, and a second less
    expect(&meets(193.3, 200), Check::R13, Fail, "FAIL-13D-FORCED");
    expect(&meets(194.3, 200), Check::R13, Pass, "");
}

/// The run ends in the turn: what it leads to is read at the last sample.
#[test]
fn a_turn_with_which_the_run_ends_is_looked_at() {
    let script = own(6.0).hold(60.0).turn(40.0, 3.0);
    let third = target(900.0, 400.0, 180.0, 1.0);
    let judgement = judge(&Scene::new(script, head_on()).and(third));
    expect(&judgement, Check::R8Third, Fail, "FAIL-8C-TARGET-1");
}

/// A quarter of next to no speed is nothing.
#[test]
fn a_ship_that_lies_nearly_still_keeps_her_speed() {
    let script = |to_mps: f64| {
        let slow = own(6.0).hold(50.0).speed_to(0.1, 0.5).hold(90.0);
        slow.speed_to(to_mps, 0.1).hold(60.0)
    };
    let judged = |to_mps: f64| {
        let judgement = judge(&Scene::new(script(to_mps), from_port()));
        assert_eq!(judgement.pairs[0].role, record::Role::StandOn, "{judgement:#?}");
        verdict(&judgement, Check::R17Hold).clone()
    };
    let found = judged(0.3);
    let x_u = found.evidence.iter().find(|e| e.name == "x_u").unwrap().value;
    assert_ne!(found.status, Fail, "{found:#?}");
    assert!(x_u.abs() < 1e-9, "{found:#?}");
}

#[test]
fn a_rule_set_may_not_open_the_head_on_sector_too_far() {
    let may = |key: &str, value: f64| rules().with(key, value).is_ok();
    assert!(may("head_on_reciprocal_factor", 1.5) && may("head_on_reciprocal_factor", 2.0));
    assert!(!may("head_on_reciprocal_factor", 2.1));
    assert!(may("head_on_half_angle_deg", 40.0) && !may("head_on_half_angle_deg", 95.0));
    assert!(may("close_factor", 1.0) && !may("close_factor", 0.9));
}

/// A count is a whole number.
#[test]
fn a_count_of_a_rule_set_takes_no_fraction() {
    let fail_runs = |value: f64| rules().with("dribble_fail_runs", value);
    assert_eq!(fail_runs(7.0).unwrap().manoeuvre.dribble_fail_runs, 7);
    assert!(fail_runs(7.5).is_err());
}
