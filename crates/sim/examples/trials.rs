//! Sea trials of the named vessels as numbers.
//!
//! `cargo run -p sim --example trials`

use geom::units::deg;
use sim::vessel::Model;
use sim::vessel::trial::{crash_stop, turning_circle, zigzag};

fn main() {
    println!(
        "vessel, L m, m/s: advance, transfer, tactical, final L; speed %; overshoots deg; stop"
    );
    for (name, approach_mps) in [("viknes", 7.0), ("gunnerus", 5.144), ("frigate", 9.0)] {
        let Some(model) = Model::of(&record::Vessel::Model(name.to_owned())) else { continue };
        let Some(length_m) = sim::vessel::length_m(name) else { continue };
        print!("{name}, {length_m}, {approach_mps}:");
        if let Some(turn) = turning_circle(&model, approach_mps, deg(35.0)) {
            let of_length =
                [turn.advance_m, turn.transfer_m, turn.tactical_diameter_m, turn.final_diameter_m];
            of_length.iter().for_each(|m| print!(" {:.2}", m / length_m));
            print!("; {:.0} %;", 100.0 * turn.speed_share);
        }
        for angle_deg in [10.0, 20.0] {
            if let Some(zigzag) = zigzag(&model, approach_mps, deg(angle_deg)) {
                let [first, second] = zigzag.overshoot_rad.map(|rad| rad / deg(1.0));
                print!(" {angle_deg}/{angle_deg}: {first:.1}, {second:.1};");
            }
        }
        if let Some(stop) = crash_stop(&model, approach_mps) {
            println!(" {:.1} s, {:.2} L", stop.time_s, stop.track_reach_m / length_m);
        }
    }
}
