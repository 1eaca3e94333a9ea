//! What one beat of a planner from outside costs, JSON included:
//! `cargo run --release --package planner-host --example round_trip -- PLANNER...`
//!
//! Each planner is asked 20,000 times with one track that is never a danger, so that a good planner
//! has next to nothing to compute. The mean is that of a whole loop; the quantiles are of single
//! calls and hold what reading the clock costs. `rust` is the small planner of `examples/rust`,
//! called: what a call into a library costs more than that is what the library costs.

#[path = "../../../examples/rust/src/planner.rs"]
#[expect(unreachable_pub, reason = "the module of an example's binary")]
mod small_vo;

use geom::Vec2;
use planner_api::{Mission, OwnShip, OwnState, Planner, Situation, TargetTrack, Waypoint};
use std::time::Instant;

const CALLS: u32 = 20_000;

fn main() {
    let names: Vec<String> = std::env::args().skip(1).collect();
    if names.is_empty() {
        eprintln!("name planners: rust, exec:COMMAND, lib:FILE");
        std::process::exit(2);
    }
    println!("{:>8} {:>8} {:>8} {:>8}  planner, us per call", "mean", "median", "p99", "max");
    for name in names {
        if name == "rust" {
            measure(&name, &mut small_vo::SmallVo::default());
            continue;
        }
        let entry = match planner_host::outside(&name) {
            Some(Ok(entry)) => entry,
            Some(Err(error)) => panic!("{error}"),
            None => panic!("`{name}` is neither exec: nor lib:"),
        };
        let mut planner = (entry.make)(&entry.options).expect("the planner can be made");
        measure(&name, planner.as_mut());
    }
}

fn measure(name: &str, planner: &mut dyn Planner) {
    planner.reset(&mission());
    let mut ask = |beat: u32| {
        let t_s = f64::from(beat);
        let (own, track) = scene(t_s);
        let tracks = [track];
        let situation = Situation { t_s, own, tracks: &tracks, visual_range_m: None };
        std::hint::black_box(planner.plan(std::hint::black_box(&situation)));
    };
    let whole = now();
    (0..CALLS).for_each(&mut ask);
    let mean = whole.elapsed().as_secs_f64() * 1e6 / f64::from(CALLS);
    let mut taken_us: Vec<f64> = (0..CALLS)
        .map(|beat| {
            let started = now();
            ask(beat);
            started.elapsed().as_secs_f64() * 1e6
        })
        .collect();
    taken_us.sort_by(f64::total_cmp);
    let at = |share: f64| taken_us[((taken_us.len() - 1) as f64 * share) as usize];
    println!("{mean:>8.3} {:>8.2} {:>8.2} {:>8.0}  {name}", at(0.5), at(0.99), at(1.0));
}

#[expect(clippy::disallowed_methods, reason = "a measurement of time")]
fn now() -> Instant {
    Instant::now()
}

fn mission() -> Mission {
    Mission {
        own: OwnShip {
            length_m: 8.45,
            beam_m: 2.71,
            speed_mps_max: 12.5,
            yaw_rate_radps_max: 0.2,
            acceleration_mps2_max: 0.5,
        },
        route: vec![Waypoint { position_m: Vec2::new(3e5, 1e3), speed_mps: None }],
        cruise_mps: 7.3,
        safety_radius_m: 150.0,
        between_centres: false,
        beat_s: 1.0,
        hazards: Vec::new(),
        stream_seed: 0x0123_4567_89ab_cdef,
    }
}

/// Numbers with as many digits as those of a campaign.
fn scene(t_s: f64) -> (OwnState, TargetTrack) {
    let third = 1.0 / 3.0;
    let own = OwnState {
        position_m: Vec2::new(7.3 * t_s + third, 0.1 * t_s),
        psi_rad: 0.1 * third,
        velocity_mps: Vec2::new(7.3 - 0.1 * third, 0.1 * third),
        cog_rad: 0.01 * third,
        sog_mps: 7.3 - 0.2 * third,
        stw_mps: 7.3,
        yaw_rate_radps: 0.001 * third,
    };
    let track = TargetTrack {
        id: 1,
        position_m: Vec2::new(7.3 * t_s, 5000.0 + 3.0 * t_s + third),
        velocity_mps: Vec2::new(0.7 * third, 9.1 * third),
        cog_rad: 4.0 * third,
        sog_mps: 9.2 * third,
        psi_rad: None,
        length_m: Some(100.0 * third),
        beam_m: None,
        covariance: [[0.0; 4]; 4],
        age_s: t_s,
        since_update_s: 0.0,
    };
    (own, track)
}
