//! What can be wrong with a specification of encounters.

use std::path::PathBuf;

/// Why there are no encounters.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A value in the campaign file is wrong.
    #[error("`{key}` {problem}")]
    Spec {
        /// The key, with the tables it stands in.
        key: String,
        /// What is wrong with it and what would be right.
        problem: String,
    },
    /// A class, miss distance and time that the ships of a stratum cannot make.
    #[error("failed to place target {target} of {stratum}/{j:06} in {tries} tries: {problem}")]
    Placement {
        /// Name of the stratum.
        stratum: String,
        /// Which draw of it.
        j: u64,
        /// Which target, from 1.
        target: u8,
        /// How many speeds and courses were tried.
        tries: u64,
        /// Which constraint was not met.
        problem: String,
    },
    /// A situation of another tool is not as its schema says, or not in our world.
    #[error("{}: {at}: {problem}", file.display())]
    Situation {
        /// The file.
        file: PathBuf,
        /// JSON path of the value, from `$`.
        at: String,
        /// What is wrong with it and what would be right.
        problem: String,
    },
    /// A file could not be read.
    #[error("failed to read {}: {problem}", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        problem: String,
    },
}

impl Error {
    /// A wrong value of the campaign file.
    pub(crate) fn spec(key: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Spec { key: key.into(), problem: problem.into() }
    }
}

/// `Ok` where `holds`, else the error about `key`.
pub(crate) fn require(
    holds: bool,
    key: impl FnOnce() -> String,
    problem: impl FnOnce() -> String,
) -> Result<(), Error> {
    if holds { Ok(()) } else { Err(Error::spec(key(), problem())) }
}
