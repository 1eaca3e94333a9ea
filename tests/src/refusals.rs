//! Bad input of every kind ends in one clear message, exit 2, and no half-written output.

use crate::support::{run_err, run_ok, seatrial};
use std::fs;
use std::path::Path;

const QUICK: &str = include_str!("../../campaigns/quick.toml");

/// Writes a changed copy of the default campaign.
fn changed(folder: &Path, from: &str, to: &str) -> &'static str {
    assert!(QUICK.contains(from), "the default campaign no longer says `{from}`");
    fs::write(folder.join("changed.toml"), QUICK.replacen(from, to, 1)).unwrap();
    "campaign changed.toml --encounters 1 --out out --quiet"
}

#[test]
fn wrong_campaign_files_are_refused_with_place_and_reason() {
    let cases = [
        ("step_s = 0.5", "step = 0.5", &["step", "step_s"][..]),
        ("step_s = 0.5", "step_s = \"fast\"", &["step_s", "line"]),
        ("step_s = 0.5", "step_s = nan", &["step_s"]),
        ("step_s = 0.5", "step_s = 0.3", &["step_s", "beat_s"]),
        ("safety_radius_m = 150.0", "safety_radius_m = -1.0", &["safety_radius_m"]),
        (
            "speed_mps = { uniform = [5.0, 9.0] }",
            "speed_mps = { uniform = [9.0, 5.0] }",
            &["speed_mps"],
        ),
        (
            "speed_mps = { uniform = [5.0, 9.0] }",
            "speed_mps = { uniform = [nan, 9.0] }",
            &["speed_mps"],
        ),
        ("speed_mps = { uniform = [5.0, 9.0] }", "speed_mps = { gauss = [5.0, 9.0] }", &["gauss"]),
        ("class = \"head_on\"", "class = \"head-on\"", &["head-on", "head_on"]),
        ("vessel = \"viknes\"", "vessel = \"vikness\"", &["vikness", "viknes"]),
        ("planners = [\"zhuang\"]", "planners = [\"zuang\"]", &["zuang", "zhuang"]),
        ("planners = [\"zhuang\"]", "planners = []", &["planners"]),
        ("rules = \"usv-oe2023-v1\"", "rules = \"mine\"", &["mine", "usv-oe2023-v1"]),
        ("schema = 1", "schema = 2", &["schema"]),
        ("schema = 1", "schema 1", &["line"]),
    ];
    for (from, to, words) in cases {
        let folder = tempfile::tempdir().unwrap();
        let line = changed(folder.path(), from, to);
        let said = run_err(folder.path(), line, 2);
        for word in words {
            assert!(said.contains(word), "`{to}`: the message does not say {word}: {said}");
        }
        assert!(!folder.path().join("out").exists(), "`{to}` left output behind");
    }
}

#[test]
fn wrong_command_lines_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (line, word) in [
        ("campaign nowhere", "quick"),
        ("campaign nowhere.toml", "nowhere.toml"),
        ("campaign --planner nobody", "zhuang"),
        ("campaign --encounters 0", "encounters"),
        ("campaign --encounters many", "many"),
        ("campaign --shard 0/3", "1"),
        ("campaign --shard 4/3", "4/3"),
        ("campaign --threads 0", "threads"),
        ("campaign --fast", "--fast"),
        ("campaign quick --situations nowhere.json", "no [situations] table"),
        ("campaign --situations nowhere.json", "nowhere.json"),
        ("replay nowhere head_on/000000", "nowhere"),
        ("frobnicate", "frobnicate"),
    ] {
        let said = run_err(folder.path(), line, 2);
        assert!(said.contains(word), "`{line}`: the message does not say {word}: {said}");
        assert!(!folder.path().join("reports").exists(), "`{line}` left output behind");
    }
}

/// A redirection to a full disk: told once, however many lines are cut, and not called done.
#[test]
fn output_that_cannot_be_printed_is_told_once() {
    let folder = tempfile::tempdir().unwrap();
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = seatrial(folder.path()).arg("planners").stdout(full).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert_eq!(said.matches("standard output was cut").count(), 1, "{said}");
}

#[test]
fn folders_that_hold_something_else_are_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let mine = folder.path().join("mine");
    fs::create_dir(&mine).unwrap();
    fs::write(mine.join("thesis.txt"), "three years of work").unwrap();
    for line in [
        "campaign --encounters 1 --out mine --quiet",
        "campaign --encounters 1 --out mine --quiet --force",
    ] {
        let said = run_err(folder.path(), line, 2);
        assert!(said.contains("mine") && said.contains("not made by this tool"), "{said}");
    }
    assert_eq!(fs::read_to_string(mine.join("thesis.txt")).unwrap(), "three years of work");

    run_ok(folder.path(), "campaign --encounters 1 --out result --quiet");
    let said = run_err(folder.path(), "campaign --encounters 1 --seed 5 --out result --quiet", 2);
    assert!(said.contains("seed") && said.contains('5'), "it names what differs: {said}");
    let said = run_ok(folder.path(), "campaign --encounters 1 --out result");
    assert!(said.contains("finished already"), "{said}");
    run_ok(folder.path(), "campaign --encounters 1 --seed 5 --out result --quiet --force");
}
