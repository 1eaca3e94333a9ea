//! The class by the planner's own head-on sector, beside the judge's that decides.

use super::*;
use geom::HeadOnSector;
use geom::units::deg;

/// A ship 8 degrees on the starboard bow, reciprocal but for 2 degrees; own ship turns to port.
fn judged(half_angle_deg: Option<f64>) -> Judgement {
    let other = target(1500.0, 210.0, 188.0, 5.0).hold(300.0);
    let mut trace = Scene::new(own(7.0).hold(30.0).turn(-40.0, 3.0).hold(260.0), other).trace();
    trace.planner_sector = half_angle_deg.map(|h| HeadOnSector::wide(deg(h)));
    judge_by(rules(), &trace)
}

#[test]
fn verdicts_under_the_planners_class_stand_beside_the_judges() {
    let narrow = judged(Some(3.0));
    assert_eq!(narrow.pairs[0].class, Some(EncounterClass::HeadOn));
    assert_eq!(narrow.pairs[0].class_by_planner, Some(EncounterClass::CrossingStbd));
    // the judge's class decides
    expect(&narrow, Check::Turn, Status::Fail, "FAIL-14-PORT");
    let fails = narrow.fails_by_planner_class().unwrap();
    assert!(!fails.contains(&Check::R14), "{fails:?}");
    let theirs = narrow.by_planner_class.as_ref().unwrap();
    assert_eq!(theirs.len(), narrow.verdicts.len());
    let r15 = theirs.iter().find(|verdict| verdict.check == Check::R15).unwrap();
    assert_ne!(r15.status, Status::NotApplicable);
    // and nothing else of the judgement moves
    let without = judged(None);
    assert_eq!(without.verdicts, narrow.verdicts);
    assert_eq!((without.pairs[0].class_by_planner, without.by_planner_class), (None, None));
}

#[test]
fn where_the_classes_agree_there_is_nothing_beside_them() {
    let same = judged(Some(13.0));
    assert_eq!(same.pairs[0].class_by_planner, same.pairs[0].class);
    assert_eq!(same.by_planner_class, None);
}

#[test]
fn every_verdict_says_by_what_its_stages_were_found() {
    let by = |judgement: &Judgement| {
        let all: Vec<_> = judgement.verdicts.iter().map(|verdict| verdict.stages_by).collect();
        assert!(all.iter().all(|by| *by == all[0]), "{all:?}");
        all[0]
    };
    assert_eq!(by(&judged(None)), Some(StageClock::Range));
    let overtaking = judge(&Scene::new(own(9.0).hold(300.0), slow_ahead()));
    assert_eq!(by(&overtaking), Some(StageClock::Time));
}
