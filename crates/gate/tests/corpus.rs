//! The corpus: shrinking keeps a failure, and a case says the same when it is read back.

use campaign::plan::RulesChoice;
use gate::corpus::{self, Case, Found, Question};
use gate::{Event, shrink};
use planner_api::Options;
use std::sync::atomic::AtomicU64;

const QUICK: &str = include_str!("../../../campaigns/quick.toml");
const RULES: &str = include_str!("../../../campaigns/rulesets/usv-oe2023-v1.toml");

/// The first encounter of head-on in which `hold-course` comes too close, made small, written and
/// read back.
#[test]
fn a_failure_is_made_small_goes_on_failing_and_survives_its_file() {
    let registry = planners::registry();
    let file = campaign::CampaignFile::parse(QUICK, "quick").unwrap();
    let settings = encounter::RunSettings {
        limits: file.run.limits(),
        safety_radius_m: file.run.safety_radius_m,
        distance: file.run.distance,
    };
    let model = file.model.as_ref().unwrap();
    let generator = encounter::Generator::new(model, &settings).unwrap();
    let drawn = generator.draw(record::Seed(u64::MAX), 0, 3).unwrap().encounter;
    let rules = RulesChoice::new("usv-oe2023-v1", RULES.to_owned()).unwrap();
    let make = || corpus::make(&registry, "hold-course", &Options::new());
    let kept = [Event::SafetyRadius];
    let small = shrink::shrink(&drawn, &kept, &rules, &make).unwrap();
    assert_ne!(small, drawn, "nothing was made simpler");
    let north_m = small.targets[0].start.position_m.x;
    assert!((north_m - north_m.round()).abs() < 1e-9, "{north_m} is not round");

    let case = Case {
        schema: 1,
        name: "head-on".into(),
        why: "it holds on".into(),
        rules: "usv-oe2023-v1".into(),
        must_not: kept.to_vec(),
        waived: None,
        found: Found {
            planner: "hold-course".into(),
            options: Options::new(),
            events: kept.to_vec(),
        },
        encounter: small,
    };
    let text = toml::to_string_pretty(&case).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("head-on.toml"), text).unwrap();
    let cases = corpus::read(folder.path()).unwrap();
    assert_eq!(cases, [case]);

    // the planner that avoids passes, so holding on is newly broken, and not the other way round
    let find = |_: &str| Ok(RULES.to_owned());
    let answer = |planner: &str, q: &Question| {
        let mut planner = corpus::make(&registry, planner, &Options::new())?;
        let beat = AtomicU64::new(0);
        corpus::events(&q.encounter, planner.as_mut(), &q.rules, &q.events, &beat).map(Some)
    };
    let mut holds = |q: &Question| answer("hold-course", q);
    let mut avoids = |q: &Question| answer("zhuang-corrected", q);
    let worse = corpus::replay(&cases, &find, &mut avoids, &mut holds).unwrap();
    assert_eq!(worse.broken.len(), 1, "{worse:?}");
    let better = corpus::replay(&cases, &find, &mut holds, &mut avoids).unwrap();
    assert!(better.broken.is_empty(), "{better:?}");
    let lost = corpus::replay(&cases, &find, &mut avoids, &mut |_| Ok(None)).unwrap();
    assert_eq!(lost.broken.len(), 1, "a planner that is lost breaks the case");
    let good = || corpus::make(&registry, "zhuang-corrected", &Options::new());
    let none = shrink::shrink(&cases[0].encounter, &kept, &rules, &good);
    assert!(none.is_err(), "an encounter that does not fail is not shrunk");
}
