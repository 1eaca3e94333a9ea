//! The table `[model]` of a campaign file: random encounters, stratum by stratum.
//!
//! Nothing that changes a result has a default: a key is required, or its absence means what its
//! documentation says. Units stand in the keys; degrees live here and nowhere further down.

use crate::Distribution;
use crate::encounter_rate::RateSpec;
use crate::hazard::Polygon;
use crate::intent::{ConductSpec, IntentMix};
use crate::limits::{Limits, ScaledLimits};
use crate::sensing::SensingSpec;
use crate::wanted::Border;
use crate::weather::WeatherSpec;
use geom::units::deg;
use geom::{EncounterClass, HeadOnSector};
use serde::{Deserialize, Serialize};

/// Random encounters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// The ship whose planner is under test.
    pub own: OwnSpec,
    /// The other ships.
    pub target: TargetSpec,
    /// How the ships lie to one another.
    pub geometry: GeometrySpec,
    /// What own ship perceives.
    pub sensing: SensingSpec,
    /// Current, wind and waves; absent: calm.
    pub weather: Option<WeatherSpec>,
    /// Ships nearer than this see one another, metres, and beyond it Rule 19 holds; absent: all
    /// are in sight.
    pub visual_range_m: Option<f64>,
    /// Land, piers and shoals: simple polygons, corners in metres ahead of own start and to
    /// starboard of it, which is north and east where own course is north; absent: none.
    pub hazard: Option<Vec<Polygon>>,
    /// Draws encounters at the rate at which a traffic makes them, and weights them. Absent: the
    /// laws are drawn as they stand, and every encounter has weight 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub encounter_rate: Option<RateSpec>,
    /// What is asked for, in the order of reports.
    pub stratum: Vec<StratumSpec>,
}

/// Name of the vessel that has limits instead of a parameter set.
pub const KINEMATIC: &str = "kinematic";

/// Own ship.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OwnSpec {
    /// `kinematic`, or the name of a parameter set of the simulator, such as `viknes`.
    pub vessel: String,
    /// Length over all, metres.
    pub length_m: f64,
    /// Beam, metres.
    pub beam_m: f64,
    /// Speed at the start and planned speed, m/s.
    pub speed_mps: Distribution,
    /// Limits of a kinematic vessel.
    pub limits: Option<Limits>,
    /// Limits of a kinematic vessel by her length, instead of `limits`.
    pub scaled_limits: Option<ScaledLimits>,
}

/// The other ships; all of them are kinematic.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TargetSpec {
    /// Length over all, metres.
    pub length_m: Distribution,
    /// Beam as a share of the length.
    pub beam_per_length: Distribution,
    /// Speed, m/s; a stratum may have its own.
    pub speed_mps: Distribution,
    /// What they mean to do, unless there is a mix.
    pub intent: IntentSpec,
    /// Instead of `intent`: shares of intents; a stratum may have its own. Absent: `intent`.
    pub intent_mix: Option<IntentMix>,
    /// Numbers for the intents of a mix.
    pub conduct: Option<ConductSpec>,
    /// Limits, the same for every target.
    pub limits: Option<Limits>,
    /// Limits by length, instead of `limits`.
    pub scaled_limits: Option<ScaledLimits>,
}

/// What a target means to do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum IntentSpec {
    /// Keeps course and speed.
    HoldCourse,
    /// Alters once, whatever own ship does.
    Alter(AlterSpec),
    /// Runs a planner of the registry.
    Planner(String),
}

/// One alteration of a target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AlterSpec {
    /// How long before the promised closest point, seconds; at once if that is before the start.
    pub before_cpa_s: Distribution,
    /// Change of course, degrees, positive to starboard.
    pub course_change_deg: Distribution,
    /// New speed as a multiple of the old one.
    pub speed_factor: Distribution,
}

/// How the ships lie to one another at the start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GeometrySpec {
    /// Target's course less own course, degrees; a stratum may have its own.
    pub relative_course_deg: Distribution,
    /// Signed miss distance between reference points, metres: positive when the target passes to
    /// starboard of own ship's motion relative to it.
    pub miss_m: Distribution,
    /// Time to the closest point, seconds: uniform over the part of this range that the start
    /// range allows at the drawn speeds and course.
    pub tcpa_s: [f64; 2],
    /// Least start range between reference points, metres, less half the target's length.
    pub range_m_min_beyond_half_length: f64,
    /// Largest start range, metres.
    pub range_m_max: f64,
    /// The goal lies ahead at own speed times (this times the time to CPA, plus the next).
    pub goal_tcpa_factor: f64,
    /// Seconds.
    pub goal_extra_s: f64,
    /// Whether own course is uniform over the circle, or north.
    pub random_rotation: bool,
    /// Half-angle of the head-on class that the generator promises, degrees.
    pub head_on_half_angle_deg: f64,
    /// Largest departure from reciprocal headings in a head-on encounter, degrees; twice the
    /// half-angle adds no condition.
    pub head_on_reciprocal_deg: f64,
}

/// One stratum: a class, the border between two, or neither: whatever the laws give, as in a
/// traffic that was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StratumSpec {
    /// Name, part of every encounter's id.
    pub name: String,
    /// The class at the start, or ...
    pub class: Option<EncounterClass>,
    /// ... the border that the start straddles, ...
    pub boundary: Option<Border>,
    /// ... and how far from it the start may lie on either side, degrees.
    pub within_deg: Option<f64>,
    /// Further targets, placed like the first and independently of it; absent: none.
    pub also: Option<Vec<AlsoSpec>>,
    /// Instead of the target's `speed_mps`.
    pub target_speed_mps: Option<Distribution>,
    /// Instead of the geometry's `relative_course_deg`.
    pub relative_course_deg: Option<Distribution>,
    /// Instead of the target's `intent_mix`, for every target of this stratum.
    pub intent_mix: Option<IntentMix>,
}

/// One more target of a stratum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AlsoSpec {
    /// Her class at the start.
    pub class: EncounterClass,
    /// Instead of the target's `speed_mps`.
    pub target_speed_mps: Option<Distribution>,
    /// Instead of the geometry's `relative_course_deg`.
    pub relative_course_deg: Option<Distribution>,
    /// Arrival: her time to CPA less the first target's, seconds, so that duties fall together or
    /// one after the other as declared. Absent: her time is drawn as the first target's is,
    /// independently of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tcpa_after_first_s: Option<Distribution>,
}

impl Model {
    /// Names of the strata, in order.
    pub fn strata_names(&self) -> Vec<String> {
        self.stratum.iter().map(|stratum| stratum.name.clone()).collect()
    }
}

impl GeometrySpec {
    /// The head-on sector that the generator promises.
    pub fn head_on(&self) -> HeadOnSector {
        HeadOnSector {
            half_angle_rad: deg(self.head_on_half_angle_deg),
            reciprocal_rad: deg(self.head_on_reciprocal_deg),
        }
    }
}
