//! What can go wrong with a pack. The messages are fragments that follow "failed to".

use std::io;
use std::path::{Path, PathBuf};

/// Why a pack was not made or could not be read.
#[derive(Debug, thiserror::Error)]
pub enum EvidenceError {
    /// A file or folder.
    #[error("{action} {}: {source}", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// With which file.
        path: PathBuf,
        /// Why it did not work.
        source: io::Error,
    },
    /// A file of the pack does not have the form that it should have.
    #[error("read {path}: {problem}")]
    Form {
        /// Inside the pack.
        path: String,
        /// What is wrong.
        problem: String,
    },
    /// A template does not fit its data.
    #[error("fill the template of evidence.html: {0}")]
    Template(minijinja::Error),
    /// An encounter could not be packed as a recording.
    #[error("compress the recording of {id}: {source}")]
    Recording {
        /// The encounter.
        id: String,
        /// Why it did not work.
        source: io::Error,
    },
    /// The report could not be rendered.
    #[error("{0}")]
    Report(#[from] report::ReportError),
    /// The table could not be read.
    #[error("{0}")]
    Table(#[from] table::TableError),
    /// The plan could not be used.
    #[error("use the plan: {0}")]
    Plan(#[from] campaign::Error),
    /// The program that signs could not be run, or refused.
    #[error("sign with `minisign`: {0}")]
    Sign(String),
}

impl EvidenceError {
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { action, path, source }
    }
}
