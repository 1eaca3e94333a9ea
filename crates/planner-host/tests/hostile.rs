//! What planners from outside do wrong: each costs its own encounter, under its own name, and the
//! next encounter meets a planner that works. The planners are scripts for `sh`, so that nothing
//! has to be installed.
#![expect(clippy::unwrap_used, reason = "a step that fails here fails the test")]

use geom::Vec2;
use planner_api::{
    Command, FailureKind, Mission, Order, OwnShip, OwnState, Planner, PlannerFailure, Situation,
    Waypoint,
};
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};
use toml::Value;

const HELLO: &str =
    r#"{"type":"hello","protocol":1,"name":"script","version":"7","beat_s":null,"needs":[]}"#;

/// A planner that says `hello`, answers `reset` well and does `plan` at every plan. `$n` is the
/// number of the request.
fn script(plan: &str) -> String {
    whole(&format!(
        r#"read l; echo '{HELLO}'; n=0
        while read l; do n=$((n+1)); case "$l" in
          *reset*) echo "{{\"type\":\"ready\",\"seq\":$n}}";;
          *) {plan};;
        esac; done"#
    ))
}

const GOOD: &str =
    r#"echo "{\"type\":\"order\",\"seq\":$n,\"order\":{\"velocity_mps\":[3.5,-1]}}""#;

thread_local! {
    /// The scripts of a test, which runs in a thread of its own; removed at its end.
    static FOLDERS: RefCell<Vec<tempfile::TempDir>> = const { RefCell::new(Vec::new()) };
}

/// A command line for a script, which stands in a file so that its quotation marks stay whole.
fn whole(script: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("planner.sh");
    std::fs::write(&path, script).unwrap();
    FOLDERS.with_borrow_mut(|folders| folders.push(folder));
    format!("exec:sh '{}'", path.display())
}

fn planner(name: &str, options: &[(&str, f64)]) -> Box<dyn Planner> {
    let entry = planner_host::outside(name).unwrap().unwrap();
    let defaults = [("call_limit_s", 1.0), ("start_limit_s", 2.0)];
    let changes = defaults.iter().chain(options);
    let changes = changes.map(|(key, value)| ((*key).to_owned(), Value::Float(*value)));
    (entry.make)(&entry.resolve(&changes.collect()).unwrap()).unwrap()
}

fn mission() -> Mission {
    Mission {
        own: OwnShip {
            length_m: 8.45,
            beam_m: 2.71,
            speed_mps_max: 10.0,
            yaw_rate_radps_max: 0.2,
            acceleration_mps2_max: 0.5,
        },
        route: vec![Waypoint { position_m: Vec2::new(1000.0, 0.0), speed_mps: None }],
        cruise_mps: 7.0,
        safety_radius_m: 150.0,
        between_centres: false,
        beat_s: 1.0,
        hazards: Vec::new(),
        stream_seed: u64::MAX,
    }
}

fn situation(t_s: f64) -> Situation<'static> {
    let own = OwnState {
        position_m: Vec2::zeros(),
        psi_rad: 0.1,
        velocity_mps: Vec2::new(7.0, 0.0),
        cog_rad: 0.0,
        sog_mps: 7.0,
        stw_mps: 7.0,
        yaw_rate_radps: 0.0,
    };
    Situation { t_s, own, tracks: &[], visual_range_m: None }
}

/// One encounter of three beats.
fn encounter(planner: &mut Box<dyn Planner>) -> Result<Vec<Command>, PlannerFailure> {
    let run = || {
        planner.reset(&mission());
        (0..3).map(|beat| planner.plan(&situation(f64::from(beat)))).collect()
    };
    catch_unwind(AssertUnwindSafe(run)).map_err(|payload| *payload.downcast().unwrap())
}

#[track_caller]
fn fails(script: &str, kind: FailureKind, words: &[&str]) -> Duration {
    fails_with(script, &[], kind, words)
}

#[track_caller]
fn fails_with(name: &str, options: &[(&str, f64)], kind: FailureKind, words: &[&str]) -> Duration {
    let mut planner = planner(name, options);
    #[expect(clippy::disallowed_methods, reason = "the limits under test are on the wall clock")]
    let started = Instant::now();
    let failure = encounter(&mut planner).unwrap_err();
    let taken = started.elapsed();
    assert_eq!(failure.kind, kind, "{}", failure.detail);
    for word in words {
        assert!(failure.detail.contains(word), "{word:?} is not in: {}", failure.detail);
    }
    taken
}

fn good() -> Vec<Command> {
    vec![Command::velocity(Vec2::new(3.5, -1.0)); 3]
}

#[test]
fn a_good_planner_serves_many_encounters_in_one_process() {
    let mut planner = planner(&script(GOOD), &[]);
    for _ in 0..5 {
        assert_eq!(encounter(&mut planner).unwrap(), good());
    }
    // `$n` counts within a process: had it been replaced, the numbers would have begun anew too,
    // so count the processes by their number instead
    let by_process =
        r#"echo "{\"type\":\"order\",\"seq\":$n,\"order\":{\"velocity_mps\":[$$,0]}}""#;
    let mut planner = self::planner(&script(by_process), &[]);
    let first = encounter(&mut planner).unwrap();
    assert_eq!(encounter(&mut planner).unwrap(), first);
}

#[test]
fn one_that_dies_costs_its_own_encounter_and_is_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let mark = folder.path().join("died");
    let dies_once = format!(
        "[ -e '{0}' ] || [ $n -ne 3 ] || {{ touch '{0}'; echo last words >&2; exit 7; }}; {GOOD}",
        mark.display()
    );
    let mut planner = planner(&script(&dies_once), &[]);
    let failure = encounter(&mut planner).unwrap_err();
    assert_eq!(failure.kind, FailureKind::Crashed);
    assert!(failure.detail.contains("exit status: 7"), "{}", failure.detail);
    assert!(failure.detail.contains("last words"), "{}", failure.detail);
    assert!(failure.detail.contains("`script` 7"), "{}", failure.detail);
    assert_eq!(encounter(&mut planner).unwrap(), good());
}

#[test]
fn one_that_kills_itself_says_by_which_signal() {
    fails(&script("kill -SEGV $$"), FailureKind::Crashed, &["signal: 11"]);
}

#[test]
fn one_that_hangs_is_ended_at_its_limit() {
    let taken = fails(&script("sleep 1000"), FailureKind::Hung, &["no answer within 1 s"]);
    assert!(taken < Duration::from_secs(4), "{taken:?}");
}

#[test]
fn one_that_hangs_at_the_start_or_in_reset_is_ended_too() {
    fails_with(&whole("sleep 1000"), &[("start_limit_s", 0.3)], FailureKind::Hung, &["0.3 s"]);
    let in_reset = format!("read l; echo '{HELLO}'; sleep 1000");
    fails(&whole(&in_reset), FailureKind::Hung, &["waiting for `ready`"]);
}

#[test]
fn half_a_line_is_not_an_answer() {
    let half = r#"printf '{"type":"order","se'; "#;
    fails(&script(&format!("{half} sleep 1000")), FailureKind::Hung, &["half a line"]);
    fails(&script(&format!("{half} exit 0")), FailureKind::Crashed, &["middle of a line"]);
    // the second half of it is the next answer
    fails(&script(&format!("{half} {GOOD}")), FailureKind::Protocol, &["no `order`"]);
}

#[test]
fn a_flood_of_output_is_cut_off() {
    let endless = "while :; do printf xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx; done";
    let kib = [("output_limit_kib", 64.0)];
    fails_with(&script(endless), &kib, FailureKind::Protocol, &["more than 65536 bytes"]);
    let lines = script("while :; do echo xxxxxxxxxxxxxxxxxxxxxxxx; done");
    fails_with(&lines, &kib, FailureKind::Protocol, &["no `order`"]);
    let after_a_good_answer = script(&format!("while :; do {GOOD}; done"));
    fails_with(
        &after_a_good_answer,
        &kib,
        FailureKind::Protocol,
        &["number 2 to request number 3"],
    );
}

#[test]
fn answers_out_of_order_and_of_the_wrong_kind_break_the_protocol() {
    let late = GOOD.replace("$n", "$((n-1))");
    fails(&script(&late), FailureKind::Protocol, &["number 1 to request number 2"]);
    let ready = r#"echo "{\"type\":\"ready\",\"seq\":$n}""#;
    fails(&script(ready), FailureKind::Protocol, &["no `order`", "ready"]);
    for wrong in [
        r#"{\"type\":\"order\",\"seq\":$n}"#,
        r#"{\"type\":\"order\",\"seq\":$n,\"order\":{\"velocity_mps\":[1]}}"#,
        r#"{\"type\":\"order\",\"seq\":$n,\"order\":{\"velocity_mps\":[1,\"2\"]}}"#,
        r#"{\"type\":\"order\",\"seq\":$n,\"order\":{\"velocity_mps\":[1,2]},\"speed\":1}"#,
        r#"{\"type\":\"order\",\"seq\":$n,\"order\":{\"course_speed\":{\"course_rad\":1}}}"#,
        "",
        "hello",
    ] {
        fails(&script(&format!("echo \"{wrong}\"")), FailureKind::Protocol, &["no `order`"]);
    }
}

#[test]
fn what_is_left_over_from_one_encounter_is_not_charged_to_the_next() {
    // one answer too many at the third plan of the first encounter (request 4)
    let too_many = format!("{GOOD}; if [ $n -eq 4 ]; then {GOOD}; fi");
    let mut planner = planner(&script(&too_many), &[]);
    for _ in 0..3 {
        assert_eq!(encounter(&mut planner).unwrap(), good());
    }
    // and one that ends between two encounters
    let mut planner = self::planner(&script(&format!("{GOOD}; [ $n -lt 4 ] || exit 0")), &[]);
    for _ in 0..3 {
        assert_eq!(encounter(&mut planner).unwrap(), good());
    }
}

#[test]
fn another_version_and_unknown_needs_are_refused() {
    let hello =
        |from: &str, to: &str| whole(&format!("read l; echo '{}'; cat", HELLO.replace(from, to)));
    let version = hello("\"protocol\":1", "\"protocol\":2");
    fails(&version, FailureKind::Protocol, &["speaks protocol 2, the bench 1"]);
    let needs = hello("[]", "[\"the_truth\"]");
    fails(&needs, FailureKind::Protocol, &["needs `the_truth`", "covariance"]);
    let beat = hello("null", "0.5");
    fails(&beat, FailureKind::Protocol, &["every 0.5 s, the campaign 1 s"]);
    fails(&hello("hello", "hi"), FailureKind::Protocol, &["no `hello`"]);
}

#[test]
fn numbers_that_are_not_finite_are_no_break_of_the_protocol() {
    for word in ["NaN", "nan", "-nan", "Infinity", "-inf", "1e999", "null"] {
        let mut planner = planner(&script(&GOOD.replace("3.5", word)), &[]);
        for command in encounter(&mut planner).unwrap() {
            let Order::Velocity { velocity_mps } = command.order else { panic!("{command:?}") };
            assert!(!velocity_mps.x.is_finite(), "{word}");
            assert_eq!(
                command.order.checked(10.0, 0.0),
                Err(planner_api::CommandError::NonFinite),
                "{word}"
            );
        }
    }
}

#[test]
fn memory_is_limited() {
    let doubling = "x=0123456789abcdef; while :; do x=$x$x; done";
    let mib = [("memory_limit_mib", 128.0), ("call_limit_s", 20.0)];
    let failure = |name: &str| {
        let mut planner = planner(name, &mib);
        encounter(&mut planner).unwrap_err()
    };
    let failure = failure(&script(doubling));
    assert_eq!(failure.kind, FailureKind::Crashed, "{}", failure.detail);
}

#[test]
fn what_a_planner_starts_dies_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let pid = folder.path().join("pid");
    // the grandchild holds the pipes open, so that the end of the output never comes
    let forks = format!("sleep 1000 & echo $! > '{}'; exit 5", pid.display());
    fails(&script(&forks), FailureKind::Crashed, &["exit status: 5"]);
    let pid: i32 = std::fs::read_to_string(pid).unwrap().trim().parse().unwrap();
    assert!(is_gone(pid), "the grandchild {pid} outlived the planner");
    // and where the planner goes on well, it dies with the planner's end
    let path = folder.path().join("pid2");
    let keeps =
        format!("[ -e '{0}' ] || {{ sleep 1000 & echo $! > '{0}'; }}; {GOOD}", path.display());
    let mut planner = planner(&script(&keeps), &[]);
    assert_eq!(encounter(&mut planner).unwrap(), good());
    let pid: i32 = std::fs::read_to_string(path).unwrap().trim().parse().unwrap();
    assert!(!is_gone(pid));
    drop(planner);
    assert!(is_gone(pid), "the grandchild {pid} outlived the planner");
}

/// A process that is gone, or only waits for somebody to ask after it.
fn is_gone(pid: i32) -> bool {
    for _ in 0..100 {
        let state = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
        if state.is_empty() || state.contains(") Z ") {
            return true;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    false
}

#[test]
fn standard_error_without_end_is_emptied_and_its_end_is_kept() {
    let noisy =
        format!("i=0; while [ $i -lt 5000 ]; do i=$((i+1)); echo noise $i >&2; done; {GOOD}");
    let mut planner = planner(&script(&noisy), &[("call_limit_s", 20.0)]);
    assert_eq!(encounter(&mut planner).unwrap(), good());
    let endless = "while :; do echo no end in sight >&2; done";
    fails(&script(endless), FailureKind::Hung, &["no end in sight"]);
}

#[test]
fn one_that_never_reads_is_not_waited_for_for_ever() {
    let deaf = format!("echo '{HELLO}'; exec sleep 1000");
    fails(&whole(&deaf), FailureKind::Hung, &["waiting for `ready`"]);
}

#[test]
fn one_that_cannot_be_started_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("planner");
    std::fs::write(&path, "#!/no/such/interpreter\n").unwrap();
    let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    std::fs::set_permissions(&path, mode).unwrap();
    let name = format!("exec:'{}'", path.display());
    fails(&name, FailureKind::Crashed, &["cannot be started"]);
}
