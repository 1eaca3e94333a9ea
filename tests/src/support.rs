//! Runs the binary and reads what it wrote.

use campaign::plan::{Build, Plan};
use campaign::{CampaignFile, Overrides};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A command of the binary under test, in a folder of its own.
pub(crate) fn seatrial(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_seatrial-under-test"));
    command.current_dir(folder);
    command
}

/// Runs a command line of words without spaces.
pub(crate) fn run(folder: &Path, line: &str) -> Output {
    seatrial(folder).args(line.split_whitespace()).output().expect("the binary starts")
}

/// Runs a command line and insists that it exits with 0.
pub(crate) fn run_ok(folder: &Path, line: &str) -> String {
    let output = run(folder, line);
    assert_eq!(
        output.status.code(),
        Some(0),
        "`seatrial {line}` said: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).expect("text")
}

/// Standard error of a command line that must exit with `code`.
pub(crate) fn run_err(folder: &Path, line: &str, code: i32) -> String {
    let output = run(folder, line);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "`seatrial {line}` said: {said}");
    said
}

/// Text of a file of `campaigns/`, without its `.toml`.
pub(crate) fn campaign_text(name: &str) -> String {
    let path = format!("{}/../campaigns/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// The plan of a campaign of this text for one planner, with options of its own.
pub(crate) fn plan_for(planner: &str, options: &str, text: &str, overrides: Overrides) -> Plan {
    let mut file: toml::Table = text.parse().unwrap();
    let options: toml::Table = options.parse().unwrap();
    let own = toml::Table::from_iter([(planner.to_owned(), toml::Value::Table(options))]);
    file.insert("planner".into(), toml::Value::Table(own));
    let overrides = Overrides { planners: vec![planner.to_owned()], ..overrides };
    let build = Build {
        tool_version: String::new(),
        git_commit: String::new(),
        git_clean: true,
        engine: String::new(),
        planners: String::new(),
        cargo_lock_sha256: String::new(),
        rustc: String::new(),
    };
    let rules = |name: &str| Ok(campaign_text(&format!("rulesets/{name}")));
    let file = CampaignFile::parse(&file.to_string(), planner).unwrap();
    file.resolve(&overrides, None, &planners::registry(), &rules, &build).unwrap().remove(0)
}

/// A file of JSON.
pub(crate) fn json(path: impl AsRef<Path>) -> Value {
    let path = path.as_ref();
    let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// `root_digest` of a result.
pub(crate) fn root_digest(result: &Path) -> String {
    json(result.join("summary.json"))["root_digest"].as_str().expect("a string").to_owned()
}

/// Every file below a folder, sorted, relative to it.
pub(crate) fn files(folder: &Path) -> Vec<PathBuf> {
    fn below(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() { below(&path, found) } else { found.push(path) }
        }
    }
    let mut found = Vec::new();
    below(folder, &mut found);
    let mut found: Vec<PathBuf> =
        found.iter().map(|p| p.strip_prefix(folder).expect("below").to_owned()).collect();
    found.sort();
    found
}

/// Asserts that two results are byte for byte the same but for wall-clock facts.
pub(crate) fn assert_same_result(a: &Path, b: &Path) {
    assert_eq!(files(a), files(b));
    for file in files(a).iter().filter(|file| !file.ends_with("timing.json")) {
        let same = fs::read(a.join(file)).expect("a") == fs::read(b.join(file)).expect("b");
        assert!(same, "{} differs", file.display());
    }
}

/// The rows of a result.
pub(crate) fn rows(result: &Path) -> Vec<record::RunRow> {
    table::read_rows(result.join("runs.parquet"))
        .expect("a table")
        .map(|row| row.expect("a row"))
        .collect()
}
