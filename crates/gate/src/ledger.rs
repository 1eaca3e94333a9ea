//! The ledger of attempts: append-only, so that trying until it passes has its price.
//!
//! Attempt j of one change series passes at a_P / 2^(j-1); a whole series then passes falsely with
//! probability at most 2 a_P. The same fresh key is the same attempt, however often it is run.
//! Every line carries the hash of the line before: a line that was taken out or changed is
//! noticed. Source: statistics specification, section 5, item 2.

use campaign::Error;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::FreshKey;

/// One line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Hash of the line before; empty in the first.
    pub previous: String,
    /// The change series, by default a branch.
    pub series: String,
    /// Attempt j of the series, from 1.
    pub attempt: u32,
    /// Key of the fresh set.
    pub key: FreshKey,
    /// Hash of the campaign.
    pub campaign_hash: String,
    /// The baseline as it was named.
    pub baseline: String,
    /// The candidate as it was named.
    pub candidate: String,
    /// The cap of this run, pairs.
    pub cap_pairs: u64,
    /// `started`, or the verdict.
    pub state: String,
}

/// The file and what it holds.
#[derive(Debug)]
pub struct Ledger {
    path: PathBuf,
    entries: Vec<Entry>,
    last: String,
}

impl Ledger {
    /// Reads a ledger; a file that is not there is an empty one.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let text = match fs::read_to_string(path) {
            Ok(text) => text,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(e) => return Err(Error::io("read", path)(e)),
        };
        let mut entries = Vec::new();
        let mut last = String::new();
        for (number, line) in text.lines().enumerate() {
            let wrong = |what: &str| {
                Error::input(format!(
                    "ledger {}, line {}: {what}; the ledger is append-only",
                    path.display(),
                    number + 1
                ))
            };
            let entry: Entry = serde_json::from_str(line).map_err(|e| wrong(&e.to_string()))?;
            if entry.previous != last {
                return Err(wrong("a line before it was changed or taken out"));
            }
            last = blake3::hash(line.as_bytes()).to_hex().to_string();
            entries.push(entry);
        }
        Ok(Self { path: path.to_owned(), entries, last })
    }

    /// The attempt that a run with this key is.
    pub fn attempt(&self, series: &str, key: &FreshKey) -> u32 {
        let of_series = || self.entries.iter().filter(|entry| entry.series == series);
        of_series().find(|entry| entry.key == *key).map_or_else(
            || of_series().map(|entry| entry.attempt).max().unwrap_or(0) + 1,
            |entry| entry.attempt,
        )
    }

    /// Appends a line; its `previous` is filled in here.
    pub fn append(&mut self, mut entry: Entry) -> Result<(), Error> {
        entry.previous.clone_from(&self.last);
        let line = serde_json::to_string(&entry).map_err(|e| Error::Fault(e.to_string()))?;
        if let Some(folder) = self.path.parent() {
            fs::create_dir_all(folder).map_err(Error::io("make", folder))?;
        }
        let mut file = fs::OpenOptions::new()
            .create(true)
            .append(true)
            .open(&self.path)
            .map_err(Error::io("open", &self.path))?;
        writeln!(file, "{line}").map_err(Error::io("write", &self.path))?;
        self.last = blake3::hash(line.as_bytes()).to_hex().to_string();
        self.entries.push(entry);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(series: &str, key: &FreshKey, attempt: u32) -> Entry {
        Entry {
            previous: String::new(),
            series: series.into(),
            attempt,
            key: key.clone(),
            campaign_hash: "c".into(),
            baseline: "a".into(),
            candidate: "b".into(),
            cap_pairs: 10,
            state: "started".into(),
        }
    }

    #[test]
    fn a_new_key_is_a_new_attempt_and_an_old_one_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ledger.jsonl");
        let keys = ["1", "2", "3"].map(|c| FreshKey::new("campaign", c));
        let mut ledger = Ledger::open(&path).unwrap();
        assert_eq!(ledger.attempt("x", &keys[0]), 1);
        ledger.append(entry("x", &keys[0], 1)).unwrap();
        assert_eq!(ledger.attempt("x", &keys[0]), 1, "the same key again is the same attempt");
        assert_eq!(ledger.attempt("x", &keys[1]), 2);
        ledger.append(entry("x", &keys[1], 2)).unwrap();
        assert_eq!(ledger.attempt("y", &keys[2]), 1, "another series starts anew");
        let again = Ledger::open(&path).unwrap();
        assert_eq!(again.attempt("x", &keys[2]), 3);
    }

    #[test]
    fn a_line_that_was_taken_out_or_changed_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ledger.jsonl");
        let mut ledger = Ledger::open(&path).unwrap();
        for (i, c) in ["1", "2", "3"].into_iter().enumerate() {
            ledger.append(entry("x", &FreshKey::new("campaign", c), i as u32 + 1)).unwrap();
        }
        let text = fs::read_to_string(&path).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        fs::write(&path, format!("{}\n{}\n", lines[0], lines[2])).unwrap();
        assert!(Ledger::open(&path).unwrap_err().to_string().contains("line 2"));
        fs::write(&path, text.replacen("\"baseline\":\"a\"", "\"baseline\":\"z\"", 1)).unwrap();
        assert!(Ledger::open(&path).is_err());
    }
}
