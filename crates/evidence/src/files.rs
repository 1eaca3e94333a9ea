//! The files below a folder and their hashes.

use crate::EvidenceError;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// SHA-256 as hexadecimal digits.
pub fn sha256_hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Every file below a folder: path with slashes, content.
///
/// # Errors
/// Something cannot be read.
pub fn read_all(folder: &Path) -> Result<BTreeMap<String, Vec<u8>>, EvidenceError> {
    let mut found = BTreeMap::new();
    collect(folder, "", &mut found)?;
    Ok(found)
}

fn collect(
    folder: &Path,
    prefix: &str,
    found: &mut BTreeMap<String, Vec<u8>>,
) -> Result<(), EvidenceError> {
    for entry in fs::read_dir(folder).map_err(EvidenceError::io("read", folder))? {
        let entry = entry.map_err(EvidenceError::io("read", folder))?;
        let path = entry.path();
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if path.is_dir() {
            collect(&path, &format!("{name}/"), found)?;
        } else {
            let bytes = fs::read(&path).map_err(EvidenceError::io("read", &path))?;
            found.insert(name, bytes);
        }
    }
    Ok(())
}
