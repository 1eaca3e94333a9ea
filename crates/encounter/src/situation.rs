//! Named sets: encounters that a campaign file spells out, one `[[situation]]` each.
//!
//! The table `[set]` says once what the ships are; each situation says where they are. Positions
//! are in metres (`north_m`, `east_m`) or nautical miles (`north_nm`, `east_nm`), speeds in m/s
//! (`speed_mps`) or knots (`speed_kn`), one choice for a whole file, so that a number cannot be
//! misread by a slip of a suffix. A situation's name is its stratum, with `j` = 0.

use crate::hazard::Polygon;
use crate::limits::{Limits, ScaledLimits};
use crate::sensing::SensingSpec;
use serde::{Deserialize, Serialize};

/// What the situations of a file have in common.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetSettings {
    /// Own ship.
    pub own: SetOwn,
    /// Every target.
    pub target: SetTarget,
    /// What own ship perceives.
    pub sensing: SensingSpec,
}

/// Own ship of every situation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetOwn {
    /// `kinematic`, or the name of a parameter set of the simulator.
    pub vessel: String,
    /// Length over all, metres.
    pub length_m: f64,
    /// Beam, metres.
    pub beam_m: f64,
    /// Limits of a kinematic vessel.
    pub limits: Option<Limits>,
    /// Limits by length, instead of `limits`.
    pub scaled_limits: Option<ScaledLimits>,
}

/// The targets of every situation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetTarget {
    /// Length over all, metres, of a target that has none of her own.
    pub length_m: Option<f64>,
    /// Beam, metres, likewise.
    pub beam_m: Option<f64>,
    /// What a target means to do that says nothing else.
    pub intent: SetIntent,
    /// Limits.
    pub limits: Option<Limits>,
    /// Limits by length, instead of `limits`.
    pub scaled_limits: Option<ScaledLimits>,
}

/// What a target means to do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SetIntent {
    /// Keeps course and speed.
    HoldCourse,
    /// Alters once, whatever own ship does.
    Alter(SetAlter),
    /// Sails through these places, with a speed towards each, whatever own ship does, and goes on
    /// behind the last.
    Track(Vec<PlaceAt>),
    /// Runs a planner of the registry.
    Planner(String),
}

/// A place of a track.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlaceAt {
    /// Metres north.
    pub north_m: Option<f64>,
    /// Metres east.
    pub east_m: Option<f64>,
    /// Nautical miles north.
    pub north_nm: Option<f64>,
    /// Nautical miles east.
    pub east_nm: Option<f64>,
    /// Speed towards it, m/s.
    pub speed_mps: Option<f64>,
    /// Speed towards it, knots.
    pub speed_kn: Option<f64>,
}

/// One alteration of a target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetAlter {
    /// When, seconds from the start.
    pub at_s: f64,
    /// New course, degrees.
    pub course_deg: f64,
    /// New speed, m/s; absent: unchanged.
    pub speed_mps: Option<f64>,
}

/// One situation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Situation {
    /// Name, unique in its file.
    pub name: String,
    /// Own ship at the start.
    pub own: OwnAt,
    /// Where she goes.
    pub goal: Place,
    /// The targets at the start, at least one.
    pub targets: Vec<TargetAt>,
    /// Land, piers and shoals: simple polygons, corners in metres north and east; absent: none.
    pub hazard: Option<Vec<Polygon>>,
    /// Instead of the run's safety radius, metres.
    pub safety_radius_m: Option<f64>,
    /// Instead of the detection range of `[set.sensing]`, metres.
    pub detection_range_m: Option<f64>,
}

/// A point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// Metres north.
    pub north_m: Option<f64>,
    /// Metres east.
    pub east_m: Option<f64>,
    /// Nautical miles north.
    pub north_nm: Option<f64>,
    /// Nautical miles east.
    pub east_nm: Option<f64>,
}

/// Own ship at the start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OwnAt {
    /// Metres north.
    pub north_m: Option<f64>,
    /// Metres east.
    pub east_m: Option<f64>,
    /// Nautical miles north.
    pub north_nm: Option<f64>,
    /// Nautical miles east.
    pub east_nm: Option<f64>,
    /// Heading and course, degrees clockwise from north.
    pub course_deg: f64,
    /// Speed, m/s.
    pub speed_mps: Option<f64>,
    /// Speed, knots.
    pub speed_kn: Option<f64>,
}

/// A target at the start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TargetAt {
    /// Metres north.
    pub north_m: Option<f64>,
    /// Metres east.
    pub east_m: Option<f64>,
    /// Nautical miles north.
    pub north_nm: Option<f64>,
    /// Nautical miles east.
    pub east_nm: Option<f64>,
    /// Heading and course, degrees clockwise from north.
    pub course_deg: f64,
    /// Speed, m/s.
    pub speed_mps: Option<f64>,
    /// Speed, knots.
    pub speed_kn: Option<f64>,
    /// Length over all, metres, instead of the set's.
    pub length_m: Option<f64>,
    /// Beam, metres, instead of the set's.
    pub beam_m: Option<f64>,
    /// What she means to do, instead of the set's.
    pub intent: Option<SetIntent>,
    /// What the source of the set calls this encounter, in its own words; nothing depends on it.
    pub source_label: Option<String>,
}
