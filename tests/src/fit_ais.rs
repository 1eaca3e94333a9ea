//! AIS reports become campaigns that run at once: the fitted traffic, and the encounters sailed
//! again with own ship in the place of one vessel.

use crate::support::{json, rows, run_err, run_ok};
use std::fs;
use std::path::Path;

const PAIRS: u64 = 12;
/// Metres in a degree of latitude and of longitude at 55 degrees, near enough.
const DEGREE_M: [f64; 2] = [111_340.0, 63_995.0];

/// Where ship 0 or 1 of a pair is, metres north and east. Ship 0 goes north through the origin at
/// 600 s; ship 1 goes west and passes 25 m times the pair's number east of it. Ship 1 of the last
/// pair turns south after 450 s.
fn place_m(pair: u64, ship: u64, t_s: f64) -> [f64; 2] {
    let (north_mps, west_mps) = (4.0 + 0.2 * pair as f64, 5.0 + 0.1 * pair as f64);
    let (left_s, lag_m) = (600.0 - t_s, 25.0 * pair as f64);
    match (ship, pair == PAIRS - 1 && t_s > 450.0) {
        (0, _) => [-north_mps * left_s, 0.0],
        (_, false) => [0.0, west_mps * left_s + lag_m],
        (_, true) => [-west_mps * (t_s - 450.0), west_mps * 150.0 + lag_m],
    }
}

fn apart_m(a: [f64; 2], b: [f64; 2]) -> f64 {
    let [north_m, east_m] = [a[0] - b[0], a[1] - b[1]];
    (north_m * north_m + east_m * east_m).sqrt()
}

/// The traffic in the form of the United States since 2024, with what has to be cleaned.
fn reports() -> String {
    let mut text =
        "mmsi,base_date_time,longitude,latitude,sog,cog,heading,vessel_name,length\n".to_owned();
    for pair in 0..PAIRS {
        for step in 0..=120u64 {
            for ship in 0..2 {
                let t_s = 10.0 * step as f64;
                let [north_m, east_m] = place_m(pair, ship, t_s);
                let later_m = place_m(pair, ship, t_s + 1.0);
                let mps = apart_m(later_m, [north_m, east_m]);
                let clock = 3600 * pair + 10 * step;
                text += &format!(
                    "{},2024-05-01 {:02}:{:02}:{:02},{:.7},{:.7},{:.3},360,511,\"A, B\",{}\n",
                    211_000_100 + 2 * pair + ship,
                    clock / 3600,
                    clock / 60 % 60,
                    clock % 60,
                    11.0 + east_m / DEGREE_M[1],
                    55.0 + north_m / DEGREE_M[0],
                    mps / 0.514_444,
                    20 + pair,
                );
            }
        }
    }
    text += "211000100,2024-05-01 00:10:05,54.8,55.0,8.0,0,0,A,20\n\
             211000100,2024-05-01 00:10:07,11.0,91.0,102.3,0,0,A,20\n\
             2190045,2024-05-01 00:10:07,11.0,55.0,0.0,0,0,A,20\n\
             211000100,2024-05-01 00:10:08\n";
    text
}

fn fit(folder: &Path) -> String {
    fs::write(folder.join("traffic.csv"), reports()).unwrap();
    run_ok(folder, "fit-ais traffic.csv --out fit")
}

/// Least distance between own ship, who goes straight on from where vessel `own` of the pair is
/// at `start_s`, and the track of the other.
fn closest_m(pair: u64, own: u64, start_s: f64) -> f64 {
    let (from, to) = (place_m(pair, own, start_s - 15.0), place_m(pair, own, start_s + 15.0));
    let velocity = [(to[0] - from[0]) / 30.0, (to[1] - from[1]) / 30.0];
    let start = place_m(pair, own, start_s);
    let apart = |k: i32| {
        let ahead_s = f64::from(k);
        let other = place_m(pair, 1 - own, start_s + ahead_s);
        let mine = [start[0] + velocity[0] * ahead_s, start[1] + velocity[1] * ahead_s];
        apart_m(mine, other)
    };
    (0..600).map(apart).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_file_of_reports_becomes_two_campaigns_that_run() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let said = fit(path);
    assert!(said.contains("12 encounters: too few encounters to represent a traffic"), "{said}");
    for line in [
        "| a wild position | 1 | 2906 |",
        "| no position | 1 | 2907 |",
        "| sent by no ship | 1 | 2908 |",
        "| fewer fields than columns | 1 | 2909 |",
        "| times out of order, put right | 1 | 2906 |",
    ] {
        assert!(said.contains(line), "{line}: {said}");
    }
    let picture = fs::read_to_string(path.join("fit/traffic.svg")).unwrap();
    assert!(picture.contains("traffic.csv: 24 ships, 12 encounters"));

    run_ok(
        path,
        "campaign fit/model.toml --encounters 60 --planner hold-course --out model --quiet",
    );
    let summary = json(path.join("model/summary.json"));
    assert_eq!(
        (&summary["encounters"], &summary["strata"][0]["name"]),
        (&60.into(), &"traffic".into())
    );
    let drawn = rows(&path.join("model"));
    // the laws of the file: lengths from 20 to 31 m, and own speeds of its ships
    assert!(
        drawn.iter().all(|row| row.target_length_m.is_some_and(|m| (20.0..=31.0).contains(&m)))
    );
    assert!(drawn.iter().all(|row| (3.9..6.3).contains(&row.own_speed_mps)));

    run_ok(path, "campaign fit/situations.toml --planner hold-course --out again --quiet");
    let again = rows(&path.join("again"));
    assert_eq!(again.len(), 2 * PAIRS as usize);
    for row in &again {
        let mut words = row.id.stratum.split('_').skip(1).map(|word| word.parse::<u64>().unwrap());
        let (pair, own) = (words.next().unwrap(), words.next().unwrap());
        // an encounter begins five minutes before its recorded closest point
        let recorded = (0..1200).map(|t_s| {
            let (a, b) = (place_m(pair, 0, f64::from(t_s)), place_m(pair, 1, f64::from(t_s)));
            (apart_m(a, b), t_s)
        });
        let cpa_s = recorded.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap().1;
        let expected_m = closest_m(pair, own, f64::from(cpa_s) - 300.0);
        let got_m = row.cpa_centre_m.unwrap();
        assert!((got_m - expected_m).abs() < 25.0, "{}: {got_m} {expected_m}", row.id);
    }
}

#[test]
fn what_is_no_file_of_reports_is_told_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for (text, words) in [
        ("", "cannot use bad.csv: the file is empty"),
        ("MMSI,BaseDateTime,LAT,LON,SOG\n", "line 1 has no column for the course (cog)"),
    ] {
        fs::write(path.join("bad.csv"), text).unwrap();
        let said = run_err(path, "fit-ais bad.csv", 2);
        assert!(said.contains(words), "{said}");
    }
    assert!(run_err(path, "fit-ais none.csv", 2).contains("cannot read none.csv"));
    // nothing to fit: said, and no campaign is written that could not run
    fs::write(path.join("bad.csv"), "mmsi,time,lat,lon,sog,cog\nx,y,z,1,2,3\n").unwrap();
    let said = run_ok(path, "fit-ais bad.csv");
    assert!(said.contains("| no time | 1 | 2 |"), "{said}");
    assert!(!path.join("reports/ais-bad/model.toml").exists());
    // two rows that no ship can both have sent: nobody knows which is wrong, and neither is used
    let rows =
        ["2023-05-01 00:00:00,211000100,55.0,11.0,9", "2023-05-01 00:00:10,211000100,54,1,9"];
    fs::write(path.join("bad.csv"), format!("time,mmsi,lat,lon,sog,cog\n{},\n", rows.join(",\n")))
        .unwrap();
    let said = run_ok(path, "fit-ais bad.csv --out two");
    assert!(said.contains("| a wild position | 2 | 2 |\n"), "{said}");
    assert!(said.contains("| ships | 0 |"), "{said}");
}
