//! Where the planner of a pack comes from: the registry of this tool, or the pack itself.

use crate::say::say;
use campaign::{Error, Plan};
use evidence::{Files, planner_of};
use planner_api::Registry;
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::PathBuf;

/// Whether encounters can be run again.
pub(super) enum Known {
    /// With this registry; the folder has the planner's files and goes with this value.
    Runnable(Registry, Option<tempfile::TempDir>),
    /// They cannot, and why.
    RecordAlone(String),
}

/// The registry with the planner of the plan in it. A planner from outside is taken out of the
/// pack into a folder of its own: it may write beside itself, and a copied pack may have lost the
/// permission to run it. The files were compared with their hashes before.
pub(super) fn registry(
    plan: &Plan,
    pack: &Files,
    start_planner: bool,
    registry: Registry,
) -> Result<Known, Error> {
    let name = &plan.planner.name;
    if !name.starts_with("exec:") && !name.starts_with("lib:") {
        let registry = super::with_outside(registry, std::slice::from_ref(name))?;
        return Ok(Known::Runnable(registry, None));
    }
    let alone = |why: &str| Ok(Known::RecordAlone(format!("planner {name} {why}")));
    let Some(list) = planner_of(pack, name).map_err(super::evidence::failed)? else {
        return alone("is a program from outside, and its file is not in the pack");
    };
    let hashes: BTreeMap<String, String> =
        list.files.iter().map(|file| (file.named.clone(), file.sha256.clone())).collect();
    if hashes != plan.planner.files_sha256 {
        return alone("is in the pack with other files than those that the plan has the hashes of");
    }
    if !start_planner {
        return alone("is in the pack and was not to be started (--no-planner)");
    }
    let folder = tempfile::tempdir().map_err(Error::io("make", &std::env::temp_dir()))?;
    let mut places: BTreeMap<&str, PathBuf> = BTreeMap::new();
    for file in &list.files {
        let path = folder.path().join(&file.path);
        let parent = path.parent().unwrap_or(folder.path());
        fs::create_dir_all(parent).map_err(Error::io("make", parent))?;
        fs::write(&path, &pack[&file.path]).map_err(Error::io("write", &path))?;
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755))
            .map_err(Error::io("make executable", &path))?;
        places.insert(&file.named, path);
    }
    match planner_host::relocated(name, &|word| places.get(word).cloned()) {
        Some(Ok(entry)) => {
            let paths: Vec<&str> = list.files.iter().map(|file| file.path.as_str()).collect();
            say!("planner: {name}, started out of the pack ({})", paths.join(", "));
            Ok(Known::Runnable(registry.with(entry), Some(folder)))
        }
        Some(Err(error)) => alone(&format!("is in the pack and cannot be started here: {error}")),
        None => alone("is no planner of this tool"),
    }
}
