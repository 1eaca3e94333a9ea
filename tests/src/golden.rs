//! The digests that a commit promised. `.ci/run` compares the release build with the same files.

use crate::support::{root_digest, run_ok};

#[test]
fn the_default_campaign_has_its_golden_digest() {
    let golden = include_str!("../golden/quick-20.txt").trim();
    let folder = tempfile::tempdir().unwrap();
    run_ok(folder.path(), "campaign quick --encounters 20 --out result --quiet");
    assert_eq!(
        root_digest(&folder.path().join("result")),
        golden,
        "a run gives other bits than before; if that was meant, say why in CHANGELOG.md and \
         write the new digest to tests/golden/quick-20.txt"
    );
}
