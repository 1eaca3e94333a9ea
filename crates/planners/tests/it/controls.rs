//! The negative controls have the fault that they are for.

use crate::scene::{Scene, Vessel, planner};
use geom::wrap;
use planner_api::{OwnState, Situation};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn head_on() -> Scene {
    Scene { detection_m: f64::INFINITY, ..Scene::paper(4500.0, &[Vessel(0.0, 3000.0, 6.0, -90.0)]) }
}

fn crossing() -> Scene {
    let target = Vessel(1500.0, 2000.0, 6.0, 180.0);
    Scene { detection_m: f64::INFINITY, ..Scene::paper(4500.0, &[target]) }
}

#[test]
fn hold_course_keeps_the_miss_distance() {
    let run = head_on().run(planner("hold-course", "").as_mut());
    assert!(run.range_m_min() < 1.0 && run.first_turn(0.1).abs() < 0.5);
}

#[test]
fn always_port_and_sign_flip_turn_to_port_in_time() {
    for name in ["always-port", "sign-flip"] {
        for scene in [head_on(), crossing()] {
            let run = scene.run(planner(name, "").as_mut());
            assert!(run.first_turn(2.0) < 0.0, "{name}");
            assert!(run.range_m_min() > 140.0, "{name}: {}", run.range_m_min());
        }
    }
    let zhuang = head_on().run(planner("zhuang", "").as_mut());
    assert!(zhuang.first_turn(2.0) > 0.0);
}

#[test]
fn late_acts_60_seconds_after_the_seed_planner() {
    let first_s = |name: &str| {
        let run = crossing().run(planner(name, "").as_mut());
        let psi_0 = run.beats[0].psi_rad;
        run.beats.iter().find(|b| wrap(b.psi_rad - psi_0).abs() > 0.01).map(|b| b.t_s)
    };
    let (on_time, late) = (first_s("zhuang").unwrap(), first_s("late").unwrap());
    assert!((late - on_time - 60.0).abs() < 1.5, "{on_time} {late}");
}

#[test]
fn blind_to_nearest_sees_the_second() {
    let run = head_on().run(planner("blind-to-nearest", "").as_mut());
    assert!(run.range_m_min() < 1.0);
    let far = Vessel(900.0, 2600.0, 7.0, -90.0);
    let two = Scene { targets: vec![far, Vessel(0.0, 3000.0, 6.0, -90.0)], ..head_on() };
    let (course_rad, _) = two.first_order(planner("blind-to-nearest", "").as_mut());
    assert!(course_rad > 0.01, "the second nearest is avoided: {course_rad}");
}

#[test]
fn dribble_alters_in_small_complete_steps() {
    let run = head_on().run(planner("dribble", "").as_mut());
    let psi_0 = run.beats[0].psi_rad;
    let offset_deg = |b: &crate::scene::Beat| wrap(b.psi_rad - psi_0).to_degrees();
    let at = |t_s: usize| offset_deg(&run.beats[t_s]);
    for (t_s, expected) in [(15, 8.0), (35, 16.0), (55, 24.0)] {
        // the bearing of the goal moves to port meanwhile
        assert!((at(t_s) - expected).abs() < 2.0, "{t_s} s: {}", at(t_s));
    }
}

#[test]
fn the_share_is_drawn_from_the_planners_own_stream() {
    let scene = head_on();
    let mut nan = planner("nan", "share = 0.2");
    let mut armed = 0;
    for stream_seed in 0..2000 {
        let mission = planner_api::Mission { stream_seed, ..scene.mission() };
        nan.reset(&mission);
        let tracks = scene.tracks(0.0, scene.own.position_m());
        let own = OwnState::steady(scene.own.position_m(), 0.0, 8.0);
        let situation = Situation { t_s: 0.0, own, tracks: &tracks, visual_range_m: None };
        armed += u32::from(nan.plan(&situation).order.checked(12.0, 0.0).is_err());
    }
    // 400 expected, standard deviation 18
    assert!((330..=470).contains(&armed), "{armed}");
}

const FAULT_VARIABLE: &str = "PLANNERS_TEST_FAULT";

/// Runs itself in a child process for each fault that ends or blocks one.
#[test]
fn destructive_faults_destroy() {
    if let Ok(fault) = std::env::var(FAULT_VARIABLE) {
        let seed = head_on().mission().stream_seed;
        let options = format!("only_stream_seed = '{seed:x}'");
        head_on().first_order(planner(&fault, &options).as_mut());
        return;
    }
    for (fault, ends) in [("spins", false), ("aborts", true), ("overflows", true)] {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "controls::destructive_faults_destroy"])
            .env(FAULT_VARIABLE, fault)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let ended = wait(&mut child, Duration::from_secs(if ends { 60 } else { 2 }));
        if !ends {
            assert!(ended.is_none(), "{fault} returned");
            child.kill().unwrap();
            child.wait().unwrap();
            continue;
        }
        let status = ended.unwrap_or_else(|| panic!("{fault} did not end"));
        assert!(status.code().is_none_or(|code| code != 0 && code != 101), "{fault}: {status}");
    }
}

#[expect(clippy::disallowed_methods, reason = "a test waits for a process")]
fn wait(child: &mut std::process::Child, limit: Duration) -> Option<std::process::ExitStatus> {
    let start = Instant::now();
    while start.elapsed() < limit {
        if let Some(status) = child.try_wait().expect("a child of ours") {
            return Some(status);
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    None
}
