//! Writing: row groups in the order given, a temporary name until the file is whole.

use crate::TableError;
use crate::gather::Gathered;
use polars::io::parquet::write::BatchedWriter;
use polars::prelude::{ParquetCompression, ParquetWriter, PolarsError, StatisticsOptions};
use record::RunRow;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Rows of a row group; the last one of a file may have fewer.
pub const ROW_GROUP_ROWS: usize = 16_384;

/// Writes rows in the order given. The file appears whole, at [`ParquetSink::finish`], or not at
/// all: until then it has a temporary name beside its own, and dropping the sink removes that.
pub struct ParquetSink {
    path: PathBuf,
    temporary: PathBuf,
    gathered: Gathered,
    writer: Option<BatchedWriter<BufWriter<Noting>>>,
    failed: Failed,
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
        let failed = Failed::default();
        let file = Noting { file, failed: Arc::clone(&failed) };
        let gathered = Gathered::new();
        let write_error = |source| TableError::Write { path: path.clone(), source };
        let schema = gathered.frame().map_err(write_error)?.schema().clone();
        let writer = ParquetWriter::new(BufWriter::with_capacity(1 << 20, file))
            .with_compression(ParquetCompression::Zstd(None))
            .with_statistics(StatisticsOptions::empty())
            // One thread: the encounters themselves fill the others.
            .set_parallel(false)
            .batched(&schema)
            .map_err(write_error)?;
        Ok(Self { path, temporary, gathered, writer: Some(writer), failed, written: 0 })
    }

    /// Adds a row; a full row group is written at once.
    ///
    /// # Errors
    /// The disk is full, or gone.
    pub fn push(&mut self, row: &RunRow) -> Result<(), TableError> {
        self.gathered.push(row);
        if self.gathered.rows() == ROW_GROUP_ROWS { self.write_group() } else { Ok(()) }
    }

    /// Rows so far.
    pub fn len(&self) -> u64 {
        self.written + self.gathered.rows() as u64
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
        writer.finish().map_err(|source| self.write_error(source))?;
        // what lies in its buffer is written here, and nobody else would tell that it failed
        drop(writer);
        if let Some(source) = self.noted() {
            return Err(io_error("write", &self.path, source));
        }
        let sync = |path: &Path| File::options().write(true).open(path)?.sync_all();
        sync(&self.temporary).map_err(|source| io_error("sync", &self.temporary, source))?;
        fs::rename(&self.temporary, &self.path)
            .map_err(|source| io_error("rename", &self.temporary, source))?;
        Ok(self.written)
    }

    fn write_group(&mut self) -> Result<(), TableError> {
        if self.gathered.rows() == 0 {
            return Ok(());
        }
        let writer = self.writer.as_mut().expect("a sink has its writer until it is finished");
        self.gathered
            .frame()
            .and_then(|group| writer.write_batch(&group))
            .map_err(|source| self.write_error(source))?;
        self.written += self.gathered.rows() as u64;
        self.gathered.clear();
        Ok(())
    }

    fn noted(&self) -> Option<io::Error> {
        self.failed.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn write_error(&self, source: PolarsError) -> TableError {
        match self.noted() {
            Some(source) => io_error("write", &self.path, source),
            None => TableError::Write { path: self.path.clone(), source },
        }
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

fn io_error(action: &'static str, path: &Path, source: io::Error) -> TableError {
    TableError::Io { action, path: path.to_owned(), source }
}

/// The first failure of a file, as the system told it.
type Failed = Arc<Mutex<Option<io::Error>>>;

/// A file that keeps what the system says when a write fails: polars turns it into a text, and a
/// full disk could not be told from a fault of ours.
struct Noting {
    file: File,
    failed: Failed,
}

impl Noting {
    fn note<T>(&self, done: io::Result<T>) -> io::Result<T> {
        done.map_err(|error| {
            let told = io::Error::from(error.kind());
            self.failed.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            told
        })
    }
}

impl Write for Noting {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes);
        // the caller tries an interrupted one again
        if written.as_ref().is_err_and(|e| e.kind() == io::ErrorKind::Interrupted) {
            return written;
        }
        self.note(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.file.flush();
        self.note(flushed)
    }
}
