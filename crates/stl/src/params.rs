//! Thresholds of the second judge. The caller fills them from a named rule set file: nothing here
//! has a default, because every one of them changes a result and only one is law.

/// Which limits open the stages of an encounter (rules specification, section 3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StageClock {
    /// Fixed ranges; the overtaking roles use time all the same.
    Range,
    /// Times at the closing speed, never less than the ranges.
    Time,
}

/// The numbers that the formulas and their signals need. Angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// `D_risk`: predicted distance under which risk opens.
    pub risk_distance_m: f64,
    /// `D_cq`: by radar alone a pass predicted within this opens the duty of Rule 19(d) too.
    pub close_quarters_m: f64,
    /// `T_risk`: longest time to the closest point at which risk opens.
    pub risk_tcpa_s: f64,
    /// How long the condition of risk, or of its end, must last.
    pub risk_hold_s: f64,
    /// Risk closes beyond this multiple of `D_risk`.
    pub risk_close_factor: f64,
    /// Above this yaw rate of either ship a prediction means nothing and the state is kept.
    pub manoeuvring_yaw_rate_radps: f64,
    /// `H`: half-angle of the head-on sector.
    pub head_on_half_angle_rad: f64,
    /// `H_rec`: largest departure from reciprocal headings.
    pub head_on_reciprocal_rad: f64,
    /// Another class within this much of heading or bearing leaves doubt.
    pub doubt_rad: f64,
    /// A ship slower than this is stopped.
    pub stopped_mps: f64,
    /// `R_2`, `R_3`, `R_4`.
    pub stage_range_m: [f64; 3],
    /// `T_2`, `T_3`, `T_4`.
    pub stage_time_s: [f64; 3],
    /// Which of the two.
    pub stage_clock: StageClock,
    /// `r_pref`: distance that is preferred.
    pub preferred_m: f64,
    /// `r_min`: distance that is asked for.
    pub minimum_m: f64,
    /// `r_nm`: below it a near miss.
    pub near_miss_m: f64,
    /// Smallest alteration that can be detected.
    pub turn_detectable_rad: f64,
    /// Smallest alteration that may count in sight of one another.
    pub turn_action_rad: f64,
    /// Alteration that is readily apparent; the only one that counts by radar.
    pub turn_apparent_rad: f64,
    /// Smallest share of the speed that can be detected.
    pub speed_detectable: f64,
    /// Smallest share of the speed that may count.
    pub speed_action: f64,
    /// How long an offset is held before it counts.
    pub offset_hold_s: f64,
    /// Time over which the course and speed before an action are averaged.
    pub reference_s: f64,
    /// Time over which the heading of a stand-on ship is averaged.
    pub stand_on_mean_s: f64,
    /// How long T must be seen to do too little before the stand-on ship may act.
    pub may_act_hold_s: f64,
    /// After this time beyond its deadline the action that Rule 17(b) orders is missing.
    pub shall_act_grace_s: f64,
    /// How runs of alteration are found.
    pub run: RunParams,
    /// A run belongs to a risk that opens at most this much later.
    pub attribution_lead_s: f64,
    /// Past and clear must last this long.
    pub release_hold_s: f64,
    /// Past and clear of an overtaken ship within this angle of the bow.
    pub release_overtaking_rad: f64,
    /// Past and clear of a meeting or crossing ship when one has the other this far abaft her bow.
    pub release_abaft_rad: f64,
    /// Past and clear of any ship beyond this multiple of `R_2`.
    pub release_range_factor: f64,
    /// Rule 13(d): too close ahead within this angle of the other's bow.
    pub overtaken_bow_rad: f64,
    /// Whether Rule 17(c) binds in stage 4 too.
    pub port_turn_fails_in_stage_4: bool,
    /// Units of the robustness.
    pub scale: Scales,
}

/// How runs of alteration are found (section 5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunParams {
    /// Standard deviation of the smoothing of the heading.
    pub smoothing_s: f64,
    /// `q_on`, where half the declared largest yaw rate is not smaller.
    pub yaw_rate_on_radps: f64,
    /// A run ends when the yaw rate stays under half of `q_on` this long.
    pub quiet_s: f64,
    /// Runs of one side with a gap shorter than this are one.
    pub gap_s: f64,
    /// A turn of `turn_action_rad` within this time is a run however slow.
    pub slow_s: f64,
    /// `e_U`: acceleration at which a speed run starts, m/s^2.
    pub acceleration_mps2: f64,
    /// `U_min`: a slower ship does not turn on purpose.
    pub moving_mps: f64,
}

/// One unit of robustness for each kind of signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// For distances.
    pub distance_m: f64,
    /// For angles.
    pub angle_rad: f64,
    /// For shares of the speed.
    pub speed: f64,
}
