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
