//! Reading: row group by row group, in the order of the file.

use crate::columns::{COLUMNS, Cells, ID, J, STRATUM, blank_row, margin_name, status_name};
use crate::{ROW_GROUP_ROWS, TableError};
use polars::frame::DataFrame;
use polars::prelude::{ParallelStrategy, ParquetReader, PolarsError, SerReader};
use record::{Check, EncounterId, Reaction, RunRow, Status};
use std::fmt;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Every row of a table, in its order.
///
/// # Errors
/// The file is not there, or is not Parquet. What is wrong with a single row comes with that row.
pub fn read_rows(path: impl Into<PathBuf>) -> Result<Rows, TableError> {
    let table = Table::open(path.into())?;
    Ok(Rows { table, next: 0, group: Vec::new().into_iter(), failed: false })
}

/// The row of an encounter; `None` if the table has none.
///
/// # Errors
/// As [`read_rows`], and a damaged row.
pub fn find(path: impl Into<PathBuf>, id: &EncounterId) -> Result<Option<RunRow>, TableError> {
    let table = Table::open(path.into())?;
    let mut at = 0;
    while at < table.rows {
        let frame = table.slice(at, ROW_GROUP_ROWS, Some(&[STRATUM, J]))?;
        let found = table.read(|| {
            let strata = frame.column(STRATUM)?.str()?;
            let numbers = frame.column(J)?.u64()?;
            let same = |(stratum, j)| stratum == Some(&*id.stratum) && j == Some(id.j);
            Ok(strata.iter().zip(numbers.iter()).position(same))
        })?;
        if let Some(offset) = found {
            let row = at + offset;
            return Ok(table.rows(row, 1)?.pop());
        }
        at += ROW_GROUP_ROWS;
    }
    Ok(None)
}

/// The rows of a table; see [`read_rows`]. Ends after the first error.
pub struct Rows {
    table: Table,
    next: usize,
    group: std::vec::IntoIter<RunRow>,
    failed: bool,
}

impl Rows {
    /// Number of rows in the table.
    pub fn total(&self) -> u64 {
        self.table.rows as u64
    }
}

impl Iterator for Rows {
    type Item = Result<RunRow, TableError>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Some(row) = self.group.next() {
            return Some(Ok(row));
        }
        if self.failed || self.next >= self.table.rows {
            return None;
        }
        match self.table.rows(self.next, ROW_GROUP_ROWS) {
            Ok(rows) => {
                self.next += ROW_GROUP_ROWS;
                self.group = rows.into_iter();
                self.group.next().map(Ok)
            }
            Err(error) => {
                self.failed = true;
                Some(Err(error))
            }
        }
    }
}

impl fmt::Debug for Rows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Rows")
            .field("path", &self.table.path)
            .field("total", &self.table.rows)
            .finish_non_exhaustive()
    }
}

struct Table {
    path: PathBuf,
    rows: usize,
}

impl Table {
    fn open(path: PathBuf) -> Result<Self, TableError> {
        let rows = ParquetReader::new(open(&path)?)
            .num_rows()
            .map_err(|source| TableError::Read { path: path.clone(), source })?;
        Ok(Self { path, rows })
    }

    /// Some columns (absent: all) of the rows from `at` on.
    fn slice(
        &self,
        at: usize,
        rows: usize,
        columns: Option<&[&str]>,
    ) -> Result<DataFrame, TableError> {
        let columns = columns.map(|names| names.iter().map(|&name| name.to_owned()).collect());
        let reader = ParquetReader::new(open(&self.path)?)
            .with_slice(Some((at, rows)))
            .with_columns(columns)
            .read_parallel(ParallelStrategy::None);
        self.read(|| reader.finish())
    }

    fn rows(&self, at: usize, rows: usize) -> Result<Vec<RunRow>, TableError> {
        let frame = self.slice(at, rows, None)?;
        let mut found: Vec<RunRow> = (0..frame.height()).map(|_| blank_row()).collect();
        for column in COLUMNS {
            let cells = Named { table: self, frame: &frame, at, name: column.name };
            let required = column.required;
            match column.cells {
                Cells::Number(_, set) => {
                    let values = self.read(|| frame.column(column.name)?.f64().cloned())?;
                    cells.put(&mut found, values.iter(), required, |row, value| {
                        set(row, value);
                        true
                    })?;
                }
                Cells::Count(_, set) => {
                    let values = self.read(|| frame.column(column.name)?.u64().cloned())?;
                    cells.put(&mut found, values.iter(), required, |row, value| {
                        set(row, value);
                        true
                    })?;
                }
                Cells::Flag(_, set) => {
                    let values = self.read(|| frame.column(column.name)?.bool().cloned())?;
                    cells.put(&mut found, values.iter(), required, |row, value| {
                        set(row, value);
                        true
                    })?;
                }
                Cells::Word(_, set) => {
                    let values = self.read(|| frame.column(column.name)?.str().cloned())?;
                    cells.put(&mut found, values.iter(), required, set)?;
                }
            }
        }
        self.put_checks(&frame, at, &mut found)?;
        self.share_strata(&mut found);
        self.check_whole(&frame, at, &found)?;
        Ok(found)
    }

    fn put_checks(
        &self,
        frame: &DataFrame,
        at: usize,
        found: &mut [RunRow],
    ) -> Result<(), TableError> {
        for check in Check::ALL {
            let name = status_name(check);
            let statuses = self.read(|| frame.column(&name)?.str().cloned())?;
            let cells = Named { table: self, frame, at, name: &name };
            cells.put(found, statuses.iter(), true, |row, word| {
                let status = Status::from_name(word);
                status.map(|status| row.checks[check as usize].status = status).is_some()
            })?;
            let name = margin_name(check);
            let margins = self.read(|| frame.column(&name)?.f64().cloned())?;
            let cells = Named { table: self, frame, at, name: &name };
            cells.put(found, margins.iter(), false, |row, margin| {
                row.checks[check as usize].margin = Some(margin);
                true
            })?;
        }
        Ok(())
    }

    /// Neighbours of one stratum share its name.
    fn share_strata(&self, found: &mut [RunRow]) {
        let mut last: Option<Arc<str>> = None;
        for row in found {
            match &last {
                Some(name) if **name == *row.id.stratum => row.id.stratum = Arc::clone(name),
                _ => last = Some(Arc::clone(&row.id.stratum)),
            }
        }
    }

    /// What no single column shows: the id as text agrees, and who acted has a time.
    fn check_whole(
        &self,
        frame: &DataFrame,
        at: usize,
        found: &[RunRow],
    ) -> Result<(), TableError> {
        let ids = self.read(|| frame.column(ID)?.str().cloned())?;
        let timeless = |r: Reaction| matches!(r, Reaction::After(time_s) if time_s.is_nan());
        for (index, (row, id)) in found.iter().zip(ids.iter()).enumerate() {
            let problem = if id != Some(row.id.to_string().as_str()) {
                Some((ID, "it differs from `stratum` and `j`"))
            } else if timeless(row.reaction) {
                Some(("reaction_s", "`after` needs its seconds"))
            } else if timeless(row.apparent) {
                Some(("apparent_s", "`after` needs its seconds"))
            } else {
                None
            };
            if let Some((column, problem)) = problem {
                return Err(self.cell_error(at + index, column, problem));
            }
        }
        Ok(())
    }

    fn read<T>(&self, read: impl FnOnce() -> Result<T, PolarsError>) -> Result<T, TableError> {
        read().map_err(|source| TableError::Read { path: self.path.clone(), source })
    }

    fn cell_error(&self, row: usize, column: &str, problem: &'static str) -> TableError {
        TableError::Cell {
            path: self.path.clone(),
            row: row as u64,
            column: column.to_owned(),
            problem,
        }
    }
}

/// A column by its name, while it is put into rows.
struct Named<'a> {
    table: &'a Table,
    frame: &'a DataFrame,
    at: usize,
    name: &'a str,
}

impl Named<'_> {
    fn put<T>(
        &self,
        rows: &mut [RunRow],
        values: impl Iterator<Item = Option<T>>,
        required: bool,
        set: impl Fn(&mut RunRow, T) -> bool,
    ) -> Result<(), TableError> {
        debug_assert_eq!(self.frame.height(), rows.len());
        for (index, (row, value)) in rows.iter_mut().zip(values).enumerate() {
            let problem = match value {
                None if required => Some("it is empty and must not be"),
                None => None,
                Some(value) => (!set(row, value)).then_some("the word is not known"),
            };
            if let Some(problem) = problem {
                return Err(self.table.cell_error(self.at + index, self.name, problem));
            }
        }
        Ok(())
    }
}

fn open(path: &Path) -> Result<File, TableError> {
    File::open(path).map_err(|source| TableError::Io {
        action: "open",
        path: path.to_owned(),
        source,
    })
}
