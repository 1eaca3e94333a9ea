//! Limits of kinematic vessels, given or scaled by length.

use crate::Error;
use crate::error::require;
use crate::wanted::MOVING_MPS_MIN;
use geom::units::deg;
use record::Vessel;
use serde::{Deserialize, Serialize};

/// Limits as they are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Largest turn rate, degrees a second.
    pub yaw_rate_deg_s_max: f64,
    /// Largest acceleration and deceleration, m/s^2.
    pub acceleration_mps2_max: f64,
    /// Largest speed, m/s.
    pub speed_mps_max: f64,
}

/// Limits from a ship's length `L` and her planned speed `U` (the largest of her route):
///
/// * turn rate `U / (turn_radius_lengths L)`, at most `yaw_rate_deg_s_max`;
/// * acceleration `stopping_from_mps^2 / (2 stopping_lengths L)`, at most `acceleration_mps2_max`;
/// * speed `speed_max_per_planned U`.
///
/// A ship that plans to stand still has the limits of one that makes 0.2 m/s, the least speed at
/// which a ship counts as moving.
///
/// The IMO's standards for ship manoeuvrability, resolution MSC.137(76), ask for a tactical
/// diameter of at most five lengths and a stop within fifteen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScaledLimits {
    /// Radius of the tightest turn, in ship's lengths.
    pub turn_radius_lengths: f64,
    /// No ship turns faster, degrees a second.
    pub yaw_rate_deg_s_max: f64,
    /// Distance to stop, in ship's lengths, ...
    pub stopping_lengths: f64,
    /// ... from this speed, m/s.
    pub stopping_from_mps: f64,
    /// No ship brakes or accelerates harder, m/s^2.
    pub acceleration_mps2_max: f64,
    /// Largest speed, as a multiple of the planned one.
    pub speed_max_per_planned: f64,
}

impl Limits {
    /// The vessel with these limits.
    pub fn vessel(&self) -> Vessel {
        Vessel::Kinematic {
            yaw_rate_radps_max: deg(self.yaw_rate_deg_s_max),
            acceleration_mps2_max: self.acceleration_mps2_max,
            speed_mps_max: self.speed_mps_max,
        }
    }

    fn validate(&self, key: &str) -> Result<(), Error> {
        positive(key, "yaw_rate_deg_s_max", self.yaw_rate_deg_s_max)?;
        positive(key, "acceleration_mps2_max", self.acceleration_mps2_max)?;
        positive(key, "speed_mps_max", self.speed_mps_max)
    }
}

impl ScaledLimits {
    /// The vessel of a ship of `length_m` that plans to make `planned_mps`.
    pub fn vessel(&self, length_m: f64, planned_mps: f64) -> Vessel {
        let planned_mps = planned_mps.max(MOVING_MPS_MIN);
        let turn_radius_m = self.turn_radius_lengths * length_m;
        let stopping_m = self.stopping_lengths * length_m;
        let braking_mps2 = self.stopping_from_mps * self.stopping_from_mps / (2.0 * stopping_m);
        Vessel::Kinematic {
            yaw_rate_radps_max: (planned_mps / turn_radius_m).min(deg(self.yaw_rate_deg_s_max)),
            acceleration_mps2_max: braking_mps2.min(self.acceleration_mps2_max),
            speed_mps_max: self.speed_max_per_planned * planned_mps,
        }
    }

    pub(crate) fn validate(&self, key: &str) -> Result<(), Error> {
        positive(key, "turn_radius_lengths", self.turn_radius_lengths)?;
        positive(key, "yaw_rate_deg_s_max", self.yaw_rate_deg_s_max)?;
        positive(key, "stopping_lengths", self.stopping_lengths)?;
        positive(key, "stopping_from_mps", self.stopping_from_mps)?;
        positive(key, "acceleration_mps2_max", self.acceleration_mps2_max)?;
        require(
            self.speed_max_per_planned.is_finite() && self.speed_max_per_planned >= 1.0,
            || format!("{key}.speed_max_per_planned"),
            || {
                format!(
                    "= {} must be at least 1: a ship must reach the speed she plans",
                    self.speed_max_per_planned
                )
            },
        )
    }
}

/// Exactly one of the two ways to give limits.
pub(crate) fn validate_either(
    key: &str,
    limits: Option<&Limits>,
    scaled: Option<&ScaledLimits>,
) -> Result<(), Error> {
    match (limits, scaled) {
        (Some(limits), None) => limits.validate(&format!("{key}.limits")),
        (None, Some(scaled)) => scaled.validate(&format!("{key}.scaled_limits")),
        (None, None) => Err(Error::spec(
            format!("{key}.limits"),
            "is missing; a kinematic vessel needs `limits` or `scaled_limits`",
        )),
        (Some(_), Some(_)) => Err(Error::spec(
            format!("{key}.limits"),
            "stands beside `scaled_limits`; keep one of the two",
        )),
    }
}

/// The vessel that [`validate_either`] has let through.
pub(crate) fn either(
    limits: Option<&Limits>,
    scaled: Option<&ScaledLimits>,
    length_m: f64,
    planned_mps: f64,
) -> Option<Vessel> {
    match (limits, scaled) {
        (Some(limits), _) => Some(limits.vessel()),
        (None, Some(scaled)) => Some(scaled.vessel(length_m, planned_mps)),
        (None, None) => None,
    }
}

/// Refuses zero, a negative number, NaN and infinity.
pub(crate) fn positive(table: &str, name: &str, value: f64) -> Result<(), Error> {
    require(
        value.is_finite() && value > 0.0,
        || format!("{table}.{name}"),
        || format!("= {value} must be a positive number"),
    )
}
