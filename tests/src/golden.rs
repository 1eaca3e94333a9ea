//! The digests that a commit promised. `.ci/run` compares the optimised build with the same files.

use crate::support::{root_digest, run_ok};

/// Twenty encounters of every stratum of a campaign against its golden file.
fn has_its_golden_digest(campaign: &str, golden: &str) {
    let folder = tempfile::tempdir().unwrap();
    run_ok(folder.path(), &format!("campaign {campaign} --encounters 20 --out result --quiet"));
    assert_eq!(
        root_digest(&folder.path().join("result")),
        golden.trim(),
        "a run gives other bits than before; if that was meant, say why in CHANGELOG.md and \
         write the new digest to tests/golden/{campaign}-20.txt"
    );
}

#[test]
fn the_default_campaign_has_its_golden_digest() {
    has_its_golden_digest("quick", include_str!("../golden/quick-20.txt"));
}

#[test]
fn the_laboratory_has_its_golden_digest() {
    has_its_golden_digest("laboratory", include_str!("../golden/laboratory-20.txt"));
}
