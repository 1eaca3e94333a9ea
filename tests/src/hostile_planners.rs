//! Planners from outside that misbehave in a campaign: each way costs the encounters in which it
//! happens, under its name and with the last lines that the planner said, and no other row; the
//! limits that end them stand in the campaign file.

use crate::support::{json, rows, run_ok};
use record::{Outcome, RunRow};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The planner, apart from what it does wrong: steers for the goal, and does `ACT` in one
/// encounter of eight, chosen by the seed of its stream.
const SCRIPT: &str = r#"
import json, os, sys, time

act = sys.argv[1]
guilty = False


def say(message):
    sys.stdout.write(json.dumps(message) + "\n")
    sys.stdout.flush()


def nth_process():
    with open("processes-" + act, "a") as file:
        file.write("x")
        return file.tell()


def misbehave(seq, answer):
    print("last words:", act, file=sys.stderr, flush=True)
    if act == "dies":
        os._exit(3)
    if act == "is-killed":
        os.kill(os.getpid(), 9)
    if act == "hangs":
        time.sleep(1000)
    if act == "floods":
        while True:
            sys.stdout.write("x" * 1000)
    if act == "out-of-order":
        answer["seq"] = seq - 1
    if act == "half-a-line":
        sys.stdout.write(json.dumps(answer)[:20])
        sys.stdout.flush()
        time.sleep(1000)
    if act == "nan":
        answer["order"] = {"velocity_mps": [float("nan"), 1.0]}
    if act == "too-fast":
        answer["order"] = {"velocity_mps": [1000.0, 0.0]}
    if act == "memory":
        answer["order"] = {"velocity_mps": [float(len(bytearray(1 << 30))), 0.0]}
    if act == "forks":
        open("forks.pids", "a").close()
        for _ in range(20):
            if os.fork() == 0:
                with open("forks.pids", "a") as file:
                    file.write(f"{os.getpid()}\n")
                time.sleep(1000)
                os._exit(0)
        while open("forks.pids").read().count("\n") < 20:
            time.sleep(0.01)
        os._exit(5)
    if act == "noisy":
        while True:
            print("no end in sight", file=sys.stderr)
    say(answer)


for line in sys.stdin:
    request = json.loads(line)
    kind, seq = request["type"], request.get("seq")
    if kind == "hello":
        first = nth_process() == 1
        if act == "slow-start" and first:
            time.sleep(1000)
        protocol = 2 if act == "wrong-version" and first else 1
        say({"type": "hello", "protocol": protocol, "name": act, "version": "1"})
    elif kind == "reset":
        mission = request["mission"]
        goal, cruise = mission["route"][-1]["position_m"], mission["cruise_mps"]
        guilty = int(mission["stream_seed"][:4], 16) % 8 == 0
        say({"type": "ready", "seq": seq})
    else:
        north, east = (goal[k] - request["own"]["position_m"][k] for k in (0, 1))
        far = max((north * north + east * east) ** 0.5, 1.0)
        order = {"velocity_mps": [north * cruise / far, east * cruise / far]}
        answer = {"type": "order", "seq": seq, "order": order}
        if guilty and request["t_s"] >= 20.0:
            misbehave(seq, answer)
        else:
            say(answer)
"#;

const ENCOUNTERS: usize = 24;

/// A campaign of one stratum in the laboratory, with the limits of its planner in the file.
fn campaign(
    folder: &Path,
    name: &str,
    planner: &str,
    limits: &str,
    hang_limit_s: f64,
) -> Vec<RunRow> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../campaigns/laboratory.toml");
    let mut table: toml::Table = fs::read_to_string(file).unwrap().parse().unwrap();
    table.insert("planners".into(), toml::Value::Array(vec![planner.into()]));
    let run = table["run"].as_table_mut().unwrap();
    run.insert("twice_run_share".into(), 0.0.into());
    run.insert("planner_hang_limit_s".into(), hang_limit_s.into());
    let model = table["model"].as_table_mut().unwrap();
    let strata = model["stratum"].as_array().unwrap()[1..2].to_vec();
    model.insert("stratum".into(), toml::Value::Array(strata));
    let limits: toml::Table = limits.parse().unwrap();
    let planners = toml::Table::from_iter([(planner.to_owned(), limits.into())]);
    table.insert("planner".into(), planners.into());
    fs::write(folder.join(format!("{name}.toml")), table.to_string()).unwrap();
    run_ok(
        folder,
        &format!("campaign {name}.toml --encounters {ENCOUNTERS} --threads 2 --out {name} --quiet"),
    );
    rows(&folder.join(name))
}

/// One way to fail, how it is called, and the words that its row must have.
struct Way {
    act: &'static str,
    limits: &'static str,
    outcome: Outcome,
    words: &'static [&'static str],
    /// Whether it fails in the first encounter that a process is started for, and not by the seed.
    at_start: bool,
}

// The limits are on the wall clock: long enough that a busy machine loses nobody else.
const fn way(act: &'static str, outcome: Outcome, words: &'static [&'static str]) -> Way {
    Way { act, limits: "call_limit_s = 1.5", outcome, words, at_start: false }
}

const WAYS: [Way; 13] = [
    way("dies", Outcome::PlannerCrashed, &["exit status: 3", "last words: dies"]),
    way("is-killed", Outcome::PlannerCrashed, &["SIGKILL", "last words: is-killed"]),
    way("hangs", Outcome::PlannerHung, &["no answer within 1.5 s", "last words: hangs"]),
    Way {
        limits: "output_limit_kib = 64",
        ..way("floods", Outcome::PlannerProtocol, &["more than 65536 bytes", "last words: floods"])
    },
    way("out-of-order", Outcome::PlannerProtocol, &["to request number", "last words: out-of"]),
    way("half-a-line", Outcome::PlannerHung, &["half a line", "last words: half-a-line"]),
    way("nan", Outcome::PlannerNonFinite, &[]),
    way("too-fast", Outcome::PlannerOutOfRange, &[]),
    Way {
        limits: "memory_limit_mib = 256",
        ..way("memory", Outcome::PlannerCrashed, &["MemoryError"])
    },
    way("forks", Outcome::PlannerCrashed, &["exit status: 5", "last words: forks"]),
    way("noisy", Outcome::PlannerHung, &["no end in sight"]),
    Way {
        at_start: true,
        ..way("wrong-version", Outcome::PlannerProtocol, &["speaks protocol 2"])
    },
    Way {
        limits: "start_limit_s = 5",
        at_start: true,
        ..way("slow-start", Outcome::PlannerHung, &["waiting for `hello`: no answer within 5 s"])
    },
];

/// Every row but the guilty ones is that of the planner which behaves.
fn compare(name: &str, outcome: Outcome, words: &[&str], bad: &[RunRow], good: &[RunRow]) -> usize {
    assert_eq!((bad.len(), good.len()), (ENCOUNTERS, ENCOUNTERS), "{name}");
    let mut guilty = 0;
    for (row, was) in bad.iter().zip(good) {
        if row == was {
            continue;
        }
        guilty += 1;
        assert_eq!(row.outcome, outcome, "{name}: {} {:?}", row.id, row.planner_detail);
        assert!(row.unknown, "{name}: {} must count against the planner", row.id);
        let detail = row.planner_detail.as_deref().unwrap_or_default();
        for word in words {
            assert!(detail.contains(word), "{name}: `{word}` is not in: {detail}");
        }
    }
    guilty
}

/// Ways that are tried at once.
const LANES: usize = 3;

fn planner(act: &str) -> String {
    format!("exec:python3 planner.py {act}")
}

/// A campaign with a planner that fails in this way, beside one with `good` rows. How many
/// encounters it cost, where the seed says which.
fn fails(path: &Path, way: &Way, good: &[RunRow]) -> Option<usize> {
    let Way { act, limits, outcome, words, at_start } = *way;
    let bad = campaign(path, act, &planner(act), limits, 8.0);
    let guilty = compare(act, outcome, words, &bad, good);
    let started = fs::metadata(path.join(format!("processes-{act}"))).unwrap().len() as usize;
    if at_start {
        // two workers and a new process for one of them; those of the report's cases come later
        assert!(guilty == 1 && started >= 3, "{act}: {started} processes, {guilty} lost");
        return None;
    }
    // orders that are no numbers, or too large, leave the process as it is
    let stays = matches!(outcome, Outcome::PlannerNonFinite | Outcome::PlannerOutOfRange);
    assert!(stays || started >= 2 + guilty - 1, "{act}: {started} processes, {guilty} lost");
    let clocked = if outcome.is_wall_clock() { guilty } else { 0 };
    let summary = json(path.join(act).join("summary.json"));
    assert_eq!(summary["ended_by_wall_clock"], clocked, "{act}");
    Some(guilty)
}

#[test]
fn each_way_to_fail_costs_its_own_encounters_and_is_told_in_its_row() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("planner.py"), SCRIPT).unwrap();
    let good = campaign(path, "behaves", &planner("behaves"), "", 8.0);
    assert!(good.iter().all(|row| !row.outcome.is_planner_failure()));
    assert_eq!(json(path.join("behaves/summary.json"))["ended_by_wall_clock"], 0);
    // most of the time is spent in waiting for limits to run out
    let lanes = std::thread::scope(|scope| {
        let lane = |lane: usize| {
            let good = &good;
            scope.spawn(move || {
                let ways = WAYS.iter().skip(lane).step_by(LANES);
                ways.filter_map(|way| fails(path, way, good)).collect::<Vec<usize>>()
            })
        };
        let lanes: [_; LANES] = std::array::from_fn(lane);
        lanes.map(|lane| lane.join().unwrap())
    });
    let shares = lanes.concat();
    assert_eq!(shares.len(), WAYS.iter().filter(|way| !way.at_start).count());
    // the same encounters in each way, and the test shows something
    assert!(shares[0] > 0 && shares[0] < 15, "{shares:?}");
    assert!(shares.iter().all(|share| *share == shares[0]), "{shares:?}");
    let pids = fs::read_to_string(path.join("forks.pids")).unwrap();
    for pid in pids.lines() {
        let state = fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
        let gone = state.is_empty() || state.contains(") Z ") || !state.contains("python");
        assert!(gone, "process {pid} outlived its planner: {state}");
    }
}

/// A library runs in the engine, and takes it along; the supervisor finds out who it was.
const LIBRARY: &str = r#"
#include "seatrial_planner.h"
#include <stdio.h>
#include <stdlib.h>

struct mine { double north_m, east_m, cruise_mps; int guilty; };

static void *create(void) { return calloc(1, sizeof(struct mine)); }

static int32_t reset(void *it, const struct SeatrialMission *mission) {
    struct mine *mine = it;
    const struct SeatrialWaypoint *goal = &mission->route[mission->route_len - 1];
    mine->north_m = goal->north_m;
    mine->east_m = goal->east_m;
    mine->cruise_mps = mission->cruise_mps;
    mine->guilty = (mission->stream_seed >> 48) % 8 == 0;
    return 0;
}

static int32_t plan(void *it, const struct SeatrialSituation *seen, struct SeatrialCommand *out) {
    struct mine *mine = it;
    if (mine->guilty && seen->t_s >= 20.0) {
        fprintf(stderr, "last words: %s\n", NAME);
        ACT;
    }
    double north_m = mine->north_m - seen->own.north_m, east_m = mine->east_m - seen->own.east_m;
    double far_m = __builtin_sqrt(north_m * north_m + east_m * east_m);
    if (far_m < 1.0) far_m = 1.0;
    out->kind = SEATRIAL_VELOCITY;
    out->north_mps = north_m * mine->cruise_mps / far_m;
    out->east_mps = east_m * mine->cruise_mps / far_m;
    return 0;
}

static const struct SeatrialPlanner planner = {
    SEATRIAL_PLANNER_ABI, NAME, "1", create, reset, plan, free,
};

const struct SeatrialPlanner *seatrial_planner_v1(void) { return &planner; }
"#;

fn library(folder: &Path, name: &str, act: &str) -> String {
    let (source, output) = (folder.join(format!("{name}.c")), folder.join(format!("{name}.so")));
    fs::write(&source, LIBRARY).unwrap();
    let header = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/planner-host/include");
    let compiled = Command::new("cc")
        .args(["-O1", "-ffp-contract=off", "-shared", "-fPIC"])
        .args([format!("-DNAME=\"{name}\""), format!("-DACT={act}")])
        .arg("-I")
        .args([header.as_os_str(), source.as_os_str()])
        .arg("-o")
        .arg(&output)
        .status();
    assert!(compiled.unwrap().success(), "{name} does not compile");
    format!("lib:./{name}.so")
}

#[test]
fn a_library_that_takes_the_engine_with_it_costs_its_own_encounters() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let good = campaign(path, "good", &library(path, "good", "(void)0"), "", 2.0);
    assert!(good.iter().all(|row| !row.outcome.is_planner_failure()));
    for (name, act, outcome, words) in [
        (
            "segfaults",
            "*(volatile int *)0 = 1",
            Outcome::PlannerCrashed,
            &["signal: 11 (SIGSEGV)", "last words: segfaults"][..],
        ),
        ("exits", "exit(0)", Outcome::PlannerCrashed, &["exit", "last words: exits"][..]),
        (
            "spins",
            "for (;;)",
            Outcome::PlannerHung,
            &["no answer within 2 s", "last words: spins"][..],
        ),
    ] {
        let bad = campaign(path, name, &library(path, name, act), "", 2.0);
        let guilty = compare(name, outcome, words, &bad, &good);
        assert!(guilty > 0 && guilty < 15, "{name}: {guilty}");
    }
}
