//! Rows to Parquet and back; the only crate that names polars
#![forbid(unsafe_code)]
