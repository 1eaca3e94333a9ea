//! The walk of `docs/your-planner.md`, with its own words: the planner that it spells out runs in
//! an empty folder under the command that it gives, and conforms. Installing the package is left
//! out, because that asks the network for a build tool; its one file is on Python's path.

use crate::support::{rows, seatrial};
use std::fs;
use std::path::Path;

/// The indented block of the document that begins with the fence `opening`.
fn block(document: &str, opening: &str) -> String {
    let block = document.split(opening).nth(1).unwrap().split("```").next().unwrap();
    let lines = block.lines().map(|line| line.strip_prefix("   ").unwrap_or(line));
    lines.collect::<Vec<&str>>().join("\n")
}

/// The arguments of the first command of the document that begins so.
fn arguments(document: &str, beginning: &str) -> Vec<String> {
    let line = document.lines().find_map(|line| line.trim().strip_prefix(beginning)).unwrap();
    let mut quoted = false;
    let words = line.trim_matches(['`', '(', ')', ':']).split(|c| {
        quoted ^= c == '\'';
        c == ' ' && !quoted
    });
    words.map(|word| word.replace('\'', "")).filter(|word| !word.is_empty()).collect()
}

#[test]
fn the_planner_of_the_document_runs_in_an_empty_folder() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let document = fs::read_to_string(repository.join("docs/your-planner.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("mine.py"), block(&document, "```python")).unwrap();
    let campaign = arguments(&document, "seatrial campaign quick --planner 'exec:python3 mine.py'");
    assert_eq!(campaign, ["--encounters", "20"]);
    for arguments in [
        vec!["campaign", "quick", "--planner", "exec:python3 mine.py", "--encounters", "20"],
        vec!["conformance", "--planner", "exec:python3 mine.py"],
    ] {
        let output = seatrial(path)
            .args(&arguments)
            .env("PYTHONPATH", repository.join("python"))
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {said}");
    }
    let rows = rows(&path.join("reports/quick-exec_python3_mine.py"));
    assert_eq!(rows.len(), 180);
    assert!(rows.iter().all(|row| !row.outcome.is_planner_failure()));
    // it looks at nobody, as the document says
    assert!(rows.iter().any(|row| row.safety_radius_broken));
}

/// No collision in a run in which the planner never answered is no good news: the terminal says so.
/// In the planner's own words where its process did not end, since the run can be repeated there.
#[test]
fn a_planner_that_does_not_start_is_told_on_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let run = |planner: &str, arguments: &[&str], code: i32| {
        let mut command = seatrial(folder.path());
        let output = command.args(arguments).args(["--planner", planner]).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let campaign = |planner: &str, out: &str| {
        run(planner, &["campaign", "laboratory", "--encounters", "1", "--out", out], 0)
    };
    let (absent, rude) = ("exec:python3 nowhere.py", "exec:sh -c 'echo good-day; cat'");
    let said = campaign(absent, "absent");
    assert!(said.contains("the planner failed in 9 of 9 runs (9 planner_crashed)"), "{said}");
    let said = campaign(rude, "rude");
    assert!(said.contains("the planner failed in 9 of 9 runs (9 planner_protocol)"), "{said}");
    assert!(said.contains("it wrote: good-day"), "{said}");
    let said = run(absent, &["conformance"], 1);
    assert!(said.contains("planner_crashed") && said.contains("can't open file"), "{said}");
}
