//! Laws of the second judge, of its runs and of its predicted clearance.

mod common;

use common::{Script, USV, deg, run};
use proptest::prelude::*;
use record::{Check, ShipTrack, Trace};
use stl::action::Deviation;
use stl::checks::{Case, Claim};
use stl::clearance::{Posed, predicted_clearance_m};
use stl::life::lives;
use stl::runs::{Run, heading_runs};
use stl::{Finding, WITH_FORMULA, judge, robustness, truth};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// What the judge says has the sign that the plain boolean recursion has.
    #[test]
    fn every_verdict_agrees_with_its_boolean_truth(own in own_ships(), target in targets()) {
        let trace = run(&own, &[target], 260);
        let lives = lives(&trace, &USV);
        let deviation = Deviation::of(&trace, &USV);
        let case = Case::new(&trace, &USV, &lives, &deviation, 0);
        for check in WITH_FORMULA {
            if let Claim::Formula { formula, signals, .. } = case.claim(check) {
                prop_assert!(signals.is_finite());
                let rho = robustness(&formula, &signals).unwrap()[0];
                let holds = truth(&formula, &signals, 0).unwrap();
                prop_assert!(if holds { rho >= 0.0 } else { rho <= 0.0 }, "{check:?} {rho}");
            }
        }
    }

    /// A turn of the chart changes nothing but the last bits.
    #[test]
    fn rotation_changes_nothing(own in own_ships(), target in targets(), by in 0.2f64..6.0) {
        let trace = run(&own, &[target], 260);
        let mut turned = trace.clone();
        let (sin, cos) = libm::sincos(by);
        for_each_track(&mut turned, |track| {
            rotate(&mut track.north_m, &mut track.east_m, sin, cos);
            rotate(&mut track.vel_north_mps, &mut track.vel_east_mps, sin, cos);
            for psi in &mut track.psi_rad {
                *psi = stl::signals::wrapped_rad(*psi + by);
            }
        });
        prop_assert_eq!(agree(&trace, &turned, |_| true), Ok(()));
    }

    /// Mirrored, the checks that know no side say the same.
    #[test]
    fn mirroring_keeps_what_knows_no_side(own in own_ships(), target in targets()) {
        let trace = run(&own, &[target], 260);
        let mut mirrored = trace.clone();
        for_each_track(&mut mirrored, |track| {
            let sided = [&mut track.east_m, &mut track.vel_east_mps, &mut track.psi_rad,
                &mut track.yaw_rate_radps];
            for value in sided.into_iter().flatten() {
                *value = -*value;
            }
        });
        // The distance that suffices is that of the role, so only a distance that suffices for
        // every role, or for none, is the same for all.
        let d = trace.pairs[0].minimum.hull_m;
        if !(USV.near_miss_m..USV.minimum_m).contains(&d) {
            let status = |trace: &Trace| judge(trace, &USV)[Check::Safe as usize].status;
            prop_assert_eq!(status(&trace), status(&mirrored));
        }
        let both = |check| matches!(check, Check::R13);
        prop_assert!(agree(&trace, &mirrored, both).is_ok());
    }

    /// The same encounter begun some seconds earlier gets the same robustness.
    #[test]
    fn time_shift_changes_nothing(
        shift in 1usize..60, at in 80usize..200, turn in -50f64..50.0, miss in -150f64..150.0,
    ) {
        prop_assume!(turn.abs() > 1.0);
        let encounter = |extra: usize| {
            let gone = 5.0 * extra as f64;
            let own = Script::straight(-gone, 0.0, 0.0, 5.0).turn(at + extra, turn);
            let other = Script::straight(2300.0 + gone, miss, 180.0, 5.0);
            run(&own, &[other], 420 + extra)
        };
        let (now, earlier) = (encounter(0), encounter(shift));
        prop_assert_eq!(agree(&now, &earlier, |_| true), Ok(()));
    }

    /// A ship that acts before risk opens never fails for having nothing left to do.
    #[test]
    fn acting_early_never_fails(at in 5usize..60, turn in 10.5f64..60.0, side in any::<bool>()) {
        let turn = if side { turn } else { -turn };
        let own = Script::straight(0.0, 0.0, 0.0, 5.0).turn(at, turn);
        let far = Script::straight(4000.0, 0.0, 180.0, 5.0);
        let trace = run(&own, &[far], 800);
        for found in judge(&trace, &USV) {
            prop_assert_ne!(found.status, Finding::Violated, "{:?}", found);
        }
    }

    /// A run cut short is never said to hold, and what it says is broken is broken in the whole.
    #[test]
    fn a_cut_run_is_never_trusted(own in own_ships(), target in targets(), at in 5usize..130) {
        let whole = run(&own, std::slice::from_ref(&target), 260);
        let mut cut = run(&own, &[target], at.min(whole.samples()));
        cut.nominal = whole.nominal.clone();
        prop_assume!(!lives(&cut, &USV)[0].cpa_passed);
        let after = judge(&whole, &USV);
        for (before, after) in judge(&cut, &USV).iter().zip(after) {
            // The clock of Rule 17(a)(i) ends where she may act, which can lie inside.
            if before.check != Check::R17Hold {
                prop_assert_ne!(before.status, Finding::Holds, "{:?}", before);
            }
            if before.check == Check::Safe && before.status == Finding::Violated {
                prop_assert_eq!(after.status, Finding::Violated);
            }
        }
    }
}

#[test]
fn one_turn_is_one_run_however_fast() {
    for rate_deg in [0.25, 1.0, 3.0, 6.0] {
        let seconds = (35.0 / rate_deg) as usize;
        let found = runs_of(&[(30, rate_deg, seconds)]);
        let rest = 35.0 - rate_deg * seconds as f64;
        assert_eq!(found.len(), 1, "{rate_deg} deg/s: {found:?}");
        let size = found[0].change.to_degrees();
        assert!((size + rest - 35.0).abs() <= 2.0, "{rate_deg} deg/s: {size}");
    }
}

#[test]
fn turns_with_a_pause_are_several_runs() {
    assert_eq!(runs_of(&[(30, 3.0, 5), (60, 2.0, 10)]).len(), 2);
    let five: Vec<(usize, f64, usize)> = (0..5).map(|i| (30 + 25 * i, 2.0, 4)).collect();
    let found = runs_of(&five);
    assert_eq!(found.len(), 5, "{found:?}");
    assert!(found.iter().all(|run| (run.change.to_degrees() - 8.0).abs() < 1.0));
    let there_and_back = runs_of(&[(30, 3.0, 10), (60, -3.0, 10)]);
    assert_eq!(there_and_back.len(), 2);
    assert!(there_and_back[0].change > 0.0 && there_and_back[1].change < 0.0);
    assert!(runs_of(&[(30, 1.0, 1)]).is_empty());
}

#[test]
fn predicted_clearance_of_known_passes() {
    let trace =
        run(&Script::straight(0.0, 0.0, 0.0, 5.0), &[Script::straight(0.0, 0.0, 180.0, 5.0)], 2);
    let pass = |psi_deg: f64, position: (f64, f64), velocity: (f64, f64)| {
        let own = Posed { ship: &trace.own.ship, psi_rad: 0.0 };
        let target = Posed { ship: &trace.own.ship, psi_rad: deg(psi_deg) };
        predicted_clearance_m(own, target, position, velocity)
    };
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a}, expected {b}");
    // Opposite courses 100 m apart: less two half-beams of 3 m.
    near(pass(180.0, (1000.0, 100.0), (-10.0, 0.0)), 94.0);
    // Right ahead, going away: stern to bow, less two half-lengths of 10 m.
    near(pass(0.0, (100.0, 0.0), (5.0, 0.0)), 80.0);
    // Bow to bow.
    near(pass(180.0, (500.0, 0.0), (-10.0, 0.0)), 0.0);
    // Passing 40 m ahead of the bow on a crossing course: her broad side comes within 27 m.
    near(pass(90.0, (40.0, -500.0), (0.0, 5.0)), 27.0);
    // Overlapping now.
    near(pass(0.0, (5.0, 2.0), (5.0, 0.0)), 0.0);
}

fn runs_of(turns: &[(usize, f64, usize)]) -> Vec<Run> {
    let mut own = Script::straight(0.0, 0.0, 0.0, 5.0);
    own.turns = turns.to_vec();
    let trace = run(&own, &[Script::straight(0.0, 9000.0, 0.0, 5.0)], 320);
    let deviation = Deviation::of(&trace, &USV);
    let speed_mps = vec![5.0; deviation.heading_rad.len()];
    heading_runs(&deviation.heading_rad, &speed_mps, deg(0.6), &USV, 1.0)
}

fn own_ships() -> impl Strategy<Value = Script> {
    (3f64..8.0, 5usize..140, -60f64..60.0, 5usize..140, -3f64..3.0, any::<[bool; 2]>()).prop_map(
        |(speed, turn_at, turn, speed_at, change, [turns, slows])| {
            let own = Script::straight(0.0, 0.0, 0.0, speed);
            let own = if turns && turn.abs() > 0.5 { own.turn(turn_at, turn) } else { own };
            let change = change.max(0.5 - speed);
            if slows && change.abs() > 0.1 { own.change_speed(speed_at, change) } else { own }
        },
    )
}

fn targets() -> impl Strategy<Value = Script> {
    (300f64..1500.0, -170f64..170.0, -170f64..170.0, 0.5f64..9.0).prop_map(
        |(range, bearing, psi, speed)| {
            let (sin, cos) = libm::sincos(deg(bearing));
            Script::straight(range * cos, range * sin, psi, speed)
        },
    )
}

fn for_each_track(trace: &mut Trace, change: impl Fn(&mut ShipTrack)) {
    let nominal = trace.nominal.as_mut().expect("runs have a nominal track");
    let planned = std::iter::once(&mut nominal.own).chain(&mut nominal.targets);
    std::iter::once(&mut trace.own).chain(&mut trace.targets).chain(planned).for_each(change);
}

fn rotate(north: &mut [f64], east: &mut [f64], sin: f64, cos: f64) {
    for (n, e) in north.iter_mut().zip(east) {
        (*n, *e) = (cos * *n - sin * *e, sin * *n + cos * *e);
    }
}

fn agree(a: &Trace, b: &Trace, of: impl Fn(Check) -> bool) -> Result<(), String> {
    for (a, b) in judge(a, &USV).iter().zip(judge(b, &USV)).filter(|(a, _)| of(a.check)) {
        let same =
            a.status == b.status && (a.rho.unwrap_or(0.0) - b.rho.unwrap_or(0.0)).abs() < 1e-6;
        if !same {
            return Err(format!("{a:?} {b:?}"));
        }
    }
    Ok(())
}
