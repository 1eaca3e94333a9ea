//! Files that an evidence pack takes as they are: of the result, of the planner, of the tool, of
//! the pack before.

use crate::build;
use campaign::folder::JUDGED;
use campaign::{Error, Plan};
use evidence::{
    BENCH, BUILD, Files, PLANNER, PREVIOUS, READINGS, RESULT, SELF_TEST, SENSITIVITY, TIMING,
};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Files of a result that are taken as they are; everything else of it is made from the rows.
const TAKEN: [&str; 3] = ["runs.parquet", "manifest.json", "timing.json"];
/// The self-test among the tool's own documents.
const OWN_SELF_TEST: &str = "gate-self-test.json";

/// Every given file of a new pack.
pub(super) fn gather(
    result: &Path,
    plan: &Plan,
    self_test: Option<&Path>,
    previous: Option<&Path>,
) -> Result<Files, Error> {
    let mut given = Files::new();
    for name in TAKEN {
        given.insert(format!("{RESULT}/{name}"), read(&result.join(name))?);
    }
    given.extend(sweeps(result)?);
    given.extend(planner(plan)?);
    given.extend(bench());
    let own = build::MEASURED.iter().find(|(name, _)| *name == OWN_SELF_TEST);
    match (self_test, own) {
        (Some(path), _) => {
            given.insert(SELF_TEST.to_owned(), read(path)?);
        }
        (None, Some((_, text))) => {
            given.insert(SELF_TEST.to_owned(), text.as_bytes().to_vec());
        }
        (None, None) => {}
    }
    if let Some(pack) = previous {
        for (path, name) in PREVIOUS.iter().zip(["manifest.json", "result/summary.json"]) {
            given.insert((*path).to_owned(), read(&pack.join(name))?);
        }
    }
    Ok(given)
}

/// The given files of a pack that is there already.
pub(super) fn of_pack(pack: &Files) -> Files {
    let folders = [PLANNER, BENCH, SENSITIVITY, "gate", "previous"];
    let is_given = |path: &str| {
        let folder = path.split('/').next().unwrap_or_default();
        let taken = TAKEN.iter().any(|name| path == format!("{RESULT}/{name}"));
        taken || (path.contains('/') && folders.contains(&folder))
    };
    let given = pack.iter().filter(|(path, _)| is_given(path));
    given.map(|(path, bytes)| (path.clone(), bytes.clone())).collect()
}

/// Without what changes from one run of a campaign to the next.
pub(super) fn stable(given: &Files) -> Files {
    let stable = given.iter().filter(|(path, _)| path.as_str() != TIMING);
    stable.map(|(path, bytes)| (path.clone(), bytes.clone())).collect()
}

/// Sweeps of thresholds that were made of the result.
fn sweeps(result: &Path) -> Result<Files, Error> {
    let mut found = Files::new();
    for path in crate::files::below(result)? {
        let name = path.strip_prefix(result).unwrap_or(&path).to_string_lossy().into_owned();
        let Some((folder, file)) = name.split_once('/') else { continue };
        if folder.starts_with(JUDGED) && file.starts_with("sweep-") && file.ends_with(".json") {
            found.insert(format!("{SENSITIVITY}/{file}"), read(&path)?);
        }
    }
    Ok(found)
}

/// The files of a planner from outside, if they are those that the campaign ran.
fn planner(plan: &Plan) -> Result<Files, Error> {
    let name = &plan.planner.name;
    let mut contents = BTreeMap::new();
    for (word, sha256) in &plan.planner.files_sha256 {
        let bytes = read(Path::new(word))?;
        if evidence::sha256_hex(&bytes) != *sha256 {
            return Err(Error::input(format!(
                "{word} of planner {name} was changed after the campaign; run it again"
            )));
        }
        contents.insert(word.clone(), bytes);
    }
    if contents.is_empty() {
        return Ok(Files::new());
    }
    Ok(evidence::planner_files(name, &contents))
}

/// The tool's own documents.
fn bench() -> Files {
    let documents = build::MEASURED.iter().filter(|(name, _)| *name != OWN_SELF_TEST);
    let documents = documents.map(|(name, text)| (format!("{BENCH}/{name}"), *text));
    let own = [(BUILD.to_owned(), build::BUILT), (READINGS.to_owned(), build::READINGS)];
    documents.chain(own).map(|(path, text)| (path, text.as_bytes().to_vec())).collect()
}

fn read(path: &Path) -> Result<Vec<u8>, Error> {
    fs::read(path).map_err(Error::io("read", path))
}
