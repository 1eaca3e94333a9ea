//! Rows to Parquet and back; the only crate that names polars.
//!
//! `RunRow -> runs.parquet -> RunRow`. Memory is bounded by one row group in both directions. The
//! same rows in the same order give the same bytes, and nothing but the rows gets into the file.
//! No statistic is taken here: numbers come from `summary` and `stats`.
#![forbid(unsafe_code)]

mod columns;
mod csv;
mod error;
mod gather;
mod read;
mod write;

pub use columns::column_names;
pub use csv::{csv_head, csv_line};
pub use error::TableError;
pub use read::{Rows, find, read_rows};
pub use write::{ParquetSink, ROW_GROUP_ROWS};
