//! The corpus: shrinking keeps a failure, and a case says the same when it is read back.

use campaign::plan::RulesChoice;
use gate::corpus::{self, Case, Found, Question};
use gate::{Event, shrink};
use planner_api::Options;
use record::Encounter;
use std::sync::atomic::AtomicU64;

const LABORATORY: &str = include_str!("../../../campaigns/laboratory.toml");
const RULES: &str = include_str!("../../../campaigns/rulesets/usv-oe2023-v1.toml");
const CORPUS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/corpus");
/// One of its cases.
const ONE: &str = "head-on-to-port";
const RULESETS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../campaigns/rulesets");

/// The first encounter of head-on in which `hold-course` comes too close, made small, written and
/// read back.
#[test]
fn a_failure_is_made_small_goes_on_failing_and_survives_its_file() {
    let registry = planners::registry();
    let file = campaign::CampaignFile::parse(LABORATORY, "laboratory").unwrap();
    let settings = encounter::RunSettings {
        limits: file.run.limits(),
        safety_radius_m: file.run.safety_radius_m,
        distance: file.run.distance,
    };
    let model = file.model.as_ref().unwrap();
    let generator = encounter::Generator::new(model, &settings).unwrap();
    let drawn = generator.draw(record::Seed(u64::MAX), 0, 3).unwrap().encounter;
    let rules = RulesChoice::new("usv-oe2023-v1", RULES.to_owned()).unwrap();
    let kept = vec![Event::SafetyRadius];
    let does = |planner: &str, encounter: &Encounter| {
        let question = Question {
            encounter: encounter.clone(),
            rules: rules.clone(),
            events: kept.clone(),
            or_undetermined: false,
        };
        let planner = (planner, &Options::new());
        corpus::events(&question, &registry, planner, &AtomicU64::new(0))
    };
    let small = shrink::shrink(&drawn, "head-on", &mut |trial| {
        does("hold-course", trial).map(|events| events == kept)
    });
    let small = small.unwrap();
    assert!(small.kept > 5 && small.tried >= small.kept, "{small:?}");
    let start = small.encounter.targets[0].start;
    assert!((start.position_m.x / 10.0).fract().abs() < 1e-9, "{start:?} is not round");
    assert_eq!(small.encounter.own.start.position_m, geom::Vec2::zeros());

    let case = Case {
        schema: 1,
        name: "head-on".into(),
        why: "it holds on".into(),
        rules: "usv-oe2023-v1".into(),
        must_not: kept.clone(),
        waived: None,
        found: Found {
            planner: "hold-course".into(),
            options: Options::new(),
            events: kept.clone(),
        },
        encounter: small.encounter,
    };
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("head-on.toml"), case.text().unwrap()).unwrap();
    let cases = corpus::read(folder.path()).unwrap();
    assert_eq!(cases, [case]);

    // the planner that avoids passes, so holding on is newly broken, and not the other way round
    let find = |_: &str| Ok(RULES.to_owned());
    let answer = |planner: &str, q: &Question| {
        corpus::events(q, &registry, (planner, &Options::new()), &AtomicU64::new(0)).map(Some)
    };
    let mut holds = |q: &Question| answer("hold-course", q);
    let mut avoids = |q: &Question| answer("zhuang-corrected", q);
    let worse = corpus::replay(&cases, &find, &mut avoids, &mut holds).unwrap();
    assert_eq!(worse.broken.len(), 1, "{worse:?}");
    let better = corpus::replay(&cases, &find, &mut holds, &mut avoids).unwrap();
    assert!(better.broken.is_empty(), "{better:?}");
    let lost = corpus::replay(&cases, &find, &mut avoids, &mut |_| Ok(None)).unwrap();
    assert_eq!(lost.broken.len(), 1, "a planner that is lost breaks the case");
    let none = shrink::shrink(&cases[0].encounter, "x", &mut |trial| {
        does("zhuang-corrected", trial).map(|events| events == kept)
    });
    assert!(none.is_err(), "an encounter that does not fail is not shrunk");
}

/// A file that contradicts itself is refused with what is wrong.
#[test]
fn a_case_that_says_nothing_or_contradicts_itself_is_refused() {
    let text = std::fs::read_to_string(format!("{CORPUS}/{ONE}.toml")).unwrap();
    assert!(Case::parse(&text, ONE).is_ok());
    for (from, to, says) in [
        ("schema = 1", "schema = 2", "must be 1"),
        ("must_not = [", "must_not = []\nother = [", "unknown field"),
        ("must_not = [", "must_not = [\"near\", ", "needs a gate"),
        ("must_not = [", "must_not = [\"r19\", ", "was not found to do"),
    ] {
        let wrong = Case::parse(&text.replacen(from, to, 1), ONE).unwrap_err().to_string();
        assert!(wrong.contains(says), "{wrong} does not say `{says}`");
    }
    assert!(Case::parse(&text, "another").unwrap_err().to_string().contains("name"));
}

/// Every case of the repository gets the verdict that its file holds.
#[test]
fn every_case_of_the_corpus_gets_its_verdict() {
    let registry = planners::registry();
    let cases = corpus::read(CORPUS.as_ref()).unwrap();
    assert!((5..=15).contains(&cases.len()), "{} cases", cases.len());
    let find = |name: &str| Ok(std::fs::read_to_string(format!("{RULESETS}/{name}.toml")).unwrap());
    let mut moved = Vec::new();
    for case in &cases {
        let question = case.question(&find, corpus::every_event(), false).unwrap();
        let planner = (case.found.planner.as_str(), &case.found.options);
        let now = corpus::events(&question, &registry, planner, &AtomicU64::new(0)).unwrap();
        let changes = corpus::changes(&case.found.events, &now);
        if !changes.is_empty() {
            moved.push(format!("{}: {}", case.name, changes.join(", ")));
        }
    }
    assert!(
        moved.is_empty(),
        "verdicts moved; `cargo xtask corpus --refresh` takes them over, and CHANGELOG.md says \
         why they had to:\n{}",
        moved.join("\n")
    );
}
