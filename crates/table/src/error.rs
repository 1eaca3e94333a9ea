//! What can go wrong with a table.

use polars::prelude::PolarsError;
use std::io;
use std::path::PathBuf;

/// Why a table was not written or read. The messages are fragments that follow "failed to".
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The file could not be made, moved or opened.
    #[error("{action} {}: {source}", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// With which file.
        path: PathBuf,
        /// Why it did not work.
        source: io::Error,
    },
    /// A row group or the footer could not be encoded.
    #[error("write {}: {source}", path.display())]
    Write {
        /// Which file.
        path: PathBuf,
        /// Why it did not work.
        source: PolarsError,
    },
    /// The file is not a Parquet file, or damaged.
    #[error("read {} as a table of runs: {source}", path.display())]
    Read {
        /// Which file.
        path: PathBuf,
        /// Why it did not work.
        source: PolarsError,
    },
    /// A cell says what no run can say.
    #[error("read {}: row {row}, column `{column}`: {problem}", path.display())]
    Cell {
        /// Which file.
        path: PathBuf,
        /// Which row, from 0.
        row: u64,
        /// Which column.
        column: String,
        /// What is wrong with it.
        problem: &'static str,
    },
}
