//! The planners that a change is measured against: the current one, the last release, the anchor.
//!
//! Each is a record of a planner that can be run again: a name, its options and a commit, with the
//! hashes of what its numbers meant. A record says whom it replaced, so the files and their history
//! tell the whole line of predecessors. Many small steps, each within its margin, add up; the
//! release and the anchor bound their sum. Source: statistics specification, section 5, item 5.

use crate::serve::Identity;
use campaign::Error;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// What a stored planner is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// The planner of today; a change must not be worse.
    Current,
    /// The last release; worse by at most `release_margin_factor` margins.
    Release,
    /// Moved by nothing but a signed decision; worse by at most `anchor_margin_factor` margins.
    Anchor,
}

impl Role {
    /// Every role.
    pub const ALL: [Self; 3] = [Self::Current, Self::Release, Self::Anchor];

    /// The word used in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Current => "current",
            Self::Release => "release",
            Self::Anchor => "anchor",
        }
    }

    /// The role of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|role| role.name() == name)
    }
}

/// A planner that can be run again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// 1.
    pub schema: u32,
    /// What it is for.
    pub role: Role,
    /// Name in the registry.
    pub planner: String,
    /// Every option with its value.
    pub options: toml::Table,
    /// The gate's campaign under which the hashes hold.
    pub campaign: String,
    /// Commit and hashes.
    pub identity: Identity,
    /// Who decided on it, and why; the anchor never moves without.
    pub signed: Option<String>,
    /// Whom it replaced.
    pub replaced: Option<Replaced>,
}

/// The record before.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Replaced {
    /// Name in the registry.
    pub planner: String,
    /// Commit of its sources.
    pub git_commit: String,
    /// BLAKE3 of its record.
    pub record: String,
}

impl Record {
    /// The record of a role; none where none is stored.
    pub fn read(folder: &Path, role: Role) -> Result<Option<Self>, Error> {
        Ok(stored(folder, role)?.map(|(record, _)| record))
    }

    /// As it stands on a command line.
    pub fn named(&self) -> String {
        format!("git:{}:{}", self.identity.git_commit, self.planner)
    }

    /// Takes the place of the record of its role, and notes whom it replaced. The same planner in
    /// the same build is no change, and leaves the file as it is.
    ///
    /// # Errors
    /// An anchor that is moved without a signature.
    pub fn store(mut self, folder: &Path) -> Result<(Self, PathBuf), Error> {
        let path = path(folder, self.role);
        if let Some((before, text)) = stored(folder, self.role)? {
            if before.stands_for(&self) {
                return Ok((before, path));
            }
            if self.role == Role::Anchor && self.signed.is_none() {
                return Err(Error::input(format!(
                    "the anchor is {}; it is moved by a signed decision only: \
                     --signed \"NAME: REASON\"",
                    before.named()
                )));
            }
            self.replaced = Some(Replaced {
                planner: before.planner,
                git_commit: before.identity.git_commit,
                record: blake3::hash(text.as_bytes()).to_hex().to_string(),
            });
        }
        fs::create_dir_all(folder).map_err(Error::io("make", folder))?;
        let text = serde_json::to_string_pretty(&self)
            .map_err(|e| Error::Fault(format!("failed to encode: {e}")))?;
        campaign::part::write_whole(&path, format!("{text}\n").as_bytes())
            .map_err(Error::io("write", &path))?;
        Ok((self, path))
    }

    fn stands_for(&self, other: &Self) -> bool {
        self.planner == other.planner
            && self.options == other.options
            && self.campaign == other.campaign
            && self.identity == other.identity
            && (other.signed.is_none() || self.signed == other.signed)
    }
}

fn path(folder: &Path, role: Role) -> PathBuf {
    folder.join(format!("{}.json", role.name()))
}

/// A record and its text.
fn stored(folder: &Path, role: Role) -> Result<Option<(Record, String)>, Error> {
    let path = path(folder, role);
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(Error::io("read", &path)(e)),
    };
    let wrong = |what: String| Error::input(format!("{}: {what}", path.display()));
    let record: Record = serde_json::from_str(&text).map_err(|e| wrong(e.to_string()))?;
    if record.role != role || record.schema != 1 {
        return Err(wrong(format!("it must hold the {} in schema 1", role.name())));
    }
    Ok(Some((record, text)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(role: Role, planner: &str) -> Record {
        Record {
            schema: 1,
            role,
            planner: planner.into(),
            options: toml::Table::new(),
            campaign: "gate".into(),
            identity: Identity {
                engine: "e".into(),
                encounter_model: "m".into(),
                rule_set: "r".into(),
                planners: "p".into(),
                git_commit: "c".into(),
            },
            signed: None,
            replaced: None,
        }
    }

    #[test]
    fn a_record_says_whom_it_replaced_and_the_same_planner_changes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(Record::read(folder.path(), Role::Current).unwrap(), None);
        let first = record(Role::Current, "zhuang").store(folder.path()).unwrap();
        assert_eq!(first.0.replaced, None);
        let text = fs::read(&first.1).unwrap();
        record(Role::Current, "zhuang").store(folder.path()).unwrap();
        assert_eq!(fs::read(&first.1).unwrap(), text, "nothing changed");
        record(Role::Current, "zhuang-corrected").store(folder.path()).unwrap();
        let now = Record::read(folder.path(), Role::Current).unwrap().unwrap();
        assert_eq!(now.planner, "zhuang-corrected");
        let replaced = now.replaced.unwrap();
        assert_eq!(replaced.planner, "zhuang");
        assert_eq!(replaced.record, blake3::hash(&text).to_hex().to_string());
        assert_eq!(Record::read(folder.path(), Role::Release).unwrap(), None);
    }

    #[test]
    fn the_anchor_moves_only_with_a_signature() {
        let folder = tempfile::tempdir().unwrap();
        record(Role::Anchor, "zhuang").store(folder.path()).unwrap();
        let refused = record(Role::Anchor, "hold-course").store(folder.path()).unwrap_err();
        assert!(refused.to_string().contains("--signed"), "{refused}");
        let signed = Record {
            signed: Some("A. Mate: the old one cannot be built any more".into()),
            ..record(Role::Anchor, "hold-course")
        };
        signed.store(folder.path()).unwrap();
        let now = Record::read(folder.path(), Role::Anchor).unwrap().unwrap();
        assert_eq!(now.replaced.unwrap().planner, "zhuang");
        fs::copy(folder.path().join("anchor.json"), folder.path().join("release.json")).unwrap();
        assert!(Record::read(folder.path(), Role::Release).is_err(), "a file in another's place");
    }
}
