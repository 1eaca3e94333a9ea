//! Writes the situations of a folder of DNV traffic-situation files as `[[situation]]` tables:
//! `set_from_situations FOLDER PREFIX`. `campaigns/dnv-baseline.toml` was made with it.
//!
//! Names count the files in the order of their names; the words of a title, one for each target,
//! become the targets' labels.

use encounter::sensing::{SensingKind, SensingSpec};
use encounter::{RunSettings, ScaledLimits, SituationSettings, read_situations};
use geom::units::{to_deg, to_knots};
use record::{DistanceKind, Motion, RunLimits, RunUntil};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let usage = "set_from_situations FOLDER PREFIX";
    let (folder, prefix) = (arguments.next().ok_or(usage)?, arguments.next().ok_or(usage)?);
    for (i, encounter) in read_situations(Path::new(&folder), &how(), &run())?.iter().enumerate() {
        let goal = encounter.own.route.last().ok_or("no route")?.position_m;
        println!("\n[[situation]]");
        println!("name = \"{prefix}_{:02}\"", i + 1);
        println!("own = {{ {} }}", motion(&encounter.own.start));
        println!("goal = {{ north_m = {:.1}, east_m = {:.1} }}", plain(goal.x), plain(goal.y));
        println!("targets = [");
        let title = encounter.id.stratum.to_string();
        let labels: Vec<&str> = title.split(", ").collect();
        for (i, target) in encounter.targets.iter().enumerate() {
            let label = labels.get(i).unwrap_or(&"");
            let hull = target.hull;
            println!(
                "  {{ {}, length_m = {:.1}, beam_m = {:.1}, source_label = \"{label}\" }},",
                motion(&target.start),
                hull.length_m,
                hull.beam_m
            );
        }
        println!("]");
    }
    Ok(())
}

/// Centimetres, without a negative zero.
fn plain(value_m: f64) -> f64 {
    (value_m * 100.0).round() / 100.0 + 0.0
}

fn motion(start: &Motion) -> String {
    let (north_m, east_m) = (plain(start.position_m.x), plain(start.position_m.y));
    let course_deg = (to_deg(start.psi_rad) + 360.0) % 360.0;
    let speed_kn = to_knots(start.speed_mps);
    format!(
        "north_m = {north_m:.2}, east_m = {east_m:.2}, course_deg = {course_deg:.2}, speed_kn = \
         {speed_kn:.1}"
    )
}

fn how() -> SituationSettings {
    SituationSettings {
        after_last_cpa_s: 600.0,
        length_m_if_unknown: 100.0,
        beam_per_length_if_unknown: 0.15,
        scaled_limits: ScaledLimits {
            turn_radius_lengths: 2.5,
            yaw_rate_deg_s_max: 6.0,
            stopping_lengths: 15.0,
            stopping_from_mps: 8.66,
            acceleration_mps2_max: 0.5,
            speed_max_per_planned: 1.25,
        },
        sensing: SensingSpec {
            kind: SensingKind::Perfect,
            detection_range_m: None,
            ais: None,
            radar: None,
            tracker: None,
        },
    }
}

fn run() -> RunSettings {
    RunSettings {
        limits: RunLimits {
            step_s: 0.5,
            beat_s: 1.0,
            duration_s_max: 10_800.0,
            until: RunUntil::PastAndClear,
        },
        safety_radius_m: 400.0,
        distance: DistanceKind::Hull,
    }
}
