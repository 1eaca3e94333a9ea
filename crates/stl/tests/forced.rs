//! Rule 13(d): what the overtaken ship did because of own ship, and what she did not; and the
//! predicted clearance where the hulls meet or part.

mod common;

use common::{Script, USV, deg, run};
use record::{Check, Trace};
use stl::clearance::{Posed, predicted_clearance_m};
use stl::{Finding, judge};

/// Overtakes at 6 m/s, holds on to 240 m, and passes the other 200 m off.
fn fast() -> Script {
    Script { speed_mps: 6.0, ..Script::straight(0.0, 0.0, 0.0, 5.0) }
        .turn(65, 60.0)
        .turn(125, -60.0)
}

fn slow() -> Script {
    Script::straight(500.0, 0.0, 0.0, 2.0)
}

/// What Rule 13 says of a ship that planned to hold and does this, in the company of `third`.
fn overtaken(she: Script, third: Option<Script>) -> Finding {
    let company =
        |she: Script| -> Vec<Script> { std::iter::once(she).chain(third.clone()).collect() };
    let mut trace: Trace = run(&fast(), &company(she), 300);
    trace.nominal.as_mut().expect("planned").targets =
        run(&fast(), &company(slow()), 300).nominal.expect("planned").targets;
    judge(&trace, &USV)[Check::R13 as usize].status
}

#[test]
fn she_is_forced_off_her_course_from_ten_degrees_and_off_her_speed_from_a_quarter() {
    assert_eq!(overtaken(slow(), None), Finding::Holds);
    assert_eq!(overtaken(slow().turn(60, -9.0), None), Finding::Holds);
    assert_eq!(overtaken(slow().turn(60, -11.0), None), Finding::Violated);
    for (by_mps, finding) in [
        (-0.45, Finding::Holds),
        (-0.55, Finding::Violated),
        (0.45, Finding::Holds),
        (0.55, Finding::Violated),
    ] {
        assert_eq!(overtaken(slow().change_speed(60, by_mps), None), finding, "{by_mps}");
    }
}

/// A plan that ends before the run says nothing of what she did after it.
#[test]
fn what_she_did_after_her_plan_has_ended_is_her_own() {
    let altered_at = |from_s: usize| {
        let mut trace = run(&fast(), &[slow().turn(from_s, -20.0)], 300);
        let mut planned = run(&fast(), &[slow()], 100).nominal.expect("planned").targets;
        std::mem::swap(&mut trace.nominal.as_mut().expect("planned").targets, &mut planned);
        judge(&trace, &USV)[Check::R13 as usize].status
    };
    assert_eq!(altered_at(60), Finding::Violated);
    assert_eq!(altered_at(101), Finding::Holds);
}

#[test]
fn what_is_not_held_or_was_done_for_another_is_not_laid_to_own_ship() {
    // off by 12 degrees for 3 s, and for 9
    let jinks = |hold_s: usize| {
        let mut she = slow();
        she.turns = vec![(60, -12.0, 1), (60 + hold_s, 12.0, 1)];
        overtaken(she, None)
    };
    assert_eq!(jinks(3), Finding::Holds);
    assert_eq!(jinks(9), Finding::Violated);
    // a third ship beside her, nearer than own ship and further away
    let beside = |east_m: f64| Some(Script::straight(500.0, east_m, 0.0, 2.0));
    let turns = || slow().turn(60, -20.0);
    assert_eq!(overtaken(turns(), beside(-120.0)), Finding::Holds);
    assert_eq!(overtaken(turns(), beside(-600.0)), Finding::Violated);
}

/// What she left her plan for before there was risk was not own ship's doing, though she stays off
/// it.
#[test]
fn what_she_did_before_there_was_risk_is_her_own() {
    let far = |she: Script| {
        let own = Script { speed_mps: 8.0, ..Script::straight(0.0, 0.0, 0.0, 5.0) };
        let own = own.turn(250, 45.0).turn(330, -45.0);
        let mut trace = run(&own, &[she], 700);
        let plan = Script::straight(2400.0, 0.0, 0.0, 2.0);
        trace.nominal.as_mut().expect("planned").targets =
            run(&own, &[plan], 700).nominal.expect("planned").targets;
        judge(&trace, &USV)[Check::R13 as usize].status
    };
    // risk opens at 1900 m, at 84 s
    let she = || Script::straight(2400.0, 0.0, 0.0, 2.0);
    assert_eq!(far(she()), Finding::Holds);
    assert_eq!(far(she().turn(40, -12.0)), Finding::Holds);
    assert_eq!(far(she().turn(120, -12.0)), Finding::Violated);
}

/// Hulls of 20 by 6 metres that run into one another off their corners, that just miss, and that
/// part.
#[test]
fn clearance_is_zero_on_contact_and_grows_from_there() {
    let trace = run(&slow(), &[slow()], 2);
    let pass = |psi_deg: f64, position: (f64, f64), velocity: (f64, f64)| {
        let own = Posed { ship: &trace.own.ship, psi_rad: 0.0 };
        let target = Posed { ship: &trace.own.ship, psi_rad: deg(psi_deg) };
        predicted_clearance_m(own, target, position, velocity)
    };
    // across own track from either side, aimed off the middle by up to the reach of both
    for side in [-1.0, 1.0] {
        for (aim_m, expected_m) in [(-12.9, 0.0), (-4.0, 0.0), (0.0, 0.0), (7.3, 0.0), (12.9, 0.0)]
        {
            let found = pass(90.0, (aim_m, side * 500.0), (0.0, -side * 5.0));
            assert!((found - expected_m).abs() < 1e-9, "{aim_m}: {found}");
        }
        for aim_m in [-15.0, 14.0] {
            let found = pass(90.0, (aim_m, side * 500.0), (0.0, -side * 5.0));
            assert!((found - (aim_m.abs() - 13.0)).abs() < 1e-9, "{aim_m}: {found}");
        }
        // where own ship is broadest, and going away: as far as she is now
        let parts = pass(90.0, (-3.0, side * 500.0), (0.0, side * 5.0));
        assert!((parts - 487.0).abs() < 1e-9, "{parts}");
    }
    // bow to bow off the centre line, and stern to stern, towards and away
    for aim_m in [-5.9, 2.0, 5.9] {
        assert!(pass(180.0, (400.0, aim_m), (-3.0, 0.0)) < 1e-9);
    }
    assert!((pass(180.0, (400.0, 0.0), (3.0, 0.0)) - 380.0).abs() < 1e-9);
    for aim_m in [-4.1, 0.0, 4.1] {
        assert!((pass(180.0, (-400.0, aim_m), (-3.0, 0.0)) - 380.0).abs() < 1e-9);
    }
}
