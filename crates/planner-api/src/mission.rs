//! What a planner is told once, at the start of an encounter.

use geom::Vec2;
use serde::{Deserialize, Serialize};

/// The task of one encounter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mission {
    /// Own ship.
    pub own: OwnShip,
    /// Waypoints ahead, the goal last; at least one.
    pub route: Vec<Waypoint>,
    /// Planned speed, m/s.
    pub cruise_mps: f64,
    /// Distance that own ship shall keep from others, metres, hull to hull or between reference
    /// points as `between_centres` says.
    pub safety_radius_m: f64,
    /// Whether distances are between reference points (laboratory scenes) or from hull to hull.
    pub between_centres: bool,
    /// `plan` is called once a beat, seconds.
    pub beat_s: f64,
    /// Land, piers and shoals that the chart shows: simple polygons, corners in metres north and
    /// east, the last joined to the first; none in open water.
    #[serde(default)]
    pub hazards: Vec<Vec<Vec2>>,
    /// Seed of the planner's own random stream; written as 16 hexadecimal digits in messages.
    #[serde(with = "crate::stream::hex_seed")]
    pub stream_seed: u64,
}

impl Mission {
    /// The last waypoint, metres north and east.
    pub fn goal_m(&self) -> Vec2 {
        self.route.last().map_or_else(Vec2::zeros, |waypoint| waypoint.position_m)
    }
}

/// What does not change about own ship.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OwnShip {
    /// Length over all, metres.
    pub length_m: f64,
    /// Beam, metres.
    pub beam_m: f64,
    /// Largest speed that may be ordered, m/s; the smallest is 0.
    pub speed_mps_max: f64,
    /// Largest yaw rate the ship reaches, rad/s.
    pub yaw_rate_radps_max: f64,
    /// Largest acceleration and deceleration, m/s^2.
    pub acceleration_mps2_max: f64,
}

/// A point of the route.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Waypoint {
    /// Metres north and east.
    pub position_m: Vec2,
    /// Planned speed on the leg towards this point, m/s; absent: the cruise speed.
    pub speed_mps: Option<f64>,
}
