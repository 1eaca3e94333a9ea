//! A result whose rows stay in the parts of its shards: the list of them, and rows read from one
//! part after the other.
//!
//! The list has a line for each part, in order (stratum, j): the BLAKE3 of its file and its path
//! below the result. `b3sum --check parts.b3` reads it, and the manifest of the result holds its
//! hash, so that it stands for every byte of the parts.

use crate::part::{self, PartKey};
use crate::pipeline::{PartRead, RowSink};
use crate::{Error, Plan};
use record::{EncounterId, RunRow};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The name of the list.
pub const PARTS_LIST: &str = "parts.b3";

/// Parts that a result cannot keep: of a shard that does not lie below it.
///
/// # Errors
/// There is one; the message names its folder.
pub fn refuse_elsewhere(result: &Path, parts: &BTreeMap<PartKey, Arc<Path>>) -> Result<(), Error> {
    let stays = |folder: &Path| {
        let below = folder.strip_prefix(result);
        below.is_ok_and(|below| !below.starts_with("state"))
    };
    match parts.values().find(|folder| !stays(folder)) {
        None => Ok(()),
        Some(folder) => Err(Error::input(format!(
            "the parts in {} cannot stay where they are: a result keeps those of its own folders \
             {}; move the shard there",
            folder.display(),
            result.join("shard-*").display()
        ))),
    }
}

/// Writes the list, a line for each part as it is read; it appears whole or not at all.
#[derive(Debug)]
pub struct PartsList {
    result: PathBuf,
    temporary: PathBuf,
    out: BufWriter<File>,
}

impl PartsList {
    /// A list for this result.
    pub fn create(result: &Path) -> Result<Self, Error> {
        let temporary = result.join(format!("{PARTS_LIST}.tmp"));
        let file = File::create(&temporary).map_err(Error::io("create", &temporary))?;
        Ok(Self { result: result.to_owned(), temporary, out: BufWriter::new(file) })
    }

    /// Gives the list its name.
    pub fn finish(mut self) -> Result<(), Error> {
        let path = self.result.join(PARTS_LIST);
        self.out
            .flush()
            .and_then(|()| self.out.get_ref().sync_data())
            .and_then(|()| fs::rename(&self.temporary, &path))
            .map_err(Error::io("write", &path))
    }
}

impl RowSink for PartsList {
    fn push(&mut self, part: PartRead) -> Result<(), Error> {
        let folder = part.folder.strip_prefix(&self.result).unwrap_or(&part.folder);
        let path = folder.join(part.key.file_name());
        writeln!(self.out, "{}  {}", part.blake3, path.display())
            .map_err(Error::io("write", &self.temporary))
    }
}

impl Drop for PartsList {
    fn drop(&mut self) {
        // after `finish` there is nothing under this name; else half a list is worth nothing
        drop(fs::remove_file(&self.temporary));
    }
}

/// A line of the list.
struct Listed {
    key: PartKey,
    blake3: String,
    folder: PathBuf,
}

/// The lines of a list; each must be the part that comes next in the plan.
struct List {
    path: PathBuf,
    result: PathBuf,
    lines: std::io::Lines<BufReader<File>>,
    number: u64,
}

impl List {
    fn open(result: &Path) -> Result<Self, Error> {
        let path = result.join(PARTS_LIST);
        let file = File::open(&path).map_err(Error::io("open", &path))?;
        let lines = BufReader::new(file).lines();
        Ok(Self { path, result: result.to_owned(), lines, number: 0 })
    }

    fn next(&mut self) -> Result<Option<Listed>, Error> {
        let Some(line) = self.lines.next() else { return Ok(None) };
        let line = line.map_err(Error::io("read", &self.path))?;
        self.number += 1;
        let listed = line.split_once("  ").and_then(|(blake3, path)| {
            let path = self.result.join(path);
            let key = PartKey::of_file_name(path.file_name()?.to_str()?)?;
            Some(Listed { key, blake3: blake3.to_owned(), folder: path.parent()?.to_owned() })
        });
        let wrong = || self.damaged(&format!("line {} names no part", self.number));
        listed.map(Some).ok_or_else(wrong)
    }

    fn damaged(&self, what: &str) -> Error {
        Error::input(format!("{}: {what}; merge again", self.path.display()))
    }
}

impl Listed {
    fn rows(&self, list: &Path, plan_hash: &str) -> Result<Vec<RunRow>, Error> {
        let (part, blake3) = part::read(&self.folder, plan_hash, self.key)?;
        if blake3 == self.blake3 {
            return Ok(part.rows);
        }
        Err(Error::input(format!(
            "{} is not the file that {} lists: it was made anew after the merge; merge again",
            self.folder.join(self.key.file_name()).display(),
            list.display()
        )))
    }
}

/// Every row of a result whose rows lie in parts, in order, one part in memory.
///
/// # Errors
/// There is no list. What is wrong with it or with a part comes in its place among the rows.
pub fn rows(
    result: &Path,
    plan: &Plan,
) -> Result<impl Iterator<Item = Result<RunRow, Error>> + use<>, Error> {
    let mut list = List::open(result)?;
    let plan_hash = plan.hash()?;
    let wanted = PartKey::all(plan.strata.len(), plan.encounters_per_stratum);
    let mut parts = wanted.map(move |key| {
        let listed = list.next()?;
        let Some(listed) = listed.filter(|listed| listed.key == key) else {
            return Err(list.damaged(&format!("{} is not in its place", key.file_name())));
        };
        listed.rows(&list.path, &plan_hash)
    });
    let (mut failed, mut part) = (false, Vec::new().into_iter());
    Ok(std::iter::from_fn(move || {
        loop {
            if let Some(row) = part.next() {
                return Some(Ok(row));
            }
            match parts.next().filter(|_| !failed)? {
                Ok(rows) => part = rows.into_iter(),
                Err(error) => {
                    failed = true;
                    return Some(Err(error));
                }
            }
        }
    }))
}

/// The row of an encounter, out of the one part that holds it; `None` if it is not of the plan.
pub fn find(result: &Path, plan: &Plan, id: &EncounterId) -> Result<Option<RunRow>, Error> {
    let Some(stratum) = plan.stratum_of(id) else { return Ok(None) };
    let key = PartKey::of_encounter(stratum, id.j);
    let mut list = List::open(result)?;
    while let Some(listed) = list.next()? {
        if listed.key == key {
            let rows = listed.rows(&list.path, &plan.hash()?)?;
            return Ok(rows.into_iter().find(|row| row.id == *id));
        }
    }
    Err(list.damaged(&format!("it does not list {}", key.file_name())))
}
