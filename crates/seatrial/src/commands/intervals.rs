//! `intervals`: the exact binomial bounds against a file of known answers.

use crate::exit::Ended;
use crate::say::say;
use campaign::Error;
use std::fs;
use std::path::Path;

/// What the bounds promise.
const RELATIVE_ERROR_MAX: f64 = 1e-10;

pub(super) fn run(file: &Path) -> Result<Ended, Error> {
    let text = fs::read_to_string(file)
        .map_err(|e| Error::input(format!("cannot read {}: {e}", file.display())))?;
    let report = stats::check_intervals(&text)
        .map_err(|e| Error::input(format!("{}: {e}", file.display())))?;
    let passes = report.relative_error_max <= RELATIVE_ERROR_MAX;
    say!(
        "{} rows; largest relative error {:.2e} ({} bound, line {}), {} {RELATIVE_ERROR_MAX:e}",
        report.rows,
        report.relative_error_max,
        report.side_worst,
        report.line_worst,
        if passes { "within" } else { "NOT within" },
    );
    Ok(if passes { Ended::Done } else { Ended::Failed })
}
