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
        (
            "[model.own]",
            "[planner.zhuang]\nradus = \"hull\"\n[model.own]",
            &["changed.toml, line 29", "radus", "radius"],
        ),
        ("carried = 0.85", "carried = 1.85", &["changed.toml", "1.85"]),
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
        ("campaign --encounters 18446744073709551615", "at most 1111111111 of each"),
        ("campaign --encounters 1 --planner zhuang --planner zhuang", "twice"),
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

/// A mistake that belongs to the second planner is told before the first has run for hours.
#[test]
fn folders_of_several_planners_are_looked_at_before_the_first_runs() {
    let folder = tempfile::tempdir().unwrap();
    let write = |path: &str| {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "three years of work").unwrap();
    };
    let line = |out: &str| {
        format!(
            "campaign --encounters 1 --planner zhuang --planner hold-course --quiet --out {out}"
        )
    };
    write("mine/thesis.txt");
    write("second/hold-course/thesis.txt");
    run_ok(folder.path(), "campaign --encounters 1 --out single --quiet");
    for (out, word) in
        [("mine", "thesis.txt"), ("second", "thesis.txt"), ("single", "for each planner")]
    {
        let said = run_err(folder.path(), &line(out), 2);
        assert!(said.contains(out) && said.contains(word), "{said}");
        assert!(!folder.path().join(out).join("zhuang").exists(), "{out} was begun");
    }
    run_ok(folder.path(), &line("both"));
    let said = run_ok(folder.path(), &line("both").replace("--quiet ", ""));
    assert!(said.contains("finished already"), "{said}");
    let said = run_err(folder.path(), "slurm quick --shards 3 --out mine", 2);
    assert!(said.contains("thesis.txt"), "{said}");
}

#[test]
fn what_asks_for_a_finished_result_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let campaign = "campaign laboratory --encounters 1 --shard 1/2 --out part --quiet";
    run_ok(folder.path(), campaign);
    for line in
        ["replay part head_on/000000", "judge part --rules micro-v1", "evidence part --out pack"]
    {
        let said = run_err(folder.path(), line, 2);
        assert!(said.contains("part is not finished"), "{line}: {said}");
    }
}

/// A redirection to a full disk: told once, however many lines are cut, and not called done.
#[test]
fn output_that_cannot_be_printed_is_told_once() {
    let folder = tempfile::tempdir().unwrap();
    let on_full_disk = |argument: &str| {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        seatrial(folder.path()).arg(argument).stdout(full).output().unwrap()
    };
    let output = on_full_disk("planners");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert_eq!(said.matches("standard output was cut").count(), 1, "{said}");
    assert_eq!(on_full_disk("--help").status.code(), Some(3));
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
