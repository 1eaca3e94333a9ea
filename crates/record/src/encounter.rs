//! An encounter before it is run: who is where, who wants what, in which world.
//!
//! Made by `encounter`, read by `sim`. All positions are metres north and east of a local origin.

use crate::{EncounterId, Seed, Sensing, Weather};
use geom::{EncounterClass, HullOutline, Vec2};
use serde::{Deserialize, Serialize};

/// One encounter, whole: everything that `sim` needs but the planner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Encounter {
    /// Identity; with `seed` the key of every random stream.
    pub id: EncounterId,
    /// Seed of the campaign.
    pub seed: Seed,
    /// Importance weight, 1 for a crude draw.
    pub weight: f64,
    /// The ship whose planner is under test.
    pub own: OwnShip,
    /// The other ships, at least one unless there are hazards.
    pub targets: Vec<Target>,
    /// Static hazards: simple polygons, corners in metres north and east.
    pub hazards: Vec<Vec<Vec2>>,
    /// Current, wind and waves.
    pub weather: Weather,
    /// What own ship's planner can perceive.
    pub sensing: Sensing,
    /// In sight of one another, or not (Rule 19).
    pub visibility: Visibility,
    /// What the generator was asked for; absent for encounters read from a file.
    pub asked: Option<Asked>,
    /// Distance that own ship shall keep, in metres, measured as `distance` says.
    pub safety_radius_m: f64,
    /// The one kind of distance of this campaign.
    pub distance: DistanceKind,
    /// Clock and end of the run.
    pub run: RunLimits,
}

/// One kind of distance per report: it is used for every distance alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DistanceKind {
    /// From hull to hull, the default.
    Hull,
    /// From reference point to reference point, as the literature does.
    Centre,
}

/// Clock and end of a run, in seconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunLimits {
    /// Step of the integration; divides the beat.
    pub step_s: f64,
    /// The planner is asked once a beat; the trace has one sample a beat.
    pub beat_s: f64,
    /// Longest simulated time.
    pub duration_s_max: f64,
    /// When a run is over before that.
    pub until: RunUntil,
}

/// When a run is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RunUntil {
    /// Past and clear of every target.
    PastAndClear,
    /// Past and clear, and the last waypoint reached.
    GoalReached,
    /// Only at the longest simulated time (for measurements of speed).
    TimeIsUp,
}

/// How a ship moves at the start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// Position of the reference point, metres north and east.
    pub position_m: Vec2,
    /// Course over ground, radians clockwise from north; the heading too, where nothing drifts.
    pub psi_rad: f64,
    /// Speed over ground, m/s.
    pub speed_mps: f64,
}

/// A point of a route.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Waypoint {
    /// Metres north and east.
    pub position_m: Vec2,
    /// Planned speed on the leg towards this point, m/s; absent: the speed before it.
    pub speed_mps: Option<f64>,
}

/// The model that moves a ship.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Vessel {
    /// Turns and accelerates at once, within limits.
    Kinematic {
        /// Largest turn rate, rad/s.
        yaw_rate_radps_max: f64,
        /// Largest acceleration and deceleration, m/s^2.
        acceleration_mps2_max: f64,
        /// Largest speed, m/s.
        speed_mps_max: f64,
    },
    /// A named parameter set of `sim`, such as `viknes`.
    Model(String),
}

/// The ship whose planner is under test.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OwnShip {
    /// Outline.
    pub hull: HullOutline,
    /// How it moves.
    pub vessel: Vessel,
    /// Where it starts.
    pub start: Motion,
    /// Waypoints ahead, the goal last; at least one.
    pub route: Vec<Waypoint>,
    /// Planned speed, m/s.
    pub cruise_mps: f64,
}

/// Another ship.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// Outline, the true one.
    pub hull: HullOutline,
    /// How it moves.
    pub vessel: Vessel,
    /// Where it starts.
    pub start: Motion,
    /// What it means to do.
    pub intent: Intent,
}

/// What a target means to do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Intent {
    /// Keeps course and speed.
    HoldCourse,
    /// Follows waypoints with a speed on each leg.
    Track(Vec<Waypoint>),
    /// Turns to a course and speed at a time, whatever own ship does.
    Alter {
        /// When, in seconds from the start.
        at_s: f64,
        /// New course, radians clockwise from north.
        course_rad: f64,
        /// New speed, m/s.
        speed_mps: f64,
    },
    /// Turns to one course after another, whatever own ship does; in the order of time.
    Turns(Vec<Turn>),
    /// Meets own ship as the rules ask, or fails to.
    Duty(Conduct),
    /// Runs a planner from the registry, its own options included.
    Planner(String),
}

impl Intent {
    /// The word used in files: what she means to do, without its numbers.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::HoldCourse => "hold_course",
            Self::Track(_) => "track",
            Self::Alter { .. } => "alter",
            Self::Turns(_) => "turns",
            Self::Duty(Conduct { manner: Manner::Complies, .. }) => "complies",
            Self::Duty(Conduct { manner: Manner::Neglects, .. }) => "neglects",
            Self::Duty(Conduct { manner: Manner::WrongWay, .. }) => "wrong_way",
            Self::Planner(_) => "planner",
        }
    }
}

/// One turn of a script.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Turn {
    /// When, in seconds from the start.
    pub at_s: f64,
    /// New course, radians clockwise from north.
    pub course_rad: f64,
}

/// How a target meets own ship.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conduct {
    /// What she makes of her duty.
    pub manner: Manner,
    /// She acts when the time to the closest point of her bow is at most this, seconds: large for a
    /// ship that gives way early, small for one that does so late.
    pub act_tcpa_s: f64,
    /// There is risk when the predicted distance between reference points is at most this, metres.
    pub risk_dcpa_m: f64,
    /// Size of her one alteration, radians, positive; one that complies makes it larger where it is
    /// not enough.
    pub course_change_rad: f64,
    /// A ship that stands on acts when the time to the closest point of her bow is at most this,
    /// seconds ...
    pub stand_on_tcpa_s: f64,
    /// ... and the predicted distance between reference points still at most this, metres.
    pub stand_on_dcpa_m: f64,
}

/// What a target makes of her duty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Manner {
    /// Turns to starboard where she must give way; keeps course and speed where she must stand on.
    Complies,
    /// Keeps course and speed though obliged.
    Neglects,
    /// Turns to port, whatever her duty.
    WrongWay,
}

/// In sight of one another, or not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Visibility {
    /// Rules 11 to 18 hold.
    #[default]
    InSight,
    /// Rule 19 holds beyond this range in metres.
    Restricted {
        /// Ships nearer than this see one another.
        visual_range_m: f64,
    },
}

/// What the generator was asked for, and promised, for the first target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Asked {
    /// Class at the start.
    pub class: EncounterClass,
    /// Signed miss distance between reference points, metres: positive when the target passes to
    /// starboard of own ship's relative motion.
    pub miss_m: f64,
    /// Time to the closest point, seconds.
    pub tcpa_s: f64,
}
