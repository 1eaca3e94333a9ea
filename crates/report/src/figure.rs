//! A figure: a picture, what it shows, and the numbers behind it.

use serde::Serialize;

/// A figure of a report. It is written as `figures/<stem>.svg`.
#[derive(Clone, Debug, Serialize)]
pub struct Figure {
    /// Name of the file without its ending.
    pub stem: String,
    /// Heading.
    pub title: String,
    /// What is drawn, and of how many runs.
    pub caption: String,
    /// The picture, a whole SVG document; absent where there are no data.
    pub svg: Option<String>,
    /// The numbers behind it.
    pub table: DataTable,
}

/// The numbers behind a figure, as text.
#[derive(Clone, Debug, Default, Serialize)]
pub struct DataTable {
    /// Heads of the columns.
    pub head: Vec<String>,
    /// Rows, each as long as the head.
    pub rows: Vec<Vec<String>>,
}

impl DataTable {
    pub(crate) fn new(head: &[&str]) -> Self {
        Self { head: head.iter().map(|&name| name.to_owned()).collect(), rows: Vec::new() }
    }

    pub(crate) fn push(&mut self, row: Vec<String>) {
        debug_assert_eq!(row.len(), self.head.len());
        self.rows.push(row);
    }
}
