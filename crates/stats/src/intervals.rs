//! Checks our exact binomial bounds against a file of independently computed ones.
//!
//! Format: CSV with the header `k,n,one_sided_alpha,lower,upper`; `lower` solves P(X >= k) = alpha
//! and `upper` solves P(X <= k) = alpha, given with as many digits as the source has. Empty lines
//! and lines that start with `#` are skipped. An expected 0 or 1 must be met exactly.

use thiserror::Error;

use crate::{StatsError, clopper_pearson_lower, clopper_pearson_upper};

/// The header that the file must have.
const HEADER: &str = "k,n,one_sided_alpha,lower,upper";

/// How far our bounds are from those of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct IntervalsReport {
    /// Rows compared; each has two bounds.
    pub rows: u64,
    /// The largest |ours - theirs| / theirs.
    pub relative_error_max: f64,
    /// Line of the file (from 1) with that error.
    pub line_worst: u64,
    /// The bound with that error: `"lower"` or `"upper"`.
    pub side_worst: &'static str,
}

/// What is wrong with a file of intervals.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum IntervalsError {
    /// The first line is not the header.
    #[error("read line {line}: the header must be `{HEADER}`, not `{found}`")]
    Header {
        /// Line number, from 1.
        line: u64,
        /// What stands there.
        found: String,
    },
    /// There is a header, or not even that, and no row.
    #[error("find a row: the file has none after its header `{HEADER}`")]
    Empty,
    /// A row has too few or too many fields.
    #[error("read line {line}: {found} fields where five belong (`{HEADER}`)")]
    Fields {
        /// Line number, from 1.
        line: u64,
        /// Fields found.
        found: usize,
    },
    /// A field is not a number of its kind.
    #[error("read line {line}: {column} = `{text}` is not {kind}")]
    Number {
        /// Line number, from 1.
        line: u64,
        /// Column name.
        column: &'static str,
        /// What stands there.
        text: String,
        /// What belongs there.
        kind: &'static str,
    },
    /// The row asks for a bound that does not exist.
    #[error("check line {line}: failed to {source}")]
    Question {
        /// Line number, from 1.
        line: u64,
        /// Why there is no bound.
        source: StatsError,
    },
}

/// Compares every row of `csv` with [`clopper_pearson_lower`] and [`clopper_pearson_upper`].
///
/// # Errors
/// The first thing that is wrong with the file, with its line.
pub fn check_intervals(csv: &str) -> Result<IntervalsReport, IntervalsError> {
    let mut report =
        IntervalsReport { rows: 0, relative_error_max: 0.0, line_worst: 0, side_worst: "lower" };
    let mut header_seen = false;
    for (line, text) in (1..).zip(csv.lines()).map(|(line, text)| (line, text.trim())) {
        if text.is_empty() || text.starts_with('#') {
            continue;
        }
        if !header_seen {
            if text != HEADER {
                return Err(IntervalsError::Header { line, found: text.to_owned() });
            }
            header_seen = true;
            continue;
        }
        let row = parse_row(line, text)?;
        let question = |source| IntervalsError::Question { line, source };
        let lower = clopper_pearson_lower(row.k, row.n, row.alpha).map_err(question)?;
        let upper = clopper_pearson_upper(row.k, row.n, row.alpha).map_err(question)?;
        report.rows += 1;
        for (side, ours, theirs) in [("lower", lower, row.lower), ("upper", upper, row.upper)] {
            let error = relative_error(ours, theirs);
            if error > report.relative_error_max || report.line_worst == 0 {
                report.relative_error_max = error;
                report.line_worst = line;
                report.side_worst = side;
            }
        }
    }
    if report.rows == 0 { Err(IntervalsError::Empty) } else { Ok(report) }
}

struct Row {
    k: u64,
    n: u64,
    alpha: f64,
    lower: f64,
    upper: f64,
}

fn parse_row(line: u64, text: &str) -> Result<Row, IntervalsError> {
    let fields: Vec<&str> = text.split(',').map(str::trim).collect();
    let &[k, n, alpha, lower, upper] = fields.as_slice() else {
        return Err(IntervalsError::Fields { line, found: fields.len() });
    };
    let wrong = |column, text: &str, kind| IntervalsError::Number {
        line,
        column,
        text: text.to_owned(),
        kind,
    };
    let count =
        |column, text: &str| text.parse::<u64>().map_err(|_| wrong(column, text, "a whole number"));
    let probability = |column, text: &str| {
        let kind = "a number between 0 and 1";
        match text.parse::<f64>() {
            Ok(value) if (0.0..=1.0).contains(&value) => Ok(value),
            Ok(_) | Err(_) => Err(wrong(column, text, kind)),
        }
    };
    Ok(Row {
        k: count("k", k)?,
        n: count("n", n)?,
        alpha: probability("one_sided_alpha", alpha)?,
        lower: probability("lower", lower)?,
        upper: probability("upper", upper)?,
    })
}

fn relative_error(ours: f64, theirs: f64) -> f64 {
    let difference = (ours - theirs).abs();
    if difference > 0.0 { difference / theirs } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REFERENCE: &str = include_str!("../tests/data/clopper_pearson.csv");

    #[test]
    fn bounds_agree_with_forty_digit_values() {
        let report = check_intervals(REFERENCE).unwrap();
        assert_eq!(report.rows, 78);
        assert!(report.relative_error_max < 1e-10, "{report:?}");
        // What this implementation reaches; a loss of digits should be seen long before 1e-10.
        assert!(report.relative_error_max < 2e-14, "{report:?}");
    }

    #[test]
    fn a_wrong_digit_is_found_with_its_line() {
        let spoiled = REFERENCE
            .replace("0.0100621713458448898", "0")
            .replace("0.000100621713458448898", "0.000100621713558448898");
        let report = check_intervals(&spoiled).unwrap();
        assert!((report.relative_error_max - 1e-9).abs() < 2e-11, "{report:?}");
        assert_eq!(report.side_worst, "upper");
        let line = spoiled.lines().nth(report.line_worst as usize - 1).unwrap();
        assert!(line.starts_with("100000,1000000000,0.025,"));
    }

    #[test]
    fn bad_files_are_refused_with_the_line() {
        let rows = |text: &str| check_intervals(&format!("{HEADER}\n{text}"));
        assert_eq!(check_intervals(""), Err(IntervalsError::Empty));
        assert_eq!(rows(""), Err(IntervalsError::Empty));
        assert!(matches!(check_intervals("k,n\n"), Err(IntervalsError::Header { line: 1, .. })));
        assert_eq!(rows("1,2,3"), Err(IntervalsError::Fields { line: 2, found: 3 }));
        let message = rows("\n1,10,0.05,zero,1").unwrap_err().to_string();
        assert!(message.contains("line 3: lower = `zero`"), "{message}");
        assert!(matches!(rows("-1,10,0.05,0,1"), Err(IntervalsError::Number { .. })));
        assert!(matches!(rows("3,2,0.05,0,1"), Err(IntervalsError::Question { line: 2, .. })));
        assert!(matches!(rows("1,2,0,0,1"), Err(IntervalsError::Question { line: 2, .. })));
        assert!(matches!(rows("1,2,NaN,0,1"), Err(IntervalsError::Number { .. })));
    }

    #[test]
    fn an_expected_zero_must_be_met_exactly() {
        let report = check_intervals(&format!("{HEADER}\n1,10,0.025,0,0.445")).unwrap();
        assert!(report.relative_error_max.is_infinite());
    }
}
