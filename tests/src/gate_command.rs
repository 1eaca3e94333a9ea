//! The gate as its users meet it: verdicts, exit codes, files, and what it refuses.

use crate::support::{json, rows, run, run_err, run_ok, seatrial};
use std::fs;
use std::path::Path;

const REPOSITORY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// The gate of the repository with margins that a few hundred pairs can show.
fn small_campaign(folder: &Path) {
    let text = fs::read_to_string(format!("{REPOSITORY}/campaigns/gate.toml")).unwrap();
    let (mut small, mut rest) = (String::new(), text.as_str());
    while let Some((before, after)) = rest.split_once("difference = ") {
        let end = after.find(' ').unwrap();
        small.push_str(before);
        small.push_str("difference = 0.2");
        rest = &after[end..];
    }
    small.push_str(rest);
    let small = small
        .replace("rate_max = 1e-2", "rate_max = 0.9")
        .replace("rate_max = 1e-1", "rate_max = 0.9")
        .replace("cap_pairs = 500000", "cap_pairs = 700")
        .replace("look_every_pairs = 1000", "look_every_pairs = 70");
    fs::write(folder.join("small.toml"), small).unwrap();
}

#[test]
fn a_planner_passes_against_itself_and_a_broken_one_fails_with_its_replay() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    small_campaign(folder);
    let output = seatrial(folder)
        .args("gate --campaign small.toml --baseline zhuang --candidate zhuang".split(' '))
        .args(["--series", "x", "--out", "same", "--quiet"])
        .env("GITHUB_STEP_SUMMARY", folder.join("page.md"))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("gate: PASS") && said.contains("0 runs differ"), "{said}");
    assert!(said.contains("minutes for 20000 pairs"), "the time is said beforehand: {said}");
    let page = fs::read_to_string(folder.join("page.md")).unwrap();
    assert!(page.starts_with("## Planner gate: PASS"), "{page}");
    assert_eq!(fs::read_to_string(folder.join("same/summary.md")).unwrap(), page);

    let line = "gate --campaign small.toml --baseline zhuang --candidate hold-course --series x \
                --out worse --quiet";
    let output = run(folder, line);
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("gate: FAIL"), "{said}");
    assert!(said.contains("attempt 2 of `x`"), "another candidate is another attempt: {said}");
    assert!(said.lines().count() <= 45, "one screen: {said}");
    let junit = fs::read_to_string(folder.join("worse/junit.xml")).unwrap();
    assert!(junit.contains("<failure"), "{junit}");
    let report = json(folder.join("worse/gate.json"));
    assert_eq!(report["verdict"], "fail");
    let failure = &report["new_failures"][0]["encounter"];
    let failure =
        format!("{}/{:06}", failure["stratum"].as_str().unwrap(), failure["j"].as_u64().unwrap());
    assert!(said.contains(&format!("gate --replay {failure} --out worse")), "{said}");
    let replayed = run_ok(folder, &format!("gate --replay {failure} --out worse"));
    assert!(replayed.contains("candidate hold-course") && replayed.contains("picture"));

    let hurried = fs::read_to_string(folder.join("small.toml")).unwrap();
    // a few encounters, and a share of them that is never none: 0.75 to the 28th is 3e-4
    let hurried = hurried
        .replace("planner_hang_limit_s = 10.0", "planner_hang_limit_s = 0.3")
        .replace("cap_pairs = 700", "cap_pairs = 28")
        .replace("look_every_pairs = 70", "look_every_pairs = 28");
    fs::write(folder.join("hurried.toml"), hurried).unwrap();
    let line = "gate --campaign hurried.toml --baseline zhuang --candidate spins --series y \
                --candidate-option share=0.25 --out slow --quiet";
    let said = run(folder, line).stdout;
    let said = String::from_utf8_lossy(&said);
    assert!(said.contains("a limit on the wall clock ended"), "{said}");
    let page = fs::read_to_string(folder.join("slow/summary.md")).unwrap();
    assert!(page.contains("**a limit on the wall clock ended"), "{page}");
    let ended = &json(folder.join("slow/gate.json"))["ended_by_wall_clock"];
    assert!(ended["candidate"].as_u64() > Some(0) && ended["baseline"] == 0, "{ended}");
}

#[test]
fn what_a_gate_cannot_do_is_refused_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("results")).unwrap();
    for (line, says) in [
        ("gate --candidate zhuang", "--baseline"),
        ("gate --baseline zhuang", "--candidate"),
        ("gate --baseline results --candidate zhuang", "is a folder"),
        ("gate --baseline zhuang --candidate results", "is a folder"),
        ("gate --baseline zhuang --candidate zhuangg", "zhuangg"),
        ("gate --baseline git:main --candidate zhuang", "git"),
        ("gate --baseline git:main:exec:./x --candidate zhuang", "is not built from this"),
        ("gate --baseline zhuang --candidate git:main", "--baseline git:REV"),
        ("gate --baseline zhuang --candidate zhuang --cap 20000", "needs a cap of"),
        ("gate --baseline zhuang --candidate zhuang --campaign quick", "no table [gate]"),
        ("gate --baseline zhuang --candidate zhuang --candidate-option x", "is no option"),
        ("gate --baseline zhuang --candidate zhuang --candidate-option no_such=1", "no_such"),
        ("gate --baseline zhuang --candidate zhuang --threads 0", "--threads"),
        ("gate --small --candidate zhuang", "--self-test"),
        ("gate --replay head_on/000001", "gate.json"),
        ("baseline --planner zhuang", "git"),
        ("shrink results head_on/000001", "results"),
        ("corpus results", "holds no case"),
    ] {
        let said = run_err(folder, line, 2);
        assert!(said.contains(says), "`{line}` does not say `{says}`: {said}");
    }
    assert!(!folder.join("reports").exists(), "a refusal writes nothing");
}

/// From a campaign's failure to a case, and from a judge that moved to a refreshed case.
#[test]
fn a_failure_becomes_a_case_that_is_checked_and_refreshed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    run_ok(folder, "campaign quick --planner hold-course --encounters 3 --out result --quiet");
    let row = rows(&folder.join("result")).into_iter().find(|row| row.safety_radius_broken);
    let id = row.unwrap().id;
    let line = format!("shrink result {id} --event safety_radius --name held --out corpus");
    let said = run_ok(folder, &line);
    assert!(said.contains("changes kept"), "{said}");
    assert!(run_err(folder, &line, 2).contains("--force"));
    let wrong = format!("shrink result {id} --event planner_failure --name other --out corpus");
    assert!(run_err(folder, &wrong, 2).contains("does not do `planner_failure`"));

    let said = run_ok(folder, "corpus corpus --planner zhuang-corrected");
    assert!(said.contains("held: hold-course does"), "{said}");
    assert!(said.contains("  zhuang-corrected "), "{said}");
    let path = folder.join("corpus/held.toml");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replacen("events = [", "events = [\"r19\", ", 1)).unwrap();
    let output = run(folder, "corpus corpus");
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).contains("- r19"));
    run_ok(folder, "corpus corpus --refresh");
    assert_eq!(fs::read_to_string(&path).unwrap(), text, "refreshed to what it was");
}
