//! The files of a planner from outside inside a pack, so that a verifier can run it again.
//!
//! `planner/planner.json` says which file of the pack is which of the planner's name. What the
//! planner takes from its machine, such as an interpreter and its packages, is not in the pack.

use crate::pack::{Files, pretty};
use crate::{EvidenceError, sha256_hex};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Folder of the planner inside a pack.
pub const PLANNER: &str = "planner";
/// The list of its files.
const LIST: &str = "planner/planner.json";

/// `planner/planner.json`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannerFiles {
    /// The planner's name, as in the plan.
    pub name: String,
    /// Its files, by the words of its name.
    pub files: Vec<PlannerFile>,
}

/// A file of a planner.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannerFile {
    /// As the planner's name writes it.
    pub named: String,
    /// Inside the pack.
    pub path: String,
    /// Of its content.
    pub sha256: String,
}

/// The files of a pack for a planner's files: content by the words of its name.
pub fn planner_files(name: &str, contents: &BTreeMap<String, Vec<u8>>) -> Files {
    let mut files = Files::new();
    let mut list = PlannerFiles { name: name.to_owned(), files: Vec::new() };
    for (i, (named, bytes)) in contents.iter().enumerate() {
        let base = Path::new(named).file_name().unwrap_or_default().to_string_lossy();
        // two files of one name may lie in different folders
        let path = format!("{PLANNER}/{}/{base}", i + 1);
        let sha256 = sha256_hex(bytes);
        list.files.push(PlannerFile { named: named.clone(), path: path.clone(), sha256 });
        files.insert(path, bytes.clone());
    }
    files.insert(LIST.to_owned(), pretty(&list).into_bytes());
    files
}

/// The planner's files of a pack: none, or a list whose every file is there with its hash.
///
/// # Errors
/// The list is damaged, or is not that of the files or of the planner of this name.
pub fn planner_of(files: &Files, name: &str) -> Result<Option<PlannerFiles>, EvidenceError> {
    let wrong = |problem: String| EvidenceError::Form { path: LIST.to_owned(), problem };
    let Some(text) = files.get(LIST) else { return Ok(None) };
    let list: PlannerFiles = serde_json::from_slice(text).map_err(|e| wrong(e.to_string()))?;
    if list.name != name {
        return Err(wrong(format!("it is of planner {}, the plan of {name}", list.name)));
    }
    for file in &list.files {
        let there = files.get(&file.path).map(|bytes| sha256_hex(bytes));
        if there.as_ref() != Some(&file.sha256) {
            return Err(wrong(format!("{} is not the file that it lists", file.path)));
        }
    }
    Ok(Some(list))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_planner_is_found_whole_or_not_at_all() {
        let name = "exec:python3 a/plan.py b/plan.py";
        let contents =
            [("a/plan.py", "a"), ("b/plan.py", "b")].map(|(k, v)| (k.to_owned(), v.into()));
        let mut files = planner_files(name, &BTreeMap::from(contents));
        assert_eq!(files.len(), 3);
        let found = planner_of(&files, name).unwrap().unwrap();
        assert_eq!(found.files[1].named, "b/plan.py");
        assert_eq!(files[&found.files[1].path], b"b");
        assert!(planner_of(&files, "exec:another").is_err());
        files.insert(found.files[0].path.clone(), b"changed".to_vec());
        assert!(planner_of(&files, name).is_err());
        assert!(planner_of(&Files::new(), name).unwrap().is_none());
    }
}
