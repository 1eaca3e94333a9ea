//! Files appear whole or not at all.

use campaign::{Error, part};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Writes a file under a temporary name and renames it.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    part::write_whole(path, bytes).map_err(Error::io("write", path))
}

/// Every file below a folder, sorted.
pub(crate) fn below(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(Error::io("read", folder))? {
        let path = entry.map_err(Error::io("read", folder))?.path();
        if path.is_dir() {
            found.extend(below(&path)?);
        } else {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// SHA-256 of files, by the paths that are given.
pub(crate) fn hashes(paths: Vec<String>) -> Result<BTreeMap<String, String>, Error> {
    let hash = |path: String| {
        let bytes = fs::read(&path).map_err(Error::io("read", Path::new(&path)))?;
        Ok((path, evidence::sha256_hex(&bytes)))
    };
    paths.into_iter().map(hash).collect()
}

/// The evidence pack that a result is part of. Nothing may be written into it: `verify` finds a
/// file that does not belong there.
pub(crate) fn pack_around(result: &Path) -> Option<PathBuf> {
    let pack = result.canonicalize().ok()?.parent()?.to_owned();
    pack.join(evidence::STATEMENT).exists().then_some(pack)
}
