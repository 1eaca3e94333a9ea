//! Several targets: pair by pair, and who a turn was for (section 11).

use super::*;
use Status::{Fail, NotApplicable, Pass};

fn of(judgement: &Judgement, target: u8, check: Check) -> &Verdict {
    let found = judgement.verdicts.iter().find(|v| v.target == Some(target) && v.check == check);
    found.unwrap()
}

/// She must give way to one from starboard; the other, from port, is not to be told that she broke
/// Rule 17.
#[test]
fn a_turn_forced_by_another_target_is_excused() {
    let scene = Scene::new(own(6.0).hold(100.0).turn(60.0, 6.0).hold(600.0), from_port())
        .and(from_starboard());
    let judgement = judge(&scene);
    assert_eq!(of(&judgement, 0, Check::Turn).status, NotApplicable);
    assert_eq!(of(&judgement, 0, Check::Turn).detail, "FORCED-BY-TARGET-1");
    // her turn ends the duty to give way before Rule 17 lets go of her
    assert_eq!(of(&judgement, 0, Check::R17Hold).status, Pass);
    assert_eq!(of(&judgement, 0, Check::R17Hold).detail, "EXCUSED-BY-TARGET-1");
    assert_eq!(of(&judgement, 1, Check::Turn).status, Pass);
    assert_eq!(judgement.status(Check::Turn), Pass);
    // alone, the same turn breaks 17(a)(i)
    let alone = Scene::new(own(6.0).hold(100.0).turn(60.0, 6.0).hold(600.0), from_port());
    expect(&judge(&alone), Check::R17Hold, Fail, "FAIL-17AI");
}

/// The same by speed; and what is left of the penalties in the score is a fifth (C_x,gw).
#[test]
fn slowing_down_forced_by_another_target_is_excused() {
    let script = || own(6.0).hold(100.0).speed_to(1.5, 0.2).hold(600.0);
    let alone = judge(&Scene::new(script(), from_port()));
    expect(&alone, Check::R17Hold, Fail, "FAIL-17AI");
    let both = judge(&Scene::new(script(), from_port()).and(from_starboard()));
    let excused = of(&both, 0, Check::R17Hold);
    assert_eq!((excused.status, &*excused.detail), (NotApplicable, "EXCUSED-BY-TARGET-1"));
    let safety = of(&both, 0, Check::Safe).score.unwrap();
    // half of the penalty by speed in each stage in which it was cut: 1 - 0.2 / 2
    let share = excused.score.unwrap() / safety;
    assert!((share - 0.9).abs() < 1e-9 || (share - 0.81).abs() < 1e-9, "{share}");
}

/// Held all the same: where she owed giving way from the entry of stage 2 until she might act, Rule
/// 17(a)(i) was not put to the test; where that duty ended sooner, it was, and is kept.
#[test]
fn a_duty_to_give_way_all_the_time_leaves_nothing_to_hold() {
    let holds = |other: Script| {
        let judgement = judge(&Scene::new(own(6.0).hold(700.0), from_port()).and(other));
        let found = of(&judgement, 0, Check::R17Hold);
        assert!(judgement.pairs[1].role == record::Role::GiveWay, "{judgement:#?}");
        (found.status, found.detail.to_string())
    };
    let excused = (NotApplicable, "EXCUSED-BY-TARGET-1".to_owned());
    assert_eq!(holds(from_starboard()), excused);
    // she passes at 150 s, 130 m off
    assert_eq!(holds(target(900.0, 770.0, 270.0, 6.0)), (Pass, String::new()));
    // her risk opens after that of the ship from port
    assert_eq!(holds(target(2400.0, 2400.0, 270.0, 6.0)), (Pass, String::new()));
}

#[test]
fn a_turn_that_endangers_a_third_ship_fails_8c() {
    // own ship turns away from the one and into the course of another that was to pass wide
    let script = || own(6.0).hold(60.0).turn(40.0, 4.0).hold(500.0);
    let third = target(1550.0, 820.0, 180.0, 2.0);
    let judgement = judge(&Scene::new(script(), head_on()).and(third));
    let found = of(&judgement, 0, Check::R8Third);
    assert_eq!((found.status, found.detail.as_ref()), (Fail, "FAIL-8C-TARGET-1"), "{found:#?}");
    // one at risk before the turn is not newly endangered by it
    let known = judge(&Scene::new(script(), head_on()).and(target(1700.0, 30.0, 180.0, 1.0)));
    assert_eq!(of(&known, 0, Check::R8Third).status, Pass);
    let wide = target(1550.0, -900.0, 180.0, 2.0);
    let judgement = judge(&Scene::new(script(), head_on()).and(wide));
    assert_eq!(of(&judgement, 0, Check::R8Third).status, Pass);
    assert_eq!(judge(&Scene::new(script(), head_on())).status(Check::R8Third), NotApplicable);
}

#[test]
fn the_worst_pair_stands_for_the_run() {
    let scene = Scene::new(own(6.0).hold(60.0).turn(-35.0, 3.0).hold(400.0), head_on())
        .and(target(1500.0, 3000.0, 0.0, 3.0));
    let judgement = judge(&scene);
    assert_eq!(judgement.pairs.len(), 2);
    assert_eq!(judgement.verdicts.len(), 2 * Check::COUNT);
    assert_eq!(of(&judgement, 1, Check::Turn).status, NotApplicable);
    assert_eq!(judgement.status(Check::Turn), Fail);
}
