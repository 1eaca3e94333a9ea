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
