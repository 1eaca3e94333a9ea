//! What can stop a campaign. A failed run is data and never one of these.

use std::io;
use std::path::{Path, PathBuf};

/// Why a campaign could not be run to its end.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Something the user gave is wrong: the message says what, where, and what would be right.
    #[error("{0}")]
    Input(String),
    /// A file could not be read or written.
    #[error("failed to {doing} {}: {source}", path.display())]
    Io {
        /// What was tried, such as `write`.
        doing: &'static str,
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// Stopped before its end, and can be taken up again.
    #[error("{0}")]
    Incomplete(String),
    /// The bench itself is at fault: nothing it wrote may be trusted.
    #[error("harness fault: {0}")]
    Fault(String),
}

impl Error {
    /// An input error.
    pub fn input(message: impl Into<String>) -> Self {
        Self::Input(message.into())
    }

    /// For `map_err` on a file operation.
    pub fn io(doing: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { doing, path, source }
    }
}
