//! What own ship's planner can perceive: the truth, or what AIS, radar and a tracker make of it.

use serde::{Deserialize, Serialize};

/// What own ship's planner can perceive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sensing {
    /// The truth about every ship within `detection_range_m` (absent: all of them).
    Perfect {
        /// Metres between the reference points.
        detection_range_m: Option<f64>,
    },
    /// Tracks made of AIS reports and radar plots.
    AisRadar(Box<AisRadar>),
}

impl Sensing {
    /// The word used in files.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Perfect { .. } => "perfect",
            Self::AisRadar(_) => "ais_radar",
        }
    }
}

/// Sensors and tracker of own ship. Her own position is known exactly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AisRadar {
    /// The receiver; absent: none on board.
    pub ais: Option<Ais>,
    /// The radar; absent: none on board.
    pub radar: Option<Radar>,
    /// The tracker.
    pub tracker: Tracker,
}

/// The automatic identification system. Reporting intervals are those of ITU-R M.1371-5: class A
/// as moving and turning asks, class B (CS) every 30 s, or 180 s at up to 2 knots.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ais {
    /// Share of targets that transmit at all.
    pub carried: f64,
    /// Targets from this length on are class A, the others class B, metres.
    pub class_a_length_m_min: f64,
    /// Share of reports that are lost on the air.
    pub dropout: f64,
    /// Error of each coordinate, standard deviation, metres.
    pub position_sd_m: f64,
    /// Error of the speed over ground, m/s.
    pub sog_sd_mps: f64,
    /// Error of the course over ground, radians.
    pub cog_sd_rad: f64,
    /// Error of the heading (class A alone reports one), radians.
    pub heading_sd_rad: f64,
    /// Mean of an exponential delay of the first report beyond its phase, seconds; 0: none.
    pub first_delay_s_mean: f64,
    /// Share of targets whose dimensions are wrong, by a factor from 0.5 to 1.5.
    pub static_wrong: f64,
    /// Share of targets whose dimensions are not reported.
    pub static_missing: f64,
    /// From measurement to tracker, seconds.
    pub latency_s: f64,
}

/// A rotating radar. A target at range `r` gives a plot with probability
/// `detection_probability / (1 + (r / range_m_half)^4)` (the echo's power goes with `r^-4`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Radar {
    /// Time of one turn of the antenna, seconds; at least the beat.
    pub rotation_s: f64,
    /// Error of the range, standard deviation, metres.
    pub range_sd_m: f64,
    /// Error of the bearing, radians.
    pub bearing_sd_rad: f64,
    /// Probability of a plot close by.
    pub detection_probability: f64,
    /// Range at which it has fallen to half, metres.
    pub range_m_half: f64,
    /// No plot beyond this range, metres.
    pub range_m_max: f64,
    /// Mean number of false plots of one turn (a Poisson law), even over a disc ...
    pub clutter_per_scan: f64,
    /// ... of this radius around own ship, metres.
    pub clutter_range_m: f64,
    /// From measurement to tracker, seconds.
    pub latency_s: f64,
}

/// The tracker: constant-velocity Kalman filters with gated nearest neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tracker {
    /// White acceleration that the filter allows for, m/s^2 over one second (the root of its
    /// spectral density).
    pub acceleration_sd_mps2: f64,
    /// Standard deviation of an unknown velocity, each component, m/s.
    pub speed_sd_mps: f64,
    /// Largest squared Mahalanobis distance of a plot to its track; 9.21 holds 99 %.
    pub gate: f64,
    /// A track without AIS is confirmed by this many plots ...
    pub confirm_hits: u32,
    /// ... in this many scans, at most 32.
    pub confirm_scans: u32,
    /// A track without AIS is lost after this time without a plot, seconds.
    pub radar_coast_s_max: f64,
    /// A track with AIS likewise; more than the interval of reports.
    pub ais_coast_s_max: f64,
    /// Probability that the planner gets the picture of the beat before.
    pub frame_drop: f64,
}
