//! The output folder of one planner's result, and the states it can be in.
//!
//! Empty: used. Partial: it holds `state/` with the plan and the parts so far, and needs
//! `--resume`. Finished: it holds `manifest.json`. Anything else is not ours and is left alone.

use crate::part::PartKey;
use crate::parts_list::PARTS_LIST;
use crate::{Error, Plan, part};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The table of a result; without it the rows lie in the parts of [`PARTS_LIST`].
pub const TABLE: &str = "runs.parquet";

/// Everything a finished folder may hold, and so everything that `--force` may remove.
const OURS: [&str; 9] = [
    "state",
    "report.html",
    TABLE,
    PARTS_LIST,
    "summary.json",
    "figures",
    "manifest.json",
    "timing.json",
    "replay",
];

/// What the names of folders with the verdicts of another rule set begin with.
pub const JUDGED: &str = "judged-";

/// What the names of folders with the parts of one shard begin with.
pub const SHARD: &str = "shard-";

/// How the names of files end that are not whole yet.
const TEMPORARY: [&str; 2] = [".tmp", ".partial"];

/// Also a file that a killed process had not given its name yet.
fn is_ours(name: &str) -> bool {
    let name = TEMPORARY.iter().find_map(|end| name.strip_suffix(end)).unwrap_or(name);
    OURS.contains(&name) || name.starts_with(JUDGED) || name.starts_with(SHARD)
}

/// An output folder that is ours to write to.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
    plan_hash: String,
    /// Parts that are not in this folder, where they were merged from several.
    elsewhere: BTreeMap<PartKey, Arc<Path>>,
}

/// What opening a folder found.
#[derive(Debug)]
pub enum Opened {
    /// Ready to run; some parts may be there already.
    Ready(Folder),
    /// The very same campaign was finished here.
    Finished(Folder),
}

impl Folder {
    /// Opens a folder for a plan.
    ///
    /// # Errors
    /// The folder holds another plan (the message names what differs), is partial without
    /// `resume`, or is not ours.
    pub fn open(path: &Path, plan: &Plan, resume: bool, force: bool) -> Result<Opened, Error> {
        let this = Self::at(path, plan.hash()?);
        let shown = path.display();
        if path.exists() && !path.is_dir() {
            return Err(Error::input(format!("{shown} is a file; --out wants a folder")));
        }
        let entries = this.entries()?;
        if entries.is_empty() || this.has_barely_begun(&entries)? {
            this.begin(plan)?;
            return Ok(Opened::Ready(this));
        }
        let stranger = entries.iter().find(|name| !is_ours(name));
        let there = this.stored_plan()?;
        let (Some(there), None) = (there, stranger) else {
            let what = stranger.map_or("no manifest", String::as_str);
            return Err(Error::input(format!(
                "{shown} is not empty and was not made by this tool (it holds {what}); \
                 name an empty folder with --out"
            )));
        };
        if force {
            this.clear()?;
            this.begin(plan)?;
            return Ok(Opened::Ready(this));
        }
        let differs = differences(&there, &plan.json()?);
        if !differs.is_empty() {
            return Err(Error::input(format!(
                "{shown} holds another result: {}; name another folder with --out, or \
                 replace it with --force",
                differs.join("; ")
            )));
        }
        if path.join("manifest.json").exists() {
            // a process that was killed between its last file and this left them
            this.end()?;
            return Ok(Opened::Finished(this));
        }
        if !resume {
            return Err(Error::input(format!(
                "{shown} holds a part of this campaign; go on with --resume, or start again \
                 with --force"
            )));
        }
        Ok(Opened::Ready(this))
    }

    /// A folder that holds a plan already, for the engine and for replay.
    pub fn existing(path: &Path) -> Result<(Self, Plan), Error> {
        let this = Self::at(path, String::new());
        let json = this.stored_plan()?.ok_or_else(|| {
            Error::input(format!("{} holds no result of this tool", path.display()))
        })?;
        let plan: Plan = serde_json::from_value(json).map_err(|e| {
            Error::input(format!("{} was made by another version: {e}", path.display()))
        })?;
        let plan_hash = plan.hash()?;
        Ok((Self { plan_hash, ..this }, plan))
    }

    /// The folder into which the parts of several shards are merged.
    ///
    /// # Errors
    /// It holds a finished result, or something else than shards.
    pub fn merged(
        path: &Path,
        plan: &Plan,
        parts: BTreeMap<PartKey, Arc<Path>>,
    ) -> Result<Self, Error> {
        let this = Self { elsewhere: parts, ..Self::at(path, plan.hash()?) };
        let stranger = this.entries()?.into_iter().find(|name| !is_ours(name));
        if let Some(what) = stranger {
            let shown = path.display();
            return Err(Error::input(format!("{shown} holds {what}, which is no shard's")));
        }
        this.begin(plan)?;
        Ok(this)
    }

    fn at(path: &Path, plan_hash: String) -> Self {
        Self { path: path.to_owned(), plan_hash, elsewhere: BTreeMap::new() }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Hash of the plan.
    pub fn plan_hash(&self) -> &str {
        &self.plan_hash
    }

    /// Where parts are.
    pub fn parts(&self) -> PathBuf {
        self.path.join("state").join("parts")
    }

    /// Where a part is.
    pub fn parts_of(&self, key: PartKey) -> PathBuf {
        self.elsewhere.get(&key).map_or_else(|| self.parts(), |folder| folder.to_path_buf())
    }

    /// Where encounters that took the process with them are listed.
    pub fn lost(&self) -> PathBuf {
        self.path.join("state").join("lost.jsonl")
    }

    /// Where the slots of the workers are.
    pub fn inflight(&self) -> PathBuf {
        self.path.join("state").join("inflight")
    }

    /// Removes what only a partial result needs.
    pub fn end(&self) -> Result<(), Error> {
        let state = self.path.join("state");
        match fs::remove_dir_all(&state) {
            Err(e) if e.kind() == ErrorKind::NotFound => Ok(()),
            removed => removed.map_err(Error::io("remove", &state)),
        }
    }

    /// Whether a process was stopped here between making the folder and writing its plan.
    fn has_barely_begun(&self, entries: &[String]) -> Result<bool, Error> {
        if entries != ["state"] || self.stored_plan()?.is_some() {
            return Ok(false);
        }
        let within = Self::at(&self.path.join("state"), String::new()).entries()?;
        let parts = Self::at(&self.parts(), String::new()).entries()?;
        Ok(parts.is_empty() && within.iter().all(|name| name == "parts" || name == "plan.json.tmp"))
    }

    fn entries(&self) -> Result<Vec<String>, Error> {
        if !self.path.exists() {
            return Ok(Vec::new());
        }
        let read = Error::io("read", &self.path);
        let list: Result<Vec<_>, _> = match fs::read_dir(&self.path) {
            Ok(list) => list.collect(),
            Err(e) => return Err(read(e)),
        };
        let mut names: Vec<String> = list
            .map_err(read)?
            .iter()
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        Ok(names)
    }

    fn stored_plan(&self) -> Result<Option<Value>, Error> {
        let partial = self.path.join("state").join("plan.json");
        let finished = self.path.join("manifest.json");
        let (path, key) = if partial.exists() {
            (partial, None)
        } else if finished.exists() {
            (finished, Some("plan"))
        } else {
            return Ok(None);
        };
        let text = fs::read_to_string(&path).map_err(Error::io("read", &path))?;
        let json: Value = serde_json::from_str(&text)
            .map_err(|e| Error::input(format!("{} is damaged: {e}", path.display())))?;
        Ok(match key {
            None => Some(json),
            Some(key) => json.get(key).cloned(),
        })
    }

    fn begin(&self, plan: &Plan) -> Result<(), Error> {
        let parts = self.parts();
        fs::create_dir_all(&parts).map_err(Error::io("make", &parts))?;
        let path = self.path.join("state").join("plan.json");
        let text = format!("{:#}\n", plan.json()?);
        part::write_whole(&path, text.as_bytes()).map_err(Error::io("write", &path))
    }

    fn clear(&self) -> Result<(), Error> {
        for name in self.entries()?.iter().filter(|name| is_ours(name)) {
            let path = self.path.join(name);
            if path.is_dir() {
                fs::remove_dir_all(&path).map_err(Error::io("remove", &path))?;
            } else if path.exists() {
                fs::remove_file(&path).map_err(Error::io("remove", &path))?;
            }
        }
        Ok(())
    }
}

/// What differs between two plans, as at most four `key: there, here` texts. The commit is no
/// difference while engine and planners are the same.
pub(crate) fn differences(there: &Value, here: &Value) -> Vec<String> {
    const SHOWN: usize = 4;
    let mut found = Vec::new();
    compare("", there, here, &mut found);
    found.retain(|text: &String| !text.starts_with("build.git_"));
    if found.len() > SHOWN {
        let more = found.len() - SHOWN;
        found.truncate(SHOWN);
        found.push(format!("and {more} more"));
    }
    found
}

fn compare(key: &str, there: &Value, here: &Value, found: &mut Vec<String>) {
    match (there, here) {
        (Value::Object(a), Value::Object(b)) => {
            let mut keys: Vec<&String> = a.keys().chain(b.keys()).collect();
            keys.sort();
            keys.dedup();
            for name in keys {
                let path = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                let null = &Value::Null;
                compare(&path, a.get(name).unwrap_or(null), b.get(name).unwrap_or(null), found);
            }
        }
        (a, b) if a != b => {
            found.push(format!("{key} is {} there and {} here", brief(a), brief(b)))
        }
        _ => {}
    }
}

fn brief(value: &Value) -> String {
    const LONGEST: usize = 40;
    let text = value.to_string();
    if text.chars().count() <= LONGEST {
        text
    } else {
        text.chars().take(LONGEST).chain("...".chars()).collect()
    }
}
