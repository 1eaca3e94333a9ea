//! What can go wrong with a report.

use std::io;
use std::path::PathBuf;

/// Why a report was not written. The messages are fragments that follow "failed to".
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A file or folder could not be made or moved.
    #[error("{action} {}: {source}", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// With which file.
        path: PathBuf,
        /// Why it did not work.
        source: io::Error,
    },
    /// A template does not fit its data.
    #[error("fill the template of {page}: {source}")]
    Template {
        /// Which page.
        page: &'static str,
        /// What does not fit.
        source: minijinja::Error,
    },
    /// The data of the player cannot be written as JSON.
    #[error("encode the replay player's data: {0}")]
    Player(serde_json::Error),
}
