//! What reaches a planner through sensors, tracker and weather, against the declared parameters;
//! and that two planners meet the same noise until a target reacts to them.

mod scenes;

use geom::{Vec2, angle, units::deg, wrap};
use nalgebra::{Matrix4, Vector4};
use planner_api::{Command, Mission, Planner, Situation, TargetTrack};
use record::{Ais, AisRadar, Conduct, Encounter, Intent, Manner, Radar, Sensing, Trace, Tracker};
use scenes::{Meeting, Orders, kinematic, rough, run, viknes};

const AIS: Ais = Ais {
    carried: 1.0,
    class_a_length_m_min: 30.0,
    dropout: 0.0,
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
    rotation_s: 1.0,
    range_sd_m: 8.0,
    bearing_sd_rad: deg(0.7),
    detection_probability: 0.95,
    range_m_half: 3000.0,
    range_m_max: 6000.0,
    clutter_per_scan: 0.0,
    clutter_range_m: 2000.0,
    latency_s: 0.0,
};
const TRACKER: Tracker = scenes::tracker(1e-4);
/// A filter that expects any manoeuvre believes every measurement: its tracks err as they do.
const CREDULOUS: Tracker = scenes::tracker(1000.0);

/// Sails as told and keeps what it is shown.
struct Watch {
    orders: Orders,
    seen: Vec<Vec<TargetTrack>>,
}

impl Watch {
    fn new(orders: &[(f64, f64, f64)]) -> Self {
        Self { orders: Orders(orders.to_vec()), seen: Vec::new() }
    }
}

impl Planner for Watch {
    fn reset(&mut self, _: &Mission) {}

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        self.seen.push(situation.tracks.to_vec());
        self.orders.plan(situation)
    }
}

const NORTH: [(f64, f64, f64); 1] = [(0.0, 0.0, 7.0)];

/// An encounter by its number: the target's course goes around with it.
fn encounter(j: u64, ais: Option<Ais>, radar: Option<Radar>, tracker: Tracker) -> Encounter {
    let target_course_rad = deg((j % 49) as f64 * 7.3 - 180.0);
    let meeting = Meeting { target_course_rad, miss_m: 200.0, ..Meeting::default() };
    let mut encounter = meeting.encounter(viknes(), kinematic());
    encounter.id.j = j;
    encounter.sensing = Sensing::AisRadar(Box::new(AisRadar { ais, radar, tracker }));
    encounter
}

/// Every track that a planner is shown of the one target within a second of a measurement, with
/// where own ship and the target really are.
fn fresh(encounters: impl Iterator<Item = Encounter>, mut of: impl FnMut(&TargetTrack, Truth)) {
    for encounter in encounters {
        let mut watch = Watch::new(&NORTH);
        let trace = run(&encounter, &mut watch);
        for (beat, tracks) in watch.seen.iter().enumerate().skip(12) {
            for track in tracks.iter().filter(|track| track.since_update_s < 0.99) {
                of(track, Truth::new(&trace, beat));
            }
        }
    }
}

#[derive(Clone, Copy)]
struct Truth {
    own_m: Vec2,
    position_m: Vec2,
    velocity_mps: Vec2,
    psi_rad: f64,
}

impl Truth {
    fn new(trace: &Trace, beat: usize) -> Self {
        let target = &trace.targets[0];
        Self {
            own_m: trace.own.position_m(beat),
            position_m: target.position_m(beat),
            velocity_mps: target.velocity_mps(beat),
            psi_rad: target.psi_rad[beat],
        }
    }
}

/// Mean and standard deviation lie within 4.5 standard errors of 0 and `sd`.
fn assert_normal(what: &str, values: &[f64], sd: f64) {
    let n = values.len() as f64;
    assert!(n > 1000.0, "{what}: {n}");
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| v * v).sum::<f64>() / n;
    assert!(mean.abs() < 4.5 * sd / n.sqrt(), "{what}: mean {mean} of {n}");
    let spread = (variance / (sd * sd) - 1.0).abs();
    assert!(spread < 4.5 * (2.0 / n).sqrt(), "{what}: {} for {sd}", variance.sqrt());
}

#[test]
fn a_planner_feels_the_declared_errors_of_ais() {
    let [mut north, mut east, mut speed, mut course, mut heading] = [(); 5].map(|()| Vec::new());
    let encounters = (0..120).map(|j| encounter(j, Some(AIS), None, CREDULOUS));
    fresh(encounters, |track, truth| {
        let off_m = track.position_m - truth.position_m;
        north.push(off_m.x);
        east.push(off_m.y);
        speed.push(track.sog_mps - truth.velocity_mps.norm());
        course.push(wrap(track.cog_rad - angle::direction(truth.velocity_mps)));
        heading.push(wrap(track.psi_rad.unwrap() - truth.psi_rad));
    });
    assert_normal("north", &north, AIS.position_sd_m);
    assert_normal("east", &east, AIS.position_sd_m);
    assert_normal("speed", &speed, AIS.sog_sd_mps);
    assert_normal("course", &course, AIS.cog_sd_rad);
    assert_normal("heading", &heading, AIS.heading_sd_rad);
}

#[test]
fn a_planner_feels_the_declared_errors_of_radar() {
    let [mut range, mut bearing] = [(); 2].map(|()| Vec::new());
    let encounters = (0..30).map(|j| encounter(j, None, Some(RADAR), CREDULOUS));
    fresh(encounters, |track, truth| {
        let (seen_m, true_m) = (track.position_m - truth.own_m, truth.position_m - truth.own_m);
        range.push(seen_m.norm() - true_m.norm());
        bearing.push(wrap(angle::direction(seen_m) - angle::direction(true_m)));
    });
    assert_normal("range", &range, RADAR.range_sd_m);
    assert_normal("bearing", &bearing, RADAR.bearing_sd_rad);
}

/// Squared error of position and velocity in units of the covariance that the planner is shown:
/// chi-squared with four degrees of freedom where the filter is right.
fn normalised_error(track: &TargetTrack, truth: &Truth) -> f64 {
    let off_m = track.position_m - truth.position_m;
    let off_mps = track.velocity_mps - truth.velocity_mps;
    let off = Vector4::new(off_m.x, off_m.y, off_mps.x, off_mps.y);
    let covariance = Matrix4::from_fn(|i, k| track.covariance[i][k]);
    off.dot(&covariance.cholesky().expect("a covariance is positive definite").solve(&off))
}

/// Mean over the beats of each run, then over the runs, with the standard error of that: beats of
/// one run depend on one another, runs do not.
fn mean_normalised_error(runs: u64, encounter: impl Fn(u64) -> Encounter) -> (f64, f64) {
    let means = (0..runs).map(|j| {
        let (mut sum, mut n) = (0.0, 0.0);
        let mut watch = Watch::new(&NORTH);
        let trace = run(&encounter(j), &mut watch);
        for (beat, tracks) in watch.seen.iter().enumerate().skip(30) {
            let truth = Truth::new(&trace, beat);
            for track in tracks {
                sum += normalised_error(track, &truth);
                n += 1.0;
            }
        }
        sum / n
    });
    let means: Vec<f64> = means.collect();
    let n = means.len() as f64;
    let mean = means.iter().sum::<f64>() / n;
    let variance = means.iter().map(|m| (m - mean) * (m - mean)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

/// Over whole runs, at every beat that the planner sees: the errors of a target that keeps her
/// velocity are as large as the covariance says, for each sensor and for both together; one that
/// is allowed more acceleration than she has says too much, never too little.
#[test]
fn errors_of_whole_runs_are_as_large_as_the_covariance_says() {
    for (what, ais, radar) in
        [("ais", Some(AIS), None), ("radar", None, Some(RADAR)), ("both", Some(AIS), Some(RADAR))]
    {
        let (mean, error) = mean_normalised_error(80, |j| encounter(j, ais, radar, TRACKER));
        // chi-squared of 4 degrees of freedom: mean 4
        assert!((mean - 4.0).abs() < 4.5 * error && error < 0.3, "{what}: {mean} +- {error}");
        let cautious = Tracker { acceleration_sd_mps2: 0.15, ..TRACKER };
        let (mean, error) = mean_normalised_error(80, |j| encounter(j, ais, radar, cautious));
        assert!(mean + 4.5 * error < 4.0 && mean > 1.0, "{what}, cautious: {mean} +- {error}");
    }
}

/// Common random numbers with a target that has to give way: under two planners, one of which turns
/// off at once, her track in the weather and every AIS report of her are the same to the last bit
/// until she reacts to own ship; then they part.
#[test]
fn a_complying_target_and_her_noise_are_the_same_until_she_reacts() {
    let conduct = Conduct {
        manner: Manner::Complies,
        act_tcpa_s: 60.0,
        risk_dcpa_m: 300.0,
        course_change_rad: deg(40.0),
        stand_on_tcpa_s: 40.0,
        stand_on_dcpa_m: 100.0,
    };
    let world = |intent: Intent| {
        // from own port side: she gives way, a minute before the closest point after 150 s
        let meeting = Meeting { target_course_rad: deg(90.0), ..Meeting::default() };
        let mut encounter = meeting.encounter(viknes(), kinematic());
        encounter.targets[0].intent = intent;
        encounter.weather = rough();
        let ais = Ais { dropout: 0.2, first_delay_s_mean: 5.0, latency_s: 1.0, ..AIS };
        let tracker = Tracker { frame_drop: 0.1, ..TRACKER };
        encounter.sensing =
            Sensing::AisRadar(Box::new(AisRadar { ais: Some(ais), radar: None, tracker }));
        encounter
    };
    let sail = |intent: Intent, orders: &[(f64, f64, f64)]| {
        let mut watch = Watch::new(orders);
        let trace = run(&world(intent), &mut watch);
        (trace, watch.seen)
    };
    let veers = [(0.0, 0.0, 7.0), (10.0, deg(15.0), 6.0)];
    let (held, seen_by_held) = sail(Intent::Duty(conduct), &NORTH);
    let (veered, seen_by_veered) = sail(Intent::Duty(conduct), &veers);
    let (blind, _) = sail(Intent::HoldCourse, &NORTH);
    let parts = |a: &Trace, b: &Trace| {
        let (a, b) = (&a.targets[0], &b.targets[0]);
        let same = |k: &usize| {
            let bits = |t: &record::ShipTrack| {
                [t.north_m[*k], t.east_m[*k], t.psi_rad[*k], t.stw_mps[*k]].map(f64::to_bits)
            };
            bits(a) != bits(b)
        };
        (0..a.north_m.len().min(b.north_m.len())).find(same)
    };
    // without the duty she never turns: with it the tracks part when she acts
    let (by_held, by_veered) = (parts(&held, &blind).unwrap(), parts(&veered, &blind).unwrap());
    let first = by_held.min(by_veered);
    assert!((80..=110).contains(&by_held) && first > 70, "{by_held} {by_veered}");
    assert_eq!(parts(&held, &veered), Some(first), "they part no sooner than she reacts");
    let apart_m = (held.own.position_m(first) - veered.own.position_m(first)).norm();
    assert!(apart_m > 80.0, "own ships were elsewhere by then: {apart_m}");
    // what AIS says does not depend on where own ship listens
    let until = first - 2;
    assert_eq!(seen_by_held[..until], seen_by_veered[..until]);
    let heard = seen_by_held[..until].iter().filter(|tracks| !tracks.is_empty()).count();
    assert!(heard > until / 2, "{heard} of {until}");
}
