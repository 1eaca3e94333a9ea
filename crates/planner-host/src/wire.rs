//! The messages between the bench and a planner in a process of its own, protocol version 1.
//!
//! One message a line, JSON in UTF-8, each answered by exactly one line: `hello` by `hello`,
//! `reset` by `ready`, `plan` by `order`. Every answer repeats the number of its request. Metres
//! north and east, radians clockwise from north, metres a second, seconds; numbers are shortest
//! decimals that round-trip, seeds are hexadecimal because JSON numbers lose bits beyond 2^53.
//!
//! These types are the protocol: they change only together with [`PROTOCOL`], however
//! `planner-api` changes.

use schemars::JsonSchema;
use serde::de::{self, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

/// The version of this protocol.
pub const PROTOCOL: u32 = 1;

/// First message to a new process: what the bench speaks.
#[derive(Debug, Serialize, JsonSchema)]
pub struct HelloRequest {
    /// Always `hello`.
    pub r#type: HelloTag,
    /// Version of the protocol.
    pub protocol: u32,
    /// What this bench can do beyond the plain messages.
    pub offers: Vec<Feature>,
}

/// The planner's answer to it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hello {
    /// Always `hello`.
    pub r#type: HelloTag,
    /// Version of the protocol that the planner speaks; another one than the bench's is refused.
    pub protocol: u32,
    /// Name of the planner.
    pub name: String,
    /// Version of the planner.
    pub version: String,
    /// The only beat it can plan at, seconds; absent or null: any.
    #[serde(default)]
    pub beat_s: Option<f64>,
    /// What it cannot do without; the bench refuses a planner whose needs it does not offer.
    #[serde(default)]
    pub needs: Vec<String>,
}

/// What a planner may need.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Feature {
    /// Declared alerts are recorded.
    Alerts,
    /// Tracks carry their covariance.
    Covariance,
    /// The mission carries the whole route and not only the goal.
    Route,
    /// Orders may be velocities.
    VelocityOrders,
}

impl Feature {
    /// What this bench offers.
    pub const OFFERED: [Self; 4] =
        [Self::Alerts, Self::Covariance, Self::Route, Self::VelocityOrders];

    /// The word in messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Alerts => "alerts",
            Self::Covariance => "covariance",
            Self::Route => "route",
            Self::VelocityOrders => "velocity_orders",
        }
    }
}

/// A new encounter: forget everything and prepare.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Reset {
    /// Always `reset`.
    pub r#type: ResetTag,
    /// Number of this request; every process counts its requests from 1.
    pub seq: u64,
    /// The task.
    pub mission: Mission,
}

/// The planner's answer to `reset`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ready {
    /// Always `ready`.
    pub r#type: ReadyTag,
    /// Number of the request.
    pub seq: u64,
}

/// One beat.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Plan<'a> {
    /// Always `plan`.
    pub r#type: PlanTag,
    /// Number of this request.
    pub seq: u64,
    /// Simulated time since the start of the encounter, seconds.
    pub t_s: f64,
    /// Own ship.
    pub own: Own,
    /// What the sensors hold, in no promised order.
    pub tracks: &'a [Track],
    /// Ships beyond this range are not in sight of one another (Rule 19), metres; null when
    /// visibility is good.
    pub visual_range_m: Option<f64>,
}

/// The planner's answer to `plan`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OrderAnswer {
    /// Always `order`.
    pub r#type: OrderTag,
    /// Number of the request.
    pub seq: u64,
    /// Where to go.
    pub order: Order,
    /// Conflicts that the planner declares.
    #[serde(default)]
    pub alerts: Vec<Alert>,
}

/// An order, in either form. A number that is not finite (`NaN`, `Infinity`, `nan`, `inf`, `null`)
/// is accepted as such and ends the encounter as `planner_non_finite`.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Order {
    /// A course and a speed.
    CourseSpeed {
        /// Radians clockwise from north, within one turn either way.
        course_rad: Number,
        /// Metres a second, from 0 to own ship's largest speed.
        speed_mps: Number,
    },
    /// A velocity over ground, m/s north and east; needs no trigonometry from the planner.
    VelocityMps([Number; 2]),
}

/// A declared conflict.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Alert {
    /// Number of the track.
    pub track: u32,
    /// The rule it follows, such as `15`.
    #[serde(default)]
    pub rule: String,
    /// Why, for a human reader.
    #[serde(default)]
    pub why: String,
}

/// A number in an answer; null stands for one that is not finite.
#[derive(Clone, Copy, Debug, JsonSchema)]
#[schemars(transparent)]
pub struct Number(pub f64);

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        // Not through Option: a number that is left out would then be a null.
        from.deserialize_any(NumberVisitor)
    }
}

struct NumberVisitor;

impl Visitor<'_> for NumberVisitor {
    type Value = Number;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number")
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<Number, E> {
        Ok(Number(number))
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<Number, E> {
        Ok(Number(number as f64))
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<Number, E> {
        Ok(Number(number as f64))
    }

    fn visit_unit<E: de::Error>(self) -> Result<Number, E> {
        Ok(Number(f64::NAN))
    }
}

/// The task of one encounter.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Mission {
    /// Own ship.
    pub own: OwnShip,
    /// Waypoints ahead, the goal last; at least one.
    pub route: Vec<Waypoint>,
    /// Planned speed, m/s.
    pub cruise_mps: f64,
    /// Distance to keep from others, metres.
    pub safety_radius_m: f64,
    /// Whether that distance is between reference points and not from hull to hull.
    pub between_centres: bool,
    /// Time between two plans, seconds.
    pub beat_s: f64,
    /// Land, piers and shoals: simple polygons, corners in metres north and east, the last joined
    /// to the first; none in open water.
    pub hazards: Vec<Vec<[f64; 2]>>,
    /// Seed of the planner's own random numbers, 16 hexadecimal digits.
    pub stream_seed: String,
}

/// What does not change about own ship.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct OwnShip {
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Waypoint {
    /// Metres north and east.
    pub position_m: [f64; 2],
    /// Planned speed towards it, m/s; null: the cruise speed.
    pub speed_mps: Option<f64>,
}

/// Own ship at a beat.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Own {
    /// Metres north and east.
    pub position_m: [f64; 2],
    /// Heading.
    pub psi_rad: f64,
    /// Velocity over ground, north and east.
    pub velocity_mps: [f64; 2],
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Track {
    /// Number of the track, constant while it lives.
    pub id: u32,
    /// Estimated position, metres north and east.
    pub position_m: [f64; 2],
    /// Estimated velocity over ground, north and east.
    pub velocity_mps: [f64; 2],
    /// The same as a course; 0 where the target does not move.
    pub cog_rad: f64,
    /// The same as a speed.
    pub sog_mps: f64,
    /// Heading; null where the target does not report it.
    pub psi_rad: Option<f64>,
    /// Length, metres; null where it is not known.
    pub length_m: Option<f64>,
    /// Beam, metres; null where it is not known.
    pub beam_m: Option<f64>,
    /// Covariance of (north, east, north velocity, east velocity), row by row; zero when perfect.
    pub covariance: [[f64; 4]; 4],
    /// Seconds since the track was confirmed.
    pub age_s: f64,
    /// Seconds since the last measurement that fed it.
    pub since_update_s: f64,
}

macro_rules! tag {
    ($name:ident, $variant:ident, $word:literal) => {
        #[doc = concat!("The word `", $word, "`.")]
        #[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
        pub enum $name {
            #[doc = concat!("`", $word, "`.")]
            #[serde(rename = $word)]
            $variant,
        }
    };
}

tag!(HelloTag, Hello, "hello");
tag!(ResetTag, Reset, "reset");
tag!(ReadyTag, Ready, "ready");
tag!(PlanTag, Plan, "plan");
tag!(OrderTag, Order, "order");
