//! Sources: sizes that stay readable, no unsafe code, nothing left undone, no path of one machine.

use super::Finding;
use anyhow::{Context as _, Result, bail};
use std::path::Path;
use std::process::Command;

/// A file that needs more lines has more than one purpose.
const LINES_MAX: usize = 400;
/// Characters, as rustfmt counts.
const COLUMNS_MAX: usize = 100;
/// Endings whose files are written by hand and read by people as code.
const CODE: &[&str] = &["rs", "py", "c", "h", "cpp", "hpp", "js", "css", "sh"];
/// The one crate that may hold unsafe code: it loads libraries and limits processes.
const MAY_BE_UNSAFE: &str = "planner-host";
/// Folders of a machine that no reader of the repository has.
const MACHINE_FOLDERS: &[&str] = &["home", "root", "work", "tmp", "Users"];
/// What stands for work that is not done.
const UNDONE: &[&str] =
    &[concat!("#[", "ignore"), concat!("todo", "!("), concat!("unimplemented", "!(")];

/// Every text file that git tracks, or would (`place`, text).
pub(crate) fn tracked(root: &Path) -> Result<Vec<(String, String)>> {
    let output = Command::new("git")
        .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
        .current_dir(root)
        .output()
        .context("failed to start `git ls-files`")?;
    if !output.status.success() {
        bail!("`git ls-files` failed: {}", String::from_utf8_lossy(&output.stderr).trim());
    }
    let names = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut files = Vec::new();
    for place in names.split('\0').filter(|place| !place.is_empty()) {
        // Deleted but not yet committed, or not text: nothing to read.
        if let Ok(text) = std::fs::read_to_string(root.join(place)) {
            files.push((place.to_owned(), text));
        }
    }
    Ok(files)
}

/// The findings of one file.
pub(crate) fn check(place: &str, text: &str) -> Vec<Finding> {
    let ending = place.rsplit('.').next().unwrap_or_default();
    let code = CODE.contains(&ending);
    let mut findings = Vec::new();
    let mut add = |rule, line, what: String| {
        findings.push(Finding { rule, place: place.to_owned(), line, what });
    };
    let lines = text.lines().count();
    if code && lines > LINES_MAX {
        add("file-length", None, format!("{lines} lines, more than {LINES_MAX}"));
    }
    for (index, line) in text.lines().enumerate() {
        let number = Some(index + 1);
        let columns = line.chars().count();
        if code && columns > COLUMNS_MAX {
            add("line-length", number, format!("{columns} characters, more than {COLUMNS_MAX}"));
        }
        if let Some(folder) = machine_path(line) {
            add("machine-path", number, format!("`/{folder}` is a folder of one machine"));
        }
        if let Some(word) = UNDONE.iter().find(|word| ending == "rs" && line.contains(**word)) {
            add("undone", number, format!("`{word}` stands for work that is not done"));
        }
    }
    findings
}

/// The finding of a crate's root file that does not forbid unsafe code.
pub(crate) fn check_unsafe(name: &str, place: &str, text: &str) -> Option<Finding> {
    let forbids = text.lines().any(|line| line.trim() == "#![forbid(unsafe_code)]");
    (name != MAY_BE_UNSAFE && !forbids).then(|| Finding {
        rule: "unsafe",
        place: place.to_owned(),
        line: None,
        what: "`#![forbid(unsafe_code)]` is missing".to_owned(),
    })
}

/// The machine's folder in an absolute path, if the line has one. A slash inside a longer path, a
/// URL or a closing tag begins no absolute path.
fn machine_path(line: &str) -> Option<&'static str> {
    let inside = |before: char| before.is_alphanumeric() || "._-/<})]*~".contains(before);
    line.match_indices('/').find_map(|(at, _)| {
        if line[..at].chars().next_back().is_some_and(inside) {
            return None;
        }
        let rest = &line[at + 1..];
        MACHINE_FOLDERS.iter().copied().find(|folder| {
            let after = rest.strip_prefix(folder).map(|rest| rest.chars().next());
            after.is_some_and(|after| !after.is_some_and(|c| c.is_alphanumeric() || c == '_'))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rules(place: &str, text: &str) -> Vec<(&'static str, Option<usize>)> {
        check(place, text).iter().map(|finding| (finding.rule, finding.line)).collect()
    }

    #[test]
    fn sizes_are_limited_in_code_and_free_in_prose() {
        let long = format!("{}\n{}\n", "x".repeat(100), "é".repeat(101));
        assert_eq!(rules("a.rs", &long), [("line-length", Some(2))]);
        assert_eq!(rules("a.md", &long), []);
        assert_eq!(rules("a.py", &"x\n".repeat(400)), []);
        assert_eq!(rules("a.py", &"x\n".repeat(401)), [("file-length", None)]);
    }

    #[test]
    fn paths_of_one_machine_are_found_and_others_are_not() {
        for folder in MACHINE_FOLDERS {
            let line = format!("see /{folder}/x");
            assert_eq!(rules("a.md", &line), [("machine-path", Some(1))], "{line}");
            assert_eq!(rules("a.toml", &format!("dir = \"/{folder}\"")).len(), 1);
            for fine in ["./{}/x", "https://example.org/{}/x", "</{}>", "/{}ward", "a/{}/b"] {
                assert_eq!(rules("a.md", &fine.replace("{}", folder)), [], "{fine} {folder}");
            }
        }
    }

    #[test]
    fn undone_work_is_found_in_rust() {
        for word in UNDONE {
            assert_eq!(rules("a.rs", &format!("  {word}")), [("undone", Some(1))], "{word}");
            assert_eq!(rules("a.md", word), []);
        }
    }

    #[test]
    fn only_one_crate_may_be_unsafe() {
        let line = "//! Doc.\n#![forbid(unsafe_code)]\n";
        assert_eq!(check_unsafe("geom", "lib.rs", line), None);
        assert_eq!(check_unsafe("planner-host", "lib.rs", ""), None);
        let missing = check_unsafe("geom", "lib.rs", "//! #![forbid(unsafe_code)]\n");
        assert_eq!(missing.map(|finding| finding.rule), Some("unsafe"));
    }
}
