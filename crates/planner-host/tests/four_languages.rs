//! The small velocity-obstacle planner of `examples/` answers with the same bits in Rust, C, C++
//! and Python, whether it is called, loaded or spoken to.
//!
//! A tool that is not installed is named on standard error, past the test harness, and the others
//! are compared all the same.
#![expect(clippy::unwrap_used, reason = "a step that fails here fails the test")]

#[path = "../../../examples/rust/src/planner.rs"]
#[expect(unreachable_pub, reason = "the module of an example's binary")]
mod small_vo;

use geom::Vec2;
use planner_api::{
    Command, Mission, Order, OwnShip, OwnState, Planner, PlannerFailure, PlannerStream, Situation,
    TargetTrack, Waypoint, conformance,
};
use std::io::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::process::Stdio;

const ENCOUNTERS: u64 = 60;
const BEATS: u32 = 50;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn is_installed(tool: &str) -> bool {
    let probe = std::process::Command::new(tool)
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    let is_there = probe.is_ok_and(|status| status.success());
    if !is_there {
        let mut error = std::io::stderr();
        writeln!(error, "NOT COMPARED: `{tool}` is not installed, its planner was left out")
            .unwrap();
    }
    is_there
}

fn compile(tool: &str, arguments: &[&str], sources: &[&str], output: &Path) {
    let examples = repository().join("examples");
    let status = std::process::Command::new(tool)
        .args(["-O2", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror"])
        .args(arguments)
        .arg("-I")
        .arg(repository().join("crates/planner-host/include"))
        .args(sources.iter().map(|source| examples.join(source)))
        .arg("-lm")
        .arg("-o")
        .arg(output)
        .status()
        .unwrap();
    assert!(status.success(), "{tool} {sources:?}");
}

fn outside(name: &str) -> Box<dyn Planner> {
    let entry = planner_host::outside(name).unwrap().unwrap();
    (entry.make)(&entry.options).unwrap()
}

/// Every form of the planner that can be built here; the Rust one first.
fn planners(folder: &Path) -> Vec<(&'static str, Box<dyn Planner>)> {
    let mut all: Vec<(&'static str, Box<dyn Planner>)> =
        vec![("rust", Box::new(small_vo::SmallVo::default()))];
    let path = |name: &str| folder.join(name);
    if is_installed("cc") {
        let (library, program) = (path("libsmall_vo.so"), path("small_vo"));
        let shared = ["-std=c11", "-shared", "-fPIC"];
        compile("cc", &shared, &["c/small_vo.c", "c/small_vo_lib.c"], &library);
        compile("cc", &["-std=c11"], &["c/small_vo.c", "c/small_vo_stdio.c"], &program);
        all.push(("c, loaded", outside(&format!("lib:{}", library.display()))));
        all.push(("c, spoken to", outside(&format!("exec:'{}'", program.display()))));
    }
    if is_installed("c++") {
        let library = path("libsmall_vo_cpp.so");
        compile("c++", &["-std=c++17", "-shared", "-fPIC"], &["cpp/small_vo.cpp"], &library);
        all.push(("c++, loaded", outside(&format!("lib:{}", library.display()))));
    }
    if is_installed("python3") {
        let (package, script) =
            (repository().join("python"), repository().join("examples/python/small_vo.py"));
        let environment = format!("PYTHONDONTWRITEBYTECODE=1 'PYTHONPATH={}'", package.display());
        let name = format!("exec:env {environment} python3 '{}'", script.display());
        all.push(("python, spoken to", outside(&name)));
    }
    all
}

/// Uniform in [low, high).
fn between(stream: &mut PlannerStream, low: f64, high: f64) -> f64 {
    low + (high - low) * stream.uniform()
}

fn mission(stream: &mut PlannerStream) -> Mission {
    let legs = 1 + stream.next_u64() % 3;
    let route = (0..legs).map(|leg| Waypoint {
        position_m: Vec2::new(between(stream, -900.0, 900.0), between(stream, -900.0, 900.0)),
        speed_mps: (leg == 1).then_some(between(stream, 2.0, 14.0)),
    });
    let route = route.collect();
    Mission {
        own: OwnShip {
            length_m: 8.45,
            beam_m: 2.71,
            speed_mps_max: 12.5,
            yaw_rate_radps_max: 0.2,
            acceleration_mps2_max: 0.5,
        },
        route,
        cruise_mps: between(stream, 3.0, 14.0),
        safety_radius_m: between(stream, 50.0, 300.0),
        between_centres: stream.uniform() < 0.3,
        beat_s: 1.0,
        hazards: vec![vec![Vec2::new(9e3, 9e3), Vec2::new(9.5e3, 9e3), Vec2::new(9e3, 9.5e3)]],
        stream_seed: stream.next_u64(),
    }
}

fn tracks(stream: &mut PlannerStream) -> Vec<TargetTrack> {
    (0..stream.next_u64() % 6)
        .map(|id| {
            let mut covariance = [[0.0; 4]; 4];
            covariance[1][2] = between(stream, -3.0, 3.0);
            TargetTrack {
                id: 1000 * id as u32 + 3,
                position_m: Vec2::new(
                    between(stream, -1000.0, 1000.0),
                    between(stream, -1000.0, 1000.0),
                ),
                velocity_mps: Vec2::new(between(stream, -9.0, 9.0), between(stream, -9.0, 9.0)),
                cog_rad: 0.0,
                sog_mps: 0.0,
                psi_rad: None,
                length_m: (stream.uniform() < 0.7).then_some(between(stream, 8.0, 300.0)),
                beam_m: None,
                covariance,
                age_s: between(stream, 0.0, 100.0),
                since_update_s: 0.0,
            }
        })
        .collect()
}

/// Own ship obeys at once, so that every answer leads to the next question.
fn drive(planner: &mut dyn Planner, encounter: u64) -> Vec<Command> {
    let stream = &mut PlannerStream::new(encounter);
    let mission = mission(stream);
    planner.reset(&mission);
    let mut tracks = tracks(stream);
    let mut own = OwnState {
        position_m: Vec2::new(0.1, -0.2),
        psi_rad: 0.0,
        velocity_mps: Vec2::zeros(),
        cog_rad: 0.0,
        sog_mps: 0.0,
        stw_mps: 0.0,
        yaw_rate_radps: 0.0,
    };
    let beats = (0..BEATS).map(|beat| {
        let t_s = f64::from(beat) * mission.beat_s;
        let visual_range_m = encounter.is_multiple_of(4).then_some(800.0);
        let command = planner.plan(&Situation { t_s, own, tracks: &tracks, visual_range_m });
        let Order::Velocity { velocity_mps } = command.order else { panic!("{command:?}") };
        own.velocity_mps = velocity_mps;
        own.position_m += velocity_mps * 3.0;
        for track in &mut tracks {
            track.position_m += track.velocity_mps * 3.0;
        }
        command
    });
    beats.collect()
}

/// Every bit of an answer.
fn bits(commands: &[Command]) -> Vec<(u64, u64, String)> {
    let bits = commands.iter().map(|command| {
        let Order::Velocity { velocity_mps } = command.order else { panic!("{command:?}") };
        (velocity_mps.x.to_bits(), velocity_mps.y.to_bits(), format!("{:?}", command.alerts))
    });
    bits.collect()
}

/// Caught: C's `strtod` fed by 15 digits instead of 17 in a trial, and a contracted multiply-add.
#[test]
fn four_languages_give_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let mut planners = planners(folder.path());
    let (_, rust) = &mut planners[0];
    let expected: Vec<Vec<Command>> =
        (0..ENCOUNTERS).map(|encounter| drive(rust.as_mut(), encounter)).collect();
    let all: Vec<&Command> = expected.iter().flatten().collect();
    let altered = all.iter().filter(|command| !command.alerts.is_empty()).count();
    assert!(altered * 10 > all.len(), "only {altered} of {} beats give way", all.len());
    assert!(altered * 10 < all.len() * 9, "{altered} of {} beats give way", all.len());
    for (name, planner) in &mut planners[1..] {
        for (encounter, expected) in (0..).zip(&expected) {
            let got = catch_unwind(AssertUnwindSafe(|| drive(planner.as_mut(), encounter)));
            let got = got.unwrap_or_else(|payload| match payload.downcast::<PlannerFailure>() {
                Ok(failure) => panic!("{name}, encounter {encounter}: {failure}"),
                Err(other) => resume_unwind(other),
            });
            for (beat, (got, expected)) in bits(&got).iter().zip(&bits(expected)).enumerate() {
                assert_eq!(got, expected, "{name}, encounter {encounter}, beat {beat}");
            }
        }
    }
}

/// The kit that a planner in Rust is shown to, shown to those from outside.
#[test]
fn the_conformance_kit_runs_against_a_process_and_a_library() {
    if !is_installed("cc") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let (library, program) = (folder.path().join("small_vo.so"), folder.path().join("small_vo"));
    let shared = ["-std=c11", "-shared", "-fPIC"];
    compile("cc", &shared, &["c/small_vo.c", "c/small_vo_lib.c"], &library);
    compile("cc", &["-std=c11"], &["c/small_vo.c", "c/small_vo_stdio.c"], &program);
    for name in [format!("lib:{}", library.display()), format!("exec:'{}'", program.display())] {
        let findings = conformance::check(&|| outside(&name));
        assert!(findings.is_empty(), "{name}: {findings:#?}");
    }
    let forgetful = "exec:sh -c 'read l; exit 1'";
    let findings = conformance::check(&|| outside(forgetful));
    assert_eq!(findings[0].check, conformance::Check::Answers, "{findings:#?}");
}

/// A library of another version, or none of ours, is refused with a reason.
#[test]
fn libraries_of_another_kind_are_refused() {
    if !is_installed("cc") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let refused = |source: &str, word: &str| {
        let (code, library) = (folder.path().join("x.c"), folder.path().join(format!("{word}.so")));
        std::fs::write(&code, source).unwrap();
        compile("cc", &["-shared", "-fPIC"], &[code.to_str().unwrap()], &library);
        let name = format!("lib:{}", library.display());
        let entry = planner_host::outside(&name).unwrap().unwrap();
        let error = (entry.make)(&entry.options).err().unwrap().to_string();
        assert!(error.contains(word), "{word}: {error}");
    };
    refused("int answer(void) { return 42; }", "seatrial_planner_v1");
    let begin = "#include \"seatrial_planner.h\"\nconst SeatrialPlanner *seatrial_planner_v1(void)";
    refused(&format!("{begin} {{ return 0; }}"), "returned no planner");
    let planner = |fields: &str| {
        format!("{begin} {{ static const SeatrialPlanner p = {{ {fields} }}; return &p; }}")
    };
    refused(&planner(".abi = 99"), "version 99");
    refused(&planner(".abi = 1"), "leaves a function out");
    let text = folder.path().join("text.so");
    std::fs::write(&text, "no library").unwrap();
    let entry = planner_host::outside(&format!("lib:{}", text.display())).unwrap().unwrap();
    let error = (entry.make)(&entry.options).err().unwrap().to_string();
    assert!(error.contains("cannot be loaded"), "{error}");
}
