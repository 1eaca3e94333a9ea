//! Parameters of the corrected planner, with their sources.

use crate::clearance::{RadiusKind, UNKNOWN_LENGTH_M};
use serde::{Deserialize, Serialize};

/// Its options.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CorrectedOptions {
    /// Half-angle of the head-on sector, degrees: the judge's 13 (Woerner 2016) and 2 of doubt,
    /// which Rule 14(c) resolves towards head-on.
    pub head_on_half_angle_deg: f64,
    /// Doubt about the other borders, degrees: Rule 13(c), and give-way rather than stand-on dead
    /// ahead.
    pub doubt_deg: f64,
    /// Smallest alteration of course, degrees: "some texts suggest a minimum of 35" (Woerner).
    pub alteration_deg: f64,
    /// Distance planned beyond the safety radius, metres.
    pub margin_m: f64,
    /// A target is a risk when nearer than this, metres (Hagen et al. 2023, R_2).
    pub risk_range_m: f64,
    /// ... or nearer than this where her track is not perfect, metres: to know her takes time.
    pub noisy_risk_range_m: f64,
    /// ... with at most this time to CPA, seconds.
    pub risk_tcpa_s: f64,
    /// Stand-on in a crossing: holds outside this range, metres (the same, R_3 = 700, and a little
    /// patience).
    pub stand_on_range_m: f64,
    /// Stand-on when overtaken: holds outside this range, metres ...
    pub overtaken_range_m: f64,
    /// ... and outside this time at the rate of closing, seconds.
    pub overtaken_time_s: f64,
    /// Stand-on acts only for a predicted distance below this, hull to hull, metres (r_min =
    /// 100, less what the estimate may be off).
    pub stand_on_dcpa_m: f64,
    /// ... that has lasted this long, seconds: the other ship's inaction must be apparent.
    pub stand_on_patience_s: f64,
    /// Planned distances grow by this many standard deviations of the predicted distance ...
    pub sigmas: f64,
    /// ... but by no more than this, metres.
    pub sigma_m_max: f64,
    /// A target is watched for this long before she is classed, unless she is near, seconds: a
    /// young track has hardly a course.
    pub watch_s: f64,
    /// Distance kept between own hull and land, metres, where the route leaves as much.
    pub land_m: f64,
    /// Share of own ship's turn rate and acceleration that the prediction trusts.
    pub trusted_share: f64,
    /// Time from an order to its first effect, seconds.
    pub lag_s: f64,
    /// What R is.
    pub radius: RadiusKind,
    /// Length, metres, of a target that does not report one.
    pub unknown_length_m: f64,
}

impl Default for CorrectedOptions {
    fn default() -> Self {
        Self {
            head_on_half_angle_deg: 15.0,
            doubt_deg: 2.0,
            alteration_deg: 35.0,
            margin_m: 60.0,
            risk_range_m: 1900.0,
            noisy_risk_range_m: 2200.0,
            risk_tcpa_s: 600.0,
            stand_on_range_m: 690.0,
            overtaken_range_m: 390.0,
            overtaken_time_s: 68.0,
            stand_on_dcpa_m: 95.0,
            stand_on_patience_s: 6.0,
            sigmas: 1.0,
            sigma_m_max: 80.0,
            watch_s: 25.0,
            land_m: 40.0,
            trusted_share: 0.6,
            lag_s: 3.0,
            radius: RadiusKind::Mission,
            unknown_length_m: UNKNOWN_LENGTH_M,
        }
    }
}

impl CorrectedOptions {
    /// What is wrong with the values, and what would be right.
    pub fn check(&self) -> Result<(), String> {
        let within = |key: &str, value: f64, low: f64, high: f64| {
            if (low..=high).contains(&value) {
                return Ok(());
            }
            Err(format!("`{key}` is {value}; it must be from {low} to {high}"))
        };
        within("head_on_half_angle_deg", self.head_on_half_angle_deg, 0.0, 67.5)?;
        within("doubt_deg", self.doubt_deg, 0.0, 10.0)?;
        within("alteration_deg", self.alteration_deg, 10.0, 90.0)?;
        within("margin_m", self.margin_m, 0.0, 1e5)?;
        within("risk_range_m", self.risk_range_m, 0.0, 1e6)?;
        within("noisy_risk_range_m", self.noisy_risk_range_m, 0.0, 1e6)?;
        within("risk_tcpa_s", self.risk_tcpa_s, 0.0, 1e6)?;
        within("stand_on_range_m", self.stand_on_range_m, 0.0, 1e6)?;
        within("overtaken_range_m", self.overtaken_range_m, 0.0, 1e6)?;
        within("overtaken_time_s", self.overtaken_time_s, 0.0, 1e6)?;
        within("stand_on_dcpa_m", self.stand_on_dcpa_m, 0.0, 1e6)?;
        within("stand_on_patience_s", self.stand_on_patience_s, 0.0, 1e6)?;
        within("sigmas", self.sigmas, 0.0, 10.0)?;
        within("sigma_m_max", self.sigma_m_max, 0.0, 1e5)?;
        within("land_m", self.land_m, 0.0, 1e4)?;
        within("watch_s", self.watch_s, 0.0, 1e6)?;
        within("unknown_length_m", self.unknown_length_m, 0.0, 1e4)?;
        within("trusted_share", self.trusted_share, 0.05, 1.0)?;
        within("lag_s", self.lag_s, 0.0, 60.0)
    }
}
