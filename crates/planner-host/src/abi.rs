//! The C interface of a planner in a shared library, version 1.
//!
//! `include/seatrial_planner.h` is made from this file; `tests/header.rs` says when it is not
//! current. The layout is fixed for a version: a change of any kind is a new version, and with it a
//! new name of the exported function, so that an old library is refused and never misread.

use std::ffi::{c_char, c_void};

/// Version of this interface.
pub const SEATRIAL_PLANNER_ABI: u32 = 1;
/// `SeatrialCommand::kind`: a course and a speed.
pub const SEATRIAL_COURSE_SPEED: u32 = 1;
/// `SeatrialCommand::kind`: a velocity.
pub const SEATRIAL_VELOCITY: u32 = 2;
/// Room for declared alerts in a command.
pub const SEATRIAL_ALERTS_MAX: usize = 8;
/// Room for the words of an alert, with the closing zero.
pub const SEATRIAL_TEXT_MAX: usize = 64;

/// What does not change about own ship.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SeatrialOwnShip {
    /// Length over all, metres.
    pub length_m: f64,
    /// Beam, metres.
    pub beam_m: f64,
    /// Largest speed that may be ordered, m/s; the smallest is 0.
    pub speed_mps_max: f64,
    /// Largest yaw rate, rad/s.
    pub yaw_rate_radps_max: f64,
    /// Largest acceleration and deceleration, m/s^2.
    pub acceleration_mps2_max: f64,
}

/// A point of the route.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SeatrialWaypoint {
    /// Metres north.
    pub north_m: f64,
    /// Metres east.
    pub east_m: f64,
    /// Planned speed towards it, m/s; NaN: the cruise speed.
    pub speed_mps: f64,
}

/// A point in metres.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SeatrialPoint {
    /// Metres north.
    pub north_m: f64,
    /// Metres east.
    pub east_m: f64,
}

/// Land, a pier or a shoal: a simple polygon, the last corner joined to the first.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SeatrialHazard {
    /// Corners.
    pub corners: *const SeatrialPoint,
    /// How many; at least three.
    pub corners_len: usize,
}

/// The task of one encounter. Pointers are valid during the call only.
///
/// Later releases add fields at the end and nowhere else, so that a library that was built against
/// an older header reads what it knows. Seatrial of before 0.2 ends with `between_centres`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SeatrialMission {
    /// Own ship.
    pub own: SeatrialOwnShip,
    /// Waypoints ahead, the goal last; at least one.
    pub route: *const SeatrialWaypoint,
    /// How many.
    pub route_len: usize,
    /// Planned speed, m/s.
    pub cruise_mps: f64,
    /// Distance to keep from others, metres.
    pub safety_radius_m: f64,
    /// Time between two plans, seconds.
    pub beat_s: f64,
    /// Seed of the planner's own random numbers.
    pub stream_seed: u64,
    /// 1: distances are between reference points; 0: from hull to hull.
    pub between_centres: u32,
    /// Land, piers and shoals.
    pub hazards: *const SeatrialHazard,
    /// How many.
    pub hazards_len: usize,
}

/// Own ship at a beat: metres, m/s north and east, radians clockwise from north.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SeatrialOwn {
    /// Metres north.
    pub north_m: f64,
    /// Metres east.
    pub east_m: f64,
    /// Heading.
    pub psi_rad: f64,
    /// Velocity over ground to the north.
    pub north_mps: f64,
    /// Velocity over ground to the east.
    pub east_mps: f64,
    /// Course over ground; the heading where the ship does not move.
    pub cog_rad: f64,
    /// Speed over ground.
    pub sog_mps: f64,
    /// Speed ahead through the water.
    pub stw_mps: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate_radps: f64,
}

/// A tracked target at a beat.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SeatrialTrack {
    /// Number of the track, constant while it lives.
    pub id: u32,
    /// Metres north.
    pub north_m: f64,
    /// Metres east.
    pub east_m: f64,
    /// Velocity over ground to the north, m/s.
    pub north_mps: f64,
    /// Velocity over ground to the east, m/s.
    pub east_mps: f64,
    /// The same as a course; 0 where the target does not move.
    pub cog_rad: f64,
    /// The same as a speed.
    pub sog_mps: f64,
    /// Heading; NaN where the target does not report it.
    pub psi_rad: f64,
    /// Length, metres; NaN where it is not known.
    pub length_m: f64,
    /// Beam, metres; NaN where it is not known.
    pub beam_m: f64,
    /// Covariance of (north, east, north velocity, east velocity), row by row; zero when perfect.
    pub covariance: [[f64; 4]; 4],
    /// Seconds since the track was confirmed.
    pub age_s: f64,
    /// Seconds since the last measurement that fed it.
    pub since_update_s: f64,
}

/// One beat. Pointers are valid during the call only.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SeatrialSituation {
    /// Simulated time since the start of the encounter, seconds.
    pub t_s: f64,
    /// Own ship.
    pub own: SeatrialOwn,
    /// What the sensors hold, in no promised order.
    pub tracks: *const SeatrialTrack,
    /// How many.
    pub tracks_len: usize,
    /// Ships beyond this range are not in sight of one another (Rule 19), metres; infinite when
    /// visibility is good.
    pub visual_range_m: f64,
}

/// A declared conflict.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SeatrialAlert {
    /// Number of the track.
    pub track: u32,
    /// The rule it follows, such as `15`; ends with a zero.
    pub rule: [c_char; SEATRIAL_TEXT_MAX],
    /// Why, for a human reader; ends with a zero.
    pub why: [c_char; SEATRIAL_TEXT_MAX],
}

/// The answer of a beat; `kind` and `alerts_len` are zero before the call.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SeatrialCommand {
    /// Which pair below counts: `SEATRIAL_COURSE_SPEED` or `SEATRIAL_VELOCITY`.
    pub kind: u32,
    /// Course, radians clockwise from north, within one turn either way.
    pub course_rad: f64,
    /// Speed, m/s, from 0 to own ship's largest.
    pub speed_mps: f64,
    /// Velocity over ground to the north, m/s.
    pub north_mps: f64,
    /// Velocity over ground to the east, m/s.
    pub east_mps: f64,
    /// How many alerts are declared.
    pub alerts_len: usize,
    /// The alerts.
    pub alerts: [SeatrialAlert; SEATRIAL_ALERTS_MAX],
}

/// The planner: what `seatrial_planner_v1` returns. It and all it points to live for ever.
///
/// Several instances run at the same time in several threads, each in one thread at a time: no
/// global state that one changes and another reads. Functions that return a number return 0 when
/// all is well; any other number ends the encounter as `planner_crashed`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SeatrialPlanner {
    /// Must be `SEATRIAL_PLANNER_ABI`.
    pub abi: u32,
    /// Name of the planner.
    pub name: *const c_char,
    /// Version of the planner.
    pub version: *const c_char,
    /// Makes an instance; null when that fails.
    pub create: Option<unsafe extern "C" fn() -> *mut c_void>,
    /// Forgets everything and prepares for one encounter.
    pub reset: Option<unsafe extern "C" fn(*mut c_void, *const SeatrialMission) -> i32>,
    /// The order for this beat.
    pub plan: Option<
        unsafe extern "C" fn(*mut c_void, *const SeatrialSituation, *mut SeatrialCommand) -> i32,
    >,
    /// Frees an instance.
    pub destroy: Option<unsafe extern "C" fn(*mut c_void)>,
}

/// The one function that a library exports, as `seatrial_planner_v1`.
pub type SeatrialEntry = unsafe extern "C" fn() -> *const SeatrialPlanner;
