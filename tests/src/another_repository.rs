//! The example in Rust is a bench in a repository of its own, and its planner gives the campaign
//! digest that the same planner gives in C, C++ and Python.

use crate::support::{root_digest, run_ok, seatrial};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const CAMPAIGN: &str = "campaign quick --encounters 3 --quiet";

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Names and versions of the packages of a lock file, but for the example itself.
fn packages(lock: &Path) -> Vec<(String, String)> {
    let text = fs::read_to_string(lock).unwrap();
    let lock: toml::Table = text.parse().unwrap();
    let packages = lock["package"].as_array().unwrap().iter().map(|package| {
        let field = |key: &str| package[key].as_str().unwrap().to_owned();
        (field("name"), field("version"))
    });
    packages.filter(|(name, _)| name != "small-vo").collect()
}

/// Builds the example as somebody outside would, but for what would compile its dependencies a
/// second time: the target folder of these tests, and the profiles of the workspace.
fn bench_of_the_example(folder: &Path) -> PathBuf {
    let binary = Path::new(env!("CARGO_BIN_EXE_seatrial-under-test"));
    let target = binary.parent().unwrap().parent().unwrap();
    let manifest = fs::read_to_string(repository().join("Cargo.toml")).unwrap();
    let manifest: toml::Table = manifest.parse().unwrap();
    let profiles = toml::Table::from_iter([("profile".to_owned(), manifest["profile"].clone())]);
    let config = folder.join("profiles.toml");
    fs::write(&config, profiles.to_string()).unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--locked", "--manifest-path"]);
    cargo.arg(repository().join("examples/rust/Cargo.toml"));
    cargo.arg("--config").arg(config).arg("--target-dir").arg(target);
    if binary.parent().unwrap().ends_with("release") {
        cargo.arg("--release");
    }
    let output = cargo.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "the example does not build: {said}");
    binary.with_file_name("small-vo")
}

/// A program of `examples/` from its sources, as `docs/your-planner.md` says.
fn compile(tool: &str, arguments: &[&str], sources: &[&str], output: &Path) {
    let header = repository().join("crates/planner-host/include");
    let mut compiler = Command::new(tool);
    compiler.args(["-O2", "-ffp-contract=off"]).args(arguments).arg("-I").arg(header);
    compiler.args(sources.iter().map(|source| repository().join("examples").join(source)));
    let status = compiler.arg("-lm").arg("-o").arg(output).status().unwrap();
    assert!(status.success(), "{tool} {sources:?}");
}

/// Whatever the root lock file says must be what the example is built with.
#[test]
fn the_example_is_locked_to_the_versions_of_the_workspace() {
    let known = packages(&repository().join("Cargo.lock"));
    for package in packages(&repository().join("examples/rust/Cargo.lock")) {
        assert!(
            known.contains(&package),
            "{package:?} is not in Cargo.lock; copy it to examples/rust and build there"
        );
    }
}

#[test]
fn four_languages_give_the_same_campaign_digest() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let bench = bench_of_the_example(path);
    let line = format!("{CAMPAIGN} --planner small-vo --out rust");
    let output = Command::new(&bench).args(line.split(' ')).current_dir(path).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let expected = root_digest(&path.join("rust"));

    let shared = ["-shared", "-fPIC"];
    compile("cc", &shared, &["c/small_vo.c", "c/small_vo_lib.c"], &path.join("libsmall_vo.so"));
    compile("cc", &[], &["c/small_vo.c", "c/small_vo_stdio.c"], &path.join("small_vo"));
    compile("c++", &shared, &["cpp/small_vo.cpp"], &path.join("libsmall_vo_cpp.so"));
    let examples = repository().join("examples/python");
    for file in [examples.join("small_vo.py"), repository().join("python/seatrial.py")] {
        fs::copy(&file, path.join(file.file_name().unwrap())).unwrap();
    }
    for (name, planner) in [
        ("c-loaded", "lib:./libsmall_vo.so"),
        ("c-spoken-to", "exec:./small_vo"),
        ("cpp-loaded", "lib:./libsmall_vo_cpp.so"),
        ("python", "exec:python3 small_vo.py"),
    ] {
        let output = seatrial(path)
            .args(CAMPAIGN.split(' '))
            .args(["--planner", planner, "--out", name])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(root_digest(&path.join(name)), expected, "{name}");
        // a process of Python takes half a minute over it; the newcomer's walk has one
        if name == "python" {
            continue;
        }
        let conforms = seatrial(path).args(["conformance", "--planner", planner]).output().unwrap();
        let said = String::from_utf8_lossy(&conforms.stdout);
        assert!(conforms.status.success(), "{planner}: {said}");
    }
    // another planner has another digest, so that equality above means something
    run_ok(path, &format!("{CAMPAIGN} --planner plain-vo --out other"));
    assert_ne!(root_digest(&path.join("other")), expected);
    let output =
        seatrial(path).args(["conformance", "--planner", "zhuang-as-printed"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).contains("RotationIndifferent: fails in "));
}
