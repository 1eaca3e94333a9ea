//! Rows of an AIS file: what they say, and why the others are not used.
//!
//! 511 as heading, 360 as course, 102.3 as speed, an empty field and `Unknown` mean "not available"
//! (ITU-R M.1371). A row without a position, a speed or a time says nothing; one without a course
//! or a heading is used.

use crate::columns::{Columns, ColumnsError};
use crate::time;
use geom::units::{deg, knots};
use std::collections::BTreeMap;

/// One report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Who.
    pub mmsi: u64,
    /// When, seconds since 1970.
    pub t_s: f64,
    /// Latitude, degrees.
    pub lat_deg: f64,
    /// Longitude, degrees.
    pub lon_deg: f64,
    /// Speed over ground, m/s.
    pub sog_mps: f64,
    /// Course over ground, radians; absent where it is not available.
    pub cog_rad: Option<f64>,
    /// Length, metres; absent where it is not available.
    pub length_m: Option<f64>,
    /// Beam, metres; absent where it is not available.
    pub width_m: Option<f64>,
    /// Line of the file, from 1.
    pub line: u64,
}

/// How often something happened, and the line of the file where it happened first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counted {
    /// How often.
    pub count: u64,
    /// First line, from 1.
    pub first_line: u64,
}

/// Reasons, in the order of the alphabet.
pub type Reasons = BTreeMap<&'static str, Counted>;

/// What a file says.
#[derive(Clone, Debug)]
pub struct Rows {
    /// Its columns.
    pub columns: Columns,
    /// Lines so far, the head and empty ones among them.
    pub lines: u64,
    /// Rows, the head left out.
    pub rows: u64,
    /// Those that can be used, in their order.
    pub reports: Vec<Report>,
    /// Why the others cannot.
    pub rejected: Reasons,
    /// Reports without a course.
    pub without_course: u64,
    /// Reports without a heading, where the file has one at all.
    pub without_heading: u64,
}

/// Largest speed that an AIS report can say, knots; 102.3 is "not available".
const SOG_KN_END: f64 = 102.25;

/// Reads a file that is in memory.
///
/// # Errors
/// A column that every AIS file has is missing.
pub fn read(text: &str) -> Result<Rows, ColumnsError> {
    let mut lines = text.lines();
    let mut rows = Rows::under(lines.next().unwrap_or_default())?;
    lines.for_each(|line| rows.take(line));
    Ok(rows)
}

impl Rows {
    /// No rows yet, under a head.
    ///
    /// # Errors
    /// A column that every AIS file has is missing.
    pub fn under(head: &str) -> Result<Self, ColumnsError> {
        Ok(Self {
            columns: Columns::of(head)?,
            lines: 1,
            rows: 0,
            reports: Vec::new(),
            rejected: Reasons::new(),
            without_course: 0,
            without_heading: 0,
        })
    }

    /// The next line of the file.
    pub fn take(&mut self, line: &str) {
        self.lines += 1;
        if line.trim().is_empty() {
            return;
        }
        self.rows += 1;
        match report(line, self.lines, &self.columns) {
            Ok((report, heading_deg)) => {
                self.without_course += u64::from(report.cog_rad.is_none());
                let lacks = self.columns.heading.is_some() && heading_deg.is_none();
                self.without_heading += u64::from(lacks);
                self.reports.push(report);
            }
            Err(reason) => count(&mut self.rejected, reason, self.lines),
        }
    }
}

pub(crate) fn count(reasons: &mut Reasons, reason: &'static str, line: u64) {
    let entry = reasons.entry(reason).or_insert(Counted { count: 0, first_line: line });
    entry.count += 1;
}

/// The report and the heading of a row, or why it is not used.
fn report(row: &str, line: u64, columns: &Columns) -> Result<(Report, Option<f64>), &'static str> {
    let fields = fields(row);
    if fields.len() < columns.count {
        return Err("fewer fields than columns");
    }
    let number = |at: usize| -> Option<f64> { value(fields[at]).filter(|v| v.is_finite()) };
    if let Some(kind) = columns.kind {
        let kind = fields[kind].trim();
        if !matches!(kind, "Class A" | "Class B") {
            return Err("sent by no ship");
        }
    }
    let t_s = time::seconds(fields[columns.time], columns.order).ok_or("no time")?;
    let mmsi = fields[columns.mmsi].trim().parse::<u64>().ok().filter(|&mmsi| mmsi > 0);
    let mmsi = mmsi.ok_or("no identity")?;
    if !is_ship(mmsi) {
        return Err("sent by no ship");
    }
    let lat_deg = number(columns.latitude).ok_or("no position")?;
    let lon_deg = number(columns.longitude).ok_or("no position")?;
    // 91 and 181 are "not available"
    if lat_deg.abs() > 90.0 || lon_deg.abs() > 180.0 {
        return Err("no position");
    }
    let sog_kn =
        number(columns.sog).filter(|kn| (0.0..SOG_KN_END).contains(kn)).ok_or("no speed")?;
    let cog = number(columns.cog).filter(|cog| (0.0..360.0).contains(cog));
    // 511 is "not available"
    let heading = columns.heading.and_then(number).filter(|deg| (0.0..360.0).contains(deg));
    let metres = |at: Option<usize>| at.and_then(number).filter(|&m| m > 0.0);
    let report = Report {
        mmsi,
        t_s,
        lat_deg,
        lon_deg,
        sog_mps: knots(sog_kn),
        cog_rad: cog.map(deg),
        length_m: metres(columns.length),
        width_m: metres(columns.width),
        line,
    };
    Ok((report, heading))
}

/// Whether an identity is a ship's (ITU-R M.585): nine digits, and neither a coast station (00), a
/// group (0), an aircraft (111), a rescue transmitter (970, 972, 974) nor a mark (99).
fn is_ship(mmsi: u64) -> bool {
    (100_000_000..1_000_000_000).contains(&mmsi)
        && !matches!(mmsi / 1_000_000, 111 | 970 | 972 | 974 | 990..=999)
}

fn value(field: &str) -> Option<f64> {
    let field = field.trim();
    if field.is_empty() || field == "Unknown" { None } else { field.parse().ok() }
}

/// The fields of a line without the quotes around them; a quoted one may hold commas.
fn fields(line: &str) -> Vec<&str> {
    let mut quoted = false;
    line.trim_end_matches(['\r', '\n'])
        .split(|c| {
            quoted ^= c == '"';
            c == ',' && !quoted
        })
        .map(|field| field.trim_matches('"'))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "MMSI,BaseDateTime,LAT,LON,SOG,COG,Heading,VesselName,Length\n";

    fn rows(lines: &str) -> Rows {
        read(&format!("{HEAD}{lines}")).unwrap()
    }

    #[test]
    fn what_is_not_available_is_not_used() {
        let rows = rows(
            "211000001,2023-01-01T00:00:00,50.0,1.0,10.0,360.0,511,\"A, B\",\n\
             211000001,2023-01-01T00:00:10,50.0,1.0,10.0,45.0,511,AB,120\n",
        );
        assert_eq!((rows.rows, rows.reports.len(), rows.without_course), (2, 2, 1));
        assert_eq!(rows.reports[0].length_m, None);
        assert!((rows.reports[1].length_m.unwrap() - 120.0).abs() < 1e-12);
        assert!((rows.reports[1].sog_mps - 5.144_444_444).abs() < 1e-6);
        assert!((rows.reports[1].cog_rad.unwrap() - deg(45.0)).abs() < 1e-12);
    }

    #[test]
    fn rejected_rows_are_counted_by_reason_with_the_first_line() {
        let rows = rows(
            "211000001,2023-01-01T00:00:00,50.0,1.0,102.3,45.0,0,A,1\n\
             211000001,2023-01-01T00:00:00,91.0,181.0,9.0,45.0,0,A,1\n\
             211000001,Unknown,50.0,1.0,9.0,45.0,0,A,1\n\
             x,2023-01-01T00:00:00,50.0,1.0,9.0,45.0,0,A,1\n\
             211000001,2023-01-01T00:00:00,50.0,1.0\n\
             211000001,2023-01-01T00:00:00,50.0,1.0,,45.0,0,A,1\n",
        );
        assert_eq!(rows.reports.len(), 0);
        let said: Vec<_> = rows.rejected.iter().map(|(r, c)| (*r, c.count, c.first_line)).collect();
        assert_eq!(
            said,
            [
                ("fewer fields than columns", 1, 6),
                ("no identity", 1, 5),
                ("no position", 1, 3),
                ("no speed", 2, 2),
                ("no time", 1, 4),
            ]
        );
    }

    /// Identities of a ship, a handheld set, a coast station, a mark, a lifeboat's transmitter, a
    /// rescue aircraft, and one with a digit too few.
    #[test]
    fn identities_say_what_is_a_ship() {
        let ships = [219_000_123, 812_345_678, 100_000_001];
        assert!(ships.into_iter().all(is_ship));
        let others = [2_190_045, 992_191_234, 970_123_456, 111_219_501, 21_900_012];
        assert!(!others.into_iter().any(is_ship));
    }

    #[test]
    fn danish_marks_and_base_stations_are_no_ships() {
        let head = "# Timestamp,Type of mobile,MMSI,Latitude,Longitude,SOG,COG\n";
        let lines = "01/03/2024 00:00:00,Base Station,2190045,57.0,11.0,0.0,0.0\n\
                     01/03/2024 00:00:00,Class A,219000000,57.0,11.0,7.5,12.5\n";
        let rows = read(&format!("{head}{lines}")).unwrap();
        assert_eq!((rows.reports.len(), rows.rejected["sent by no ship"].count), (1, 1));
    }
}
