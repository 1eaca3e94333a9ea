//! The output folder of one planner's result, and the states it can be in.
//!
//! Empty: used. Partial: it holds `state/` with the plan and the parts so far, and needs
//! `--resume`. Finished: it holds `manifest.json`. Anything else is not ours and is left alone.

use crate::differences::differences;
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

/// What stands beside the folders of several planners.
const COMPARISON: [&str; 3] = ["comparison.html", "figures", "timing.json"];

/// Also a file that a killed process had not given its name yet.
fn is_ours(name: &str) -> bool {
    let name = without_temporary(name);
    OURS.contains(&name) || name.starts_with(JUDGED) || name.starts_with(SHARD)
}

fn without_temporary(name: &str) -> &str {
    TEMPORARY.iter().find_map(|end| name.strip_suffix(end)).unwrap_or(name)
}

/// What a folder is, before anything in it is touched.
enum Found {
    Unused,
    ToReplace,
    Partial,
    Finished,
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
        match this.look(plan, resume, force)? {
            Found::Partial => return Ok(Opened::Ready(this)),
            Found::Finished => {
                // a process that was killed between its last file and this left them
                this.end()?;
                return Ok(Opened::Finished(this));
            }
            Found::ToReplace => this.clear()?,
            Found::Unused => {}
        }
        this.begin(plan)?;
        Ok(Opened::Ready(this))
    }

    /// Whether [`Self::open`] would open it; changes nothing.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn check(path: &Path, plan: &Plan, resume: bool, force: bool) -> Result<(), Error> {
        Self::at(path, plan.hash()?).look(plan, resume, force).map(drop)
    }

    /// Refuses a folder for the results of several planners, which will lie in `within`, that holds
    /// anything else.
    ///
    /// # Errors
    /// It holds something that is neither a result nor of a comparison, or is a result itself.
    pub fn check_around(path: &Path, within: &[PathBuf]) -> Result<(), Error> {
        let this = Self::at(path, String::new());
        this.refuse_file()?;
        let belongs = |name: &String| {
            let inside = path.join(name);
            if COMPARISON.contains(&without_temporary(name)) || within.contains(&inside) {
                return Ok(true);
            }
            Ok(inside.is_dir() && Self::at(&inside, String::new()).is_begun()?)
        };
        for name in this.entries()? {
            if !belongs(&name)? {
                return Err(Error::input(format!(
                    "{} is to hold a folder for each planner, and holds {name}; name an empty \
                     folder with --out",
                    path.display()
                )));
            }
        }
        Ok(())
    }

    /// Whether it holds a result, or the beginning of one.
    fn is_begun(&self) -> Result<bool, Error> {
        let entries = self.entries()?;
        Ok(entries.is_empty() || self.has_barely_begun(&entries)? || self.stored_plan()?.is_some())
    }

    fn refuse_file(&self) -> Result<(), Error> {
        if self.path.exists() && !self.path.is_dir() {
            let shown = self.path.display();
            return Err(Error::input(format!("{shown} is a file; --out wants a folder")));
        }
        Ok(())
    }

    fn look(&self, plan: &Plan, resume: bool, force: bool) -> Result<Found, Error> {
        let shown = self.path.display();
        self.refuse_file()?;
        let entries = self.entries()?;
        if entries.is_empty() || self.has_barely_begun(&entries)? {
            return Ok(Found::Unused);
        }
        let stranger = entries.iter().find(|name| !is_ours(name));
        let there = self.stored_plan()?;
        let (Some(there), None) = (there, stranger) else {
            let what = stranger.map_or("no manifest", String::as_str);
            return Err(Error::input(format!(
                "{shown} is not empty and was not made by this tool (it holds {what}); \
                 name an empty folder with --out"
            )));
        };
        if force {
            return Ok(Found::ToReplace);
        }
        let differs = differences(&there, &plan.json()?);
        if !differs.is_empty() {
            return Err(Error::input(format!(
                "{shown} holds another result: {}; name another folder with --out, or \
                 replace it with --force",
                differs.join("; ")
            )));
        }
        if self.path.join("manifest.json").exists() {
            return Ok(Found::Finished);
        }
        if !resume {
            return Err(Error::input(format!(
                "{shown} holds a part of this campaign; go on with --resume, or start again \
                 with --force"
            )));
        }
        Ok(Found::Partial)
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
        Self::check_for_shards(path)?;
        this.begin(plan)?;
        Ok(this)
    }

    /// Refuses a folder that shards cannot be merged in.
    ///
    /// # Errors
    /// It holds something that is not ours.
    pub fn check_for_shards(path: &Path) -> Result<(), Error> {
        let this = Self::at(path, String::new());
        this.refuse_file()?;
        let Some(what) = this.entries()?.into_iter().find(|name| !is_ours(name)) else {
            return Ok(());
        };
        let shown = path.display();
        Err(Error::input(format!(
            "{shown} holds {what}, which is no shard's; name an empty folder"
        )))
    }

    /// A folder with a finished result.
    ///
    /// # Errors
    /// There is none, or the beginning of one.
    pub fn finished(path: &Path) -> Result<(Self, Plan), Error> {
        let found = Self::existing(path)?;
        if path.join("manifest.json").exists() {
            return Ok(found);
        }
        Err(Error::input(format!(
            "{} is not finished; go on with `campaign --resume` first",
            path.display()
        )))
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
