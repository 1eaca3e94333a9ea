//! Voyages that lie on the very sample or value where the second judge decides: what one sample
//! more or less would turn round.

#[expect(dead_code, reason = "nobody here changes speed")]
mod common;

use common::{Script, USV, deg, run};
use record::{Check, DistanceKind, Trace, Visibility};
use stl::life::lives;
use stl::runs::heading_runs;
use stl::{Finding, Robustness, judge};

fn own() -> Script {
    Script::straight(0.0, 0.0, 0.0, 5.0)
}

fn finding(trace: &Trace, check: Check) -> Robustness {
    judge(trace, &USV)[check as usize]
}

/// Own ship turns in one second: at `from_s` she holds her heading, a second later the new one.
fn turns_at_once(from_s: usize, degrees: f64) -> Script {
    let mut script = own();
    script.turns.push((from_s, degrees, 1));
    script
}

/// What was turned to port before risk opened was free; in the sample in which it opens it is not.
#[test]
fn a_port_turn_begun_in_the_sample_of_the_onset_is_not_early() {
    let ahead = Script::straight(1500.0, 0.0, 180.0, 5.0);
    let trace = run(&own().turn(0, -15.0).turn(45, 45.0), &[ahead], 300);
    assert_eq!(lives(&trace, &USV)[0].in_sight.as_ref().unwrap().onset, 0);
    let found = finding(&trace, Check::R14);
    // 15 degrees to port where less than 10 are allowed, on a scale of 10
    assert!((found.rho.unwrap() + 0.5).abs() < 1e-6, "{found:?}");
}

/// The plan was in danger from the onset on, the track of own ship never is: risk must hold for
/// 3 s. Who is seen to turn in the sample of the onset had acted by then; a second later she had
/// not, and a turn of 8 degrees to port is not what Rule 14 asks for.
#[test]
fn an_action_seen_first_in_the_sample_of_the_onset_leaves_nothing_to_break() {
    let aside = || Script::straight(6500.0, 190.0, 180.0, 5.0);
    let idle = run(&own(), &[aside()], 800);
    let onset = lives(&idle, &USV)[0].in_sight.as_ref().unwrap().onset;
    assert!(onset > 10, "{onset}");
    let acted = |from_s: usize| {
        let trace = run(&turns_at_once(from_s, -8.0), &[aside()], 800);
        let duty = lives(&trace, &USV).remove(0).in_sight.unwrap();
        (duty.onset, duty.never_opened, finding(&trace, Check::R14).status)
    };
    assert_eq!(acted(onset - 1), (onset, true, Finding::Holds));
    assert_eq!(acted(onset), (onset, true, Finding::Violated));
}

/// Abeam at 150 s: an offset made then is held beyond the end of the clock, and counts.
#[test]
fn an_offset_made_in_the_last_sample_of_the_clock_counts() {
    let found = |from_s: usize| {
        let aside = Script::straight(1500.0, -120.0, 180.0, 5.0);
        let mut trace = run(&turns_at_once(from_s, 12.0), &[aside], 300);
        trace.distance = DistanceKind::Centre;
        assert_eq!(lives(&trace, &USV)[0].in_sight.as_ref().unwrap().end, 150);
        finding(&trace, Check::R14).status
    };
    assert_eq!(found(149), Finding::Holds);
    assert_eq!(found(150), Finding::Violated);
}

/// 0.4 s before the closest point, in its sample, there is still risk: rules for ships in sight
/// begin there if she is seen there.
#[test]
fn a_ship_seen_first_at_the_closest_point_is_met_in_sight() {
    let in_sight_from = |visual_range_m: f64| {
        let aside = Script::straight(1504.0, -120.0, 180.0, 5.0);
        let mut trace = run(&own(), &[aside], 300);
        trace.distance = DistanceKind::Centre;
        trace.visibility = Visibility::Restricted { visual_range_m };
        let life = lives(&trace, &USV).remove(0);
        assert_eq!(life.cpa, 150);
        life.in_sight.map(|duty| duty.onset)
    };
    // 120.81 m at 149 s, 120.07 m at 150 s
    assert_eq!([121.0, 120.5, 120.0].map(in_sight_from), [Some(149), Some(150), None]);
}

/// Risk by radar; the predicted pass is a little too wide to open any when she is seen.
#[test]
fn a_pass_that_would_open_no_risk_is_none_in_sight() {
    let in_sight = |turn_deg: f64| {
        let mut trace =
            run(&own().turn(10, turn_deg), &[Script::straight(1500.0, 0.0, 180.0, 5.0)], 300);
        trace.visibility = Visibility::Restricted { visual_range_m: 500.0 };
        let life = lives(&trace, &USV).remove(0);
        assert!(life.by_radar.is_some());
        (life.actual.predicted_m(life.cpa), life.in_sight.is_some())
    };
    let (wide_m, seen) = in_sight(18.5);
    assert!((205.0..235.0).contains(&wide_m) && !seen, "{wide_m}");
    let (near_m, seen) = in_sight(14.0);
    assert!((120.0..195.0).contains(&near_m) && seen, "{near_m}");
}

/// A spike of one sample is a turn there and a turn back that changes nothing: no alteration, and
/// so nothing that keeps two turns to one side apart.
#[test]
fn a_run_that_changes_nothing_does_not_part_two_turns() {
    let mut heading_deg = vec![0.0; 30];
    heading_deg.extend((1..=10).map(|k| 3.0 * f64::from(k)));
    heading_deg.extend([30.0; 4]);
    heading_deg.push(46.0);
    heading_deg.extend([30.0; 7]);
    heading_deg.extend((1..=10).map(|k| 30.0 + 3.0 * f64::from(k)));
    heading_deg.extend([60.0; 30]);
    let heading_rad: Vec<f64> = heading_deg.iter().map(|&x| deg(x)).collect();
    let found = heading_runs(&heading_rad, &[5.0; 92], deg(0.6), &USV, 1.0);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!((found[0].change - deg(60.0)).abs() < 1e-9, "{found:?}");
}

/// Sampled every 2 s with a deviation of 2 s, the mean takes three samples to either side, weighed
/// exp(-z^2 / 2). A step shows its greatest rate by the weights of the middle two, over 4 s.
#[test]
fn the_mean_is_cut_at_three_standard_deviations() {
    let weight = |z: f64| libm::exp(-0.5 * z * z);
    let rate_deg_s = |reach: u32| {
        let total = 1.0 + 2.0 * (1..=reach).map(|z| weight(f64::from(z))).sum::<f64>();
        9.0 * (1.0 + weight(1.0)) / total / 4.0
    };
    // a kernel that reaches farther has a rate 0.03 % less
    assert!(rate_deg_s(2) > rate_deg_s(3) * 1.004 && rate_deg_s(3) > rate_deg_s(4) * 1.0002);
    let heading_rad: Vec<f64> = (0..80).map(|k| if k < 40 { 0.0 } else { deg(9.0) }).collect();
    let runs =
        |on_deg_s: f64| heading_runs(&heading_rad, &[5.0; 80], deg(on_deg_s), &USV, 2.0).len();
    assert_eq!(runs(rate_deg_s(3) * 0.9999), 1);
    assert_eq!(runs(rate_deg_s(3) * 1.0001), 0);
}

/// 2.64 degrees in the last two seconds: beyond its end the signal goes on as it came, and so the
/// mean shows 0.63 degrees a second where the turn begins. Held from there on it would show 0.57.
#[test]
fn a_turn_in_the_last_seconds_is_a_run() {
    let heading_rad: Vec<f64> = (0..=62).map(|k| deg(1.32 * f64::from((k - 60).max(0)))).collect();
    let found = heading_runs(&heading_rad, &[5.0; 63], deg(0.6), &USV, 1.0);
    let ends: Vec<_> = found.iter().map(|run| (run.start, run.end)).collect();
    assert_eq!(ends, [(60, 62)]);
}
