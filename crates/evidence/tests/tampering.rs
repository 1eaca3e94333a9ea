//! Whatever is done to one file of a pack, the inspection names it.

use campaign::plan::Build;
use evidence::{
    Files, MANIFEST, Manifest, SIGNATURE, STATEMENT, VOLATILE, inspect, sha256_hex, statement,
};
use proptest::prelude::*;
use proptest::sample::Index;
use record::Seed;
use std::collections::BTreeMap;

/// A pack of small files that is whole as far as an inspection can see.
fn pack() -> Files {
    let mut files = Files::new();
    for (i, path) in [
        "result/runs.parquet",
        "result/summary.json",
        "result/report.html",
        "result/manifest.json",
        "result/timing.json",
        "result/figures/cpa.svg",
        "plan/plan.json",
        "sbom.cdx.json",
        "ro-crate-metadata.json",
        "trace-table.csv",
        "argument.svg",
        "evidence.html",
        "evidence.pdf",
        "trace/turn.txt",
    ]
    .into_iter()
    .enumerate()
    {
        files.insert(path.to_owned(), format!("content {i}\n").repeat(i + 1).into_bytes());
    }
    let build = Build {
        tool_version: "0.1.0".into(),
        git_commit: "c".into(),
        git_clean: true,
        engine: "e".into(),
        planners: "p".into(),
        cargo_lock_sha256: "l".into(),
        rustc: "r".into(),
    };
    let stable = files.iter().filter(|(path, _)| !VOLATILE.contains(&path.as_str()));
    let manifest = Manifest {
        schema: 2,
        tool: "seatrial".into(),
        build,
        renderer: "r".into(),
        campaign: "quick".into(),
        planner: "zhuang".into(),
        seed: Seed(1),
        plan_hash: "h".into(),
        root_digest: "d".into(),
        encounters: 3,
        experiment: evidence::Experiment::default(),
        declared_to_differ: VOLATILE.map(str::to_owned).to_vec(),
        files_sha256: stable.map(|(path, bytes)| (path.clone(), sha256_hex(bytes))).collect(),
    };
    let text = serde_json::to_string_pretty(&manifest).expect("a manifest has string keys") + "\n";
    files.insert(MANIFEST.to_owned(), text.into_bytes());
    let hashes: BTreeMap<String, String> =
        files.iter().map(|(path, bytes)| (path.clone(), sha256_hex(bytes))).collect();
    files.insert(STATEMENT.to_owned(), statement(&hashes, &manifest));
    files
}

/// Whether the inspection names this file.
fn named(files: &Files, path: &str) -> bool {
    inspect(files).0.iter().any(|problem| problem.path == path)
}

#[test]
fn an_untouched_pack_is_whole() {
    let (problems, manifest) = inspect(&pack());
    assert_eq!(problems, []);
    assert_eq!(manifest.unwrap().encounters, 3);
}

#[test]
fn a_signature_is_no_stranger() {
    let mut files = pack();
    files.insert(SIGNATURE.to_owned(), b"any".to_vec());
    assert_eq!(inspect(&files).0, []);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn a_flipped_bit_is_named(
        file in any::<Index>(),
        at in any::<Index>(),
        bit in 0u8..8,
    ) {
        let mut files = pack();
        let path = file.get(&files.keys().cloned().collect::<Vec<_>>()).clone();
        let bytes = files.get_mut(&path).unwrap();
        let at = at.index(bytes.len());
        bytes[at] ^= 1 << bit;
        prop_assert!(named(&files, &path), "{path} byte {at} bit {bit}: {:?}", inspect(&files).0);
    }

    #[test]
    fn a_dropped_file_is_named(file in any::<Index>()) {
        let mut files = pack();
        let path = file.get(&files.keys().cloned().collect::<Vec<_>>()).clone();
        files.remove(&path);
        prop_assert!(named(&files, &path), "{path}");
    }

    #[test]
    fn an_added_file_is_named(name in "[a-z]{1,8}(/[a-z]{1,8})?\\.[a-z]{1,4}") {
        let mut files = pack();
        prop_assume!(!files.contains_key(&name));
        files.insert(name.clone(), b"more".to_vec());
        prop_assert!(named(&files, &name), "{name}");
    }

    #[test]
    fn a_renamed_file_is_named(file in any::<Index>()) {
        let mut files = pack();
        let path = file.get(&files.keys().cloned().collect::<Vec<_>>()).clone();
        let bytes = files.remove(&path).unwrap();
        files.insert(format!("{path}.old"), bytes);
        prop_assert!(named(&files, &path), "{path}");
    }

    #[test]
    fn swapped_files_are_named(a in any::<Index>(), b in any::<Index>()) {
        let mut files = pack();
        let paths: Vec<String> = files.keys().cloned().collect();
        let (a, b) = (a.get(&paths).clone(), b.get(&paths).clone());
        prop_assume!(a != b);
        let (of_a, of_b) = (files[&a].clone(), files[&b].clone());
        files.insert(a.clone(), of_b);
        files.insert(b.clone(), of_a);
        prop_assert!(named(&files, &a) || named(&files, &b), "{a} {b}");
    }
}
