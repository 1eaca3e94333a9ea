//! AIS, radar and tracker: errors against their own parameters, common random numbers, and tracks
//! that stay with their targets.

mod scenes;

use geom::{Vec2, angle, units::deg, wrap};
use planner_api::{Command, Mission, Planner, Situation, TargetTrack};
use record::{Ais, AisRadar, Encounter, Radar, Sensing, Tracker};
use scenes::{Meeting, Shy, hold, kinematic, run, viknes};
use sim::sensing::fused::{Fused, Instruments};
use sim::sensing::{Measurement, radar::probability};
use sim::ship::Ship;

const AIS: Ais = Ais {
    carried: 1.0,
    class_a_length_m_min: 30.0,
    dropout: 0.1,
    position_sd_m: 6.0,
    sog_sd_mps: 0.2,
    cog_sd_rad: deg(2.0),
    heading_sd_rad: deg(1.5),
    first_delay_s_mean: 0.0,
    static_wrong: 0.0,
    static_missing: 0.0,
    latency_s: 0.0,
};
const RADAR: Radar = Radar {
    rotation_s: 2.5,
    range_sd_m: 8.0,
    bearing_sd_rad: deg(0.7),
    detection_probability: 0.95,
    range_m_half: 3000.0,
    range_m_max: 6000.0,
    clutter_per_scan: 0.5,
    clutter_range_m: 2000.0,
    latency_s: 0.5,
};
const TRACKER: Tracker = scenes::tracker(0.1);

fn settings() -> AisRadar {
    AisRadar { ais: Some(AIS), radar: Some(RADAR), tracker: TRACKER }
}

fn with(mut encounter: Encounter, settings: AisRadar) -> Encounter {
    encounter.sensing = Sensing::AisRadar(Box::new(settings));
    encounter
}

fn ships(encounter: &Encounter) -> (Ship, Vec<Ship>) {
    let ship =
        |hull, vessel, start| Ship::new(hull, vessel, start, Vec2::zeros()).expect("a known model");
    let own = ship(encounter.own.hull, &encounter.own.vessel, &encounter.own.start);
    let targets = encounter.targets.iter().map(|t| ship(t.hull, &t.vessel, &t.start)).collect();
    (own, targets)
}

/// Everything that is measured in `beats` seconds while nobody but own ship moves; she is at
/// `own_m(t)`.
fn measured(
    encounter: &Encounter,
    settings: &AisRadar,
    beats: u32,
    own_m: impl Fn(f64) -> Vec2,
) -> (Vec<Measurement>, u32, Vec<Ship>) {
    let (mut own, targets) = ships(encounter);
    let mut instruments = Instruments::new(settings, encounter, &targets);
    let (mut all, mut scans) = (Vec::new(), 0);
    for beat in 0..beats {
        let t_s = f64::from(beat);
        own.pose.position_m = own_m(t_s);
        scans += u32::from(instruments.measure(settings, t_s, &own, &targets, &mut all));
    }
    (all, scans, targets)
}

/// Mean and standard deviation lie within 4.5 standard errors of 0 and `sd`.
fn assert_normal(what: &str, values: &[f64], sd: f64) {
    let n = values.len() as f64;
    assert!(n > 300.0, "{what}: {n}");
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| v * v).sum::<f64>() / n;
    assert!(mean.abs() < 4.5 * sd / n.sqrt(), "{what}: mean {mean} of {n}");
    let spread = (variance / (sd * sd) - 1.0).abs();
    assert!(spread < 4.5 * (2.0 / n).sqrt(), "{what}: {} for {sd}", variance.sqrt());
}

#[test]
fn errors_are_as_large_as_their_parameters() {
    let encounter =
        Meeting { tcpa_s: 120.0, ..Meeting::default() }.encounter(viknes(), kinematic());
    let (all, scans, targets) = measured(&encounter, &settings(), 20_000, |_| Vec2::zeros());
    let target = &targets[0];
    let truth_m = target.pose.position_m;
    let reports: Vec<_> = all.iter().filter(|m| m.report.is_some()).collect();
    // class A at 11.7 knots: a report each 10 s, one in ten is lost
    let (due, heard) = (2000.0f64, reports.len() as f64);
    assert!((heard - 0.9 * due).abs() < 4.5 * (due * 0.09).sqrt() + 1.0, "{heard}");
    let of = |f: &dyn Fn(&Measurement) -> f64| reports.iter().map(|m| f(m)).collect::<Vec<_>>();
    assert_normal("north", &of(&|m| m.position_m.x - truth_m.x), 6.0);
    assert_normal("east", &of(&|m| m.position_m.y - truth_m.y), 6.0);
    let velocity = |m: &Measurement| m.report.unwrap().velocity_mps;
    assert_normal("speed", &of(&|m| velocity(m).norm() - 6.0), 0.2);
    let course_rad = target.state.psi_rad;
    let off = |m: &Measurement| wrap(angle::direction(velocity(m)) - course_rad);
    assert_normal("course", &of(&off), deg(2.0));
    let heading = |m: &Measurement| wrap(m.report.unwrap().psi_rad.unwrap() - course_rad);
    assert_normal("heading", &of(&heading), deg(1.5));

    assert_eq!(scans, 8000);
    let plots: Vec<_> = all.iter().filter(|m| m.report.is_none()).collect();
    let (true_plots, clutter): (Vec<&Measurement>, Vec<&Measurement>) =
        plots.into_iter().partition(|m| m.origin.is_some());
    let n = f64::from(scans);
    let chance = probability(&RADAR, truth_m.norm());
    assert!((0.5..0.95).contains(&chance));
    let found = true_plots.len() as f64 / n;
    assert!((found - chance).abs() < 4.5 * (chance * (1.0 - chance) / n).sqrt(), "{found}");
    let range_m: Vec<f64> =
        true_plots.iter().map(|m| m.position_m.norm() - truth_m.norm()).collect();
    assert_normal("range", &range_m, 8.0);
    let bearing: Vec<f64> = true_plots
        .iter()
        .map(|m| wrap(angle::direction(m.position_m) - angle::direction(truth_m)))
        .collect();
    assert_normal("bearing", &bearing, deg(0.7));
    let rate = clutter.len() as f64 / n;
    assert!((rate - 0.5).abs() < 4.5 * (0.5 / n).sqrt(), "{rate}");
    // even over the disc: a quarter lies within half the radius
    let inner = clutter.iter().filter(|m| m.position_m.norm() < 1000.0).count() as f64;
    let share = inner / clutter.len() as f64;
    assert!((share - 0.25).abs() < 4.5 * (0.1875 / clutter.len() as f64).sqrt(), "{share}");
}

#[test]
fn transponders_come_in_their_shares() {
    let ais = Ais { carried: 0.7, static_wrong: 0.2, static_missing: 0.3, ..AIS };
    let settings = AisRadar { ais: Some(ais), radar: None, tracker: TRACKER };
    let mut encounter = Meeting::default().encounter(viknes(), kinematic());
    let (n, mut silent, mut missing, mut wrong) = (1500u32, 0.0, 0.0, 0.0);
    for j in 0..n {
        encounter.id.j = u64::from(j);
        let (all, _, _) = measured(&encounter, &settings, 120, |_| Vec2::zeros());
        match all.first().map(|m| m.report.unwrap().size_m) {
            None => silent += 1.0,
            Some(None) => missing += 1.0,
            Some(Some((length_m, _))) => wrong += f64::from((length_m - 40.0f64).abs() > 1e-9),
        }
    }
    let n = f64::from(n);
    for (count, share) in [(silent, 0.3), (missing, 0.7 * 0.3), (wrong, 0.7 * 0.2f64)] {
        let found: f64 = count / n;
        assert!((found - share).abs() < 4.5 * (share * (1.0 - share) / n).sqrt(), "{found}");
    }
}

/// The first report of a class A station at 11.7 knots comes a share of her 10 s after the declared
/// delay, which is exponential; and no report is ready sooner than its latency.
#[test]
fn the_first_report_is_as_late_as_declared() {
    let ais = Ais { first_delay_s_mean: 20.0, dropout: 0.0, latency_s: 3.0, ..AIS };
    let settings = AisRadar { ais: Some(ais), radar: None, tracker: TRACKER };
    let mut encounter = Meeting::default().encounter(viknes(), kinematic());
    let first_s = (0..1500).map(|j| {
        encounter.id.j = j;
        let (all, _, _) = measured(&encounter, &settings, 400, |_| Vec2::zeros());
        assert!(all.iter().all(|m| (m.ready_s - m.t_s - 3.0).abs() < 1e-9));
        all[0].t_s
    });
    let first_s: Vec<f64> = first_s.collect();
    let n = first_s.len() as f64;
    // half an interval for the phase, half a beat for the grid of beats
    let expected_s = 20.0 + 5.0 + 0.5;
    let sd_s = (20.0f64 * 20.0 + 100.0 / 12.0).sqrt();
    let mean_s = first_s.iter().sum::<f64>() / n;
    assert!((mean_s - expected_s).abs() < 4.5 * sd_s / n.sqrt(), "{mean_s}");
    let variance_s2 = first_s.iter().map(|t| (t - mean_s) * (t - mean_s)).sum::<f64>() / n;
    // the fourth moment of an exponential law is nine variances squared
    let spread = variance_s2 / (sd_s * sd_s) - 1.0;
    assert!(spread.abs() < 4.5 * (8.0 / n).sqrt(), "{}", variance_s2.sqrt());
}

/// What each sensor gets wrong about target 0: AIS in metres, radar in range and bearing, with the
/// time; range and bearing are those from own ship.
fn errors(all: &[Measurement], truth_m: Vec2, own_m: impl Fn(f64) -> Vec2) -> Vec<[f64; 4]> {
    let of_first = all.iter().filter(|m| m.origin == Some(0));
    of_first
        .map(|m| {
            if m.report.is_some() {
                let off_m = m.position_m - truth_m;
                return [m.t_s, 1.0, off_m.x, off_m.y];
            }
            let (seen_m, true_m) = (m.position_m - own_m(m.t_s), truth_m - own_m(m.t_s));
            let turn_rad = wrap(angle::direction(seen_m) - angle::direction(true_m));
            [m.t_s, 2.0, seen_m.norm() - true_m.norm(), turn_rad]
        })
        .collect()
}

/// Where both have a measurement of one sensor at one time, it errs alike.
fn assert_same(a: &[[f64; 4]], b: &[[f64; 4]]) {
    let mut common = 0;
    for a in a {
        let at = |b: &&[f64; 4]| (a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9;
        if let Some(b) = b.iter().find(at) {
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9), "{a:?} {b:?}");
            common += 1;
        }
    }
    assert!(common > 80, "{common}");
}

/// Common random numbers: whatever own ship does, whoever else is there, whichever other sensor is
/// on board, a sensor's errors about a target are the same.
#[test]
fn errors_depend_on_no_planner_no_other_target_and_no_other_sensor() {
    let settings = settings();
    let encounter = Meeting::default().encounter(viknes(), kinematic());
    let (stays, leaves) = (|_: f64| Vec2::zeros(), |t_s: f64| Vec2::new(7.0, -3.0) * t_s);
    let (base_all, _, targets) = measured(&encounter, &settings, 300, stays);
    let truth_m = targets[0].pose.position_m;
    let base = errors(&base_all, truth_m, stays);
    let (moved, _, _) = measured(&encounter, &settings, 300, leaves);
    assert_same(&base, &errors(&moved, truth_m, leaves));

    let mut crowded = encounter.clone();
    crowded.targets.push(crowded.targets[0].clone());
    crowded.targets[1].start.position_m += Vec2::new(800.0, 500.0);
    let (all, _, _) = measured(&crowded, &settings, 300, stays);
    assert_same(&base, &errors(&all, truth_m, stays));

    let clutter = |all: &[Measurement]| -> Vec<Measurement> {
        all.iter().filter(|m| m.origin.is_none()).copied().collect()
    };
    assert!(clutter(&base_all).len() > 30);
    assert_eq!(clutter(&base_all), clutter(&all));

    let (plots, reports): (Vec<Measurement>, Vec<Measurement>) =
        base_all.into_iter().partition(|m| m.report.is_none());
    let alone = AisRadar { ais: None, ..settings };
    assert_eq!(measured(&encounter, &alone, 300, stays).0, plots);
    let alone = AisRadar { radar: None, ..settings };
    assert_eq!(measured(&encounter, &alone, 300, stays).0, reports);
}

/// Looks and keeps what it saw.
struct Watch(Vec<(f64, Vec<TargetTrack>)>);

impl Planner for Watch {
    fn reset(&mut self, _: &Mission) {}

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        self.0.push((situation.t_s, situation.tracks.to_vec()));
        Command::course_speed(0.0, 7.0)
    }
}

/// In 200 encounters no confirmed track of the target goes astray: position and velocity stay
/// within what the covariance allows, and the innovations of a target on a straight course are at
/// most as large as the filter says (it allows for manoeuvres that she does not make).
#[test]
fn tracks_stay_with_their_targets() {
    let (mut beats, mut astray, mut seen) = (0u32, 0u32, 0u32);
    for j in 0..200 {
        let course_deg = f64::from(j) * 7.3 - 180.0;
        let meeting =
            Meeting { target_course_rad: deg(course_deg), miss_m: 120.0, ..Meeting::default() };
        let mut encounter = with(meeting.encounter(kinematic(), kinematic()), settings());
        encounter.id.j = u64::from(j as u32);
        let mut watch = Watch(Vec::new());
        let trace = run(&encounter, &mut watch);
        let pair = &trace.pairs[0];
        let (detected_s, tracked_s) = (pair.detected_s.unwrap(), pair.tracked_s.unwrap());
        assert!(detected_s <= tracked_s && tracked_s < 60.0, "{detected_s} {tracked_s}");
        for (t_s, tracks) in &watch.0 {
            let truth_m = trace.targets[0].position_m(t_s.round() as usize);
            let nearest =
                tracks.iter().filter(|t| (t.position_m - truth_m).norm() < 500.0).min_by(|a, b| {
                    let off = |t: &TargetTrack| (t.position_m - truth_m).norm();
                    off(a).total_cmp(&off(b))
                });
            assert!(tracks.iter().all(|t| t.covariance[0][0] > 0.0 && t.sog_mps.is_finite()));
            seen += u32::from(*t_s > tracked_s + 30.0);
            let Some(track) = nearest else { continue };
            if *t_s > tracked_s + 30.0 {
                beats += 1;
                let sd_m = (track.covariance[0][0] + track.covariance[1][1]).sqrt();
                let off_m = (track.position_m - truth_m).norm();
                let off_mps = (track.velocity_mps - trace.targets[0].velocity_mps(0)).norm();
                astray += u32::from(off_m > 4.0 * sd_m.max(5.0) || off_mps > 3.0);
            }
        }
    }
    let (share, held) = (f64::from(astray) / f64::from(beats), f64::from(beats) / f64::from(seen));
    assert!(share < 0.002, "{astray} of {beats}");
    assert!(held > 0.97, "{held}");
}

#[test]
fn innovations_of_a_run_are_within_their_bounds() {
    let encounter = with(Meeting::default().encounter(kinematic(), kinematic()), settings());
    let (own, mut targets) = ships(&encounter);
    let (mut sum, mut count) = (0.0, 0);
    for j in 0..60 {
        let mut encounter = encounter.clone();
        encounter.id.j = j;
        let quiet = AisRadar {
            radar: Some(Radar { clutter_per_scan: 0.0, ..RADAR }),
            tracker: Tracker { acceleration_sd_mps2: 0.01, ..TRACKER },
            ..settings()
        };
        let start = targets[0].clone();
        let mut fused = Fused::new(&quiet, &encounter, &targets);
        let mut tracks = Vec::new();
        for beat in 0..200u32 {
            let t_s = f64::from(beat);
            fused.look(t_s, &own, &targets, &mut tracks);
            targets[0].hold(t_s);
            targets[0].advance(t_s + 1.0, 1.0);
        }
        targets[0] = start;
        let (add, n) = fused.tracker().innovations();
        (sum, count) = (sum + add, count + n);
    }
    // chi-squared of 2, cut off at the gate of 13.8 (one in a thousand); the filter allows for a
    // little more than there is
    let mean = sum / count as f64;
    assert!(count > 4000 && (1.7..2.1).contains(&mean), "{mean} of {count}");
}

#[test]
fn late_and_dropped_pictures_are_told_as_such() {
    let mut slow = settings();
    slow.tracker.frame_drop = 0.3;
    slow.radar = Some(Radar { latency_s: 4.0, ..RADAR });
    slow.ais = None;
    let encounter = with(Meeting::default().encounter(kinematic(), kinematic()), slow);
    let mut watch = Watch(Vec::new());
    let trace = run(&encounter, &mut watch);
    let pair = &trace.pairs[0];
    assert!(pair.detected_s.unwrap() >= 4.0 && pair.tracked_s.unwrap() >= 9.0, "{pair:?}");
    let tracks = watch.0.iter().flat_map(|(_, tracks)| tracks);
    assert!(tracks.clone().all(|t| t.since_update_s >= 4.0 - 1e-9));
    let stands_still = watch.0.windows(2).filter(|pair| {
        let (a, b) = (&pair[0].1, &pair[1].1);
        !a.is_empty() && a.len() == b.len() && a[0].position_m == b[0].position_m
    });
    let shown = watch.0.iter().filter(|(_, tracks)| !tracks.is_empty()).count() as f64;
    let share = stands_still.count() as f64 / shown;
    assert!((share - 0.3).abs() < 4.5 * (0.21 / shown).sqrt() + 0.02, "{share} of {shown}");
    assert!(watch.0.iter().all(|(_, t)| t.iter().all(|t| t.psi_rad.is_none())));
}

/// The same bits again, and another picture for another encounter.
#[test]
fn runs_with_noise_are_repeatable() {
    let mut encounter = with(Meeting::default().encounter(viknes(), kinematic()), settings());
    let digest = |e: &Encounter| record::Digest::of_trace(&run(e, &mut Shy { course_rad: 0.0 }));
    let first = digest(&encounter);
    assert_eq!(first, digest(&encounter));
    encounter.id.j = 1;
    let other = run(&encounter, &mut hold());
    encounter.id.j = 0;
    assert_ne!(other.pairs[0].detected_s, run(&encounter, &mut hold()).pairs[0].detected_s);
    let mut bad = settings();
    bad.tracker.confirm_hits = 9;
    let refused = sim::check(&with(encounter, bad)).unwrap_err().to_string();
    assert!(refused.starts_with("the plots that confirm is 9"), "{refused}");
}
