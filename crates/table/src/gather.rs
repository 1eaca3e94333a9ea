//! The cells of a row group, column by column, in buffers that are used again for the next one.
//!
//! A row is taken apart as it comes and is not kept: a group of whole rows lies in some hundred
//! thousand small pieces of memory, which the allocator cannot hand out again as the large ones
//! that the next group's columns need, and a campaign's memory would grow with its groups.

use crate::columns::{COLUMNS, Cells, ID, margin_name, status_name};
use polars::frame::DataFrame;
use polars::prelude::{Column as Series, PolarsError};
use record::{Check, RunRow};
use std::fmt::Write;

/// The columns of the rows so far, in the order of [`crate::column_names`].
#[derive(Default)]
pub(crate) struct Gathered {
    rows: usize,
    ids: Words,
    /// One for each of [`COLUMNS`].
    cells: Vec<Buffer>,
    /// One pair for each check.
    checks: Vec<(Words, Vec<Option<f64>>)>,
}

enum Buffer {
    Number(Vec<Option<f64>>),
    Count(Vec<Option<u64>>),
    Flag(Vec<Option<bool>>),
    Word(Words),
}

/// Words, one after the other in one text.
#[derive(Default)]
struct Words {
    text: String,
    /// Where each begins and ends; none where the row has none.
    places: Vec<Option<(usize, usize)>>,
}

impl Words {
    fn push(&mut self, word: Option<&str>) {
        let start = self.text.len();
        self.places.push(word.map(|word| {
            self.text.push_str(word);
            (start, self.text.len())
        }));
    }

    fn push_written(&mut self, what: &impl std::fmt::Display) {
        let start = self.text.len();
        write!(self.text, "{what}").expect("a String takes every write");
        self.places.push(Some((start, self.text.len())));
    }

    fn clear(&mut self) {
        self.text.clear();
        self.places.clear();
    }

    fn list(&self) -> Vec<Option<&str>> {
        self.places.iter().map(|place| place.map(|(from, to)| &self.text[from..to])).collect()
    }
}

impl Gathered {
    /// No rows yet.
    pub(crate) fn new() -> Self {
        let buffer = |cells: &Cells| match cells {
            Cells::Number(..) => Buffer::Number(Vec::new()),
            Cells::Count(..) => Buffer::Count(Vec::new()),
            Cells::Flag(..) => Buffer::Flag(Vec::new()),
            Cells::Word(..) => Buffer::Word(Words::default()),
        };
        Self {
            cells: COLUMNS.iter().map(|column| buffer(&column.cells)).collect(),
            checks: Check::ALL.iter().map(|_| Default::default()).collect(),
            ..Self::default()
        }
    }

    /// Rows so far.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// Adds a row.
    pub(crate) fn push(&mut self, row: &RunRow) {
        self.rows += 1;
        self.ids.push_written(&row.id);
        for (column, buffer) in COLUMNS.iter().zip(&mut self.cells) {
            match (&column.cells, buffer) {
                (Cells::Number(get, _), Buffer::Number(cells)) => cells.push(get(row)),
                (Cells::Count(get, _), Buffer::Count(cells)) => cells.push(get(row)),
                (Cells::Flag(get, _), Buffer::Flag(cells)) => cells.push(get(row)),
                (Cells::Word(get, _), Buffer::Word(words)) => words.push(get(row)),
                _ => unreachable!("a buffer is made after its column"),
            }
        }
        for (check, (statuses, margins)) in Check::ALL.into_iter().zip(&mut self.checks) {
            let cell = row.check(check);
            statuses.push(Some(cell.status.name()));
            margins.push(cell.margin);
        }
    }

    /// Forgets the rows and keeps the room.
    pub(crate) fn clear(&mut self) {
        self.rows = 0;
        self.ids.clear();
        for buffer in &mut self.cells {
            match buffer {
                Buffer::Number(cells) => cells.clear(),
                Buffer::Count(cells) => cells.clear(),
                Buffer::Flag(cells) => cells.clear(),
                Buffer::Word(words) => words.clear(),
            }
        }
        for (statuses, margins) in &mut self.checks {
            statuses.clear();
            margins.clear();
        }
    }

    /// The rows as a frame.
    pub(crate) fn frame(&self) -> Result<DataFrame, PolarsError> {
        let mut series = vec![Series::new(ID.into(), self.ids.list())];
        for (column, buffer) in COLUMNS.iter().zip(&self.cells) {
            let name = column.name.into();
            series.push(match buffer {
                Buffer::Number(cells) => Series::new(name, cells),
                Buffer::Count(cells) => Series::new(name, cells),
                Buffer::Flag(cells) => Series::new(name, cells),
                Buffer::Word(words) => Series::new(name, words.list()),
            });
        }
        for (check, (statuses, margins)) in Check::ALL.into_iter().zip(&self.checks) {
            series.push(Series::new(status_name(check).into(), statuses.list()));
            series.push(Series::new(margin_name(check).into(), margins));
        }
        DataFrame::new(self.rows, series)
    }
}
