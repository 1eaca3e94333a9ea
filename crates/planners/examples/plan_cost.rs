//! Prints what one call of each planner costs, in microseconds:
//! `cargo run --release -p planners --example plan_cost`.
//!
//! Each number is the smallest of several means: what else a machine does only adds to it.

use geom::{Vec2, angle, units::deg};
use planner_api::{Mission, OwnShip, OwnState, Situation, TargetTrack, Waypoint};
use std::hint::black_box;

const CALLS: u32 = 1000;
const REPETITIONS: u32 = 12;

fn main() {
    println!("{:<20} {:>10} {:>10} {:>10} {:>10}", "us per call", "alone", "1 clear", "1", "3");
    for entry in planners::registry().entries() {
        if ["nan", "panics", "spins", "aborts", "overflows"].contains(&entry.name.as_str()) {
            continue;
        }
        let cost = |targets: &[TargetTrack]| cost_us(entry, targets);
        let clear = [target(1, 1500.0, 1400.0, 270.0, 6.0)];
        let three = [
            target(1, 800.0, 30.0, 180.0, 6.0),
            target(2, 700.0, 520.0, 270.0, 6.0),
            target(3, 900.0, -700.0, 90.0, 7.0),
        ];
        println!(
            "{:<20} {:>10.3} {:>10.3} {:>10.3} {:>10.3}",
            entry.name,
            cost(&[]),
            cost(&clear),
            cost(&three[..1]),
            cost(&three)
        );
    }
}

/// Every call follows a reset, so that no memory makes it cheap; the resets' cost is taken off.
#[expect(clippy::disallowed_methods, reason = "a benchmark reads the wall clock")]
fn cost_us(entry: &planner_api::PlannerEntry, tracks: &[TargetTrack]) -> f64 {
    let mut planner = (entry.make)(&entry.options).expect("the default options are valid");
    let mission = mission();
    let mut least_s = [f64::INFINITY; 2];
    for round in 0..2 * REPETITIONS {
        let with_plan = (round % 2) as usize;
        let start = std::time::Instant::now();
        for call in 0..CALLS {
            planner.reset(black_box(&mission));
            if with_plan == 1 {
                // own ship is not quite the same twice, and time goes on past every replan
                let own = own(f64::from(call % 100) * 0.01);
                let t_s = f64::from(call) * 100.0;
                let situation = Situation { t_s, own, tracks, visual_range_m: None };
                black_box(planner.plan(black_box(&situation)));
            }
        }
        least_s[with_plan] = least_s[with_plan].min(start.elapsed().as_secs_f64());
    }
    (least_s[1] - least_s[0]) / f64::from(CALLS) * 1e6
}

fn mission() -> Mission {
    Mission {
        own: OwnShip {
            length_m: 8.45,
            beam_m: 2.71,
            speed_mps_max: 12.0,
            yaw_rate_radps_max: 0.2,
            acceleration_mps2_max: 0.5,
        },
        route: vec![Waypoint { position_m: Vec2::new(6000.0, 0.0), speed_mps: None }],
        cruise_mps: 8.0,
        safety_radius_m: 150.0,
        between_centres: false,
        beat_s: 1.0,
        hazards: Vec::new(),
        stream_seed: 1,
    }
}

fn own(y_m: f64) -> OwnState {
    OwnState::steady(Vec2::new(0.0, y_m), 0.0, 8.0)
}

fn target(id: u32, x_m: f64, y_m: f64, course_deg: f64, sog_mps: f64) -> TargetTrack {
    let cog_rad = geom::wrap(deg(course_deg));
    TargetTrack {
        id,
        position_m: Vec2::new(x_m, y_m),
        velocity_mps: angle::unit(cog_rad) * sog_mps,
        cog_rad,
        sog_mps,
        psi_rad: Some(cog_rad),
        length_m: Some(30.0),
        beam_m: Some(6.0),
        covariance: [[0.0; 4]; 4],
        age_s: 60.0,
        since_update_s: 0.0,
    }
}
