//! Parts: whole files of rows that appear by atomic rename.
//!
//! A part holds the rows of [`PART_ENCOUNTERS`] consecutive encounters of one stratum, so which
//! encounters it holds depends on no thread, shard or other stratum. The file is one line of JSON,
//! then the rows and their tally, encoded with postcard. The line carries the hash of the rest and
//! of the plan, so that a part of another campaign, a cut or a changed one is refused.

use crate::Error;
use record::RunRow;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use summary::Tally;

/// Encounters in a part. It changes no result: digests and tallies do not see it.
pub const PART_ENCOUNTERS: u64 = 500;

/// Which part: stratum by its index in the plan, and which piece of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct PartKey {
    /// Index of the stratum.
    pub stratum: u32,
    /// Piece of the stratum, from 0.
    pub piece: u64,
}

impl PartKey {
    /// The encounters of this part, of `n` in the stratum.
    pub fn range(self, n: u64) -> std::ops::Range<u64> {
        let first = self.piece * PART_ENCOUNTERS;
        first..n.min(first + PART_ENCOUNTERS)
    }

    /// Name of the file.
    pub fn file_name(self) -> String {
        format!("{:04}-{:08}.part", self.stratum, self.piece)
    }

    /// The part of encounter `j` of a stratum.
    pub const fn of_encounter(stratum: u32, j: u64) -> Self {
        Self { stratum, piece: j / PART_ENCOUNTERS }
    }

    /// The part with this name of a file.
    pub fn of_file_name(name: &str) -> Option<Self> {
        let (stratum, piece) = name.strip_suffix(".part")?.split_once('-')?;
        let key = Self { stratum: stratum.parse().ok()?, piece: piece.parse().ok()? };
        (key.file_name() == name).then_some(key)
    }

    /// Every part of `strata` strata of `n` encounters, in order.
    pub fn all(strata: usize, n: u64) -> impl Iterator<Item = Self> {
        let pieces = n.div_ceil(PART_ENCOUNTERS);
        (0..strata as u32)
            .flat_map(move |stratum| (0..pieces).map(move |piece| Self { stratum, piece }))
    }
}

/// The rows of a part, in the order of j, and what they add up to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// One row for each encounter.
    pub rows: Vec<RunRow>,
    /// Their tally.
    pub tally: Tally,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    schema: u32,
    plan: String,
    key: PartKey,
    rows: u64,
    body_blake3: String,
}

const SCHEMA: u32 = 1;

/// Writes a part so that it appears whole or not at all.
pub fn write(folder: &Path, plan_hash: &str, key: PartKey, part: &Part) -> Result<(), Error> {
    let path = folder.join(key.file_name());
    let body = postcard::to_stdvec(part)
        .map_err(|e| Error::Fault(format!("failed to encode part {}: {e}", path.display())))?;
    let header = Header {
        schema: SCHEMA,
        plan: plan_hash.to_owned(),
        key,
        rows: part.rows.len() as u64,
        body_blake3: blake3::hash(&body).to_hex().to_string(),
    };
    let mut bytes = serde_json::to_vec(&header)
        .map_err(|e| Error::Fault(format!("failed to encode a part's header: {e}")))?;
    bytes.push(b'\n');
    bytes.extend_from_slice(&body);
    write_whole(&path, &bytes).map_err(Error::io("write", &path))
}

/// Writes a file under a temporary name and renames it, so that it appears whole or not at all.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(".tmp");
    let written = (|| {
        let mut file = fs::File::create(&temporary)?;
        file.write_all(bytes)?;
        file.sync_data()?;
        fs::rename(&temporary, path)
    })();
    if written.is_err() {
        // what is left of a failed write is of no use to anybody; the first error is the one told
        drop(fs::remove_file(&temporary));
    }
    written
}

/// Reads a part and refuses one that is not whole or belongs to another plan. With it comes the
/// BLAKE3 of the file, hexadecimal.
pub fn read(folder: &Path, plan_hash: &str, key: PartKey) -> Result<(Part, String), Error> {
    let path = folder.join(key.file_name());
    let bytes = fs::read(&path).map_err(Error::io("read", &path))?;
    let damaged = |what: &str| {
        Error::input(format!("{}: {what}; delete it and run again with --resume", path.display()))
    };
    let end = bytes.iter().position(|&b| b == b'\n').ok_or_else(|| damaged("has no header"))?;
    let header: Header =
        serde_json::from_slice(&bytes[..end]).map_err(|_| damaged("has a damaged header"))?;
    let body = &bytes[end + 1..];
    if header.schema != SCHEMA || header.key != key {
        return Err(damaged("is not the part that its name says"));
    }
    if header.plan != plan_hash {
        return Err(damaged("belongs to another campaign"));
    }
    if blake3::hash(body).to_hex().as_str() != header.body_blake3 {
        return Err(damaged("was changed or cut after it was written"));
    }
    let part: Part = postcard::from_bytes(body).map_err(|_| damaged("cannot be decoded"))?;
    if part.rows.len() as u64 != header.rows {
        return Err(damaged("holds another number of rows than it says"));
    }
    Ok((part, blake3::hash(&bytes).to_hex().to_string()))
}
