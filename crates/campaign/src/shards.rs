//! Parts of several shards: what is there, what is missing, and all of them as one.
//!
//! A shard is run into a folder of its own (`campaign --shard 3/1000 --out DIR/shard-0003`), so
//! that no two machines write to one file. Parts appear whole, by rename, and carry the hash of
//! their plan and of their content; here they are only found, and read later one by one in order.

use crate::differences::differences;
use crate::folder::SHARD;
use crate::part::PartKey;
use crate::pipeline::shard_keys;
use crate::{Error, Folder, Plan};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The parts that were found, and the plan that they all follow.
#[derive(Debug)]
pub struct Shards {
    /// The plan.
    pub plan: Plan,
    /// The folder of each part.
    pub parts: BTreeMap<PartKey, Arc<Path>>,
}

impl Shards {
    /// Looks at a folder, at its sub-folders `shard-*`, and at further folders of shards.
    ///
    /// # Errors
    /// There is no shard, one belongs to another campaign, or two hold the same part.
    pub fn find(dir: &Path, further: &[PathBuf]) -> Result<Self, Error> {
        let folders = folders(dir, further)?;
        let mut first: Option<(Folder, Plan)> = None;
        let mut parts: BTreeMap<PartKey, Arc<Path>> = BTreeMap::new();
        for path in &folders {
            let (folder, plan) = Folder::existing(path)?;
            match &first {
                None => first = Some((folder.clone(), plan)),
                Some((other, of)) if other.plan_hash() != folder.plan_hash() => {
                    return Err(Error::input(format!(
                        "{} and {} hold parts of different campaigns: {}",
                        other.path().display(),
                        path.display(),
                        differences(&of.json()?, &plan.json()?).join("; ")
                    )));
                }
                Some(_) => {}
            }
            add_parts(&mut parts, &folder.parts())?;
        }
        let (_, plan) = first.ok_or_else(|| {
            Error::input(format!(
                "{} holds no shard; `campaign --shard 1/N --out {}/{SHARD}1` makes one",
                dir.display(),
                dir.display()
            ))
        })?;
        let belongs = |key: &PartKey| {
            (key.stratum as usize) < plan.strata.len()
                && !key.range(plan.encounters_per_stratum).is_empty()
        };
        if let Some(key) = parts.keys().find(|key| !belongs(key)) {
            let name = key.file_name();
            return Err(Error::input(format!("part {name} is no part of this campaign")));
        }
        Ok(Self { plan, parts })
    }

    /// The parts that are not there, in order.
    pub fn missing(&self) -> impl Iterator<Item = PartKey> {
        shard_keys(&self.plan, (1, 1)).into_iter().filter(|key| !self.parts.contains_key(key))
    }

    /// The shards of `of` that have missing parts, counted from 1.
    pub fn missing_shards(&self, of: u64) -> Vec<u64> {
        let gap = |(i, key): (usize, PartKey)| {
            (!self.parts.contains_key(&key)).then_some(i as u64 % of + 1)
        };
        let keys = shard_keys(&self.plan, (1, 1));
        let mut shards: Vec<u64> = keys.into_iter().enumerate().filter_map(gap).collect();
        shards.sort_unstable();
        shards.dedup();
        shards
    }
}

/// Every folder that holds a plan and parts, sorted within `dir`.
fn folders(dir: &Path, further: &[PathBuf]) -> Result<Vec<PathBuf>, Error> {
    let is_shard = |path: &Path| path.join("state").join("plan.json").exists();
    let mut found: Vec<PathBuf> = Vec::new();
    if dir.is_dir() {
        for entry in fs::read_dir(dir).map_err(Error::io("read", dir))? {
            let path = entry.map_err(Error::io("read", dir))?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if name.starts_with(SHARD) && is_shard(&path) {
                found.push(path);
            }
        }
    }
    found.sort();
    if is_shard(dir) {
        found.insert(0, dir.to_owned());
    }
    if let Some(wrong) = further.iter().find(|path| !is_shard(path)) {
        return Err(Error::input(format!("{} holds no shard", wrong.display())));
    }
    found.extend(further.iter().cloned());
    Ok(found)
}

fn add_parts(parts: &mut BTreeMap<PartKey, Arc<Path>>, folder: &Path) -> Result<(), Error> {
    let shared: Arc<Path> = Arc::from(folder);
    for entry in fs::read_dir(folder).map_err(Error::io("read", folder))? {
        let path = entry.map_err(Error::io("read", folder))?.path();
        if path.extension().is_none_or(|extension| extension != "part") {
            continue;
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let key = PartKey::of_file_name(&name)
            .ok_or_else(|| Error::input(format!("{} is no part's name", path.display())))?;
        if let Some(other) = parts.insert(key, Arc::clone(&shared)) {
            return Err(Error::input(format!(
                "part {name} is in {} and in {}; remove one of them",
                other.display(),
                folder.display()
            )));
        }
    }
    Ok(())
}
