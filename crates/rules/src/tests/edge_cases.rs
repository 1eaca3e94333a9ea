//! The edge cases of section 16 of the rules specification, each a named test.

use super::*;
use Status::{Fail, Inconclusive, NotApplicable, NotEvaluated, Pass, Warn};
use geom::EncounterClass;
use geom::class::OVERTAKING_SECTOR_RAD;
use record::{Outcome, Reaction, Role};

/// Own ship seen at `alpha` from a slower target ahead.
fn seen_at(alpha_rad: f64) -> Option<EncounterClass> {
    let psi_rad = geom::wrap(std::f64::consts::PI - alpha_rad);
    let other = Script::new(ship(10.0, 3.0), 1500.0, 0.0, psi_rad, 0.5).hold(30.0);
    let trace = Scene::new(own(8.0).hold(30.0), other).trace();
    judge_by(rules(), &trace).pairs[0].class_by_bearings
}

#[test]
fn beta_and_alpha_at_112_5_degrees_and_beside_it() {
    // the sector is strict; at the border itself rounding of the voyage decides nothing
    let at = OVERTAKING_SECTOR_RAD;
    assert_eq!(seen_at(at + 1e-9), Some(EncounterClass::Overtaking));
    assert_eq!(seen_at(at - 1e-9), Some(EncounterClass::CrossingStbd));
    let h = rules().head_on();
    assert_eq!(geom::classify(0.3, at, h), EncounterClass::CrossingStbd);
    assert_eq!(geom::classify(at, 0.3, h), EncounterClass::CrossingStbd);
    assert_eq!(geom::classify(at + 1e-9, 0.3, h), EncounterClass::Overtaken);
}

#[test]
fn alpha_at_13_degrees_exactly() {
    let h = rules().head_on();
    assert_eq!(geom::classify(0.0, deg(13.0), h), EncounterClass::HeadOn);
    assert_eq!(geom::classify(0.0, deg(13.0) + 1e-9, h), EncounterClass::CrossingStbd);
    // in doubt, 14(c): assumed to be head-on
    let psi_deg = 180.0 - 14.0;
    let judgement = judge(&Scene::new(own(6.0).hold(500.0), target(1500.0, 0.0, psi_deg, 6.0)));
    let facts = &judgement.pairs[0];
    assert_eq!(facts.class_by_bearings, Some(EncounterClass::CrossingStbd));
    assert_eq!((facts.ambiguous, facts.role), (true, Role::Both));
    // table and sentence speak of the class that decides
    assert_eq!(facts.class, Some(EncounterClass::HeadOn));
    let sentence = verdict(&judgement, Check::R14).sentence.clone().unwrap();
    assert!(sentence.contains("meeting head-on"), "{sentence}");
}

#[test]
fn parallel_ships_of_equal_speed_are_at_no_risk() {
    let judgement = judge(&Scene::new(own(6.0).hold(500.0), target(0.0, 80.0, 0.0, 6.0)));
    assert_eq!(judgement.pairs[0].class, None);
    expect(&judgement, Check::Turn, NotApplicable, "");
    expect(&judgement, Check::Safe, Fail, "FAIL-8D");
}

#[test]
fn a_stopped_target_is_judged_by_safe_and_rule_8_only() {
    let scene = Scene::new(
        own(6.0).hold(60.0).turn(-35.0, 3.0).hold(500.0),
        target(1500.0, 0.0, 40.0, 0.0),
    );
    let judgement = judge(&scene);
    assert_eq!(judgement.pairs[0].class, Some(EncounterClass::Static));
    for check in [Check::R13, Check::R14, Check::R15, Check::R16, Check::R17Hold, Check::R19] {
        expect(&judgement, check, NotApplicable, "");
    }
    expect(&judgement, Check::R8Magnitude, Pass, "");
    expect(&judgement, Check::Safe, Pass, "EXCELLENT");
}

#[test]
fn a_stopped_own_ship_is_judged_by_safe_only() {
    let judgement = judge(&Scene::new(own(0.1).hold(900.0), target(1500.0, 120.0, 180.0, 6.0)));
    for check in Check::ALL.into_iter().filter(|&check| check != Check::Safe) {
        assert_eq!(verdict(&judgement, check).status, NotEvaluated, "{check:?}");
    }
    // 105 m off, with a drift of its own of 0.1 m/s
    expect(&judgement, Check::Safe, Pass, "");
    assert_eq!(judgement.pairs[0].role, Role::None);
}

#[test]
fn a_closest_point_already_past_at_the_start_opens_nothing() {
    let judgement = judge(&Scene::new(own(6.0).hold(300.0), target(-100.0, 40.0, 180.0, 6.0)));
    assert_eq!(judgement.pairs[0].reaction, Reaction::NoRisk);
    expect(&judgement, Check::R14, NotApplicable, "");
}

#[test]
fn an_encounter_that_begins_inside_stage_4() {
    let judgement = judge(&Scene::new(
        own(6.0).hold(3.0).turn(60.0, 15.0).hold(300.0),
        target(180.0, 5.0, 180.0, 6.0),
    ));
    let facts = &judgement.pairs[0];
    assert_eq!(facts.stages_s, [Some(0.0); 3]);
    assert!(matches!(facts.reaction, Reaction::After(s) if s < 4.0), "{facts:?}");
}

#[test]
fn a_run_that_ends_before_the_closest_point_is_never_a_pass() {
    let mut trace = Scene::new(own(6.0).hold(60.0).turn(35.0, 3.0).hold(40.0), head_on()).trace();
    trace.outcome = Outcome::Truncated;
    let judgement = judge_by(rules(), &trace);
    assert!(
        judgement.verdicts.iter().all(|v| v.status != Pass && v.status != Warn),
        "{judgement:#?}"
    );
    expect(&judgement, Check::Turn, Inconclusive, "");
    // what is broken is broken
    let wrong = Scene::new(own(6.0).hold(60.0).turn(-35.0, 3.0).hold(40.0), head_on());
    expect(&judge(&wrong), Check::Turn, Fail, "FAIL-14-PORT");
}

#[test]
fn headings_wrap_from_359_to_1() {
    // the same encounter turned so that the turn goes through north
    let turned = |psi_deg: f64| {
        let rotate =
            |north: f64, east: f64| geom::angle::rotate(geom::Vec2::new(north, east), deg(psi_deg));
        let at = rotate(2400.0, 10.0);
        let own = Script::new(ship(10.0, 3.0), 0.0, 0.0, deg(psi_deg), 6.0);
        let other = Script::new(ship(40.0, 8.0), at.x, at.y, deg(180.0 + psi_deg), 6.0);
        judge(&Scene::new(own.hold(60.0).turn(35.0, 3.0).hold(400.0), other.hold(600.0)))
    };
    for psi_deg in [-20.0, 340.0, 170.0] {
        let judgement = turned(psi_deg);
        expect(&judgement, Check::Turn, Pass, "");
        let turn = judgement.pairs[0].first_turn_rad.unwrap();
        assert!((turn - deg(35.0)).abs() < deg(0.5), "{turn}");
    }
}

/// The samples are a second apart and the hulls meet between two of them: the minimum is refined
/// by whoever made the trace, and the judge trusts it.
#[test]
fn hulls_that_overlap_between_samples_are_a_collision() {
    let mut trace = Scene::new(own(6.0).hold(300.0), target(2400.0, 60.0, 180.0, 6.0)).trace();
    trace.pairs[0].minimum.hull_m = 0.0;
    trace.pairs[0].minimum.hull_s = 200.4;
    let judgement = judge_by(rules(), &trace);
    expect(&judgement, Check::Safe, Fail, "FAIL-COLLISION");
    assert_eq!(verdict(&judgement, Check::Safe).t_s, Some(200.4));
}

/// The same with a ship that goes through the other's course in half a second, between two samples
/// at which the hulls are metres apart.
#[test]
fn a_fast_crossing_is_a_collision_between_two_samples() {
    let fast = Script::new(ship(3.0, 1.0), 30.0, 610.0, deg(270.0), 20.0).hold(60.0);
    let trace = Scene::new(own(1.0).hold(60.0), fast).trace();
    let hull_m = |k: usize| {
        let corners = |track: &record::ShipTrack| {
            track.ship.hull.corners_m(track.position_m(k), track.psi_rad[k])
        };
        crate::pair::outline_distance_m(&corners(&trace.own), &corners(&trace.targets[0]))
    };
    assert!((0..trace.samples()).all(|k| hull_m(k) > 5.0));
    expect(&judge_by(rules(), &trace), Check::Safe, Fail, "FAIL-COLLISION");
}

/// Rules 13 to 15 go by the ship's head, not by her course made good.
#[test]
fn drift_that_parts_heading_from_course_does_not_change_the_class() {
    // both carried east at 15 degrees to own heading: relative motion is that of still water
    let current = 6.0 * geom::math::tan(deg(15.0));
    let with_current = |script: Script| script.drift(0.0, current);
    let own_ship = with_current(own(6.0)).hold(60.0).turn(35.0, 3.0).hold(300.0);
    let other =
        with_current(Script::new(ship(40.0, 8.0), 2400.0, 10.0, deg(180.0), 6.0)).hold(400.0);
    let trace = Scene::new(own_ship, other).trace();
    assert!((trace.own.cog_rad(0) - deg(15.0)).abs() < 1e-6);
    let judgement = judge_by(rules(), &trace);
    assert_eq!(judgement.pairs[0].class, Some(EncounterClass::HeadOn));
    expect(&judgement, Check::R14, Pass, "");
}

/// Her class is locked: an overtaking ship that draws abeam does not become a crossing one.
#[test]
fn overtaking_then_drifting_across_stays_overtaking() {
    // converges slowly from her starboard quarter until she crosses her bow
    let scene = Scene::new(
        Script::new(ship(10.0, 3.0), 0.0, 0.0, deg(8.0), 8.0).hold(700.0),
        target(900.0, 200.0, 0.0, 4.0),
    );
    let judgement = judge(&scene);
    assert_eq!(judgement.pairs[0].class, Some(EncounterClass::Overtaking));
    assert_eq!(verdict(&judgement, Check::R13).status, Fail);
    expect(&judgement, Check::R15, NotApplicable, "");
}

/// A planned reduction for a waypoint is no departure from course and speed.
#[test]
fn a_stand_on_ship_that_slows_for_a_waypoint_holds() {
    let slows = || own(6.0).hold(100.0).speed_to(4.2, 0.1).hold(600.0);
    let other = target(1500.0, -1800.0, 90.0, 6.0);
    let planned = Scene::new(slows(), other.clone()).nominal(slows());
    let judgement = judge(&planned);
    assert_eq!(judgement.pairs[0].class, Some(EncounterClass::CrossingPort));
    expect(&judgement, Check::R17Hold, Pass, "");
    let unplanned = judge(&Scene::new(slows(), other));
    expect(&unplanned, Check::R17Hold, Fail, "FAIL-17AI");
}

#[test]
fn a_turn_at_a_waypoint_is_neither_credited_nor_blamed() {
    let turns = || own(6.0).hold(100.0).turn(-30.0, 3.0).hold(600.0);
    let other = target(2400.0, -100.0, 180.0, 6.0);
    let judgement = judge(&Scene::new(turns(), other).nominal(turns()));
    assert_eq!(judgement.pairs[0].first_turn_rad, None);
    assert_ne!(judgement.status(Check::Turn), Fail);
}

/// The other manoeuvres first: onset and class still come from the nominal track.
#[test]
fn the_target_manoeuvres_first() {
    let avoids = Script::new(ship(40.0, 8.0), 2400.0, 10.0, deg(180.0), 6.0)
        .hold(30.0)
        .turn(40.0, 2.0)
        .hold(600.0);
    let scene = Scene::new(own(6.0).hold(500.0), avoids).nominal_targets(vec![head_on()]);
    let judgement = judge(&scene);
    assert_eq!(judgement.pairs[0].class, Some(EncounterClass::HeadOn));
    // she did nothing, and Rule 14 binds both
    expect(&judgement, Check::R14, Fail, "FAIL-14-NOACT");
    expect(&judgement, Check::Safe, Pass, "EXCELLENT");
}

#[test]
fn five_turns_of_8_degrees_are_a_dribble() {
    let script = (0..5).fold(own(6.0).hold(45.0), |script, _| script.turn(8.0, 4.0).hold(15.0));
    let judgement = judge(&Scene::new(script.hold(400.0), head_on()));
    expect(&judgement, Check::R8Dribble, Fail, "FAIL-8-DRIBBLE");
}

#[test]
fn samples_that_are_not_finite_or_missing_are_inconclusive() {
    let trace = Scene::new(own(6.0).hold(60.0).turn(35.0, 3.0).hold(400.0), head_on()).trace();
    let mut broken = trace.clone();
    broken.own.psi_rad[77] = f64::NAN;
    let mut other = trace.clone();
    other.targets[0].east_m[3] = f64::INFINITY;
    let mut dropped = trace.clone();
    dropped.targets[0].vel_north_mps.pop();
    let mut nominal = trace.clone();
    nominal.nominal.as_mut().unwrap().targets[0].north_m[9] = f64::NAN;
    for flawed in [broken, other, dropped, nominal] {
        let judgement = judge_by(rules(), &flawed);
        assert_eq!(judgement.verdicts.len(), Check::COUNT);
        assert!(judgement.verdicts.iter().all(|v| v.status == Inconclusive), "{judgement:#?}");
        assert_eq!(judgement.pairs[0].reaction, Reaction::Unknown);
    }
    // contact was seen all the same
    let mut hit = Scene::new(own(6.0).hold(500.0), target(2400.0, 2.0, 180.0, 6.0)).trace();
    hit.own.north_m[20] = f64::NAN;
    expect_status(&judge_by(rules(), &hit), Check::Safe, Fail);
}

#[track_caller]
fn expect_status(judgement: &Judgement, check: Check, status: Status) {
    assert_eq!(verdict(judgement, check).status, status);
}

#[test]
fn without_a_nominal_track_an_early_action_resolves_the_encounter() {
    // turned at 10 s, long before 1900 m: risk never opens on the actual track
    let acted = |angle: f64| {
        judge(
            &Scene::new(
                own(6.0).hold(10.0).turn(angle, 3.0).hold(500.0),
                target(3000.0, 10.0, 180.0, 6.0),
            )
            .without_nominal(),
        )
    };
    let good = acted(40.0);
    expect(&good, Check::R14, NotApplicable, "RESOLVED_EARLY");
    expect(&good, Check::Turn, NotApplicable, "RESOLVED_EARLY");
    assert_eq!(good.pairs[0].class, Some(EncounterClass::HeadOn));
    assert_eq!(good.pairs[0].reaction, Reaction::Early);
    expect(&acted(-40.0), Check::Turn, Warn, "RESOLVED_EARLY");
}

/// Imazu's cases 18 and 19 lie exactly on beta = 22.5, alpha = -22.5: at that half-angle a coin
/// toss of rounding, which the doubt of 2 degrees must show.
#[test]
fn a_target_on_the_border_of_the_head_on_sector_is_ambiguous() {
    let other =
        target(1500.0 * 0.923_879_532_511_286_7, 1500.0 * 0.382_683_432_365_089_8, 225.0, 6.0);
    let trace = Scene::new(own(6.0).hold(400.0), other).trace();
    let facts = judge_by(with("head_on_half_angle_deg", 22.5), &trace).pairs[0].clone();
    assert!((facts.beta_rad.unwrap() - deg(22.5)).abs() < 1e-9);
    assert!((facts.alpha_rad.unwrap() + deg(22.5)).abs() < 1e-9);
    assert_eq!((facts.ambiguous, facts.role), (true, Role::Both));
}

/// In doubt between crossing from starboard and from port, she gives way; holding, she did what the
/// other role wants, and passed clear.
#[test]
fn a_pass_under_the_other_role_is_a_warning() {
    let crossing = Scene::new(own(6.0).hold(700.0), target(1500.0, -17.0, 90.0, 0.5));
    let judgement = judge(&crossing);
    let facts = &judgement.pairs[0];
    assert_eq!((facts.class, facts.role), (Some(EncounterClass::CrossingStbd), Role::GiveWay));
    assert_eq!(facts.class_by_bearings, Some(EncounterClass::CrossingPort));
    assert!(facts.ambiguous);
    expect(&judgement, Check::R8Time, Warn, "AMBIGUOUS");
}

/// The ships draw apart from the start, before the second at which risk would have opened on the
/// nominal track: the clock of Rules 8 and 14 to 17 never ran.
#[test]
fn what_is_passed_before_risk_opens_is_not_judged() {
    let judgement = judge(&Scene::new(
        own(6.0).turn(178.0, 20.0).speed_to(9.0, 1.0).hold(600.0),
        target(2400.0, 10.0, 180.0, 6.0),
    ));
    let facts = &judgement.pairs[0];
    assert!(facts.risk_s.unwrap() > facts.cpa_s.unwrap(), "{facts:#?}");
    for check in [Check::R8Magnitude, Check::R8Time, Check::R14] {
        expect(&judgement, check, Status::NotApplicable, "PASSED-BEFORE-RISK");
    }
    expect(&judgement, Check::Safe, Status::Pass, "EXCELLENT");
}
