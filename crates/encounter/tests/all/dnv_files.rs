//! The reader of DNV traffic situations, on small files of our own.

use crate::common::{campaign, run_settings};
use encounter::{
    Error, SituationSettings, class_at_start, last_cpa_s, nominal_cpa, read_situations,
};
use geom::units::{deg, knots};
use geom::{EncounterClass, HeadOnSector, Vec2};
use record::{Encounter, Intent, Vessel, Visibility, Waypoint};
use std::path::{Path, PathBuf};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn how() -> SituationSettings {
    campaign("situations")["situations"].clone().try_into().unwrap()
}

fn read(path: &Path) -> Result<Vec<Encounter>, Error> {
    read_situations(path, &how(), &run_settings(&campaign("situations")))
}

fn one(name: &str) -> Encounter {
    let mut encounters = read(&data(name)).unwrap();
    assert_eq!(encounters.len(), 1);
    encounters.remove(0)
}

fn near(a: f64, b: f64, within: f64) {
    assert!((a - b).abs() <= within, "{a} is not {b}");
}

/// Lengths of a degree at 60 degrees of latitude: 111 412 m and 55 800 m.
#[test]
fn a_route_with_speeds_on_its_legs_is_taken_over() {
    let encounter = one("crossing_integer_ids.json");
    assert_eq!(encounter.id.to_string(), "Ferry and coaster/000000");
    let own = &encounter.own;
    near(own.start.speed_mps, knots(10.0), 1e-12);
    near(own.cruise_mps, knots(12.0), 1e-12);
    assert_eq!(own.route.len(), 2);
    near(own.route[0].position_m.x, 0.05 * 111_412.0, 1.0);
    near(own.route[0].position_m.y, 0.0, 1e-6);
    near(own.route[0].speed_mps.unwrap(), knots(12.0), 1e-12);
    // a tenth of a degree east on the parallel of 60.05, where it is 0.9985 as long as on 60
    near(own.route[1].position_m.y, 0.1 * 55_800.0 * 0.9985, 2.0);
    near(own.route[1].speed_mps.unwrap(), knots(8.0), 1e-12);
    // 30 m to the bow and 10 m to the stern; 4 m to port and 6 m to starboard
    near(own.hull.midships_forward_m, 10.0, 1e-12);
    near(own.hull.midships_starboard_m, 1.0, 1e-12);

    let target = &encounter.targets[0];
    near(target.start.speed_mps, knots(7.0), 1e-12);
    near(target.start.psi_rad, deg(-90.0), 2e-3);
    near(target.hull.length_m, 80.0, 1e-12);
    near(target.hull.beam_m, 0.16 * 80.0, 1e-12);
    let Intent::Track(waypoints) = &target.intent else { panic!("{:?}", target.intent) };
    assert_eq!(waypoints.len(), 1);
    assert_eq!(waypoints[0].speed_mps, None);
    let class = class_at_start(&encounter, 0, HeadOnSector::wide(deg(13.0)));
    assert_eq!(class, Some(EncounterClass::CrossingStbd));
}

#[test]
fn limits_follow_length_and_planned_speed() {
    let encounter = one("crossing_integer_ids.json");
    let Vessel::Kinematic { yaw_rate_radps_max, acceleration_mps2_max, speed_mps_max } =
        encounter.own.vessel
    else {
        panic!("{:?}", encounter.own.vessel)
    };
    // 40 m and 12 kn, the fastest leg: radius of 100 m, stop from 8.66 m/s within 600 m
    near(yaw_rate_radps_max, knots(12.0) / 100.0, 1e-12);
    near(acceleration_mps2_max, 8.66 * 8.66 / 1200.0, 1e-12);
    near(speed_mps_max, 1.25 * knots(12.0), 1e-12);
}

/// Own ship turns to the east at 60.05 N after 902 s; the target crosses ahead of her before that.
#[test]
fn the_run_ends_ten_minutes_after_the_last_closest_point_on_the_routes() {
    let encounter = one("crossing_integer_ids.json");
    // at 12 kn north and 7 kn west from 3342 m north and 3345 m east
    let (v, w) = (knots(12.0), knots(7.0));
    let t_s = (3342.4 * v + 3345.0 * w) / (v * v + w * w);
    assert!(t_s < 0.05 * 111_412.0 / v, "{t_s}");
    let end_s = encounter.run.duration_s_max;
    near(end_s, t_s + 600.0, 2.0);
    assert!((end_s / encounter.run.beat_s).fract() <= 0.0);
}

#[test]
fn single_waypoints_a_tide_fog_and_the_date_line() {
    let encounter = one("fog_uuid_ids.json");
    near(encounter.weather.current_mps.y, 0.5, 1e-12);
    assert_eq!(encounter.visibility, Visibility::Restricted { visual_range_m: 926.0 });
    let own = &encounter.own;
    // over ground 10 kn to the east in a tide of 0.5 m/s to the east
    near(own.start.speed_mps, knots(10.0) - 0.5, 1e-12);
    near(own.start.psi_rad, deg(90.0), 1e-12);
    assert_eq!(own.route.len(), 1);
    near(own.route[0].position_m.y, knots(10.0) * 10_800.0, 1e-6);
    near(own.hull.length_m, 100.0, 1e-12);
    // she holds her course, so it goes before her heading; 0.04 degrees to the east of own ship
    let target = &encounter.targets[0];
    assert_eq!(target.intent, Intent::HoldCourse);
    near(target.start.position_m.y, 0.04 * 109_640.0, 5.0);
    near(target.start.psi_rad, deg(-90.0), 1e-12);
    near(target.start.speed_mps, knots(5.0) + 0.5, 1e-12);
    // a stopped ship in a tide stems it
    near(encounter.targets[1].start.speed_mps, 0.5, 1e-12);
    near(nominal_cpa(&encounter)[0].tcpa_s.unwrap(), 0.04 * 109_640.0 / knots(15.0), 1.0);
}

#[test]
fn a_folder_is_read_in_the_order_of_its_names_and_titles_become_unique() {
    let encounters = read(&data("folder")).unwrap();
    let strata: Vec<&str> = encounters.iter().map(|e| &*e.id.stratum).collect();
    assert_eq!(strata, ["HO", "HO (2)", "c_without_title"]);
    let ahead_m: Vec<f64> = encounters.iter().map(|e| e.targets[0].start.position_m.x).collect();
    assert!(ahead_m.is_sorted(), "{ahead_m:?}");
    assert!(encounters.iter().all(|e| e.id.j == 0));
    near(encounters[0].safety_radius_m, 400.0, 1e-12);
    assert_eq!(encounters, read(&data("folder")).unwrap());
}

/// A file of our own with one thing changed, and where the message says that it is.
fn refused(change: &str, to: &str) -> String {
    let text = std::fs::read_to_string(data("crossing_integer_ids.json")).unwrap();
    assert!(text.contains(change), "{change}");
    let folder = tempfolder();
    let path = folder.join(format!("{}.json", to.bytes().map(u64::from).sum::<u64>()));
    std::fs::write(&path, text.replace(change, to)).unwrap();
    let message = read(&path).unwrap_err().to_string();
    std::fs::remove_file(&path).unwrap();
    assert!(message.contains(&path.display().to_string()), "{message}");
    message
}

fn tempfolder() -> PathBuf {
    let folder = std::env::temp_dir().join(format!("encounter-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn errors_name_the_file_the_place_and_what_is_wrong() {
    for (change, to, expected) in [
        ("\"version\": \"0.2.0\"", "\"version\": \"1.0\"", "$.version: = \"1.0\" is not known"),
        ("\"version\": \"0.2.0\",", "", "$: lacks `version`"),
        ("\"targetShips\": [", "\"others\": [", "$: has no target in `targetShips`"),
        (
            "\"lat\": 60.03, \"lon\": 5.06",
            "\"lat\": 95.0, \"lon\": 5.06",
            "$.targetShips[0].waypoints[0].position.lat: = 95 must lie from -89 to 89",
        ),
        (
            "\"lat\": 60.03, \"lon\": 5.06",
            "\"lat\": 60.03",
            "$.targetShips[0].waypoints[0].position: lacks `lon`",
        ),
        ("\"sog\": 12.0", "\"sog\": \"fast\"", "$.ownShip.waypoints[1].leg.sog: must be a number"),
        (
            "\"value\": 8.0",
            "\"value\": -8.0",
            "$.ownShip.waypoints[2].leg.data.sog.value: = -8 must lie from 0 to 100",
        ),
        ("\"leg\": { \"sog\": 7.0 }", "\"leg\": {}", "$.targetShips[0]: has no speed"),
        (
            "\"id\": 12",
            "\"id\": \"twelve\"",
            "$.targetShips[0].static.id: must be an integer or a UUID",
        ),
        (
            "\"id\": 12",
            "\"id\": 12, \"initDelay\": 30.0",
            "$.targetShips[0].static.initDelay: is a delayed start",
        ),
        (
            "\"id\": 12",
            "\"id\": 12, \"pathType\": \"bezier\"",
            "$.targetShips[0].static.pathType: = \"bezier\" is not known",
        ),
        (
            "\"length\": 40.0",
            "\"length\": 60.0",
            "$.ownShip.static.dimensions: has length = 60, but a + b = 40",
        ),
        (
            "\"version\": \"0.2.0\"",
            "\"version\": \"0.2.0\", \"systemUnderTest\": {}",
            "$: is the output of a run",
        ),
        ("\"ownShip\": {", "\"ownShip\": [{", "is not JSON"),
    ] {
        let message = refused(change, to);
        assert!(message.contains(expected), "{message}\nlacks\n{expected}");
    }
}

#[test]
fn a_missing_file_and_an_empty_folder_are_told_apart() {
    let message = read(&data("nowhere.json")).unwrap_err().to_string();
    assert!(message.starts_with("failed to read") && message.contains("nowhere.json"), "{message}");
    let empty = tempfolder().join("empty");
    std::fs::create_dir_all(&empty).unwrap();
    let message = read(&empty).unwrap_err().to_string();
    assert!(message.contains("holds no *.json"), "{message}");
}

/// Found: an own ship without a planned speed made a route of no length.
#[test]
fn own_ship_must_move() {
    let message = refused("\"sog\": 12.0", "\"sog\": 0.0");
    assert!(message.contains("$.ownShip: does not move"), "{message}");
}

#[test]
fn positions_are_relative_to_own_first_waypoint() {
    for encounter in read(&data("folder")).unwrap() {
        assert!(encounter.own.start.position_m.norm() < 1e-6);
        let way = encounter.own.route[0].position_m;
        // 0.1 degrees of latitude at 55.05 degrees: 111.321 km a degree
        assert!((way - Vec2::new(11_132.0, 0.0)).norm() < 2.0, "{way}");
    }
}

/// The target of the first file turns across own ship's bow; without her route she would stay
/// abeam.
#[test]
fn the_last_closest_point_is_that_of_the_routes() {
    let mut encounter = one("folder/a_first.json");
    let speed_mps = encounter.own.start.speed_mps;
    let target = &mut encounter.targets[0];
    target.start = encounter.own.start;
    target.start.position_m = Vec2::new(1000.0, 1000.0);
    let beside_m = Vec2::new(1000.0 + 100.0 * speed_mps, 1000.0);
    target.intent = Intent::Track(vec![
        Waypoint { position_m: beside_m, speed_mps: None },
        Waypoint { position_m: beside_m + Vec2::new(0.0, -9000.0), speed_mps: None },
    ]);
    near(last_cpa_s(&encounter), 100.0 + 1000.0 / speed_mps, 1e-6);
    encounter.targets[0].intent = Intent::HoldCourse;
    near(last_cpa_s(&encounter), 0.0, 1e-6);
}
