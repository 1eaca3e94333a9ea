//! What can stop a campaign. A failed run is data and never one of these.

use std::io::{self, ErrorKind};
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
    /// A stage with errors of its own could not write its files.
    #[error("failed to {what}")]
    Stage {
        /// What was tried, with which file, and what the system says.
        what: String,
        /// The same as a kind.
        kind: ErrorKind,
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

    /// The error of a stage that has its own; its text follows "failed to". Where no file operation
    /// is at its bottom it is a fault of the bench.
    pub fn stage(error: impl std::error::Error + 'static) -> Self {
        let what = error.to_string();
        let mut cause: Option<&(dyn std::error::Error + 'static)> = Some(&error);
        while let Some(this) = cause {
            if let Some(system) = this.downcast_ref::<io::Error>() {
                return Self::Stage { what, kind: system.kind() };
            }
            cause = this.source();
        }
        Self::Fault(format!("failed to {what}"))
    }

    fn kind(&self) -> Option<ErrorKind> {
        match self {
            Self::Io { source, .. } => Some(source.kind()),
            Self::Stage { kind, .. } => Some(*kind),
            Self::Input(_) | Self::Incomplete(_) | Self::Fault(_) => None,
        }
    }

    /// Whether there was no room for a file: what was written before stays good.
    pub fn is_no_room(&self) -> bool {
        use ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
        matches!(self.kind(), Some(StorageFull | QuotaExceeded | FileTooLarge))
    }

    /// Whether a file or folder that was named cannot be used: forbidden, read-only, or no folder.
    pub fn is_wrong_place(&self) -> bool {
        use ErrorKind::{
            IsADirectory, NotADirectory, NotFound, PermissionDenied, ReadOnlyFilesystem,
        };
        matches!(
            self.kind(),
            Some(IsADirectory | NotADirectory | NotFound | PermissionDenied | ReadOnlyFilesystem)
        )
    }

    /// The user stopped it, and is told how to go on.
    pub fn stopped(folder: &Path, go_on: &str) -> Self {
        let kept = folder.display();
        Self::Incomplete(format!("stopped; what was done is kept in {kept}; {go_on}"))
    }

    /// Where the reason is a lack of room: the same for somebody who is told how to go on.
    pub fn kept_in(self, folder: &Path, go_on: &str) -> Self {
        if !self.is_no_room() {
            return self;
        }
        Self::Incomplete(format!(
            "{self}; what was done is kept in {}; make room, then {go_on}",
            folder.display()
        ))
    }
}
