//! The last safe instants where they are known in closed form, and laws that hold everywhere.

use campaign::last_minute::find;
use geom::{HullOutline, Vec2, units::deg};
use proptest::prelude::*;
use record::{
    DistanceKind, Encounter, EncounterClass, EncounterId, Intent, LastInstant, LastMinute, Motion,
    OwnShip, PairFacts, Reaction, Role, RunLimits, RunUntil, Seed, Sensing, Target, Vessel,
    Visibility, Waypoint, Weather,
};

const NEAR_MISS_M: f64 = 50.0;
const OWN_MPS: f64 = 6.0;

fn kinematic(yaw_rate_radps_max: f64, acceleration_mps2_max: f64) -> Vessel {
    Vessel::Kinematic { yaw_rate_radps_max, acceleration_mps2_max, speed_mps_max: 12.0 }
}

fn target(hull: HullOutline, position_m: Vec2, psi_rad: f64, speed_mps: f64) -> Target {
    let start = Motion { position_m, psi_rad, speed_mps };
    Target { hull, vessel: kinematic(0.05, 0.1), start, intent: Intent::HoldCourse }
}

/// Own ship from the origin to the north at 6 m/s.
fn encounter(hull: HullOutline, vessel: Vessel, target: Target) -> Encounter {
    let goal = Waypoint { position_m: Vec2::new(5000.0, 0.0), speed_mps: None };
    let start = Motion { position_m: Vec2::zeros(), psi_rad: 0.0, speed_mps: OWN_MPS };
    Encounter {
        id: EncounterId::new("test", 0),
        seed: Seed(1),
        weight: 1.0,
        own: OwnShip { hull, vessel, start, route: vec![goal], cruise_mps: OWN_MPS },
        targets: vec![target],
        hazards: Vec::new(),
        weather: Weather::default(),
        sensing: Sensing::Perfect { detection_range_m: None },
        visibility: Visibility::InSight,
        asked: None,
        safety_radius_m: 150.0,
        distance: DistanceKind::Hull,
        run: RunLimits {
            step_s: 0.5,
            beat_s: 1.0,
            duration_s_max: 1200.0,
            until: RunUntil::PastAndClear,
        },
    }
}

/// Facts of a pair that reached stage 3.
fn facts(class: EncounterClass, role: Role) -> PairFacts {
    PairFacts {
        target: 0,
        risk_s: Some(0.0),
        class: Some(class),
        class_by_bearings: Some(class),
        class_by_planner: None,
        role,
        ambiguous: false,
        beta_rad: None,
        alpha_rad: None,
        range_m: None,
        cpa_s: None,
        stages_s: [Some(0.0), Some(0.0), None],
        released_s: None,
        reaction: Reaction::Never,
        apparent: Reaction::Never,
        first_turn_rad: None,
    }
}

fn found(encounter: &Encounter, facts: PairFacts) -> Option<LastMinute> {
    let nominal = sim::nominal(encounter).expect("the encounter is sound");
    find(encounter, &nominal, &[facts], NEAR_MISS_M).expect("both have models")[0]
}

fn last(encounter: &Encounter) -> LastMinute {
    let found = found(encounter, facts(EncounterClass::CrossingStbd, Role::GiveWay));
    found.expect("the pair reached stage 3")
}

fn seconds(instant: LastInstant) -> f64 {
    match instant {
        LastInstant::At(t_s) | LastInstant::Indicative(t_s) => t_s,
        other => panic!("{other:?} has no time"),
    }
}

/// A hull that lies across own ship's track, 2 km long, its near side straight: own ship meets its
/// broadside, as a wall.
fn wall(side_at_m: f64) -> Target {
    let hull = HullOutline::centred(2000.0, 20.0);
    // the parallel body of an outline reaches from 10 % forward to 15 % aft of midships
    target(hull, Vec2::new(side_at_m + 10.0, 300.0), deg(90.0), 0.0)
}

/// A hull as small as a point turns hard over on a circle of radius R = U / r and then goes along
/// the wall: the last safe range is R, one step of the grid at most before it.
#[test]
fn hard_over_before_a_wall_is_known_in_closed_form() {
    let point = HullOutline::centred(0.02, 0.01);
    for (yaw_rate_radps, side_at_m) in [(0.1, 900.0), (0.04, 1100.3), (0.3, 707.1)] {
        // an engine that hardly brakes: turning is all that helps
        let vessel = kinematic(yaw_rate_radps, 1e-5);
        let found = last(&encounter(point, vessel, wall(side_at_m)));
        let radius_m = OWN_MPS / yaw_rate_radps;
        let exact_s = (side_at_m - radius_m) / OWN_MPS;
        assert!(!matches!(found.own, LastInstant::Indicative(_)));
        let early_s = exact_s - seconds(found.own);
        assert!((-0.01..=1.0).contains(&early_s), "{early_s} s before {exact_s} s");
        let near_s = (side_at_m - radius_m - NEAR_MISS_M) / OWN_MPS;
        let early_s = near_s - seconds(found.own_near_miss);
        assert!((-0.01..=1.0).contains(&early_s), "{early_s} s before {near_s} s");
        // she lies still and cannot help
        assert_eq!(found.target, LastInstant::BeforeStart);
    }
}

/// A ship that hardly turns stops within U^2 / 2a and half her length.
#[test]
fn crash_stop_before_a_wall_is_known_in_closed_form() {
    let hull = HullOutline::centred(30.0, 6.0);
    for (brakes_mps2, side_at_m) in [(0.5, 900.0), (0.05, 1103.3), (0.2, 808.1)] {
        let vessel = kinematic(1e-5, brakes_mps2);
        let found = last(&encounter(hull, vessel, wall(side_at_m)));
        let way_m = OWN_MPS * OWN_MPS / (2.0 * brakes_mps2) + 15.0;
        let exact_s = (side_at_m - way_m) / OWN_MPS;
        let early_s = exact_s - seconds(found.own);
        assert!((-0.01..=1.0).contains(&early_s), "{early_s} s before {exact_s} s");
    }
}

/// Head on she may not turn to port, whatever it would save: a long hull that lies to starboard.
#[test]
fn forbidden_side_is_left_out_of_one_instant_and_not_of_the_other() {
    let hull = HullOutline::centred(2000.0, 20.0);
    let ahead = target(hull, Vec2::new(900.0, 960.0), deg(90.0), 0.0);
    let encounter = encounter(HullOutline::centred(0.02, 0.01), kinematic(0.1, 1e-5), ahead);
    let pair = |class, role| found(&encounter, facts(class, role)).unwrap();
    let head_on = pair(EncounterClass::HeadOn, Role::Both);
    let give_way = pair(EncounterClass::CrossingStbd, Role::GiveWay);
    assert!(seconds(head_on.own) < seconds(head_on.own_any_turn));
    assert_eq!(give_way.own, head_on.own_any_turn);
    assert_eq!(give_way.own_any_turn, head_on.own_any_turn);
}

#[test]
fn nothing_helps_a_ship_that_begins_before_a_wall() {
    let hull = HullOutline::centred(8.0, 2.0);
    let encounter = encounter(hull, kinematic(0.01, 1e-3), wall(300.0));
    let found = found(&encounter, facts(EncounterClass::CrossingStbd, Role::GiveWay));
    let pair = found.unwrap();
    assert_eq!((pair.own, pair.own_any_turn), (LastInstant::BeforeStart, LastInstant::BeforeStart));
}

#[test]
fn pair_that_passes_clear_was_never_critical() {
    let far = target(HullOutline::centred(30.0, 6.0), Vec2::new(900.0, 300.0), deg(180.0), 5.0);
    let encounter = encounter(HullOutline::centred(8.0, 2.0), kinematic(0.1, 0.2), far);
    let crossing = facts(EncounterClass::CrossingStbd, Role::GiveWay);
    let early = PairFacts { stages_s: [Some(0.0), None, None], ..crossing.clone() };
    let passed = found(&encounter, crossing);
    assert_eq!(passed.unwrap().own, LastInstant::NeverCritical);
    assert_eq!(found(&encounter, early), None, "stage 3 was not reached");
}

/// A meeting of a small ship with one of `beam_m` on a course that leads through her.
fn meeting(course_rad: f64, speed_mps: f64, miss_m: f64, beam_m: f64) -> Option<Encounter> {
    let velocity = geom::unit(course_rad) * speed_mps;
    let relative = velocity - Vec2::new(OWN_MPS, 0.0);
    if relative.norm() < 1.0 {
        return None;
    }
    let aside = Vec2::new(-relative.y, relative.x) / relative.norm();
    let position_m = aside * miss_m - relative * 120.0;
    let other = target(HullOutline::centred(60.0, beam_m), position_m, course_rad, speed_mps);
    let vessel = Vessel::Model("viknes".to_owned());
    let encounter = encounter(HullOutline::centred(8.45, 2.71), vessel, other);
    (position_m.norm() > 150.0 && sim::check(&encounter).is_ok()).then_some(encounter)
}

/// How late an instant is; a pair that was never critical is later than any.
fn rank(instant: LastInstant) -> f64 {
    match instant {
        LastInstant::NeverCritical => f64::INFINITY,
        LastInstant::BeforeStart => -1.0,
        LastInstant::At(t_s) | LastInstant::Indicative(t_s) => t_s,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn wider_target_is_never_met_later(
        course in -3.1f64..3.1, speed in 2f64..11.0, miss in -20f64..20.0, wider in 0.5f64..12.0,
    ) {
        let narrow = meeting(course, speed, miss, 8.0);
        let wide = meeting(course, speed, miss, 8.0 + wider);
        prop_assume!(narrow.is_some() && wide.is_some());
        let (narrow, wide) = (last(&narrow.unwrap()), last(&wide.unwrap()));
        for instant in [
            |last: &LastMinute| last.own,
            |last: &LastMinute| last.own_near_miss,
            |last: &LastMinute| last.target,
        ] {
            prop_assert!(rank(instant(&wide)) <= rank(instant(&narrow)), "{wide:?} {narrow:?}");
        }
        prop_assert!(rank(wide.own_near_miss) <= rank(wide.own));
    }

    /// In the mirror nothing changes but the sides, and both sides are searched.
    #[test]
    fn mirror_image_has_the_same_instants(
        course in -3.1f64..3.1, speed in 2f64..11.0, miss in -20f64..20.0,
    ) {
        let image = meeting(-course, speed, -miss, 10.0);
        let encounter = meeting(course, speed, miss, 10.0);
        prop_assume!(image.is_some() && encounter.is_some());
        prop_assert_eq!(last(&image.unwrap()), last(&encounter.unwrap()));
    }
}
