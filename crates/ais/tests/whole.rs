//! A small file of our own from rows to laws: two forms of the same traffic give the same model.

use ais::document::{ABSENT, TOO_FEW, model, report};
use ais::model_file::{Source, campaign};
use ais::replay::replay;
use record::Seed;
use std::fmt::Write as _;

/// Crossings: ship `2k` goes north, ship `2k + 1` west, so that they come within 400 m of each
/// other 600 s after the start of their hour. A report every ten seconds, twenty minutes long.
fn traffic(line: impl Fn(u64, u64, f64, f64, f64, f64) -> String) -> String {
    let mut text = String::new();
    for k in 0..12u64 {
        let (north_mps, west_mps) = (4.0 + 0.2 * k as f64, 5.0 + 0.1 * k as f64);
        for step in 0..=120u64 {
            let t_s = 3600 * k + 10 * step;
            let left_s = 600.0 - 10.0 * step as f64;
            // 111,132 m and 63,994 m are close to a degree of latitude and longitude at 55 degrees
            let north_deg = 55.0 - north_mps * left_s / 111_320.0;
            let west_deg = 11.0 + (west_mps * left_s + 25.0 * k as f64) / 63_994.0;
            text += &line(211_000_100 + 2 * k, t_s, north_deg, 11.0, north_mps, 0.0);
            text += &line(211_000_101 + 2 * k, t_s, 55.0, west_deg, west_mps, 270.0);
        }
    }
    text
}

fn clock(t_s: u64) -> String {
    format!("{:02}:{:02}:{:02}", t_s / 3600, t_s / 60 % 60, t_s % 60)
}

fn american() -> String {
    let rows = traffic(|mmsi, t_s, lat, lon, mps, cog| {
        let kn = mps / 0.514_444_444;
        let length = 20 + mmsi % 30;
        format!("{mmsi},2023-05-01T{},{lat:.7},{lon:.7},{kn:.4},{cog},511,A,{length}\n", clock(t_s))
    });
    format!("MMSI,BaseDateTime,LAT,LON,SOG,COG,Heading,VesselName,Length\n{rows}")
}

fn danish() -> String {
    let rows = traffic(|mmsi, t_s, lat, lon, mps, cog| {
        let (kn, clock) = (mps / 0.514_444_444, clock(t_s));
        format!("01/05/2023 {clock},Class A,{mmsi},{lat:.7},{lon:.7},Under way,,{kn:.4},{cog},\n")
    });
    let head = "# Timestamp,Type of mobile,MMSI,Latitude,Longitude,Navigational status,ROT,SOG,COG,\
                Heading\n";
    format!("{head}{rows}01/05/2023 00:00:00,Base Station,2190045,55.0,11.0,,,,,\n")
}

const TEMPLATE: &str = include_str!("../../../campaigns/open-sea.toml");

fn source(name: &str) -> Source {
    Source {
        name: name.to_owned(),
        blake3: "00".to_owned(),
        tool: "seatrial test".to_owned(),
        seed: 1,
        template: "open-sea".to_owned(),
    }
}

#[test]
fn a_file_becomes_a_model() {
    let rows = ais::read(&american()).unwrap();
    let mut reasons = rows.rejected.clone();
    let tracks = ais::tracks(&rows.reports, &mut reasons);
    let found = ais::meetings(&tracks);
    assert_eq!((tracks.len(), found.meetings.len()), (24, 12));
    assert!(reasons.is_empty() && found.left_out.is_empty(), "{reasons:?} {found:?}");
    let model = model(&tracks, &found, Seed(1));
    assert_eq!((model.speed.sample.len(), model.length.sample.len()), (24, 24));
    let fastest = model.speed.sample.iter().copied().fold(0.0, f64::max);
    assert!((fastest - 6.2).abs() < 0.05, "{fastest}");
    for meeting in &found.meetings {
        assert!((meeting.relative_course_rad() + 90f64.to_radians()).abs() < 0.01);
    }
    let written = report("own.csv", &rows, &tracks, &found, &model);
    assert!(written.contains(TOO_FEW), "{written}");
    let campaign = campaign(TEMPLATE, &source("own.csv"), &model).unwrap();
    for key in ["speed_mps = {", "relative_course_deg = { empirical", "miss_m = {", "tcpa_s = ["] {
        assert!(campaign.lines().any(|line| line.starts_with(key)), "{key}: {campaign}");
    }
    assert_eq!(campaign.matches("[[model.stratum]]").count(), 1);
    assert!(campaign.contains(TOO_FEW));
    let wrong = ais::model_file::campaign("name = 1\n", &source("x"), &model).unwrap_err();
    assert_eq!(wrong, "`.title` is not in it");
}

#[test]
fn the_danish_form_gives_the_same_encounters_and_says_what_it_lacks() {
    let [a, b] = [american(), danish()].map(|text| {
        let rows = ais::read(&text).unwrap();
        let tracks = ais::tracks(&rows.reports, &mut rows.rejected.clone());
        let found = ais::meetings(&tracks);
        (rows, tracks, found)
    });
    assert_eq!(b.0.rejected["sent by no ship"].count, 1);
    assert_eq!(a.2.meetings.len(), b.2.meetings.len());
    for (x, y) in a.2.meetings.iter().zip(&b.2.meetings) {
        assert!((x.cpa_m - y.cpa_m).abs() < 1e-3 && (x.miss_m() - y.miss_m()).abs() < 1e-3);
    }
    let model = model(&b.1, &b.2, Seed(1));
    assert!(model.length.fitted.is_none());
    let written = report("danish.csv", &b.0, &b.1, &b.2, &model);
    assert!(written.contains(&format!("| length, m | 0 | {ABSENT}")), "{written}");
    let campaign = campaign(TEMPLATE, &source("danish.csv"), &model).unwrap();
    assert!(campaign.contains("length_m = { uniform = [8.0, 120.0] }\n"), "{campaign}");
    assert!(campaign.contains(&format!("# length, m: {ABSENT}")), "{campaign}");
}

/// Each encounter twice, once in each role, from the origin.
#[test]
fn every_encounter_can_be_replayed_in_both_roles() {
    let rows = ais::read(&american()).unwrap();
    let tracks = ais::tracks(&rows.reports, &mut rows.rejected.clone());
    let found = ais::meetings(&tracks);
    let text = replay(TEMPLATE, &source("own.csv"), &tracks, &found.meetings[..1]);
    let text = text.unwrap().unwrap();
    assert_eq!(text.matches("[[situation]]").count(), 2);
    let mut names = String::new();
    for role in 0..2 {
        writeln!(names, "name = \"pair_0000_{role}\"").unwrap();
    }
    assert!(names.lines().all(|name| text.contains(name)), "{text}");
    assert!(text.contains("own = { north_m = 0.00, east_m = 0.00, course_deg = 0.0"), "{text}");
    assert!(text.contains("course_deg = 269.9"), "a parallel bends to the pole: {text}");
}

const FORMS: [&str; 5] = [
    "United States to 2023",
    "United States since 2024",
    "Danish, 22 columns",
    "Danish, 26 columns",
    "Stone-Soup",
];

/// The first line of each known form.
fn head(form: &str) -> String {
    let short = "# Timestamp,Type of mobile,MMSI,Latitude,Longitude,Navigational status,ROT,SOG,\
                 COG,Heading,IMO,Callsign,Name,Ship type,Cargo type,Width,Length,Type of position \
                 fixing device,Draught,Destination,ETA,Data source type";
    match form {
        "Danish, 22 columns" => short.to_owned(),
        "Danish, 26 columns" => format!("{short},A,B,C,D"),
        "United States to 2023" => "MMSI,BaseDateTime,LAT,LON,SOG,COG,Heading,VesselName,IMO,\
                                    CallSign,VesselType,Status,Length,Width,Draft,Cargo,\
                                    TransceiverClass"
            .to_owned(),
        "United States since 2024" => "mmsi,base_date_time,longitude,latitude,sog,cog,heading,\
                                       vessel_name,imo,call_sign,vessel_type,status,length,width,\
                                       draft,cargo,transceiver"
            .to_owned(),
        _ => "Time,MMSI,Latitude_degrees,Longitude_degrees,COG_degrees,SOG_knots".to_owned(),
    }
}

/// The traffic in a form, with every column as its publisher writes it.
fn in_form(form: &str) -> String {
    let rows = traffic(|mmsi, t_s, lat, lon, mps, cog| {
        let (kn, clock, length) = (mps / 0.514_444_444, clock(t_s), 20 + mmsi % 30);
        match form {
            "Danish, 22 columns" | "Danish, 26 columns" => {
                let ends = if form.contains("26") { ",10,10,3,3" } else { "" };
                format!(
                    "01/05/2023 {clock},Class A,{mmsi},{lat:.7},{lon:.7},Under way using engine,,\
                     {kn:.4},{cog},511,Unknown,Unknown,\"A, B\",Cargo,,6,{length},GPS,,,,AIS\
                     {ends}\n"
                )
            }
            "United States to 2023" => format!(
                "{mmsi},2023-05-01T{clock},{lat:.7},{lon:.7},{kn:.4},{cog},511.0,\"A, B\",,,70,0,\
                 {length},6,,,A\n"
            ),
            "United States since 2024" => format!(
                "{mmsi},2023-05-01 {clock},{lon:.7},{lat:.7},{kn:.4},{cog},511,\"A, B\",,,70,0,\
                 {length},6,,,A\n"
            ),
            _ => format!("2023-05-01 {clock},{mmsi},{lat:.7},{lon:.7},{cog},{kn:.4}\n"),
        }
    });
    format!("{}\n{rows}", head(form))
}

/// Five forms of the same traffic, each in full: the same ships, encounters and laws; the form
/// without lengths says so and differs in nothing else.
#[test]
fn every_form_in_full_gives_the_same_model() {
    let read = |form: &str| {
        let rows = ais::read(&in_form(form)).unwrap();
        let mut reasons = rows.rejected.clone();
        let tracks = ais::tracks(&rows.reports, &mut reasons);
        assert!(reasons.is_empty(), "{form}: {reasons:?}");
        let found = ais::meetings(&tracks);
        let model = model(&tracks, &found, Seed(1));
        (rows.reports.len(), found.meetings, model)
    };
    let (reports, meetings, first) = read(FORMS[0]);
    assert_eq!((reports, meetings.len(), first.length.sample.len()), (12 * 242, 12, 24));
    for &form in &FORMS[1..] {
        let (again, met, model) = read(form);
        assert_eq!((again, &met), (reports, &meetings), "{form}");
        assert_eq!(model.speed.sample, first.speed.sample, "{form}");
        let lengths = if form == "Stone-Soup" { &[][..] } else { &first.length.sample[..] };
        assert_eq!(model.length.sample, lengths, "{form}");
    }
}

/// In every form, each way of saying that a value is not available: the row goes for the reason
/// that is counted with its line, or stays without the value.
#[test]
fn what_is_not_available_goes_with_its_reason_in_every_form() {
    for form in FORMS {
        let head = head(form);
        let columns = ais::Columns::of(&head).unwrap();
        let time =
            if columns.kind.is_some() { "01/05/2023 00:00:00" } else { "2023-05-01 00:00:00" };
        let row = |at: Option<usize>, value: &str| {
            let mut fields = vec![""; columns.count];
            let good = [
                (Some(columns.time), time),
                (Some(columns.mmsi), "211000100"),
                (Some(columns.latitude), "55.0"),
                (Some(columns.longitude), "11.0"),
                (Some(columns.sog), "9.5"),
                (Some(columns.cog), "45.0"),
                (columns.heading, "44"),
                (columns.length, "120"),
                (columns.width, "20"),
                (columns.kind, "Class B"),
            ];
            for (at, value) in good.into_iter().chain([(at, value)]) {
                at.into_iter().for_each(|at| fields[at] = value);
            }
            fields.join(",")
        };
        let lines = |at, values: &[&str]| -> ais::Rows {
            let rows: Vec<String> = values.iter().map(|value| row(at, value)).collect();
            ais::read(&format!("{head}\n{}\n{}\n", row(None, ""), rows.join("\n"))).unwrap()
        };
        for (at, values, reason) in [
            (columns.time, &["", "Unknown", "24:00", "2023-13-01 00:00:00"][..], "no time"),
            (columns.mmsi, &["", "Unknown", "0", "-3"], "no identity"),
            (columns.latitude, &["", "Unknown", "91.0", "NaN", "N55"], "no position"),
            (columns.longitude, &["", "Unknown", "181.0", "inf"], "no position"),
            (columns.sog, &["", "Unknown", "102.3", "1023", "-1"], "no speed"),
        ] {
            let rows = lines(Some(at), values);
            assert_eq!(rows.reports.len(), 1, "{form}, {reason}");
            let said: Vec<_> = rows.rejected.into_iter().collect();
            let counted = ais::Counted { count: values.len() as u64, first_line: 3 };
            assert_eq!(said, [(reason, counted)], "{form}");
        }
        let courses = lines(Some(columns.cog), &["", "Unknown", "360", "360.0", "409.5"]);
        assert_eq!((courses.reports.len(), courses.without_course), (6, 5), "{form}");
        let headings = lines(columns.heading, &["", "Unknown", "511", "511.0", "360"]);
        let without = if columns.heading.is_some() { 5 } else { 0 };
        assert_eq!((headings.reports.len(), headings.without_heading), (6, without), "{form}");
        let lengths = lines(columns.length, &["", "Unknown", "0", "0.0", "-5"]);
        let known = lengths.reports.iter().filter(|report| report.length_m.is_some()).count();
        assert_eq!(known, usize::from(columns.length.is_some()), "{form}");
        let short = format!("{head}\n{}\n", row(None, "").rsplit_once(',').unwrap().0);
        let rejected = ais::read(&short).unwrap().rejected;
        assert_eq!(rejected["fewer fields than columns"].first_line, 2, "{form}");
    }
}
