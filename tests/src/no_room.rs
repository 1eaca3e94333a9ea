//! A full disk is a clear error and leaves a state that can be taken up again.
//!
//! A limit on the size of files stands in for the disk: it needs no mount and no privileges, and
//! the writes fail in the same places.

use crate::support::{assert_same_result, run_err, run_ok, seatrial};
use std::path::Path;
use std::process::{Command, Output};

const CAMPAIGN: &str =
    "campaign laboratory --encounters 250 --threads 2 --quiet --planner hold-course";

/// The binary, with files of at most `kib`.
fn run_in_kib(folder: &Path, kib: u32, line: &str) -> Output {
    let command = seatrial(folder);
    Command::new("bash")
        .arg("-c")
        // without the trap the system ends the process instead of failing the write
        .arg(format!("trap '' XFSZ; ulimit -f {kib}; exec \"$0\" {line}"))
        .arg(command.get_program())
        .current_dir(folder)
        .output()
        .expect("bash starts")
}

#[test]
fn a_full_disk_says_what_is_kept_and_how_to_go_on() {
    let folder = tempfile::tempdir().unwrap();
    run_ok(folder.path(), &format!("{CAMPAIGN} --out straight"));
    // no part finds room; then the parts do, and the table does not
    for (kib, out, file) in [(30, "parts", ".part"), (200, "table", "runs.parquet")] {
        let line = format!("{CAMPAIGN} --out {out}");
        let ended = run_in_kib(folder.path(), kib, &line);
        let said = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(3), "{said}");
        for words in [file, "File too large", "is kept in", out, "--resume"] {
            assert!(said.contains(words), "the message does not say {words}: {said}");
        }
        assert!(!said.contains("harness fault"), "{said}");
        let result = folder.path().join(out);
        assert!(!result.join(file).exists(), "half a file has a name");
        assert!(!result.join("manifest.json").exists(), "it passes for a finished one");
        run_ok(folder.path(), &format!("{line} --resume"));
        assert_same_result(&folder.path().join("straight"), &result);
    }
}

/// What a kill leaves between two files is taken up again, at every such moment.
#[test]
fn what_a_kill_left_unfinished_is_ours() {
    let folder = tempfile::tempdir().unwrap();
    run_ok(folder.path(), &format!("{CAMPAIGN} --out straight"));
    // before the plan was written
    let begun = folder.path().join("begun");
    std::fs::create_dir_all(begun.join("state/parts")).unwrap();
    std::fs::write(begun.join("state/plan.json.tmp"), "{").unwrap();
    run_ok(folder.path(), &format!("{CAMPAIGN} --out begun"));
    assert_same_result(&folder.path().join("straight"), &begun);
    // while the table and the summary were written
    let writing = folder.path().join("writing");
    run_ok(folder.path(), &format!("{CAMPAIGN} --shard 1/1 --out writing"));
    for name in ["runs.parquet.partial", "summary.json.tmp", "report.html.partial"] {
        std::fs::write(writing.join(name), "half").unwrap();
    }
    run_ok(folder.path(), &format!("{CAMPAIGN} --out writing --resume"));
    assert_same_result(&folder.path().join("straight"), &writing);
    assert!(!writing.join("runs.parquet.partial").exists());
    // after the manifest
    std::fs::create_dir_all(writing.join("state/parts")).unwrap();
    run_ok(folder.path(), &format!("{CAMPAIGN} --out writing"));
    assert!(!writing.join("state").exists(), "a finished result keeps no state");
    // parts without a plan are somebody's work, and not taken for an empty folder
    std::fs::create_dir_all(folder.path().join("parts-only/state/parts")).unwrap();
    std::fs::write(folder.path().join("parts-only/state/parts/0000-00000000.part"), "x").unwrap();
    run_err(folder.path(), &format!("{CAMPAIGN} --out parts-only"), 2);
}
