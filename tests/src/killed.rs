//! Killed in the middle and resumed, a campaign ends as one never stopped.

use crate::support::{assert_same_result, run_err, run_ok, seatrial};
use std::path::Path;
use std::process::Stdio;
use std::sync::OnceLock;
use std::time::Duration;
use tempfile::TempDir;

const CAMPAIGN: &str =
    "campaign laboratory --encounters 510 --threads 2 --quiet --planner hold-course";

/// The campaign as it is when nobody stops it.
fn straight() -> &'static Path {
    static STRAIGHT: OnceLock<TempDir> = OnceLock::new();
    let folder = STRAIGHT.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        run_ok(folder.path(), &format!("{CAMPAIGN} --out ."));
        folder
    });
    folder.path()
}

/// Waits until at least `parts` parts are there.
fn wait_for_parts(result: &Path, parts: usize) {
    for _ in 0..6000 {
        let there = std::fs::read_dir(result.join("state/parts"))
            .map(|list| {
                list.flatten().filter(|e| e.path().extension().is_some_and(|x| x == "part")).count()
            })
            .unwrap_or(0);
        if there >= parts {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("no part appeared in {}", result.display());
}

#[test]
fn a_campaign_killed_and_resumed_ends_as_one_never_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = seatrial(folder.path())
        .args(CAMPAIGN.split_whitespace())
        .args(["--out", "killed"])
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_for_parts(&folder.path().join("killed"), 2);
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(!folder.path().join("killed/manifest.json").exists(), "it was killed too late");
    // without --resume a partial result is left alone
    let said = run_err(folder.path(), &format!("{CAMPAIGN} --out killed"), 2);
    assert!(said.contains("--resume"), "{said}");
    run_ok(folder.path(), &format!("{CAMPAIGN} --out killed --resume"));
    assert_same_result(straight(), &folder.path().join("killed"));
}

/// Interrupts a command when `moment` has come; what it says, once it has ended with 3.
fn interrupt(folder: &Path, line: &str, moment: impl Fn() -> bool) -> String {
    let mut child = seatrial(folder)
        .args(line.split_whitespace())
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    while !moment() {
        assert!(child.try_wait().unwrap().is_none(), "`{line}` ended before it was interrupted");
        std::thread::sleep(Duration::from_millis(1));
    }
    let id = child.id().to_string();
    let interrupted = std::process::Command::new("kill").args(["-INT", &id]).status().unwrap();
    assert!(interrupted.success());
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(3), "{said}");
    said
}

#[test]
fn an_interrupt_leaves_a_resumable_state_and_says_how() {
    let folder = tempfile::tempdir().unwrap();
    // while encounters are run, and while the table is made of them
    for (out, file) in [("parts", "state/parts/0000-00000000.part"), ("table", TABLE)] {
        let there = folder.path().join(out);
        let line = format!("{CAMPAIGN} --out {out}");
        let said = interrupt(folder.path(), &line, || there.join(file).exists());
        assert!(said.contains("--resume"), "{said}");
        assert!(!there.join("manifest.json").exists(), "it passes for a finished one");
        run_ok(folder.path(), &format!("{line} --resume"));
        assert_same_result(straight(), &there);
    }
}

/// The table before it is whole.
const TABLE: &str = "runs.parquet.partial";

/// Whatever was cut or changed in a part is found before it is used.
#[test]
fn a_damaged_part_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let campaign = "campaign laboratory --encounters 20 --planner hold-course --out parts --quiet";
    run_ok(folder.path(), &format!("{campaign} --shard 1/9"));
    let parts = folder.path().join("parts/state/parts");
    let first = std::fs::read_dir(&parts).unwrap().flatten().map(|e| e.path()).min().unwrap();
    let mut bytes = std::fs::read(&first).unwrap();
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    std::fs::write(&first, bytes).unwrap();
    let said = run_err(folder.path(), &format!("{campaign} --resume"), 2);
    assert!(said.contains(first.file_name().unwrap().to_str().unwrap()), "{said}");
}
