//! A small velocity-obstacle planner; the same one stands in C, C++ and Python beside it.
//!
//! It steers for the next waypoint. If that would bring own ship nearer to a track than the safety
//! radius within ten minutes, it takes the smallest alteration that keeps clear, starboard first,
//! in steps of 15 degrees up to 90, then a stop; if none keeps clear, the one that comes least
//! near.
//!
//! Only + - * / sqrt and comparisons, and the same ones in the same order in every language: so all
//! four give the same bits.

use planner_api::{Alert, Command, Mission, Order, Planner, Situation, TargetTrack, Vec2};

/// Cosine and sine of the 15 degrees between two courses that it tries.
const COS_STEP: f64 = 0.965_925_826_289_068_3;
const SIN_STEP: f64 = 0.258_819_045_102_520_74;
/// Courses that it tries on each side.
const STEPS: usize = 6;
/// How far it looks ahead, seconds.
const HORIZON_S: f64 = 600.0;
/// A waypoint this near is passed, metres.
const PASSED_M: f64 = 50.0;

/// The planner.
#[derive(Debug, Default)]
pub struct SmallVo {
    mission: Option<Mission>,
    next: usize,
}

impl Planner for SmallVo {
    fn reset(&mut self, mission: &Mission) {
        self.mission = Some(mission.clone());
        self.next = 0;
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let mission = self.mission.as_ref().expect("reset comes before plan");
        let own_m = situation.own.position_m;
        let preferred = preferred(mission, &mut self.next, own_m);
        let (mut best_margin, worst) = margin(mission, situation, preferred);
        let mut best = preferred;
        let mut alerts = Vec::new();
        if best_margin < 0.0 {
            let why = "inside the safety radius on the planned course".to_owned();
            alerts.push(Alert { track: worst, rule: "8".to_owned(), why });
            let (mut starboard, mut port) = (preferred, preferred);
            let mut candidates = Vec::with_capacity(2 * STEPS + 1);
            for _ in 0..STEPS {
                starboard = Vec2::new(
                    starboard.x * COS_STEP - starboard.y * SIN_STEP,
                    starboard.x * SIN_STEP + starboard.y * COS_STEP,
                );
                port = Vec2::new(
                    port.x * COS_STEP + port.y * SIN_STEP,
                    port.y * COS_STEP - port.x * SIN_STEP,
                );
                candidates.extend([starboard, port]);
            }
            candidates.push(Vec2::new(0.0, 0.0));
            for candidate in candidates {
                let (candidate_margin, _) = margin(mission, situation, candidate);
                if candidate_margin > best_margin {
                    (best_margin, best) = (candidate_margin, candidate);
                }
                if candidate_margin >= 0.0 {
                    break;
                }
            }
        }
        Command { order: Order::Velocity { velocity_mps: best }, alerts }
    }
}

/// The velocity towards the next waypoint; passes those that are near.
fn preferred(mission: &Mission, next: &mut usize, own_m: Vec2) -> Vec2 {
    loop {
        let waypoint = &mission.route[*next];
        let (north, east) = (waypoint.position_m.x - own_m.x, waypoint.position_m.y - own_m.y);
        let distance_m = (north * north + east * east).sqrt();
        if distance_m <= PASSED_M && *next + 1 < mission.route.len() {
            *next += 1;
            continue;
        }
        let mut speed_mps = waypoint.speed_mps.unwrap_or(mission.cruise_mps);
        if speed_mps > mission.own.speed_mps_max {
            speed_mps = mission.own.speed_mps_max;
        }
        if distance_m < 1.0 {
            return Vec2::new(0.0, 0.0);
        }
        return Vec2::new(north / distance_m * speed_mps, east / distance_m * speed_mps);
    }
}

/// The smallest (square of the distance less square of the radius) over all tracks, and whose it
/// is.
fn margin(mission: &Mission, situation: &Situation<'_>, velocity: Vec2) -> (f64, u32) {
    let (mut smallest, mut whose) = (f64::INFINITY, 0);
    for track in situation.tracks {
        let one = margin_of(mission, situation.own.position_m, velocity, track);
        if one < smallest {
            (smallest, whose) = (one, track.id);
        }
    }
    (smallest, whose)
}

fn margin_of(mission: &Mission, own_m: Vec2, velocity: Vec2, track: &TargetTrack) -> f64 {
    let mut radius_m = mission.safety_radius_m;
    if !mission.between_centres {
        let length_m = track.length_m.unwrap_or(mission.own.length_m);
        radius_m += (mission.own.length_m + length_m) / 2.0;
    }
    let (north, east) = (track.position_m.x - own_m.x, track.position_m.y - own_m.y);
    let north_mps = track.velocity_mps.x - velocity.x;
    let east_mps = track.velocity_mps.y - velocity.y;
    let speed_squared = north_mps * north_mps + east_mps * east_mps;
    let mut t_s = 0.0;
    if speed_squared > 0.0 {
        t_s = -(north * north_mps + east * east_mps) / speed_squared;
    }
    let t_s = t_s.clamp(0.0, HORIZON_S);
    let (north, east) = (north + north_mps * t_s, east + east_mps * t_s);
    north * north + east * east - radius_m * radius_m
}
