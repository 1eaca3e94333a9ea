//! What halving the step changes: smallest hull distance of random close encounters.
//!
//! `cargo run --release -p sim --example convergence`

#[path = "../tests/scenes/mod.rs"]
mod scenes;

use geom::units::deg;
use planner_api::Planner;
use record::{EncounterId, Purpose, Seed, Streams, Vessel};
use scenes::{Meeting, Orders, Shy, kinematic, run, viknes};

const ENCOUNTERS: u64 = 600;
const STEPS_S: [f64; 5] = [1.0, 0.5, 0.25, 0.125, 0.0625];

fn main() {
    println!("change of the smallest hull distance when the step is halved, metres");
    println!(
        "own, target          planner    step_s  p50        p99        max        ends differ"
    );
    for (name, own, target) in [
        ("viknes, viknes", viknes(), viknes()),
        ("viknes, kinematic", viknes(), kinematic()),
        ("kinematic, kinematic", kinematic(), kinematic()),
    ] {
        for planner in ["scheduled", "shy"] {
            table(name, planner, &own, &target);
        }
    }
}

fn table(name: &str, planner: &str, own: &Vessel, target: &Vessel) {
    for pair in STEPS_S.windows(2) {
        let mut changes_m = Vec::new();
        let mut ends_differ = 0;
        for j in 0..ENCOUNTERS {
            let sail = |step_s: f64| {
                let (meeting, turn_rad, at_s) = draw(j, step_s);
                let mut scheduled = Orders(vec![(0.0, 0.0, 7.0), (at_s, turn_rad, 6.0)]);
                let mut shy = Shy { course_rad: 0.0 };
                let planner: &mut dyn Planner =
                    if planner == "shy" { &mut shy } else { &mut scheduled };
                run(&meeting.encounter(own.clone(), target.clone()), planner)
            };
            let (coarse, fine) = (sail(pair[0]), sail(pair[1]));
            ends_differ += u32::from(coarse.outcome != fine.outcome);
            changes_m.push((coarse.pairs[0].minimum.hull_m - fine.pairs[0].minimum.hull_m).abs());
        }
        changes_m.sort_by(f64::total_cmp);
        let quantile = |q: f64| changes_m[(q * (changes_m.len() - 1) as f64) as usize];
        println!(
            "{name:20} {planner:10} {:7.4} {:.2e}   {:.2e}   {:.2e}   {ends_differ}",
            pair[0],
            quantile(0.5),
            quantile(0.99),
            quantile(1.0),
        );
    }
}

/// A meeting within 60 m, and a turn that begins shortly before it.
fn draw(j: u64, step_s: f64) -> (Meeting, f64, f64) {
    let mut draw =
        Streams::new(Seed(1), &EncounterId::new("convergence", j)).stream(Purpose::Geometry, 0);
    let meeting = Meeting {
        target_course_rad: draw.uniform_in(-3.1, 3.1),
        target_mps: draw.uniform_in(1.0, 9.0),
        target_length_m: draw.uniform_in(8.0, 60.0),
        miss_m: draw.uniform_in(-60.0, 60.0),
        tcpa_s: draw.uniform_in(60.0, 120.0),
        step_s,
    };
    let turn_rad = draw.uniform_in(deg(-90.0), deg(90.0));
    (meeting, turn_rad, (meeting.tcpa_s - draw.uniform_in(5.0, 40.0)).round())
}
