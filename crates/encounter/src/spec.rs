//! The table `[model]` of a campaign file: random encounters, stratum by stratum.
//!
//! Nothing that changes a result has a default: a key is required, or its absence means what its
//! documentation says. Units stand in the keys; degrees live here and nowhere further down.

use crate::distribution::{Distribution, range};
use crate::error::require;
use crate::intent::{ConductSpec, IntentMix};
use crate::limits::{Limits, ScaledLimits, positive, validate_either};
use crate::sensing::SensingSpec;
use crate::wanted::Border;
use crate::weather::WeatherSpec;
use crate::{Error, RunSettings};
use geom::units::deg;
use geom::{EncounterClass, HeadOnSector, Vec2};
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
    /// What is asked for, in the order of reports.
    pub stratum: Vec<StratumSpec>,
}

/// Corners, two numbers each, metres.
pub type Polygon = Vec<[f64; 2]>;

/// Refuses what is no simple polygon; `key` is where the list stands.
pub(crate) fn validate_hazards(key: &str, hazards: Option<&Vec<Polygon>>) -> Result<(), Error> {
    let hazards = hazards.map_or(&[][..], Vec::as_slice);
    require(
        hazards.len() <= usize::from(u8::MAX),
        || key.to_owned(),
        || format!("has {} polygons; at most 255 can be told apart", hazards.len()),
    )?;
    for (i, polygon) in hazards.iter().enumerate() {
        if let Some(fault) = geom::polygon::fault(&corners(polygon, 0.0)) {
            return Err(Error::spec(format!("{key}.{}", i + 1), fault.to_string()));
        }
    }
    Ok(())
}

/// The corners, turned by own course.
pub(crate) fn corners(polygon: &[[f64; 2]], own_psi_rad: f64) -> Vec<Vec2> {
    let place = |&[ahead_m, starboard_m]: &[f64; 2]| Vec2::new(ahead_m, starboard_m);
    if own_psi_rad.abs() <= 0.0 {
        return polygon.iter().map(place).collect();
    }
    polygon.iter().map(|corner| geom::angle::rotate(place(corner), own_psi_rad)).collect()
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
}

impl Model {
    /// Names of the strata, in order.
    pub fn strata_names(&self) -> Vec<String> {
        self.stratum.iter().map(|stratum| stratum.name.clone()).collect()
    }

    /// Refuses what cannot be drawn; keys in messages start with `model.`.
    pub fn validate(&self, run: &RunSettings) -> Result<(), Error> {
        self.own.validate()?;
        self.target.validate()?;
        self.geometry.validate(&self.own)?;
        self.sensing.validate("model.sensing")?;
        self.weather.as_ref().map_or(Ok(()), WeatherSpec::validate)?;
        self.visual_range_m
            .map_or(Ok(()), |range_m| positive("model", "visual_range_m", range_m))?;
        validate_hazards("model.hazard", self.hazard.as_ref())?;
        self.validate_radius(run)?;
        require(
            !self.stratum.is_empty(),
            || "model.stratum".to_owned(),
            || "is empty; name at least one [[model.stratum]]".to_owned(),
        )?;
        for (i, stratum) in self.stratum.iter().enumerate() {
            stratum.validate()?;
            if let Some(mix) = &stratum.intent_mix {
                let key = format!("model.stratum.{}.intent_mix", stratum.name);
                mix.validate(&key, self.target.conduct.as_ref())?;
            }
            require(
                self.stratum[..i].iter().all(|other| other.name != stratum.name),
                || format!("model.stratum.{}", stratum.name),
                || "stands twice; names of strata are unique".to_owned(),
            )?;
        }
        Ok(())
    }

    fn validate_radius(&self, run: &RunSettings) -> Result<(), Error> {
        let target_length_m = self.target.length_m.bounds().1;
        run.validate_centre_radius(self.own.length_m, target_length_m)
    }
}

impl OwnSpec {
    fn validate(&self) -> Result<(), Error> {
        validate_hull("model.own", self.length_m, self.beam_m)?;
        self.speed_mps.validate_within("model.own.speed_mps", 0.0, SPEED_MPS_MAX)?;
        validate_vessel(
            "model.own",
            &self.vessel,
            self.limits.as_ref(),
            self.scaled_limits.as_ref(),
        )?;
        within_limit("model.own", &self.speed_mps, self.limits.as_ref())
    }
}

impl TargetSpec {
    fn validate(&self) -> Result<(), Error> {
        self.length_m.validate_within("model.target.length_m", 0.0, LENGTH_M_MAX)?;
        self.beam_per_length.validate_within("model.target.beam_per_length", 0.0, 1.0)?;
        let (length_m, share) = (self.length_m.bounds().0, self.beam_per_length.bounds().0);
        validate_hull("model.target", length_m, length_m * share)?;
        self.speed_mps.validate_within("model.target.speed_mps", 0.0, SPEED_MPS_MAX)?;
        validate_either("model.target", self.limits.as_ref(), self.scaled_limits.as_ref())?;
        within_limit("model.target", &self.speed_mps, self.limits.as_ref())?;
        if let Some(conduct) = &self.conduct {
            conduct.validate()?;
        }
        if let Some(mix) = &self.intent_mix {
            mix.validate("model.target.intent_mix", self.conduct.as_ref())?;
        }
        if let IntentSpec::Alter(alter) = &self.intent {
            let key = |name: &str| format!("model.target.intent.alter.{name}");
            alter.before_cpa_s.validate_within(&key("before_cpa_s"), 0.0, f64::MAX)?;
            alter.course_change_deg.validate_within(&key("course_change_deg"), -180.0, 180.0)?;
            alter.speed_factor.validate_within(&key("speed_factor"), 0.0, f64::MAX)?;
        }
        Ok(())
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

    fn validate(&self, own: &OwnSpec) -> Result<(), Error> {
        const TABLE: &str = "model.geometry";
        let key = |name: &str| format!("{TABLE}.{name}");
        validate_course(&key("relative_course_deg"), &self.relative_course_deg)?;
        let nearest_m = self.range_m_min_beyond_half_length;
        positive(TABLE, "range_m_min_beyond_half_length", nearest_m)?;
        positive(TABLE, "range_m_max", self.range_m_max)?;
        require(
            nearest_m > own.length_m / 2.0,
            || key("range_m_min_beyond_half_length"),
            || format!("= {nearest_m} must be over half of own length, {}", own.length_m / 2.0),
        )?;
        require(
            nearest_m < self.range_m_max,
            || key("range_m_max"),
            || {
                let max_m = self.range_m_max;
                format!("= {max_m} must be over range_m_min_beyond_half_length = {nearest_m}")
            },
        )?;
        let far_m = self.range_m_max;
        self.miss_m.validate_within(&key("miss_m"), -far_m, far_m)?;
        positive(TABLE, "tcpa_s", self.tcpa_s[0])?;
        range(&key("tcpa_s"), self.tcpa_s[0], self.tcpa_s[1])?;
        positive(TABLE, "goal_tcpa_factor", self.goal_tcpa_factor)?;
        positive(TABLE, "goal_extra_s", self.goal_extra_s)?;
        angle(&key("head_on_half_angle_deg"), self.head_on_half_angle_deg, 60.0)?;
        angle(&key("head_on_reciprocal_deg"), self.head_on_reciprocal_deg, 120.0)
    }
}

impl StratumSpec {
    fn validate(&self) -> Result<(), Error> {
        require(
            !self.name.is_empty(),
            || "model.stratum.name".to_owned(),
            || "is empty; every stratum needs a name".to_owned(),
        )?;
        let key = |name: &str| format!("model.stratum.{}.{name}", self.name);
        match (self.class, self.boundary, self.within_deg) {
            (_, None, None) => {}
            (None, Some(_), Some(within_deg)) => angle(&key("within_deg"), within_deg, 45.0)?,
            (None, Some(_), None) => {
                return Err(Error::spec(key("within_deg"), "is missing beside `boundary`"));
            }
            (_, None, Some(_)) => {
                return Err(Error::spec(
                    key("within_deg"),
                    "belongs to `boundary`, not to `class`",
                ));
            }
            (Some(_), Some(_), _) => {
                return Err(Error::spec(key("class"), "and `boundary` exclude each other"));
            }
        }
        let further = self.also.as_ref().map_or(0, Vec::len);
        require(
            further < usize::from(u8::MAX),
            || key("also"),
            || format!("names {further} further targets; at most 254 can be told apart"),
        )?;
        validate_laws(
            &format!("model.stratum.{}", self.name),
            &self.target_speed_mps,
            &self.relative_course_deg,
        )?;
        for (i, also) in self.also.iter().flatten().enumerate() {
            let table = key(&format!("also.{}", i + 1));
            validate_laws(&table, &also.target_speed_mps, &also.relative_course_deg)?;
        }
        Ok(())
    }
}

/// The laws that a target may have of her own.
fn validate_laws(
    table: &str,
    speed: &Option<Distribution>,
    course: &Option<Distribution>,
) -> Result<(), Error> {
    let key = |name: &str| format!("{table}.{name}");
    if let Some(speed) = speed {
        speed.validate_within(&key("target_speed_mps"), 0.0, SPEED_MPS_MAX)?;
    }
    course.as_ref().map_or(Ok(()), |course| validate_course(&key("relative_course_deg"), course))
}

/// Guards against a length or a speed in the wrong unit: no ship is longer or faster.
const LENGTH_M_MAX: f64 = 500.0;
const SPEED_MPS_MAX: f64 = 60.0;

/// A hull with an area: a contact must have somewhere to happen. A point vessel is one of a metre,
/// with distances between centres.
pub(crate) fn validate_hull(key: &str, length_m: f64, beam_m: f64) -> Result<(), Error> {
    require(
        length_m > 0.0 && length_m <= LENGTH_M_MAX,
        || format!("{key}.length_m"),
        || format!("= {length_m} must be positive and at most {LENGTH_M_MAX} metres"),
    )?;
    require(
        beam_m > 0.0 && beam_m <= length_m,
        || format!("{key}.beam_m"),
        || format!("= {beam_m} must be positive and at most the length, {length_m}"),
    )
}

/// Limits for a kinematic vessel and for no other.
pub(crate) fn validate_vessel(
    key: &str,
    vessel: &str,
    limits: Option<&Limits>,
    scaled: Option<&ScaledLimits>,
) -> Result<(), Error> {
    if vessel == KINEMATIC {
        return validate_either(key, limits, scaled);
    }
    require(
        limits.is_none() && scaled.is_none(),
        || format!("{key}.limits"),
        || format!("belong to vessel = \"{KINEMATIC}\"; `{vessel}` brings its own"),
    )
}

fn within_limit(table: &str, speed: &Distribution, limits: Option<&Limits>) -> Result<(), Error> {
    let fastest_mps = speed.bounds().1;
    let limit_mps = limits.map_or(f64::INFINITY, |limits| limits.speed_mps_max);
    require(
        fastest_mps <= limit_mps,
        || format!("{table}.speed_mps"),
        || format!("reaches {fastest_mps}, over the vessel's own limit of {limit_mps}"),
    )
}

fn validate_course(key: &str, course: &Distribution) -> Result<(), Error> {
    course.validate_within(key, -360.0, 360.0)?;
    let (low, high) = course.bounds();
    require(
        high - low <= 360.0,
        || key.to_owned(),
        || format!("spans {} degrees; a circle has 360", high - low),
    )
}

fn angle(key: &str, value_deg: f64, most_deg: f64) -> Result<(), Error> {
    require(
        value_deg > 0.0 && value_deg <= most_deg,
        || key.to_owned(),
        || format!("= {value_deg} must be over 0 and at most {most_deg} degrees"),
    )
}
