//! Rule sets: every number that the treaty leaves open, in a named and versioned file.
//!
//! A file of `campaigns/rulesets/` is read here, checked for contradictions and handed to the
//! judge. There are no defaults: a missing key is an error, an unknown key is an error with the
//! allowed ones. The only number of Rules 5 to 19 that is law, "more than 22.5 degrees abaft her
//! beam", stands in `geom::class` and in no file. Reference: rules specification, sections 2 to 10.

use geom::units::deg;
use serde::{Deserialize, Deserializer};

/// All thresholds of the judge. Angles are radians, times seconds, distances metres.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RuleSet {
    /// Version of the file format, 1.
    pub schema: u32,
    /// Name with version, such as `usv-oe2023-v1`; the name of the file.
    pub name: String,
    /// One line for the report: for which ships, after which source.
    pub title: String,
    /// When risk of collision opens and closes (section 1).
    pub risk: Risk,
    /// Which class an encounter is (section 2).
    pub classification: Classification,
    /// Stages of an encounter (section 3).
    pub stages: Stages,
    /// Passing distances (section 4), in the campaign's one kind of distance.
    pub distance: Distances,
    /// "Finally past and clear" (section 2).
    pub release: Release,
    /// What counts as a manoeuvre (sections 5 and 6).
    pub manoeuvre: Manoeuvre,
    /// Ample time (section 7).
    pub timing: Timing,
    /// The stand-on vessel (section 9, Rule 17).
    pub stand_on: StandOn,
    /// Rule 19 (section 9).
    pub restricted_visibility: RestrictedVisibility,
    #[serde(skip)]
    pub(crate) text: String,
}

/// When risk of collision opens and closes (Rule 7).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Risk {
    /// `D_risk`: risk needs a predicted passing distance below this.
    pub d_risk_m: f64,
    /// `T_risk`: risk needs a time to CPA of at most this.
    pub t_risk_s: f64,
    /// How long a condition must hold to open or close risk.
    pub persistence_s: f64,
    /// Risk closes beyond this multiple of `d_risk_m`.
    pub close_factor: f64,
    /// While either ship turns faster than this, nothing opens or closes.
    #[serde(rename = "held_above_yaw_rate_deg_s", deserialize_with = "degrees")]
    pub held_above_yaw_rate_radps: f64,
}

/// The two-variable test of Rules 13 to 15.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Classification {
    /// `H`: largest bearing and contact angle of a head-on encounter.
    #[serde(rename = "head_on_half_angle_deg", deserialize_with = "degrees")]
    pub head_on_half_angle_rad: f64,
    /// `H_rec` as a multiple of `H`; 2 adds no condition.
    pub head_on_reciprocal_factor: f64,
    /// A class is in doubt when another lies within this of heading or bearing.
    #[serde(rename = "doubt_deg", deserialize_with = "degrees")]
    pub doubt_rad: f64,
    /// A ship slower than this over ground is stopped.
    pub stopped_mps: f64,
}

/// Range of the stages.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stages {
    /// Fixed ranges, or ranges that grow with closing speed.
    pub mode: StageMode,
    /// Outer range of stage 2: give-way acts, stand-on holds.
    pub r2_m: f64,
    /// Outer range of stage 3: stand-on may act.
    pub r3_m: f64,
    /// Outer range of stage 4: stand-on shall act.
    pub r4_m: f64,
    /// Time of stage 2.
    pub t2_s: f64,
    /// Time of stage 3.
    pub t3_s: f64,
    /// Time of stage 4.
    pub t4_s: f64,
}

/// How the limits of the stages are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StageMode {
    /// Fixed ranges (as papers do), but for the overtaking roles.
    Range,
    /// Ranges that grow with the closing speed.
    Time,
}

/// Passing distances.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Distances {
    /// At least this is excellent.
    pub r_pref_m: f64,
    /// At least this is a pass.
    pub r_min_m: f64,
    /// Below this is a near miss.
    pub r_nm_m: f64,
    /// Below this the score is 0.
    pub r_col_m: f64,
}

/// "Finally past and clear".
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Release {
    /// The overtaker is this near to right ahead of the other.
    #[serde(rename = "overtaker_ahead_deg", deserialize_with = "degrees")]
    pub overtaker_ahead_rad: f64,
    /// Meeting and crossing ships: one has the other this far abaft her bow.
    #[serde(rename = "abaft_deg", deserialize_with = "degrees")]
    pub abaft_rad: f64,
    /// Beyond this multiple of `r2_m` the bearing does not matter.
    pub beyond_r2_factor: f64,
    /// How long it must hold.
    pub held_s: f64,
}

/// What counts as a manoeuvre.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manoeuvre {
    /// Standard deviation of the smoothing of the heading.
    pub heading_sigma_s: f64,
    /// A run starts at this yaw rate, or half the declared largest one.
    #[serde(rename = "turn_rate_start_deg_s", deserialize_with = "degrees")]
    pub turn_rate_start_radps: f64,
    /// A run ends when the rate stays under half its start for this long.
    pub turn_quiet_s: f64,
    /// Runs to one side with a shorter gap are one.
    pub turn_gap_s: f64,
    /// A change of `substantial_turn_deg` within this is a run, however slow.
    pub slow_turn_s: f64,
    /// A speed run changes at least this fast.
    pub speed_rate_mps2: f64,
    /// Below this speed a heading means nothing.
    pub moving_mps: f64,
    /// Smallest turn that another ship can see.
    #[serde(rename = "detectable_turn_deg", deserialize_with = "degrees")]
    pub detectable_turn_rad: f64,
    /// Likewise, change of speed.
    pub detectable_speed_fraction: f64,
    /// A turn that counts as an action.
    #[serde(rename = "substantial_turn_deg", deserialize_with = "degrees")]
    pub substantial_turn_rad: f64,
    /// Likewise, cut of speed.
    pub substantial_speed_fraction: f64,
    /// A turn that is readily apparent.
    #[serde(rename = "apparent_turn_deg", deserialize_with = "degrees")]
    pub apparent_turn_rad: f64,
    /// Likewise, cut of speed.
    pub apparent_speed_fraction: f64,
    /// An offset counts when it is held this long.
    pub offset_held_s: f64,
    /// Heading and speed before an action are means over this time.
    pub baseline_s: f64,
    /// A run this long before the onset of risk still belongs to that target.
    pub attribution_lead_s: f64,
    /// This many small alterations to one side are a warning.
    pub dribble_warn_runs: u32,
    /// This many are a failure.
    pub dribble_fail_runs: u32,
}

/// Ample time.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// A slower reaction is a warning.
    pub react_warn_s: f64,
    /// A slower reaction is a failure; absent: no such limit.
    pub react_fail_s: Option<f64>,
    /// Where risk opens inside stage 3: a reaction up to this passes.
    pub late_onset_pass_s: f64,
    /// Likewise: a slower one fails.
    pub late_onset_fail_s: f64,
    /// Less time to the last safe instant is a warning.
    pub last_minute_warn_s: f64,
    /// An alert this far from any risk is false.
    pub alert_tolerance_s: f64,
}

/// The stand-on vessel.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StandOn {
    /// She may act once a close pass has been predicted this long in stage 3.
    pub may_act_persistence_s: f64,
    /// Whether she may also act when the other has not moved for `may_act_early_s` in stage 2.
    pub may_act_early: bool,
    /// See `may_act_early`.
    pub may_act_early_s: f64,
    /// She shall act within this of stage 4 (or of the other's last safe instant).
    pub shall_act_grace_s: f64,
    /// Her heading is a mean over this time.
    pub heading_mean_s: f64,
    /// What a turn to port in stage 4 is.
    pub port_in_stage_4: PortInExtremis,
}

/// What a turn to port in stage 4 is to the judge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PortInExtremis {
    /// 17(b) wants "such action as will best aid": a warning.
    Warn,
    /// The conservative reading: a failure.
    Fail,
}

/// Restricted visibility.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RestrictedVisibility {
    /// `D_cq`: distance of close quarters.
    pub close_quarters_m: f64,
    /// Steerage speed as a share of the planned one, where the ship declares none.
    pub steerage_fraction: f64,
    /// Safe speed: own ship stops within this share of the visual range.
    pub stopping_visibility_share: f64,
}

fn degrees<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    f64::deserialize(deserializer).map(deg)
}
