//! What a model must be to be drawn from; every fault names its key, the value and what is right.

use crate::distribution::{Distribution, range};
use crate::error::require;
use crate::hazard::validate_hazards;
use crate::limits::{Limits, ScaledLimits, positive, validate_either};
use crate::spec::TargetSpec;
use crate::spec::{GeometrySpec, IntentSpec, KINEMATIC, Model, OwnSpec, StratumSpec};
use crate::weather::WeatherSpec;
use crate::{Error, RunSettings};

impl Model {
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
            self.validate_arrivals(stratum)?;
        }
        self.encounter_rate.as_ref().map_or(Ok(()), |rate| rate.validate(self))
    }

    /// Arrivals of further targets, none of them before the start.
    fn validate_arrivals(&self, stratum: &StratumSpec) -> Result<(), Error> {
        let first_s = self.geometry.tcpa_s[0];
        for (i, also) in stratum.also.iter().flatten().enumerate() {
            let Some(after_s) = &also.tcpa_after_first_s else { continue };
            let key = format!("model.stratum.{}.also.{}.tcpa_after_first_s", stratum.name, i + 1);
            after_s.validate(&key)?;
            let earliest_s = first_s + after_s.bounds().0;
            require(
                earliest_s > 0.0,
                || key,
                || {
                    format!(
                        "reaches {}: with the first target {first_s} s from CPA she would have \
                         passed before the start",
                        after_s.bounds().0
                    )
                },
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
