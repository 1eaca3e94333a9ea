//! What a campaign file must not say, and what the message tells about it.

use crate::common::{campaign, run_settings};
use encounter::{Error, Generator, Model, SetSettings, Situation, situations};
use record::DistanceKind;

fn parse(text: &str) -> Result<Model, String> {
    let file: toml::Table = text.parse().map_err(|e: toml::de::Error| e.to_string())?;
    file["model"].clone().try_into().map_err(|e: toml::de::Error| e.to_string())
}

fn changed(name: &str, from: &str, to: &str) -> String {
    let path = format!("{}/../../campaigns/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

/// The message about `laboratory` with one thing changed.
fn refused(from: &str, to: &str) -> String {
    let run = run_settings(&campaign("laboratory"));
    match parse(&changed("laboratory", from, to)) {
        Err(message) => message,
        Ok(model) => Generator::new(&model, &run).map(|_| ()).unwrap_err().to_string(),
    }
}

#[test]
fn wrong_values_are_named_with_what_would_be_right() {
    for (from, to, expected) in [
        (
            "uniform = [5.0, 9.0]",
            "uniform = [9.0, 5.0]",
            "`model.own.speed_mps` = [9, 5] runs backwards; write [5, 9]",
        ),
        ("uniform = [5.0, 9.0]", "uniform = [5.0, 5.0]", "`model.own.speed_mps` = [5, 5] is empty"),
        (
            "uniform = [5.0, 9.0]",
            "uniform = [5.0, nan]",
            "`model.own.speed_mps` = NaN must be a finite number",
        ),
        ("uniform = [5.0, 9.0]", "uniform = [-5.0, 9.0]", "it must lie within 0 to 60"),
        ("uniform = [8.0, 120.0]", "uniform = [0.0, 120.0]", "`model.target.length_m` = 0"),
        ("uniform = [-150.0, 150.0]", "uniform = [-150.0, 5000.0]", "`model.geometry.miss_m`"),
        ("tcpa_s = [90.0, 300.0]", "tcpa_s = [300.0, 90.0]", "`model.geometry.tcpa_s`"),
        ("tcpa_s = [90.0, 300.0]", "tcpa_s = [0.0, 300.0]", "`model.geometry.tcpa_s`"),
        ("range_m_max = 3000.0", "range_m_max = 300.0", "`model.geometry.range_m_max` = 300"),
        ("head_on_half_angle_deg = 13.0", "head_on_half_angle_deg = 0.0", "must be over 0"),
        (
            "within_deg = 3.0",
            "within_deg = -3.0",
            "`model.stratum.boundary_head_on.within_deg` = -3",
        ),
        (
            "class = \"head_on\"",
            "class = \"head_on\"\nboundary = \"head_on_crossing\"",
            "`model.stratum.head_on.class` and `boundary` exclude each other",
        ),
        (
            "boundary = \"head_on_crossing\"\nwithin_deg = 3.0",
            "boundary = \"head_on_crossing\"",
            "`model.stratum.boundary_head_on.within_deg` is missing",
        ),
        ("name = \"crossing_port\"", "name = \"head_on\"", "stands twice"),
        ("vessel = \"viknes\"", "vessel = \"kinematic\"", "`model.own.limits` is missing"),
        (
            "[model.target.scaled_limits]\nturn_radius_lengths = 2.5",
            "[model.target.scaled_limits]\nturn_radius_lengths = 0.0",
            "`model.target.scaled_limits.turn_radius_lengths` = 0",
        ),
        ("speed_max_per_planned = 1.25", "speed_max_per_planned = 0.5", "must be at least 1"),
        // what serde tells, with the allowed words
        ("class = \"head_on\"", "class = \"headon\"", "unknown variant `headon`"),
        (
            "intent = \"hold_course\"",
            "intent = \"hold_course\"\nspeed = 3.0",
            "unknown field `speed`",
        ),
        ("random_rotation = false", "", "missing field `random_rotation`"),
        ("uniform = [5.0, 9.0]", "gauss = [5.0, 9.0]", "unknown variant `gauss`"),
        ("beam_m = 2.71", "beam_m = \"wide\"", "invalid type: string"),
    ] {
        let message = refused(from, to);
        assert!(message.contains(expected), "{message}\nlacks\n{expected}");
    }
}

/// Land is told with the number of the polygon and of the edges that cross.
#[test]
fn a_hazard_that_crosses_itself_is_refused() {
    let table = "[model.sensing]";
    let bow_tie = "[model]\nhazard = [[[9.0, 9.0], [9.0, 19.0], [19.0, 9.0]], \
         [[700.0, 0.0], [720.0, 20.0], [720.0, 0.0], [700.0, 20.0]]]\n[model.sensing]";
    assert_eq!(
        refused(table, bow_tie),
        "`model.hazard.2` edge 1 meets edge 3; go around the outline once, without crossing it"
    );
}

/// A class that the ships of the file cannot make is told before the first encounter, with the
/// constraint that failed.
#[test]
fn a_class_that_cannot_be_placed_is_an_error() {
    let slow = "class = \"overtaken\"\ntarget_speed_mps = { uniform = [1.0, 3.0] }";
    let message = refused("class = \"overtaken\"", slow);
    assert!(
        message.starts_with("failed to place target 1 of overtaken/000000 in 100000 tries")
            && message.contains("give the class overtaken"),
        "{message}"
    );
    let message = refused("tcpa_s = [90.0, 300.0]", "tcpa_s = [1.0, 2.0]");
    assert!(message.contains("the start range from 379 to 3000 m is not met"), "{message}");
    let ahead = "class = \"head_on\"\nrelative_course_deg = { uniform = [-20.0, 20.0] }";
    let message = refused("class = \"head_on\"", ahead);
    assert!(message.contains("of head_on/000000"), "{message}");
}

#[test]
fn a_radius_below_half_the_hulls_is_refused_between_centres() {
    let model = parse(&changed("laboratory", "", "")).unwrap();
    let mut run = run_settings(&campaign("laboratory"));
    run.distance = DistanceKind::Centre;
    run.safety_radius_m = 60.0;
    let message = Generator::new(&model, &run).unwrap_err().to_string();
    assert!(message.contains("`run.safety_radius_m` = 60 is below half of both hulls, 64.2"));
    run.safety_radius_m = 64.5;
    assert!(Generator::new(&model, &run).is_ok());
    run.distance = DistanceKind::Hull;
    run.safety_radius_m = 1.0;
    assert!(Generator::new(&model, &run).is_ok());
    for radius_m in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        run.safety_radius_m = radius_m;
        assert!(Generator::new(&model, &run).is_err(), "{radius_m}");
    }
}

#[test]
fn no_stratum_is_an_error() {
    let mut model = parse(&changed("laboratory", "", "")).unwrap();
    model.stratum.clear();
    let error = Generator::new(&model, &run_settings(&campaign("laboratory"))).unwrap_err();
    assert!(matches!(&error, Error::Spec { key, .. } if key == "model.stratum"), "{error}");
}

fn refused_set(from: &str, to: &str) -> String {
    let text = changed("paper", from, to);
    let file: toml::Table = text.parse().unwrap();
    let run = run_settings(&file);
    let list: Result<Vec<Situation>, _> = file["situation"].clone().try_into();
    let set: Result<SetSettings, _> = file["set"].clone().try_into();
    match (set, list) {
        (Ok(set), Ok(list)) => situations(&set, &list, &run).unwrap_err().to_string(),
        (Err(e), _) | (_, Err(e)) => e.to_string(),
    }
}

#[test]
fn wrong_situations_are_named() {
    let first = "  { north_m = 900.0, east_m = 0.0, course_deg = 0.0, speed_mps = 3.5 },\n";
    for (from, to, expected) in [
        (first, "", "`situation.fig_14.targets` is empty"),
        (
            "north_m = 900.0, east_m = 0.0",
            "north_nm = 0.5, east_nm = 0.0",
            "`situation.fig_14.targets.1` must have north_m and east_m and no other unit",
        ),
        (
            "north_m = 900.0, east_m = 0.0",
            "north_m = 900.0",
            "`situation.fig_14.targets.1` must have north_m and east_m",
        ),
        (
            "speed_mps = 3.5",
            "speed_kn = 7.0",
            "`situation.fig_14.targets.1` must have speed_mps and no other unit",
        ),
        ("speed_mps = 3.5", "speed_mps = -3.5", "it must be at least 0"),
        ("speed_mps = 3.5", "speed_mps = 13.5", "over her own limit of 12"),
        (
            "course_deg = 0.0, speed_mps = 3.5",
            "course_deg = 700.0, speed_mps = 3.5",
            "`situation.fig_14.targets.1.course_deg` = 700",
        ),
        ("north_m = 900.0", "north_m = nan", "must have finite coordinates"),
        ("name = \"fig_14b\"", "name = \"fig_14\"", "needs a name of its own"),
        (
            "safety_radius_m = 120.0",
            "safety_radius_m = 5.0",
            "`run.safety_radius_m` = 5 is below half of both hulls",
        ),
        ("detection_range_m = 700.0", "detection_range_m = 0.0", "must be a positive number"),
        ("goal = { north_m = 6000.0,", "goal = { north = 6000.0,", "unknown field `north`"),
    ] {
        let message = refused_set(from, to);
        assert!(message.contains(expected), "{message}\nlacks\n{expected}");
    }
    let set: SetSettings = campaign("paper")["set"].clone().try_into().unwrap();
    let run = run_settings(&campaign("paper"));
    let message = situations(&set, &[], &run).unwrap_err().to_string();
    assert!(message.contains("`situation` is missing"), "{message}");
}
