//! The discs that a velocity-obstacle planner keeps its relative velocity out of, for the player.
//! The planner's own `Clearance` computes them, from the options of the plan.

use campaign::Plan;
use planner_api::{Mission, TargetTrack};
use planners::clearance::Clearance;
use planners::corrected::CorrectedOptions;
use planners::zhuang::ZhuangOptions;
use record::{DistanceKind, Encounter};

/// Radius around each target, metres between reference points; absent for other planners.
pub(crate) fn radii_m(plan: &Plan, encounter: &Encounter) -> Option<Vec<f64>> {
    let mission = mission(encounter);
    let (clearance, factor) = clearance(plan, &mission)?;
    let radius_m = |target: &record::encounter::Target| {
        factor * clearance.radius_m(&track_of_length(target.hull.length_m))
    };
    Some(encounter.targets.iter().map(radius_m).collect())
}

fn clearance(plan: &Plan, mission: &Mission) -> Option<(Clearance, f64)> {
    let options = || plan.planner.options.clone();
    match plan.planner.name.as_str() {
        "zhuang" | "zhuang-as-printed" | "zhuang-latched" => {
            let o: ZhuangOptions = options().try_into().ok()?;
            Some((Clearance::new(mission, o.radius, o.unknown_length_m), o.radius_factor))
        }
        "zhuang-corrected" => {
            let o: CorrectedOptions = options().try_into().ok()?;
            let clearance = Clearance::new(mission, o.radius, o.unknown_length_m);
            Some((clearance.widened(o.margin_m), 1.0))
        }
        _ => None,
    }
}

/// As much of the mission as a clearance reads.
fn mission(encounter: &Encounter) -> Mission {
    let hull = &encounter.own.hull;
    Mission {
        own: planner_api::mission::OwnShip {
            length_m: hull.length_m,
            beam_m: hull.beam_m,
            speed_mps_max: 0.0,
            yaw_rate_radps_max: 0.0,
            acceleration_mps2_max: 0.0,
        },
        route: Vec::new(),
        cruise_mps: encounter.own.cruise_mps,
        safety_radius_m: encounter.safety_radius_m,
        between_centres: encounter.distance == DistanceKind::Centre,
        beat_s: encounter.run.beat_s,
        hazards: Vec::new(),
        stream_seed: 0,
    }
}

/// A track that reports its length, as perfect sensing gives it.
fn track_of_length(length_m: f64) -> TargetTrack {
    TargetTrack {
        id: 0,
        position_m: geom::Vec2::zeros(),
        velocity_mps: geom::Vec2::zeros(),
        cog_rad: 0.0,
        sog_mps: 0.0,
        psi_rad: None,
        length_m: Some(length_m),
        beam_m: None,
        covariance: [[0.0; 4]; 4],
        age_s: 0.0,
        since_update_s: 0.0,
    }
}
