//! Rows as comma-separated text (RFC 4180), with the columns of the table.

use crate::columns::{COLUMNS, Cells, column_names};
use record::{Check, RunRow};
use std::fmt::Write;

/// The names of the columns, with the end of the line.
pub fn csv_head() -> String {
    column_names().join(",") + "\r\n"
}

/// One row, with the end of the line. Numbers have as many digits as bring the same bits back; a
/// digest is a whole number, as in the table; an empty cell is a value that there is not.
pub fn csv_line(row: &RunRow) -> String {
    let mut line = quoted(&row.id.to_string());
    for column in COLUMNS {
        line.push(',');
        let cell = match column.cells {
            Cells::Number(get, _) => get(row).map(|value| value.to_string()),
            Cells::Count(get, _) => get(row).map(|value| value.to_string()),
            Cells::Flag(get, _) => get(row).map(|value| value.to_string()),
            Cells::Word(get, _) => get(row).map(quoted),
        };
        line.push_str(&cell.unwrap_or_default());
    }
    for check in Check::ALL {
        let cell = row.check(check);
        let margin = cell.margin.map_or_else(String::new, |margin| margin.to_string());
        write!(line, ",{},{margin}", cell.status.name()).expect("a String takes every write");
    }
    line + "\r\n"
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\r', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::blank_row;
    use record::EncounterId;

    #[test]
    fn a_line_has_as_many_cells_as_the_head() {
        let mut row = blank_row();
        row.id = EncounterId::new("head_on", 7);
        row.cpa_hull_m = Some(0.1 + 0.2);
        let line = csv_line(&row);
        assert_eq!(line.matches(',').count(), csv_head().matches(',').count());
        assert!(line.starts_with("head_on/000007,head_on,7,invalid,"));
        assert!(line.contains(",0.30000000000000004,"));
    }

    #[test]
    fn names_with_commas_and_quotes_are_quoted() {
        let mut row = blank_row();
        row.id = EncounterId::new("HO, \"close\"", 0);
        assert!(
            csv_line(&row).starts_with("\"HO, \"\"close\"\"/000000\",\"HO, \"\"close\"\"\",0,")
        );
    }
}
