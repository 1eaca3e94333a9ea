//! The Python package: what it does for a planner, and the adapter for the NTNU simulator's call.
//!
//! Where Python is not installed this is said on standard error, past the test harness.

use geom::Vec2;
use planner_api::{
    Alert, Command, FailureKind, Mission, Order, OwnShip, OwnState, Planner, PlannerFailure,
    Situation, TargetTrack, Waypoint,
};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::io::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::Stdio;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A planner that `python3 ARGUMENTS` is, if there is a Python.
fn python(arguments: &str) -> Option<Box<dyn Planner>> {
    let probe = std::process::Command::new("python3")
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    if !probe.is_ok_and(|status| status.success()) {
        let mut error = std::io::stderr();
        writeln!(error, "NOT TESTED: `python3` is not installed, the package was left out").ok()?;
        return None;
    }
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python");
    let path = format!("{}:{}", repository().join("python").display(), tests.display());
    let name =
        format!("exec:env PYTHONDONTWRITEBYTECODE=1 'PYTHONPATH={path}' python3 {arguments}");
    let entry = planner_host::outside(&name)?.expect("python3 was found a moment ago");
    Some((entry.make)(&entry.options).expect("nothing is started yet"))
}

fn mission() -> Mission {
    let waypoint =
        |north_m, east_m, speed_mps| Waypoint { position_m: Vec2::new(north_m, east_m), speed_mps };
    Mission {
        own: OwnShip {
            length_m: 8.45,
            beam_m: 2.71,
            speed_mps_max: 12.5,
            yaw_rate_radps_max: 0.2,
            acceleration_mps2_max: 0.5,
        },
        route: vec![waypoint(500.0, 0.0, Some(4.0)), waypoint(1000.0, 0.0, None)],
        cruise_mps: 7.0,
        safety_radius_m: 150.0,
        between_centres: false,
        beat_s: 1.0,
        hazards: Vec::new(),
        stream_seed: 1,
    }
}

fn own() -> OwnState {
    OwnState {
        position_m: Vec2::new(10.0, 20.0),
        psi_rad: FRAC_PI_2,
        velocity_mps: Vec2::new(3.0, 2.0),
        cog_rad: 0.6,
        sog_mps: 3.6,
        stw_mps: 2.0,
        yaw_rate_radps: 0.25,
    }
}

fn track() -> TargetTrack {
    let mut covariance = [[0.0; 4]; 4];
    for (index, variance) in [9.0, 8.0, 7.0, 6.0].into_iter().enumerate() {
        covariance[index][index] = variance;
    }
    TargetTrack {
        id: 5,
        position_m: Vec2::new(1.0, 2.0),
        velocity_mps: Vec2::new(3.0, 4.0),
        cog_rad: 0.9,
        sog_mps: 5.0,
        psi_rad: None,
        length_m: Some(100.0),
        beam_m: None,
        covariance,
        age_s: 1.0,
        since_update_s: 0.0,
    }
}

fn plan(planner: &mut dyn Planner, t_s: f64, tracks: &[TargetTrack]) -> Command {
    planner.plan(&Situation { t_s, own: own(), tracks, visual_range_m: None })
}

/// An unwinding without a message becomes one with it.
fn told<T>(run: impl FnOnce() -> T) -> T {
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|payload| {
        panic!("{}", payload.downcast::<PlannerFailure>().expect("a planner's failure"))
    })
}

fn failure(run: impl FnOnce() -> Command) -> PlannerFailure {
    let payload = catch_unwind(AssertUnwindSafe(run)).expect_err("the planner must fail");
    *payload.downcast().expect("a planner's failure")
}

/// The arguments are checked by the planner itself, in `tests/python/colav_planner.py`.
#[test]
fn a_planner_of_the_ntnu_simulator_runs_unchanged() {
    let Some(mut planner) = python("-m seatrial colav_planner:Checks") else { return };
    for resets in 1..3 {
        told(|| planner.reset(&mission()));
        for t_s in [0.0, 1.0] {
            let expected = Command::course_speed(7.0 + t_s - TAU, f64::from(resets) + 0.25);
            let got = told(|| plan(planner.as_mut(), t_s, &[track()]));
            assert_eq!(got, expected);
        }
    }
    let Some(mut older) = python("-m seatrial colav_planner:Older") else { return };
    told(|| older.reset(&mission()));
    let Order::CourseSpeed { course_rad, .. } = told(|| plan(older.as_mut(), 0.0, &[])).order
    else {
        panic!("a course and a speed")
    };
    assert!(course_rad.is_nan());
}

#[test]
fn an_exception_is_a_crash_with_its_traceback() {
    let Some(mut planner) = python("-m seatrial colav_planner:Checks") else { return };
    told(|| planner.reset(&mission()));
    let failure = failure(|| plan(planner.as_mut(), 0.0, &[]));
    assert_eq!(failure.kind, FailureKind::Crashed);
    assert!(failure.detail.contains("IndexError"), "{}", failure.detail);
    assert!(failure.detail.contains("`Checks` 0"), "{}", failure.detail);
}

#[test]
fn the_example_of_thirty_lines_is_that_long_and_gives_way() {
    let path = repository().join("examples/python/first_planner.py");
    let lines = std::fs::read_to_string(&path).unwrap().lines().count();
    assert!(lines <= 30, "{lines} lines");
    let Some(mut planner) = python(&format!("'{}'", path.display())) else { return };
    told(|| planner.reset(&mission()));
    let alone = told(|| plan(planner.as_mut(), 0.0, &[]));
    let Order::CourseSpeed { course_rad, speed_mps } = alone.order else { panic!("{alone:?}") };
    assert!((course_rad - (-20.0 / 990.0_f64)).abs() < 1e-4, "{course_rad}");
    assert_eq!((speed_mps, alone.alerts.len()), (7.0, 0));
    let ahead = TargetTrack { position_m: Vec2::new(300.0, 20.0), ..track() };
    let turned = told(|| plan(planner.as_mut(), 1.0, &[ahead]));
    let Order::CourseSpeed { course_rad: new_rad, .. } = turned.order else { panic!("{turned:?}") };
    assert!((new_rad - course_rad - TAU / 12.0).abs() < 1e-12);
    let alert = Alert { track: 5, rule: "8".to_owned(), why: "near ahead".to_owned() };
    assert_eq!(turned.alerts, [alert]);
}
