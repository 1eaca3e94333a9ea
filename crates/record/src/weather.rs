//! Current, wind and waves of one encounter.

use geom::Vec2;
use serde::{Deserialize, Serialize};

/// Current, wind and waves; the default is calm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Weather {
    /// Constant current, metres a second towards north and east; zero in calm.
    pub current_mps: Vec2,
    /// What the current does besides, the same for all ships.
    #[serde(default)]
    pub current_noise: Option<Fluctuation>,
    /// Wind with gusts, the same for all ships.
    #[serde(default)]
    pub wind: Option<Wind>,
    /// Waves; every ship has her own phase.
    #[serde(default)]
    pub waves: Option<Waves>,
}

/// A first-order Gauss-Markov process: normal with mean 0, correlation `exp(-t / time constant)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fluctuation {
    /// Standard deviation, m/s (of each component of a vector).
    pub sd_mps: f64,
    /// Time constant, seconds.
    pub time_constant_s: f64,
}

/// Wind. A ship drifts to leeward by the force on her projected areas, or where her model has none
/// by a share of the wind across her heading; along her heading her engine makes up for it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wind {
    /// Mean, metres a second towards north and east (where it blows to).
    pub velocity_mps: Vec2,
    /// Gusts along the mean direction.
    pub gusts: Fluctuation,
    /// Leeway as a share of the wind across the heading, for ships whose model has no areas.
    pub leeway: f64,
}

/// Waves: a mean drift, a drift that comes and goes, and a yaw disturbance, first-order processes
/// all of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Waves {
    /// Mean drift, metres a second towards north and east.
    pub drift_mps: Vec2,
    /// Standard deviation of each component of the drift, m/s.
    pub drift_sd_mps: f64,
    /// Standard deviation of the yaw rate that waves impose, rad/s.
    pub yaw_rate_sd_radps: f64,
    /// Time constant of both, seconds.
    pub time_constant_s: f64,
    /// Ships longer than this feel less, as this length over theirs, metres.
    pub length_m_ref: f64,
}
