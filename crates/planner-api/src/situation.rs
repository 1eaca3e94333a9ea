//! What a planner sees at a beat.

use geom::{Vec2, angle};
use serde::{Deserialize, Serialize};

/// One beat. Metres north and east, radians clockwise from north, metres a second.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Situation<'a> {
    /// Simulated time, seconds from the start of the encounter.
    pub t_s: f64,
    /// Own ship, as her own navigation knows it.
    pub own: OwnState,
    /// What the sensors hold, in no promised order; a target without a track is not there.
    pub tracks: &'a [TargetTrack],
    /// Ships beyond this range are not in sight of one another (Rule 19), metres; absent when
    /// visibility is good.
    pub visual_range_m: Option<f64>,
}

/// Own ship.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OwnState {
    /// Position of the reference point.
    pub position_m: Vec2,
    /// Heading.
    pub psi_rad: f64,
    /// Velocity over ground.
    pub velocity_mps: Vec2,
    /// Course over ground; the heading where the ship does not move.
    pub cog_rad: f64,
    /// Speed over ground.
    pub sog_mps: f64,
    /// Speed ahead through the water.
    pub stw_mps: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate_radps: f64,
}

impl OwnState {
    /// On a steady course through still water; metres north and east, radians clockwise from
    /// north, m/s.
    pub fn steady(position_m: Vec2, course_rad: f64, speed_mps: f64) -> Self {
        Self {
            position_m,
            psi_rad: course_rad,
            velocity_mps: angle::unit(course_rad) * speed_mps,
            cog_rad: course_rad,
            sog_mps: speed_mps,
            stw_mps: speed_mps,
            yaw_rate_radps: 0.0,
        }
    }
}

/// A tracked target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TargetTrack {
    /// Number of the track, constant while it lives.
    pub id: u32,
    /// Estimated position.
    pub position_m: Vec2,
    /// Estimated velocity over ground, north and east.
    pub velocity_mps: Vec2,
    /// The same as a course; 0 where the target does not move.
    pub cog_rad: f64,
    /// The same as a speed.
    pub sog_mps: f64,
    /// Heading, where the target reports it.
    pub psi_rad: Option<f64>,
    /// Length, where it is known.
    pub length_m: Option<f64>,
    /// Beam, where it is known.
    pub beam_m: Option<f64>,
    /// Covariance of (north, east, north velocity, east velocity), row by row; zero when perfect.
    pub covariance: [[f64; 4]; 4],
    /// Age of the track, seconds since it was confirmed.
    pub age_s: f64,
    /// Seconds since the last measurement that fed it.
    pub since_update_s: f64,
}
