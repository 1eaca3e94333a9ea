//! What judging costs: `cargo run --release --package rules --example judge_cost`.
//!
//! One target, 600 samples of one second, all checks; own ship alters course by 35 degrees and
//! returns. Prints microseconds for each judgement of three classes.

use geom::units::deg;
use geom::{HullOutline, Vec2, unit};
use record::{
    DistanceKind, EncounterId, Nominal, Outcome, Pair, PairMinimum, PlannerEvents, Ship, ShipTrack,
    Trace, Visibility,
};
use rules::{Judge, RuleSet};
use std::hint::black_box;

const SAMPLES: usize = 600;
const ROUNDS: u32 = 20_000;

fn main() {
    let text = include_str!("../../../campaigns/rulesets/usv-oe2023-v1.toml");
    let rules = RuleSet::parse(text).expect("the default rule set is sound");
    let mut judge = Judge::new(rules);
    for (name, bearing_deg, course_deg) in
        [("head-on", 0.0, 180.0), ("crossing", 45.0, 270.0), ("from port", -45.0, 90.0)]
    {
        let trace = encounter(bearing_deg, course_deg);
        let judgement = judge.judge(&trace);
        let class = judgement.pairs[0].class;
        #[expect(clippy::disallowed_methods, reason = "a benchmark measures the wall clock")]
        let start = std::time::Instant::now();
        for _ in 0..ROUNDS {
            black_box(judge.judge(black_box(&trace)));
        }
        let each_us = start.elapsed().as_secs_f64() * 1e6 / f64::from(ROUNDS);
        println!("{name:10} {each_us:6.1} us a judgement ({SAMPLES} samples, found {class:?})");
    }
}

fn encounter(bearing_deg: f64, course_deg: f64) -> Trace {
    let own_ship = ship(8.45, 2.7);
    let target_ship = ship(40.0, 8.0);
    let start_m = unit(deg(bearing_deg)) * 1800.0;
    let nominal = sail(&own_ship, Vec2::zeros(), 6.0, |_| 0.0);
    let own = sail(&own_ship, Vec2::zeros(), 6.0, |t_s| match t_s {
        20.0..32.0 => deg(3.0),
        260.0..272.0 => deg(-3.0),
        _ => 0.0,
    });
    let target = sail_from(&target_ship, start_m, deg(course_deg), 6.0, |_| 0.0);
    let pair = |own: &ShipTrack| minimum(own, &target);
    let (hull_m, found) = pair(&own);
    Trace {
        id: EncounterId::new("cost", 0),
        outcome: Outcome::Completed,
        end_s: (SAMPLES - 1) as f64,
        sample_s: 1.0,
        safety_radius_m: 150.0,
        distance: DistanceKind::Hull,
        visibility: Visibility::InSight,
        route: Vec::new(),
        cruise_mps: 6.0,
        pairs: vec![Pair { hull_m, minimum: found, detected_s: Some(0.0), tracked_s: Some(0.0) }],
        hazard_m_min: None,
        orders: Vec::new(),
        alerts: Vec::new(),
        events: PlannerEvents::default(),
        contact: None,
        planner_sector: None,
        planner_detail: None,
        goal_reached: false,
        nominal: Some(Nominal {
            minima: vec![pair(&nominal).1],
            own: nominal,
            targets: vec![target.clone()],
        }),
        last_minute: None,
        unavoidable: None,
        own,
        targets: vec![target],
    }
}

fn ship(length_m: f64, beam_m: f64) -> Ship {
    Ship {
        hull: HullOutline::centred(length_m, beam_m),
        yaw_rate_radps_max: deg(10.0),
        speed_mps_max: 12.0,
        steerage_mps: None,
        stopping: None,
    }
}

fn sail(ship: &Ship, from_m: Vec2, speed_mps: f64, rate: impl Fn(f64) -> f64) -> ShipTrack {
    sail_from(ship, from_m, 0.0, speed_mps, rate)
}

fn sail_from(
    ship: &Ship,
    from_m: Vec2,
    psi_rad: f64,
    speed_mps: f64,
    rate: impl Fn(f64) -> f64,
) -> ShipTrack {
    let mut track = ShipTrack::with_capacity(ship.clone(), SAMPLES);
    let (mut position_m, mut psi_rad) = (from_m, psi_rad);
    for k in 0..SAMPLES {
        let velocity_mps = unit(psi_rad) * speed_mps;
        track.north_m.push(position_m.x);
        track.east_m.push(position_m.y);
        track.psi_rad.push(geom::wrap(psi_rad));
        track.vel_north_mps.push(velocity_mps.x);
        track.vel_east_mps.push(velocity_mps.y);
        track.stw_mps.push(speed_mps);
        track.yaw_rate_radps.push(rate(k as f64));
        position_m += velocity_mps;
        psi_rad += rate(k as f64);
    }
    track
}

/// Distances between circles around the hulls: near enough for a measurement of cost.
fn minimum(own: &ShipTrack, target: &ShipTrack) -> (Vec<f64>, PairMinimum) {
    let radii_m = own.ship.hull.radius_m() + target.ship.hull.radius_m();
    let centre_m: Vec<f64> =
        (0..SAMPLES).map(|k| (target.position_m(k) - own.position_m(k)).norm()).collect();
    let hull_m: Vec<f64> = centre_m.iter().map(|centre_m| (centre_m - radii_m).max(0.1)).collect();
    let nearest = (0..SAMPLES).min_by(|&a, &b| centre_m[a].total_cmp(&centre_m[b]));
    let k = nearest.expect("there are samples");
    let t_s = k as f64;
    let minimum =
        PairMinimum { hull_m: hull_m[k], hull_s: t_s, centre_m: centre_m[k], centre_s: t_s };
    (hull_m, minimum)
}
