//! The state of current, wind and waves, drawn for each encounter.
//!
//! Directions are uniform over the circle; waves run with the wind. The stream is one of its own,
//! so that weather moves no ship of the geometry, and its fluctuations come from another.

use crate::limits::positive;
use crate::{Distribution, Error};
use geom::units::deg;
use record::{Fluctuation, Purpose, Streams, Waves, Weather, Wind};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The table `[model.weather]`; absent: calm. Each of its tables may be absent, too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeatherSpec {
    /// Current.
    pub current: Option<CurrentSpec>,
    /// Wind.
    pub wind: Option<WindSpec>,
    /// Waves.
    pub waves: Option<WavesSpec>,
}

/// Current: a constant and a fluctuation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurrentSpec {
    /// Speed of the constant part, m/s.
    pub speed_mps: Distribution,
    /// Standard deviation of each component of the rest, m/s.
    pub sd_mps: f64,
    /// Its time constant, seconds.
    pub time_constant_s: f64,
}

/// Wind with gusts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindSpec {
    /// Mean speed, m/s.
    pub speed_mps: Distribution,
    /// Standard deviation of gusts as a share of the mean speed.
    pub gust_sd_per_speed: f64,
    /// Time constant of gusts, seconds.
    pub gust_time_constant_s: f64,
    /// Leeway as a share of the wind across the heading, for ships whose model has no areas.
    pub leeway: f64,
}

/// Waves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WavesSpec {
    /// Mean drift, m/s, with the wind.
    pub drift_mps: Distribution,
    /// Standard deviation of each component of the rest, m/s.
    pub drift_sd_mps: f64,
    /// Standard deviation of the yaw rate that waves impose, degrees a second.
    pub yaw_rate_sd_deg_s: f64,
    /// Time constant of both, seconds.
    pub time_constant_s: f64,
    /// Ships longer than this feel less, as this length over theirs, metres.
    pub length_m_ref: f64,
}

impl WeatherSpec {
    pub(crate) fn validate(&self) -> Result<(), Error> {
        const TABLE: &str = "model.weather";
        let key = |name: &str| format!("{TABLE}.{name}");
        if let Some(current) = &self.current {
            current.speed_mps.validate_within(&key("current.speed_mps"), 0.0, 5.0)?;
            positive(&key("current"), "time_constant_s", current.time_constant_s)?;
        }
        if let Some(wind) = &self.wind {
            wind.speed_mps.validate_within(&key("wind.speed_mps"), 0.0, 50.0)?;
            positive(&key("wind"), "gust_time_constant_s", wind.gust_time_constant_s)?;
        }
        if let Some(waves) = &self.waves {
            waves.drift_mps.validate_within(&key("waves.drift_mps"), 0.0, 2.0)?;
            positive(&key("waves"), "time_constant_s", waves.time_constant_s)?;
            positive(&key("waves"), "length_m_ref", waves.length_m_ref)?;
        }
        Ok(())
    }

    /// The weather of one encounter. Both directions are drawn, whether their tables are there or
    /// not.
    pub(crate) fn draw(&self, streams: &Streams) -> Weather {
        let mut stream = streams.stream(Purpose::Weather, 0);
        let set = geom::unit(-stream.uniform_in(-PI, PI));
        let leeward = geom::unit(-stream.uniform_in(-PI, PI));
        let mut speed = |law: Option<&Distribution>| law.map_or(0.0, |law| law.draw(&mut stream));
        let current_mps = speed(self.current.as_ref().map(|current| &current.speed_mps));
        let wind_mps = speed(self.wind.as_ref().map(|wind| &wind.speed_mps));
        let wave_mps = speed(self.waves.as_ref().map(|waves| &waves.drift_mps));
        Weather {
            current_mps: set * current_mps,
            current_noise: self.current.as_ref().map(|current| Fluctuation {
                sd_mps: current.sd_mps,
                time_constant_s: current.time_constant_s,
            }),
            wind: self.wind.as_ref().map(|wind| Wind {
                velocity_mps: leeward * wind_mps,
                gusts: Fluctuation {
                    sd_mps: wind.gust_sd_per_speed * wind_mps,
                    time_constant_s: wind.gust_time_constant_s,
                },
                leeway: wind.leeway,
            }),
            waves: self.waves.as_ref().map(|waves| Waves {
                drift_mps: leeward * wave_mps,
                drift_sd_mps: waves.drift_sd_mps,
                yaw_rate_sd_radps: deg(waves.yaw_rate_sd_deg_s),
                time_constant_s: waves.time_constant_s,
                length_m_ref: waves.length_m_ref,
            }),
        }
    }
}
