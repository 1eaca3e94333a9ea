//! What judging one trace costs: 600 samples, one target.
//!
//! `cargo run --release -p stl --example cost`

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Script, USV, run};
use std::hint::black_box;
use std::time::Instant;

fn main() {
    let own = Script::straight(0.0, 0.0, 0.0, 5.0);
    let east = |bearing_m: f64, psi: f64| Script::straight(1500.0, bearing_m, psi, 5.0);
    let encounters = [
        ("head on, starboard turn", own.clone().turn(60, 35.0).turn(400, -35.0), east(0.0, 180.0)),
        ("crossing, starboard turn", own.clone().turn(60, 40.0), east(1500.0, -90.0)),
        (
            "crossing, stand on",
            own.clone(),
            east(-1480.0, 90.0).turn(90, 60.0).change_speed(95, -0.5),
        ),
        (
            "overtaking",
            Script { speed_mps: 6.0, ..own.clone() }.turn(10, 25.0).turn(62, -25.0),
            Script::straight(400.0, 0.0, 0.0, 2.0),
        ),
        ("no risk", own, Script::straight(0.0, 3000.0, 0.0, 5.0)),
    ];
    for (name, own, target) in encounters {
        let trace = run(&own, &[target], 600);
        let rounds = 4000;
        #[expect(clippy::disallowed_methods, reason = "a benchmark reads the wall clock")]
        let start = Instant::now();
        for _ in 0..rounds {
            black_box(stl::judge(black_box(&trace), &USV));
        }
        let each_us = start.elapsed().as_secs_f64() * 1e6 / f64::from(rounds);
        println!("{name}: {} samples, {each_us:.1} us", trace.samples());
    }
}
