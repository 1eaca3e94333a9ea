//! Voyages that seldom come about, in which a small mistake of the judge would give another
//! verdict: a run that starts while she turns, and a ship that has turned right round when the
//! other passes.

use super::*;

/// Status and detail of a check of the only pair.
fn said(trace: &Trace, check: Check) -> (Status, String) {
    let judgement = judge_by(rules(), trace);
    let verdict = verdict(&judgement, check);
    (verdict.status, verdict.detail.to_string())
}

/// The trace as one with a sample in two seconds.
fn every_second_sample(mut trace: Trace) -> Trace {
    for track in [&mut trace.own].into_iter().chain(&mut trace.targets) {
        for signal in track.signals_mut() {
            *signal = signal.iter().copied().step_by(2).collect();
        }
    }
    for pair in &mut trace.pairs {
        pair.hull_m = pair.hull_m.iter().copied().step_by(2).collect();
    }
    trace.sample_s = 2.0;
    trace
}

/// Turns by 4 degrees in the first seconds, to the east, and meets a ship head-on.
fn starts_turning(rate_deg_s: f64) -> Trace {
    let own = Script::new(ship(10.0, 3.0), 0.0, 0.0, deg(86.0), 5.0).turn(4.0, rate_deg_s);
    let other = Script::new(ship(40.0, 8.0), 0.0, 1500.0, deg(270.0), 5.0).hold(240.0);
    Scene::new(own.hold(230.0), other).without_nominal().trace()
}

/// A turn begins at 0.6 degrees a second: 0.4 makes none of 4 degrees, be it under way when the run
/// starts or not, and 1 does.
#[test]
fn a_run_that_starts_in_a_turn_has_her_rate_from_the_first_sample_on() {
    for thin in [|trace: Trace| trace, every_second_sample] {
        let of = |rate_deg_s| said(&thin(starts_turning(rate_deg_s)), Check::Turn).0;
        assert_eq!(of(0.4), Status::NotApplicable);
        assert_eq!(of(1.0), Status::Pass);
    }
}

/// Own ship meets another head-on, turns right round to starboard and is overtaken: whichever side
/// she is passed on, one of the two sees the other to starboard, and that is not port to port.
#[test]
fn port_to_port_is_asked_of_both_ships() {
    // own ship ends 95 m to the east of where she began, heading south
    for east_m in [190.0, -60.0] {
        let own = Script::new(ship(10.0, 3.0), 0.0, 0.0, 0.0, 5.0).hold(30.0).turn(180.0, 6.0);
        let other = Script::new(ship(40.0, 8.0), 1500.0, east_m, deg(180.0), 8.0).hold(600.0);
        let trace = Scene::new(own.hold(500.0), other).trace();
        let expected = (Status::Warn, "NOT-PORT-TO-PORT".to_owned());
        assert_eq!(said(&trace, Check::R14), expected, "{east_m} m");
    }
}

/// She stops, and then her head swings by 20 degrees: fast, and too slowly for a rate. A ship
/// without way does not manoeuvre by it, whether it is asked for runs or for an offset; one that
/// keeps a little way does (section 5).
#[test]
fn a_ship_that_lies_still_and_swings_has_not_turned() {
    for rate in [2.0, 0.25] {
        for side in [1.0, -1.0] {
            let judged = |left_mps: f64| {
                let stops = own(6.0).hold(60.0).speed_to(left_mps, 0.5).hold(20.0);
                judge(&Scene::new(stops.turn(side * 20.0, rate).hold(300.0), head_on()))
            };
            let still = judged(0.1);
            expect(&still, Check::Turn, Status::NotApplicable, "NO-TURN");
            expect(&still, Check::R14, Status::Fail, "FAIL-14-NOACT");
            assert_eq!(still.pairs[0].first_turn_rad, None);
            let slow = judged(0.5);
            assert_ne!(slow.status(Check::Turn), Status::NotApplicable, "{rate} {side}: {slow:#?}");
        }
    }
}
