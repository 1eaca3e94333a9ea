//! Writing: row groups in the order given, a temporary name until the file is whole.

use crate::TableError;
use crate::columns::{COLUMNS, Cells, ID, margin_name, status_name};
use polars::frame::DataFrame;
use polars::io::parquet::write::BatchedWriter;
use polars::prelude::{
    Column as Series, ParquetCompression, ParquetWriter, PolarsError, StatisticsOptions,
};
use record::{Check, RunRow};
use std::fmt;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

/// Rows of a row group; the last one of a file may have fewer.
pub const ROW_GROUP_ROWS: usize = 16_384;

/// Writes rows in the order given. The file appears whole, at [`ParquetSink::finish`], or not at
/// all: until then it has a temporary name beside its own, and dropping the sink removes that.
pub struct ParquetSink {
    path: PathBuf,
    temporary: PathBuf,
    rows: Vec<RunRow>,
    writer: Option<BatchedWriter<BufWriter<File>>>,
    written: u64,
}

impl ParquetSink {
    /// A sink that will put its file at `path`, over what is there.
    ///
    /// # Errors
    /// The temporary file beside `path` cannot be made.
    pub fn create(path: impl Into<PathBuf>) -> Result<Self, TableError> {
        let path = path.into();
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(".partial");
        let temporary = path.with_file_name(name);
        let file =
            File::create(&temporary).map_err(|source| io_error("create", &temporary, source))?;
        let schema = frame(&[]).map_err(|source| write_error(&path, source))?.schema().clone();
        let writer = ParquetWriter::new(BufWriter::with_capacity(1 << 20, file))
            .with_compression(ParquetCompression::Zstd(None))
            .with_statistics(StatisticsOptions::empty())
            // One thread: the encounters themselves fill the others.
            .set_parallel(false)
            .batched(&schema)
            .map_err(|source| write_error(&path, source))?;
        let rows = Vec::with_capacity(ROW_GROUP_ROWS);
        Ok(Self { path, temporary, rows, writer: Some(writer), written: 0 })
    }

    /// Adds a row; a full row group is written at once.
    ///
    /// # Errors
    /// The disk is full, or gone.
    pub fn push(&mut self, row: RunRow) -> Result<(), TableError> {
        self.rows.push(row);
        if self.rows.len() == ROW_GROUP_ROWS { self.write_group() } else { Ok(()) }
    }

    /// Rows so far.
    pub fn len(&self) -> u64 {
        self.written + self.rows.len() as u64
    }

    /// Whether there are none yet.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Writes the rest, makes the file durable and gives it its name. Returns the number of rows.
    ///
    /// # Errors
    /// The disk is full, or gone; the file does not appear then.
    pub fn finish(mut self) -> Result<u64, TableError> {
        self.write_group()?;
        let writer = self.writer.take().expect("a sink has its writer until it is finished");
        writer.finish().map_err(|source| write_error(&self.path, source))?;
        drop(writer);
        let sync = |path: &Path| File::options().write(true).open(path)?.sync_all();
        sync(&self.temporary).map_err(|source| io_error("sync", &self.temporary, source))?;
        fs::rename(&self.temporary, &self.path)
            .map_err(|source| io_error("rename", &self.temporary, source))?;
        Ok(self.written)
    }

    fn write_group(&mut self) -> Result<(), TableError> {
        if self.rows.is_empty() {
            return Ok(());
        }
        let writer = self.writer.as_mut().expect("a sink has its writer until it is finished");
        frame(&self.rows)
            .and_then(|group| writer.write_batch(&group))
            .map_err(|source| write_error(&self.path, source))?;
        self.written += self.rows.len() as u64;
        self.rows.clear();
        Ok(())
    }
}

impl Drop for ParquetSink {
    fn drop(&mut self) {
        drop(self.writer.take());
        // After `finish` there is nothing under this name; else half a file is worth nothing.
        let _ = fs::remove_file(&self.temporary);
    }
}

impl fmt::Debug for ParquetSink {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ParquetSink")
            .field("path", &self.path)
            .field("rows", &self.len())
            .finish_non_exhaustive()
    }
}

/// The rows as columns.
fn frame(rows: &[RunRow]) -> Result<DataFrame, PolarsError> {
    let ids: Vec<String> = rows.iter().map(|row| row.id.to_string()).collect();
    let mut series = vec![Series::new(ID.into(), ids)];
    for column in COLUMNS {
        let name = column.name.into();
        series.push(match column.cells {
            Cells::Number(get, _) => Series::new(name, cells(rows, get)),
            Cells::Count(get, _) => Series::new(name, cells(rows, get)),
            Cells::Flag(get, _) => Series::new(name, cells(rows, get)),
            Cells::Word(get, _) => {
                Series::new(name, rows.iter().map(get).collect::<Vec<Option<&str>>>())
            }
        });
    }
    for check in Check::ALL {
        let statuses: Vec<&str> = rows.iter().map(|row| row.check(check).status.name()).collect();
        series.push(Series::new(status_name(check).into(), statuses));
        let margins: Vec<Option<f64>> = rows.iter().map(|row| row.check(check).margin).collect();
        series.push(Series::new(margin_name(check).into(), margins));
    }
    DataFrame::new(rows.len(), series)
}

fn cells<T>(rows: &[RunRow], get: fn(&RunRow) -> Option<T>) -> Vec<Option<T>> {
    rows.iter().map(get).collect()
}

fn io_error(action: &'static str, path: &Path, source: std::io::Error) -> TableError {
    TableError::Io { action, path: path.to_owned(), source }
}

fn write_error(path: &Path, source: PolarsError) -> TableError {
    TableError::Write { path: path.to_owned(), source }
}
