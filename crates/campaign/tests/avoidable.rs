//! Contacts that somebody could have avoided, and contacts that nobody could, in scenes with a
//! closed form: a ship that turns on a circle of 60 m and hardly brakes, and one that brakes within
//! 36 m and hardly turns.

use campaign::avoidable::unavoidable;
use geom::{HullOutline, Vec2, units::deg};
use planner_api::{Command, Mission, Planner, Situation};
use record::{
    DistanceKind, Encounter, EncounterId, Intent, Motion, Outcome, OwnShip, RunLimits, RunUntil,
    Seed, Sensing, Target, Trace, Vessel, Visibility, Waypoint, Weather,
};
use sim::Scratch;
use std::sync::atomic::AtomicU64;

const OWN_MPS: f64 = 6.0;

fn kinematic(yaw_rate_radps_max: f64, acceleration_mps2_max: f64) -> Vessel {
    Vessel::Kinematic { yaw_rate_radps_max, acceleration_mps2_max, speed_mps_max: 12.0 }
}

/// Turns on a circle of 60 m.
fn turns() -> Vessel {
    kinematic(0.1, 1e-5)
}

/// Own ship from the origin to the north at 6 m/s.
fn scene(vessel: Vessel, targets: Vec<Target>, hazards: Vec<Vec<Vec2>>) -> Encounter {
    let goal = Waypoint { position_m: Vec2::new(5000.0, 0.0), speed_mps: None };
    let start = Motion { position_m: Vec2::zeros(), psi_rad: 0.0, speed_mps: OWN_MPS };
    let point = HullOutline::centred(0.02, 0.01);
    Encounter {
        id: EncounterId::new("test", 0),
        seed: Seed(1),
        weight: 1.0,
        own: OwnShip { hull: point, vessel, start, route: vec![goal], cruise_mps: OWN_MPS },
        targets,
        hazards,
        weather: Weather::default(),
        sensing: Sensing::Perfect { detection_range_m: None },
        visibility: Visibility::InSight,
        asked: None,
        safety_radius_m: 150.0,
        distance: DistanceKind::Hull,
        run: RunLimits {
            step_s: 0.5,
            beat_s: 1.0,
            duration_s_max: 600.0,
            until: RunUntil::PastAndClear,
        },
    }
}

/// A ship that lies still, 2 km long and 20 m wide: her side is straight for 200 m ahead and 300 m
/// astern of her middle.
fn wall(middle_m: Vec2, psi_rad: f64) -> Target {
    let start = Motion { position_m: middle_m, psi_rad, speed_mps: 0.0 };
    let hull = HullOutline::centred(2000.0, 20.0);
    Target { hull, vessel: kinematic(0.05, 0.1), start, intent: Intent::HoldCourse }
}

/// A wall across own ship's way, so many metres ahead.
fn across(ahead_m: f64) -> Target {
    wall(Vec2::new(ahead_m + 10.0, 0.0), deg(90.0))
}

/// A wall along own ship's way, so many metres to starboard (to port where negative).
fn along(starboard_m: f64) -> Target {
    wall(Vec2::new(0.0, starboard_m + 10f64.copysign(starboard_m)), 0.0)
}

fn rectangle(north_m: [f64; 2], east_m: [f64; 2]) -> Vec<Vec2> {
    let corner = |north: usize, east: usize| Vec2::new(north_m[north], east_m[east]);
    vec![corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)]
}

/// Orders this course and speed at every beat.
struct Steady(f64, f64);

impl Planner for Steady {
    fn reset(&mut self, _: &Mission) {}

    fn plan(&mut self, _: &Situation<'_>) -> Command {
        Command::course_speed(self.0, self.1)
    }
}

fn asked_of(encounter: &Encounter, planner: &mut dyn Planner) -> (Outcome, Option<bool>) {
    sim::check(encounter).expect("the encounter is sound");
    let (mut scratch, beat) = (Scratch::default(), AtomicU64::new(0));
    let trace: Trace = sim::run(encounter, planner, &mut scratch, &beat);
    let answer = unavoidable(encounter, &trace, &mut |_| None, (&mut scratch, &beat));
    (trace.outcome, answer)
}

/// What is said of a run that keeps course and speed.
fn asked(encounter: &Encounter) -> (Outcome, Option<bool>) {
    asked_of(encounter, &mut Steady(0.0, OWN_MPS))
}

const AVOIDABLE: (Outcome, Option<bool>) = (Outcome::Collision, Some(false));
const UNAVOIDABLE: (Outcome, Option<bool>) = (Outcome::Collision, Some(true));

#[test]
fn turning_circle_decides_before_a_wall() {
    assert_eq!(asked(&scene(turns(), vec![across(61.0)], vec![])), AVOIDABLE);
    assert_eq!(asked(&scene(turns(), vec![across(59.0)], vec![])), UNAVOIDABLE);
}

#[test]
fn stopping_distance_decides_before_a_wall() {
    let stops = kinematic(1e-5, 0.5);
    assert_eq!(asked(&scene(stops.clone(), vec![across(37.0)], vec![])), AVOIDABLE);
    assert_eq!(asked(&scene(stops, vec![across(35.0)], vec![])), UNAVOIDABLE);
}

/// She can act from her first track on: seen in time the same wall is avoidable, and else not.
#[test]
fn the_first_track_is_the_first_moment() {
    let seen_from = |detection_range_m: f64| {
        let mut encounter = scene(turns(), vec![across(500.0)], vec![]);
        encounter.sensing = Sensing::Perfect { detection_range_m: Some(detection_range_m) };
        asked(&encounter)
    };
    // the range is to the middle of the hull, 10 m behind the side; she looks every 6 m
    assert_eq!(seen_from(77.0), AVOIDABLE);
    assert_eq!(seen_from(69.0), UNAVOIDABLE);
    assert_eq!(seen_from(5.0), UNAVOIDABLE, "never tracked");
}

/// Two ships on either side of her and a mole ahead: each alone leaves a way out, both do not.
#[test]
fn two_targets_box_her_in() {
    let mole = || vec![rectangle([80.0, 90.0], [-300.0, 300.0])];
    let aground = |targets| asked(&scene(turns(), targets, mole()));
    assert_eq!(aground(vec![along(30.0)]), (Outcome::Grounding, Some(false)));
    assert_eq!(aground(vec![along(-30.0)]), (Outcome::Grounding, Some(false)));
    assert_eq!(aground(vec![along(30.0), along(-30.0)]), (Outcome::Grounding, Some(true)));
}

/// A wall ahead and one to starboard: she turns to port, unless there is land.
#[test]
fn a_hazard_closes_the_only_way_out() {
    let walls = || vec![across(80.0), along(30.0)];
    assert_eq!(asked(&scene(turns(), walls(), vec![])), AVOIDABLE);
    let quay = rectangle([-200.0, 79.0], [-40.0, -30.0]);
    assert_eq!(asked(&scene(turns(), walls(), vec![quay])), UNAVOIDABLE);
}

/// A planner that turns into a ship which would have passed: keeping on clears.
#[test]
fn keeping_on_counts_as_a_manoeuvre() {
    let beside = wall(Vec2::new(0.0, 400.0), 0.0);
    let helpless = kinematic(0.02, 1e-5);
    let encounter = scene(helpless, vec![beside], vec![]);
    assert_eq!(asked_of(&encounter, &mut Steady(deg(90.0), OWN_MPS)), AVOIDABLE);
}

#[test]
fn what_was_avoided_was_avoidable_and_a_failure_is_asked_about() {
    let clear = scene(turns(), vec![along(500.0)], vec![]);
    assert_eq!(asked(&clear), (Outcome::Completed, Some(false)));
    let near = |ahead_m| scene(turns(), vec![across(ahead_m)], vec![]);
    let nonsense = |encounter| asked_of(&encounter, &mut Steady(f64::NAN, OWN_MPS));
    assert_eq!(nonsense(near(61.0)), (Outcome::PlannerNonFinite, Some(false)));
    assert_eq!(nonsense(near(59.0)), (Outcome::PlannerNonFinite, Some(true)));
}
