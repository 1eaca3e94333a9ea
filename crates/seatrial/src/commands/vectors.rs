//! `vectors`: the seed planner's equations against a file of known answers.

use crate::exit::Ended;
use crate::say::say;
use campaign::Error;
use std::fs;
use std::path::Path;

pub(super) fn run(file: &Path) -> Result<Ended, Error> {
    let text = fs::read_to_string(file)
        .map_err(|e| Error::input(format!("cannot read {}: {e}", file.display())))?;
    let report = planners::check_vectors(&text)
        .map_err(|e| Error::input(format!("{}: {e}", file.display())))?;
    say!("{:32} {:>6} {:>10}  worst row", "column", "cells", "error");
    for column in &report.columns {
        let (name, cells) = (&column.name, column.cells);
        say!("{name:32} {cells:>6} {:>10.2e}  {}", column.error_max, column.worst_row);
    }
    let passes = report.passes();
    say!("{} rows, {}", report.rows, if passes { "all within 1e-9" } else { "NOT within 1e-9" });
    Ok(if passes { Ended::Done } else { Ended::Failed })
}
