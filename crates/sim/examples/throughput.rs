//! What a run costs: 20 simulated minutes of two 3-DOF vessels, against the same vessels
//! integrated by a bare loop.
//!
//! `cargo run --release -p sim --example throughput`

use geom::{HullOutline, Vec2, units::deg};
use planner_api::{Command, Mission, Planner, Situation};
use record::{
    DistanceKind, Encounter, EncounterId, Intent, Motion, OwnShip, RunLimits, RunUntil, Seed,
    Sensing, Target, Vessel, Visibility, Waypoint, Weather,
};
use sim::vessel::{Helm, Model, State};
use std::hint::black_box;
use std::sync::LazyLock;
use std::sync::atomic::AtomicU64;
use std::time::Instant;

const DURATION_S: f64 = 1200.0;
const RUNS: u64 = 400;

fn main() {
    println!("step_s  floor/s  run/s  ratio  nominal/s  share  digest/s  bare us/ship-step");
    for step_s in [0.25, 0.5, 1.0] {
        let encounters: Vec<Encounter> = (0..RUNS).map(|j| encounter(j, step_s)).collect();
        let (floor, run, nominal, digest) = measure(&encounters, step_s);
        let ship_steps = 2.0 * DURATION_S / step_s;
        println!(
            "{step_s:6} {floor:8.0} {run:6.0} {:6.2} {nominal:10.0} {:6.3} {digest:9.0} {:8.4}",
            floor / run,
            run / nominal,
            1e6 / (floor * ship_steps),
        );
    }
}

/// Encounters a second: bare loop, run, nominal track, digest.
fn measure(encounters: &[Encounter], step_s: f64) -> (f64, f64, f64, f64) {
    let beat = AtomicU64::new(0);
    let mut scratch = sim::Scratch::default();
    let mut best = [0f64; 4];
    for _ in 0..5 {
        let mut traces = Vec::new();
        let rates = [
            rate(encounters, |e| bare(e, step_s)),
            rate(encounters, |e| {
                let trace = sim::run(e, &mut Weave, &mut scratch, &beat);
                if traces.len() < 20 {
                    traces.push(trace);
                }
            }),
            rate(encounters, |e| {
                black_box(sim::nominal(e));
            }),
        ];
        let digest = rate(encounters, |e| {
            black_box(record::Digest::of_trace(&traces[e.id.j as usize % traces.len()]));
        });
        for (best, rate) in best.iter_mut().zip(rates.into_iter().chain([digest])) {
            *best = best.max(rate);
        }
    }
    (best[0], best[1], best[2], best[3])
}

fn rate(encounters: &[Encounter], mut f: impl FnMut(&Encounter)) -> f64 {
    let start_s = clock_s();
    encounters.iter().for_each(&mut f);
    encounters.len() as f64 / (clock_s() - start_s)
}

/// Time that this thread had a processor, where Linux tells it; wall-clock time elsewhere.
#[expect(clippy::disallowed_methods, reason = "this program measures time and nothing else")]
fn clock_s() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    let on_cpu = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = on_cpu.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| START.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// Two ships under the orders of [`Weave`], nothing else.
fn bare(encounter: &Encounter, step_s: f64) {
    let model = Model::of(&encounter.own.vessel).expect("a known model");
    let mut ships = [&encounter.own.start, &encounter.targets[0].start]
        .map(|s| State::ahead(s.position_m, s.psi_rad, s.speed_mps));
    let hold =
        |s: &State| Helm { psi_rad: s.psi_rad, direction: s.heading, speed_mps: s.surge_mps };
    let mut helms = [hold(&ships[0]), hold(&ships[1])];
    let steps_a_beat = (1.0 / step_s) as usize;
    for second in 0..DURATION_S as usize {
        helms[0] = Helm::over_ground(weave(second as f64), 7.0, Vec2::zeros());
        for _ in 0..steps_a_beat {
            for (ship, helm) in ships.iter_mut().zip(&helms) {
                *ship = model.step(ship, helm, Vec2::zeros(), step_s);
            }
        }
    }
    black_box(ships);
}

/// Alters course every two minutes.
fn weave(t_s: f64) -> f64 {
    if ((t_s / 120.0) as u64).is_multiple_of(2) { 0.0 } else { deg(35.0) }
}

struct Weave;

impl Planner for Weave {
    fn reset(&mut self, _: &Mission) {}

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        Command::course_speed(weave(situation.t_s), 7.0)
    }
}

/// A crossing with its closest point within 150 m.
fn encounter(j: u64, step_s: f64) -> Encounter {
    let course_rad = deg(-170.0 + (j % 17) as f64 * 10.0);
    let velocity = geom::unit(course_rad) * 6.0;
    let relative = velocity - Vec2::new(7.0, 0.0);
    let side = Vec2::new(-relative.y, relative.x) / relative.norm();
    let miss_m = 60.0 + (j % 7) as f64 * 15.0;
    let motion = |position_m, psi_rad, speed_mps| Motion { position_m, psi_rad, speed_mps };
    let vessel = || Vessel::Model("viknes".to_owned());
    let hull = HullOutline::centred(8.45, 2.71);
    Encounter {
        id: EncounterId::new("throughput", j),
        seed: Seed(1),
        weight: 1.0,
        own: OwnShip {
            hull,
            vessel: vessel(),
            start: motion(Vec2::zeros(), 0.0, 7.0),
            route: vec![Waypoint { position_m: Vec2::new(9000.0, 0.0), speed_mps: None }],
            cruise_mps: 7.0,
        },
        targets: vec![Target {
            hull,
            vessel: vessel(),
            start: motion(side * miss_m - relative * 115.0, course_rad, 6.0),
            intent: Intent::HoldCourse,
        }],
        hazards: Vec::new(),
        weather: Weather::default(),
        sensing: Sensing::Perfect { detection_range_m: None },
        visibility: Visibility::InSight,
        asked: None,
        safety_radius_m: 150.0,
        distance: DistanceKind::Hull,
        run: RunLimits {
            step_s,
            beat_s: 1.0,
            duration_s_max: DURATION_S,
            until: RunUntil::TimeIsUp,
        },
    }
}
