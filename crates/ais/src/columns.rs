//! Which column is which, by name.
//!
//! Known are the six columns of the Solent file of Stone-Soup, the Danish form (22 or 26 columns,
//! day/month/year) and both forms of the United States (to 2023 and since 2024). Names are compared
//! without case, spaces, underscores and units.

use crate::time::Order;

/// Where the columns stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Columns {
    /// How many there are.
    pub count: usize,
    /// Time of the report.
    pub time: usize,
    /// In which order a date is written.
    pub order: Order,
    /// Identity.
    pub mmsi: usize,
    /// Latitude, degrees.
    pub latitude: usize,
    /// Longitude, degrees.
    pub longitude: usize,
    /// Speed over ground, knots.
    pub sog: usize,
    /// Course over ground, degrees.
    pub cog: usize,
    /// Heading, degrees.
    pub heading: Option<usize>,
    /// Length, metres.
    pub length: Option<usize>,
    /// Beam, metres.
    pub width: Option<usize>,
    /// What sends: class A or B, a base station, a mark.
    pub kind: Option<usize>,
}

/// A head that is not understood.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ColumnsError {
    /// No line at all.
    #[error("the file is empty; the first line names the columns")]
    Empty,
    /// A column that every AIS file has.
    #[error("line 1 has no column for {what} ({names}); it has {there}")]
    Missing {
        /// Which.
        what: &'static str,
        /// What it may be called.
        names: String,
        /// What there is.
        there: String,
    },
}

const TIME: &[&str] = &["time", "timestamp", "basedatetime"];
const MMSI: &[&str] = &["mmsi"];
const LATITUDE: &[&str] = &["latitude", "lat"];
const LONGITUDE: &[&str] = &["longitude", "lon"];
const SOG: &[&str] = &["sog"];
const COG: &[&str] = &["cog"];
const HEADING: &[&str] = &["heading"];
const LENGTH: &[&str] = &["length"];
const WIDTH: &[&str] = &["width"];
const KIND: &[&str] = &["typeofmobile"];

impl Columns {
    /// Reads the head line.
    ///
    /// # Errors
    /// A column that every AIS file has is missing.
    pub fn of(head: &str) -> Result<Self, ColumnsError> {
        let head = head.trim_start_matches('\u{feff}').trim_end();
        if head.is_empty() {
            return Err(ColumnsError::Empty);
        }
        let names: Vec<String> = head.split(',').map(plain).collect();
        let find = |wanted: &[&str]| names.iter().position(|name| wanted.contains(&name.as_str()));
        let need = |what: &'static str, wanted: &[&str]| {
            find(wanted).ok_or_else(|| ColumnsError::Missing {
                what,
                names: wanted.join(" or "),
                there: shown(head),
            })
        };
        let kind = find(KIND);
        Ok(Self {
            count: names.len(),
            time: need("the time", TIME)?,
            // the Danish form alone says what sends, and writes the day first
            order: if kind.is_some() { Order::DayFirst } else { Order::YearFirst },
            mmsi: need("the identity", MMSI)?,
            latitude: need("the latitude", LATITUDE)?,
            longitude: need("the longitude", LONGITUDE)?,
            sog: need("the speed", SOG)?,
            cog: need("the course", COG)?,
            heading: find(HEADING),
            length: find(LENGTH),
            width: find(WIDTH),
            kind,
        })
    }
}

/// The beginning of a head: a file that holds no reports may have anything there.
fn shown(head: &str) -> String {
    const CHARS_MAX: usize = 300;
    let plain = |c: char| if c.is_control() { '?' } else { c };
    let shown: String = head.chars().take(CHARS_MAX).map(plain).collect();
    if head.chars().nth(CHARS_MAX).is_some() { format!("{shown} ...") } else { shown }
}

/// A name without case, spaces, underscores and units.
fn plain(name: &str) -> String {
    let name: String =
        name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect();
    let bare = name.trim_end_matches("degrees").trim_end_matches("knots");
    bare.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_is_known() {
        let solent = "Time,MMSI,Latitude_degrees,Longitude_degrees,COG_degrees,SOG_knots";
        let columns = Columns::of(solent).unwrap();
        assert_eq!((columns.latitude, columns.cog, columns.sog), (2, 4, 5));
        assert_eq!((columns.length, columns.order), (None, Order::YearFirst));
        let short = "# Timestamp,Type of mobile,MMSI,Latitude,Longitude,Navigational status,ROT,\
                     SOG,COG,Heading,IMO,Callsign,Name,Ship type,Cargo type,Width,Length,Type of \
                     position fixing device,Draught,Destination,ETA,Data source type";
        for (danish, count) in [(short.to_owned(), 22), (format!("{short},A,B,C,D"), 26)] {
            let columns = Columns::of(&danish).unwrap();
            assert_eq!(columns.count, count);
            assert_eq!((columns.time, columns.kind, columns.mmsi), (0, Some(1), 2));
            assert_eq!((columns.sog, columns.cog, columns.heading), (7, 8, Some(9)));
            assert_eq!((columns.width, columns.length), (Some(15), Some(16)));
            assert_eq!(columns.order, Order::DayFirst);
        }
        for (american, latitude) in [
            (
                "MMSI,BaseDateTime,LAT,LON,SOG,COG,Heading,VesselName,IMO,CallSign,VesselType,\
                 Status,Length,Width,Draft,Cargo,TransceiverClass",
                2,
            ),
            (
                "mmsi,base_date_time,longitude,latitude,sog,cog,heading,vessel_name,imo,call_sign,\
                 vessel_type,status,length,width,draft,cargo,transceiver",
                3,
            ),
        ] {
            let columns = Columns::of(american).unwrap();
            assert_eq!((columns.time, columns.mmsi, columns.latitude), (1, 0, latitude));
            assert_eq!((columns.length, columns.width), (Some(12), Some(13)), "{american}");
            assert_eq!((columns.heading, columns.order), (Some(6), Order::YearFirst));
        }
    }

    #[test]
    fn a_missing_column_is_named_with_what_is_there() {
        let error = Columns::of("Time,MMSI,Lat,Lon,SOG").unwrap_err().to_string();
        assert_eq!(
            error,
            "line 1 has no column for the course (cog); it has Time,MMSI,Lat,Lon,SOG"
        );
        assert_eq!(Columns::of("").unwrap_err(), ColumnsError::Empty);
        let picture = Columns::of(&"\u{1b}[2J\0".repeat(1000)).unwrap_err().to_string();
        assert!(picture.len() < 400 && picture.ends_with("?[2J? ..."), "{picture}");
    }
}
