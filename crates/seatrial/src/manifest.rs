//! `manifest.json`: what made a result, the plan it followed, and hashes of every other file.

use campaign::folder::{JUDGED, SHARD};
use campaign::{Error, Finished, Plan};
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::Path;

#[derive(Serialize)]
struct Manifest<'a> {
    schema: u32,
    tool: &'static str,
    build: &'a campaign::plan::Build,
    plan_hash: String,
    root_digest: &'a str,
    encounters: u64,
    files_sha256: BTreeMap<String, String>,
    plan: serde_json::Value,
}

/// Written last: a folder that has one is finished.
pub(crate) fn write(folder: &Path, plan: &Plan, finished: &Finished) -> Result<(), Error> {
    let manifest = Manifest {
        schema: 1,
        tool: "seatrial",
        build: &plan.build,
        plan_hash: plan.hash()?,
        root_digest: &finished.root_digest,
        encounters: finished.encounters,
        files_sha256: hashes(folder)?,
        plan: plan.json()?,
    };
    let mut text = serde_json::to_string_pretty(&manifest)
        .map_err(|e| Error::Fault(format!("failed to encode the manifest: {e}")))?;
    text.push('\n');
    crate::files::write(&folder.join("manifest.json"), text.as_bytes())
}

/// SHA-256 of every file of a result but the manifest itself, wall-clock facts, what only a
/// partial result needs, and what was judged later.
fn hashes(folder: &Path) -> Result<BTreeMap<String, String>, Error> {
    const LEFT_OUT: [&str; 4] = ["manifest.json", "timing.json", "state", "replay"];
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).map_err(Error::io("read", folder))? {
        let path = entry.map_err(Error::io("read", folder))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if LEFT_OUT.contains(&name.as_str())
            || [JUDGED, SHARD].iter().any(|prefix| name.starts_with(prefix))
        {
            continue;
        }
        let files = if path.is_dir() { crate::files::below(&path)? } else { vec![path] };
        for path in files {
            let name = path.strip_prefix(folder).unwrap_or(&path).to_string_lossy().into_owned();
            found.insert(name, sha256_hex(&path)?);
        }
    }
    Ok(found)
}

/// A table may be larger than the memory: it is read piece by piece.
fn sha256_hex(path: &Path) -> Result<String, Error> {
    let mut file = fs::File::open(path).map_err(Error::io("read", path))?;
    let (mut hasher, mut piece) = (Sha256::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut piece).map_err(Error::io("read", path))? {
            0 => break,
            count => hasher.update(&piece[..count]),
        }
    }
    Ok(hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}
