//! Cost of a draw and share of refused tries, stratum by stratum: `draw_cost FILE.toml [N]`.
#![expect(clippy::disallowed_methods, reason = "a measurement reads the clock")]

use encounter::{Generator, Model, RunSettings};
use record::{DistanceKind, RunLimits, RunUntil, Seed};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("draw_cost FILE.toml [N]")?;
    let n: u64 = arguments.next().map_or(Ok(100_000), |n| n.parse())?;
    let file: toml::Table = std::fs::read_to_string(path)?.parse()?;
    let model: Model = file["model"].clone().try_into()?;
    let number = |key: &str| file["run"][key].as_float().ok_or(key.to_owned());
    let run = RunSettings {
        limits: RunLimits {
            step_s: number("step_s")?,
            beat_s: number("beat_s")?,
            duration_s_max: number("duration_s_max")?,
            until: RunUntil::PastAndClear,
        },
        safety_radius_m: number("safety_radius_m")?,
        distance: if file["run"]["distance"].as_str() == Some("centre") {
            DistanceKind::Centre
        } else {
            DistanceKind::Hull
        },
    };
    let start = Instant::now();
    let generator = Generator::new(&model, &run)?;
    println!("generator made in {:.2} ms", start.elapsed().as_secs_f64() * 1e3);
    println!("{:<22} {:>9} {:>11} {:>10}", "stratum", "us/draw", "tries/draw", "refused");
    for (index, name) in generator.strata().iter().enumerate() {
        let start = Instant::now();
        let mut rejected = 0;
        for j in 0..n {
            rejected += std::hint::black_box(generator.draw(Seed(1), index, j)?).rejected;
        }
        let each_us = start.elapsed().as_secs_f64() * 1e6 / n as f64;
        let tries = (n + rejected) as f64;
        println!(
            "{name:<22} {each_us:>9.2} {:>11.2} {:>9.1}%",
            tries / n as f64,
            100.0 * rejected as f64 / tries
        );
    }
    Ok(())
}
