//! The tracker and its ships: one track through a hard turn, two tracks for two ships. Plots and
//! reports are exact, so that what fails is the association and not the luck of the noise.

mod scenes;

use geom::{Vec2, angle, units::deg};
use nalgebra::Matrix2;
use planner_api::TargetTrack;
use record::Tracker as Settings;
use sim::sensing::tracker::Tracker;
use sim::sensing::{Measurement, Report};

const SETTINGS: Settings = scenes::tracker(0.15);
const ROTATION_S: f64 = 2.5;
const LENGTH_M: f64 = 12.0;

fn plot(t_s: f64, position_m: Vec2) -> Measurement {
    let position_m2 = Matrix2::identity() * 100.0;
    Measurement { t_s, ready_s: t_s, origin: None, position_m, position_m2, report: None }
}

fn report(t_s: f64, position_m: Vec2, velocity_mps: Vec2) -> Measurement {
    let velocity_mps2 = Matrix2::identity() * 0.04;
    let size_m = Some((LENGTH_M, 4.0));
    let report = Report { mmsi: 1, velocity_mps, velocity_mps2, psi_rad: None, size_m };
    let position_m2 = Matrix2::identity() * 25.0;
    Measurement { position_m2, report: Some(report), ..plot(t_s, position_m) }
}

fn shown(tracker: &Tracker, t_s: f64) -> Vec<TargetTrack> {
    let mut tracks = Vec::new();
    tracker.show(t_s, &mut tracks);
    tracks
}

/// Goes north at 9 m/s, turns by `by_rad` at `rate_radps` from 20 s on, and goes on; position and
/// velocity at `t_s`.
fn turning(t_s: f64, by_rad: f64, rate_radps: f64) -> (Vec2, Vec2) {
    let speed_mps = 9.0;
    let turn_s = ((t_s - 20.0) * rate_radps.abs() / by_rad.abs()).clamp(0.0, 1.0);
    let course_rad = by_rad * turn_s;
    let radius_m = speed_mps / (rate_radps.abs() * by_rad.signum());
    let (c, s) = (angle::unit(course_rad).x, angle::unit(course_rad).y);
    let on_circle_m = Vec2::new(s, 1.0 - c) * radius_m;
    let end_s = 20.0 + (by_rad / rate_radps).abs();
    let straight_m = angle::unit(course_rad) * (speed_mps * (t_s - end_s).max(0.0));
    let start_m = Vec2::new(speed_mps * t_s.min(20.0), 0.0);
    (start_m + on_circle_m + straight_m, angle::unit(course_rad) * speed_mps)
}

/// Scans with two tracks shown, and with her own more than 50 m from her, after a turn that her
/// reports say nothing of.
fn ghosts(by_deg: f64, rate_deg_s: f64) -> (u32, u32) {
    let at = |t_s: f64| turning(t_s, deg(by_deg), deg(rate_deg_s));
    let mut tracker = Tracker::new(&SETTINGS);
    let (first_m, first_mps) = at(0.0);
    tracker.report(0.0, &report(0.0, first_m, first_mps));
    let (mut double, mut far) = (0, 0);
    for scan in 1..30 {
        let t_s = ROTATION_S * f64::from(scan);
        let ship_m = at(t_s).0;
        tracker.scan(t_s, &[plot(t_s, ship_m)]);
        tracker.drop_lost(t_s);
        let tracks = shown(&tracker, t_s);
        double += u32::from(tracks.len() > 1);
        let hers = |t: &&TargetTrack| t.length_m == Some(LENGTH_M);
        let off_m = tracks.iter().find(hers).map(|t| (t.position_m - ship_m).norm());
        far += u32::from(off_m.expect("she may coast for 95 s") > 50.0);
    }
    (double, far)
}

/// The limits are those of the design: three plots confirm the new track, and a ship that turns by
/// more than a right angle is recognised once the time since she was last seen allows for it.
#[test]
fn a_ship_that_turns_between_two_reports_soon_has_one_track() {
    for by_deg in [-90.0, 90.0] {
        for rate_deg_s in [3.0, 6.0, 10.0, 20.0, 60.0] {
            let (double, far) = ghosts(by_deg, rate_deg_s);
            assert!(double <= 2 && far <= 4, "{by_deg} at {rate_deg_s}: {double}, {far}");
        }
    }
    for by_deg in [-150.0, 150.0] {
        for (rate_deg_s, double_max) in [(6.0, 2), (10.0, 4), (20.0, 6)] {
            let (double, far) = ghosts(by_deg, rate_deg_s);
            assert!(double <= double_max && far <= 8, "{by_deg} at {rate_deg_s}: {double}, {far}");
        }
    }
}

#[test]
fn two_ships_in_the_same_scans_keep_two_tracks() {
    let mut tracker = Tracker::new(&SETTINGS);
    let velocity_mps = Vec2::new(5.0, 0.0);
    let at = |t_s: f64, east_m: f64| Vec2::new(5.0 * t_s, east_m);
    tracker.report(0.0, &report(0.0, at(0.0, 0.0), velocity_mps));
    for scan in 1..40 {
        let t_s = ROTATION_S * f64::from(scan);
        // abreast, nearer to each other than the gate
        let plots = [plot(t_s, at(t_s, 0.0)), plot(t_s, at(t_s, 18.0))];
        tracker.scan(t_s, &plots);
        if scan >= 5 {
            let tracks = shown(&tracker, t_s);
            let mut east_m: Vec<f64> = tracks.iter().map(|t| t.position_m.y).collect();
            east_m.sort_by(f64::total_cmp);
            assert_eq!(tracks.len(), 2, "{t_s}: {east_m:?}");
            assert!(east_m[0].abs() < 6.0 && (east_m[1] - 18.0).abs() < 6.0, "{east_m:?}");
        }
    }
}

/// The named ship drops out of the radar and turns away; a ship without a name takes her place.
/// The next report says where she is: her track is there, and the other ship keeps one.
#[test]
fn a_report_far_off_gives_the_plots_back_to_the_other_ship() {
    let mut tracker = Tracker::new(&SETTINGS);
    let velocity_mps = Vec2::new(5.0, 0.0);
    let along = |t_s: f64| Vec2::new(5.0 * t_s, 0.0);
    tracker.report(0.0, &report(0.0, along(0.0), velocity_mps));
    for scan in 1..=12 {
        let t_s = ROTATION_S * f64::from(scan);
        tracker.scan(t_s, &[plot(t_s, along(t_s))]);
    }
    let away_m = Vec2::new(0.0, 150.0);
    tracker.report(30.0, &report(30.0, away_m, Vec2::new(0.0, 5.0)));
    for scan in 13..=20 {
        let t_s = ROTATION_S * f64::from(scan);
        let hers_m = away_m + Vec2::new(0.0, 5.0 * (t_s - 30.0));
        tracker.scan(t_s, &[plot(t_s, along(t_s)), plot(t_s, hers_m)]);
        let tracks = shown(&tracker, t_s);
        assert_eq!(tracks.len(), 2, "{t_s}");
        for (length_m, ship_m) in [(Some(LENGTH_M), hers_m), (None, along(t_s))] {
            let track = tracks.iter().find(|t| t.length_m == length_m).expect("a track of hers");
            assert!((track.position_m - ship_m).norm() < 10.0, "{t_s}: {:?}", track.position_m);
        }
    }
}
