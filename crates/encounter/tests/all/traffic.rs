//! What a traffic that was measured needs: a stratum of whatever its laws give, and targets that
//! sail a recorded track.

use crate::common::{campaign, run_settings};
use encounter::{Generator, Model, SetSettings, Situation, last_cpa_s, situations};
use geom::units::deg;
use geom::{EncounterClass, Vec2, wrap};
use record::{Intent, Seed, Waypoint};
use std::collections::BTreeMap;

fn laboratory() -> toml::Table {
    campaign("laboratory")
}

/// The laws of the file reach the encounter as they are: one relative course in four is each of
/// four, though the classes that they make are met with very different chances.
#[test]
fn a_stratum_without_a_class_takes_what_the_laws_give() {
    let file = laboratory();
    let mut table = file["model"].clone();
    let stratum: toml::Value = toml::Table::from_iter([("name".into(), "traffic".into())]).into();
    let model = table.as_table_mut().unwrap();
    model.insert("stratum".into(), vec![stratum].into());
    let law = "law = { empirical = [180.0, 90.0, -90.0, 5.0] }".parse::<toml::Table>().unwrap();
    let geometry = model["geometry"].as_table_mut().unwrap();
    geometry.insert("relative_course_deg".into(), law["law"].clone());
    // long enough that no course is refused for its closing speed
    geometry.insert("tcpa_s".into(), vec![5.0, 3000.0].into());
    let model: Model = table.try_into().unwrap();
    let generator = Generator::new(&model, &run_settings(&file)).unwrap();
    let mut courses: BTreeMap<i64, u32> = BTreeMap::new();
    let mut classes: BTreeMap<EncounterClass, u32> = BTreeMap::new();
    const N: u32 = 4000;
    for j in 0..N {
        let drawn = generator.draw(Seed(7), 0, u64::from(j)).unwrap().encounter;
        let course_rad = wrap(drawn.targets[0].start.psi_rad - drawn.own.start.psi_rad);
        *courses.entry((course_rad / deg(1.0)).round() as i64).or_default() += 1;
        *classes.entry(drawn.asked.unwrap().class).or_default() += 1;
    }
    assert_eq!(courses.len(), 4, "{courses:?}");
    for (course, count) in &courses {
        // five standard deviations of a quarter of 4,000
        assert!(count.abs_diff(N / 4) < 137, "{course}: {count}");
    }
    assert!(classes.len() >= 4, "{classes:?}");
}

fn replayed(intent: &str) -> Result<record::Encounter, String> {
    let file = campaign("imazu");
    let set: SetSettings = file["set"].clone().try_into().unwrap();
    let text = format!(
        "name = 'recorded'\n\
         own = {{ north_m = 0.0, east_m = 0.0, course_deg = 0.0, speed_mps = 5.0 }}\n\
         goal = {{ north_m = 9000.0, east_m = 0.0 }}\n\
         targets = [ {{ north_m = 3000.0, east_m = 0.0, course_deg = 180.0, speed_mps = 5.0, \
         intent = {{ track = [ {intent} ] }} }} ]\n"
    );
    let situation: Situation = toml::from_str(&text).map_err(|e| e.to_string())?;
    situations(&set, &[situation], &run_settings(&file))
        .map(|mut all| all.remove(0))
        .map_err(|e| e.to_string())
}

#[test]
fn a_target_of_a_situation_can_sail_a_track() {
    let encounter = replayed(
        "{ north_m = 2500.0, east_m = 0.0, speed_mps = 5.0 }, \
         { north_m = 2500.0, east_m = 2000.0, speed_mps = 8.0 }",
    )
    .unwrap();
    let place = |x, y, mps| Waypoint { position_m: Vec2::new(x, y), speed_mps: Some(mps) };
    let track = vec![place(2500.0, 0.0, 5.0), place(2500.0, 2000.0, 8.0)];
    assert_eq!(encounter.targets[0].intent, Intent::Track(track));
    // at 100 s she turns east, 2,000 m ahead of own ship: the square of the distance is
    // (2500 - 5 t)^2 + (8 (t - 100))^2 from then on, least at 18900 / 89 s
    assert!((last_cpa_s(&encounter) - 18_900.0 / 89.0).abs() < 1e-6);
}

#[test]
fn a_wrong_track_is_named_with_its_place() {
    let first = "{ north_m = 2500.0, east_m = 0.0, speed_mps = 5.0 }";
    for (intent, expected) in [
        (String::new(), "`situation.recorded.targets.1.intent.track` is empty"),
        (
            format!("{first}, {{ north_m = 1.0, east_m = 0.0 }}"),
            "`situation.recorded.targets.1.intent.track.2` must have speed_mps",
        ),
        (
            "{ north_nm = 1.0, east_nm = 0.0, speed_mps = 5.0 }".to_owned(),
            "`situation.recorded.targets.1.intent.track.1` must have north_m and east_m",
        ),
    ] {
        let said = replayed(&intent).unwrap_err();
        assert!(said.contains(expected), "{said}");
    }
}
