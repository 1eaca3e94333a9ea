//! The same digest for any number of threads, and for two runs.

use crate::support::{assert_same_result, root_digest, run_ok};

#[test]
fn threads_change_nothing_but_timing() {
    let folder = tempfile::tempdir().unwrap();
    for threads in [1, 2, 7] {
        run_ok(
            folder.path(),
            &format!("campaign quick --encounters 30 --threads {threads} --out t{threads} --quiet"),
        );
    }
    assert_same_result(&folder.path().join("t1"), &folder.path().join("t2"));
    assert_same_result(&folder.path().join("t1"), &folder.path().join("t7"));
}

#[test]
fn another_seed_gives_another_digest() {
    let folder = tempfile::tempdir().unwrap();
    run_ok(folder.path(), "campaign quick --encounters 3 --out a --quiet");
    run_ok(folder.path(), "campaign quick --encounters 3 --seed 2 --out b --quiet");
    assert_ne!(root_digest(&folder.path().join("a")), root_digest(&folder.path().join("b")));
}
