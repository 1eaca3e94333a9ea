//! The parts of the second judge by themselves: runs, stages of a prediction, release.

mod common;

use common::{Script, USV, deg, run};
use record::{DistanceKind, EncounterClass, Trace};
use stl::Params;
use stl::action::{Action, Deviation};
use stl::clearance::{Posed, predicted_clearance_m};
use stl::life::lives;
use stl::risk::{class_by_direction, released};
use stl::runs::{Run, heading_runs, speed_runs};
use stl::signals::{Course, PairSignals};

fn own() -> Script {
    Script::straight(0.0, 0.0, 0.0, 5.0)
}

fn ahead() -> Script {
    Script::straight(1500.0, 0.0, 180.0, 5.0)
}

/// The runs of a heading that goes straight from one corner (second, degrees) to the next.
fn runs_of(corners: &[(usize, f64)]) -> Vec<Run> {
    let mut heading_rad = vec![deg(corners[0].1)];
    for pair in corners.windows(2) {
        let ((from_s, from_deg), (to_s, to_deg)) = (pair[0], pair[1]);
        let per_s = (to_deg - from_deg) / (to_s - from_s) as f64;
        heading_rad.extend((1..=to_s - from_s).map(|i| deg(from_deg + per_s * i as f64)));
    }
    let speed_mps = vec![5.0; heading_rad.len()];
    heading_runs(&heading_rad, &speed_mps, deg(0.6), &USV, 1.0)
}

#[track_caller]
fn expect_runs(corners: &[(usize, f64)], expected: &[(usize, usize, f64)]) {
    let found = runs_of(corners);
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    for (run, &(start, end, change_deg)) in found.iter().zip(expected) {
        assert!(run.start.abs_diff(start) <= 2 && run.end.abs_diff(end) <= 6, "{found:#?}");
        assert!((run.change - deg(change_deg)).abs() < deg(0.5), "{found:#?}");
    }
}

/// 0.15 degrees a second never reach the rate of a run: these are found by their size.
#[test]
fn a_turn_too_slow_for_the_rate_is_a_run_by_its_size() {
    let there_and_back =
        [(0, 20.0), (20, 20.0), (120, 35.0), (200, 35.0), (300, 20.0), (340, 20.0)];
    expect_runs(&there_and_back, &[(20, 120, 15.0), (200, 300, -15.0)]);
    // in the mean a pause of 18 s is one of 6 s: part of the turn; one of 30 s ends it
    let paused = |s: usize| [(0, 0.0), (20, 0.0), (100, 12.0), (100 + s, 12.0), (180 + s, 24.0)];
    expect_runs(&paused(18), &[(20, 198, 24.0)]);
    expect_runs(&paused(30), &[(20, 100, 12.0), (130, 210, 12.0)]);
    // 9 degrees are no alteration
    expect_runs(&[(0, 0.0), (20, 0.0), (80, 9.0), (200, 9.0)], &[]);
}

#[test]
fn a_run_begins_where_the_heading_is_left_for_good() {
    // half a degree, and back, before the turn
    let found = runs_of(&[(0, 0.0), (26, 0.0), (27, 0.5), (28, 0.0), (38, 30.0), (90, 30.0)]);
    assert_eq!((found.len(), found[0].start), (1, 28), "{found:?}");
    // two turns to port with a short pause, on a heading that is not 0
    let found = runs_of(&[(0, 50.0), (30, 50.0), (32, 45.0), (41, 45.0), (44, 38.0), (100, 38.0)]);
    assert_eq!((found.len(), found[0].start), (1, 30), "{found:?}");
    assert!((found[0].change - deg(-12.0)).abs() < 1e-9, "{found:?}");
    // turning from the first sample on
    let found = runs_of(&[(0, 50.0), (10, 80.0), (90, 80.0)]);
    assert_eq!((found.len(), found[0].start), (1, 0), "{found:?}");
}

#[test]
fn a_run_ends_where_the_rate_does() {
    let found = runs_of(&[(0, 0.0), (30, 0.0), (40, 30.0), (46, 30.0), (56, 0.0), (90, 0.0)]);
    let ends: Vec<_> = found.iter().map(|run| (run.start, run.end)).collect();
    // 43 s is the one quiet sample between the two
    assert_eq!(ends, [(30, 43), (46, 59)]);
}

/// A ship that stops in her turn ends the run there.
#[test]
fn a_run_ends_where_the_ship_stops() {
    let heading_rad: Vec<f64> =
        (0..90_u32).map(|k| deg(3.0 * f64::from(k.clamp(30, 50)))).collect();
    let runs = |until: usize| {
        let speed_mps: Vec<f64> = (0..90).map(|k| if k < until { 5.0 } else { 0.1 }).collect();
        let found = heading_runs(&heading_rad, &speed_mps, deg(0.6), &USV, 1.0);
        found.iter().map(|run| run.end).collect::<Vec<_>>()
    };
    assert!(runs(90)[0] > 50);
    assert_eq!(runs(40)[0], 40);
}

/// 0.06 m/s from sample to sample is 0.06 m/s^2 once a second and 0.03 every two seconds.
#[test]
fn a_speed_run_is_one_by_its_acceleration() {
    let change_mps: Vec<f64> = (0..20).map(|k| -0.06 * f64::from(k)).collect();
    let runs = |sample_s: f64| speed_runs(&change_mps, &[5.0; 20], &USV, sample_s).len();
    assert_eq!((runs(1.0), runs(2.0)), (1, 0));
    assert_eq!(runs(0.5), 1);
}

/// A ship that turns at no more than 0.8 degrees a second has runs from 0.4 on.
#[test]
fn what_a_run_is_depends_on_how_fast_she_can_turn() {
    let mut sluggish = own();
    sluggish.turns = vec![(30, 0.5, 16)];
    let mut trace = run(&sluggish, &[ahead()], 200);
    assert_eq!(Deviation::of(&trace, &USV).turns.len(), 0);
    trace.own.ship.yaw_rate_radps_max = deg(0.8);
    assert_eq!(Deviation::of(&trace, &USV).turns.len(), 1);
}

/// With a plan, what leads towards it leads back; without one nothing does.
#[test]
fn towards_the_plan_is_back() {
    let script =
        own().turn(20, 30.0).turn(60, -30.0).change_speed(100, -2.0).change_speed(150, 2.0);
    let mut trace = run(&script, &[ahead()], 250);
    let did = Deviation::of(&trace, &USV);
    let turns: Vec<_> = did.turns.iter().map(|run| did.turns_back(run)).collect();
    let speeds: Vec<_> = did.speed_changes.iter().map(|run| did.regains(run)).collect();
    assert_eq!((turns, speeds), (vec![false, true], vec![false, true]));
    trace.nominal = None;
    let did = Deviation::of(&trace, &USV);
    assert!(!did.turns.iter().any(|run| did.turns_back(run)));
    assert!(!did.speed_changes.iter().any(|run| did.regains(run)));
}

#[test]
fn a_plan_that_ends_before_the_run_goes_on_as_it_ended() {
    let mut trace = run(&own().turn(20, 30.0), &[ahead()], 250);
    let whole = Deviation::of(&trace, &USV);
    let planned = &mut trace.nominal.as_mut().unwrap().own;
    planned.psi_rad.truncate(100);
    planned.vel_north_mps.truncate(100);
    planned.vel_east_mps.truncate(100);
    planned.north_m.truncate(100);
    planned.east_m.truncate(100);
    planned.stw_mps.truncate(100);
    planned.yaw_rate_radps.truncate(100);
    assert_eq!(Deviation::of(&trace, &USV).heading_rad, whole.heading_rad);
}

/// A yaw of 4 degrees to starboard, the pass predicted clear, on a course that has drifted by 5:
/// what follows to the other side goes past the first course, and is the action.
#[test]
fn an_alteration_past_a_drifted_course_is_the_action() {
    let mut script = own().turn(60, 4.0).turn(80, -40.0);
    script.turns.push((2, 0.125, 40));
    let trace = run(&script, &[Script::straight(1500.0, -140.0, 180.0, 5.0)], 300);
    let lives = lives(&trace, &USV);
    let duty = lives[0].in_sight.as_ref().unwrap();
    let did = Action::of(&Deviation::of(&trace, &USV), &lives, 0, duty, &USV, 1.0);
    assert_eq!(did.turns.len(), 2, "{did:#?}");
    assert!(did.side < 0.0, "{did:#?}");
}

/// After a slow loss of speed: back to the plan is no action, and well past it is one.
#[test]
fn faster_than_the_plan_is_an_action() {
    let gains = |to_mps: f64| {
        let mut script = own();
        script.speeds = vec![(20, -0.02, 40), (120, (to_mps - 4.2) / 4.0, 4)];
        let trace = run(&script, &[Script::straight(1500.0, 130.0, 180.0, 5.0)], 300);
        let lives = lives(&trace, &USV);
        let duty = lives[0].in_sight.as_ref().unwrap();
        let did = Deviation::of(&trace, &USV);
        Action::of(&did, &lives, 0, duty, &USV, 1.0).speed_changes.len()
    };
    assert_eq!((gains(5.0), gains(5.25), gains(5.5)), (0, 0, 1));
}

/// Past and clear from the first second on at which it then holds for ten.
#[test]
fn release_is_the_first_sample_of_the_stretch() {
    let fast = Script { speed_mps: 8.0, ..own() };
    let trace = run(&fast, &[Script::straight(500.0, 250.0, 0.0, 3.0)], 400);
    let pair = PairSignals::new(&trace.own, &trace.targets[0], DistanceKind::Centre);
    let class = EncounterClass::Overtaking;
    let release = |until: usize| released(&pair, class, &USV, 1.0, 0, &pair.range_m[..until]);
    let k = release(400).unwrap();
    let clear = |k: usize| pair.alpha_rad(k).abs() < USV.release_overtaking_rad;
    assert!(clear(k) && !clear(k - 1) && pair.range_m[k] > USV.preferred_m, "{k}");
    assert_eq!((release(k + 11), release(k + 10)), (Some(k), None));
}

/// 12 degrees on either bow are reciprocal within 26 degrees and not within 20.
#[test]
fn head_on_asks_for_nearly_reciprocal_courses() {
    let narrow = Params { head_on_reciprocal_rad: deg(20.0), ..USV };
    let class = |beta_deg: f64, alpha_deg: f64, params: &Params| {
        class_by_direction(deg(beta_deg), deg(alpha_deg), params)
    };
    assert_eq!(class(12.0, -12.0, &USV), EncounterClass::HeadOn);
    assert_eq!(class(12.0, -12.0, &narrow), EncounterClass::CrossingStbd);
    assert_eq!(class(12.0, 12.0, &narrow), EncounterClass::HeadOn);
}

/// What spares the prediction with outlines decides as the prediction does, wherever the reference
/// point lies, in the hull or outside.
#[test]
fn the_short_cut_of_the_prediction_decides_the_same() {
    let points = [(0.0, 0.0), (4.0, 1.0), (20.0, 0.0), (0.0, 6.0), (60.0, 0.0), (60.0, 20.0)];
    for (forward_m, starboard_m) in points {
        for psi_deg in (0..360).step_by(45) {
            let target = Script::straight(400.0, -330.0, f64::from(psi_deg), 4.0);
            let mut trace = run(&own(), &[target], 60);
            for track in [&mut trace.own, &mut trace.targets[0]] {
                track.ship.hull.midships_forward_m = forward_m;
                track.ship.hull.midships_starboard_m = starboard_m;
            }
            let pair = PairSignals::new(&trace.own, &trace.targets[0], DistanceKind::Hull);
            for k in (0..60).step_by(7) {
                let predicted_m = pair.predicted_m(k);
                let near_m = [predicted_m + 0.1, predicted_m - 0.1];
                for limit_m in [0.3, 1.0, 2.0, 20.0, 50.0, 100.0].into_iter().chain(near_m) {
                    let within = pair.predicted_within(k, limit_m);
                    assert_eq!(within, predicted_m < limit_m, "{k}: {predicted_m} {limit_m}");
                }
            }
        }
    }
}

/// The course made good is that of the velocity over ground, and where there is none the heading.
#[test]
fn her_track_is_where_she_goes() {
    let mut trace: Trace = run(&own(), &[Script::straight(400.0, 0.0, 0.0, 4.0)], 3);
    (trace.targets[0].vel_north_mps[1], trace.targets[0].vel_east_mps[1]) = (0.0, 4.0);
    (trace.targets[0].vel_north_mps[2], trace.targets[0].vel_east_mps[2]) = (0.0, 0.0);
    let pair = PairSignals::new(&trace.own, &trace.targets[0], DistanceKind::Hull);
    let at = |k: usize| pair.ahead_and_abeam_m(k, Course::MadeGood);
    let near = |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs() + (b - d).abs() < 1e-9;
    // 400 m astern of her, less the 10 m to her bow; she goes east: abeam to starboard
    assert!(near(at(0), (-410.0, 0.0)), "{:?}", at(0));
    assert!(near(at(1), (-10.0, 399.0)), "{:?}", at(1));
    assert!(near(at(2), (-408.0 + 10.0 - 10.0, 0.0)), "{:?}", at(2));
}

/// Two ships at rest, against the distances from every corner of one to every side of the other.
#[test]
fn clearance_at_rest_is_the_distance_of_the_outlines() {
    let trace = run(&own(), &[ahead()], 2);
    let corners = |psi_deg: f64, north_m: f64, east_m: f64| {
        let at = geom::Vec2::new(north_m, east_m);
        trace.own.ship.hull.corners_m(at, deg(psi_deg)).to_vec()
    };
    let to_side_m = |p: geom::Vec2, a: geom::Vec2, b: geom::Vec2| {
        let along = b - a;
        let share = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        (p - (a + along * share)).norm()
    };
    let least_m = |one: &[geom::Vec2], other: &[geom::Vec2]| {
        let sides = || (0..other.len()).map(|i| (other[i], other[(i + 1) % other.len()]));
        let all = one.iter().flat_map(|p| sides().map(|(a, b)| to_side_m(*p, a, b)));
        all.fold(f64::INFINITY, f64::min)
    };
    for own_deg in (0..360).step_by(24) {
        for target_deg in (0..360).step_by(24) {
            for bearing_deg in (0..360).step_by(24) {
                let [own_deg, target_deg] = [own_deg, target_deg].map(f64::from);
                let (sin, cos) = libm::sincos(deg(f64::from(bearing_deg)));
                let (north_m, east_m) = (25.0 * cos, 25.0 * sin);
                let (a, b) = (corners(own_deg, 0.0, 0.0), corners(target_deg, north_m, east_m));
                let expected_m = least_m(&a, &b).min(least_m(&b, &a));
                let ship = &trace.own.ship;
                let (own, target) = (
                    Posed { ship, psi_rad: deg(own_deg) },
                    Posed { ship, psi_rad: deg(target_deg) },
                );
                let found_m = predicted_clearance_m(own, target, (north_m, east_m), (0.0, 0.0));
                let said = format!("{own_deg} {target_deg} {bearing_deg}: {found_m} {expected_m}");
                assert!((found_m - expected_m).abs() < 1e-6, "{said}");
            }
        }
    }
}
