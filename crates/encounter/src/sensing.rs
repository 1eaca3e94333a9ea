//! What own ship perceives, as a campaign file says it: `perfect`, or `ais_radar` with its tables.

use crate::Error;
use crate::error::require;
use crate::limits::positive;
use geom::units::deg;
use record::{Ais, AisRadar, Radar, Sensing, Tracker};
use serde::{Deserialize, Serialize};

/// What own ship perceives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensingSpec {
    /// Which world.
    pub kind: SensingKind,
    /// With `perfect`: range between reference points within which ships are seen, metres;
    /// absent: no limit.
    pub detection_range_m: Option<f64>,
    /// With `ais_radar`: the receiver; absent: none on board.
    pub ais: Option<AisSpec>,
    /// With `ais_radar`: the radar; absent: none on board.
    pub radar: Option<RadarSpec>,
    /// With `ais_radar`: the tracker.
    pub tracker: Option<Tracker>,
}

/// Kinds of sensing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SensingKind {
    /// The truth about every ship in range.
    Perfect,
    /// Tracks made of AIS reports and radar plots.
    AisRadar,
}

/// The AIS receiver; see [`record::Ais`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AisSpec {
    /// Share of targets that transmit at all.
    pub carried: f64,
    /// Targets from this length on are class A, metres.
    pub class_a_length_m_min: f64,
    /// Share of reports that are lost.
    pub dropout: f64,
    /// Standard deviation of each coordinate, metres.
    pub position_sd_m: f64,
    /// Of the speed, m/s.
    pub sog_sd_mps: f64,
    /// Of the course, degrees.
    pub cog_sd_deg: f64,
    /// Of the heading, degrees.
    pub heading_sd_deg: f64,
    /// Mean delay of the first report beyond its phase, seconds.
    pub first_delay_s_mean: f64,
    /// Share of targets with wrong dimensions.
    pub static_wrong: f64,
    /// Share of targets without dimensions.
    pub static_missing: f64,
    /// From measurement to tracker, seconds.
    pub latency_s: f64,
}

/// The radar; see [`record::Radar`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RadarSpec {
    /// Time of one turn of the antenna, seconds.
    pub rotation_s: f64,
    /// Standard deviation of the range, metres.
    pub range_sd_m: f64,
    /// Of the bearing, degrees.
    pub bearing_sd_deg: f64,
    /// Probability of a plot close by.
    pub detection_probability: f64,
    /// Range at which it has fallen to half, metres.
    pub range_m_half: f64,
    /// No plot beyond this range, metres.
    pub range_m_max: f64,
    /// Mean number of false plots of one turn.
    pub clutter_per_scan: f64,
    /// Radius of the disc that they lie in, metres.
    pub clutter_range_m: f64,
    /// From measurement to tracker, seconds.
    pub latency_s: f64,
}

impl SensingSpec {
    /// As the simulator takes it.
    pub fn sensing(&self) -> Sensing {
        match (self.kind, self.tracker) {
            (SensingKind::AisRadar, Some(tracker)) => {
                let (ais, radar) = (self.ais.map(ais), self.radar.map(radar));
                Sensing::AisRadar(Box::new(AisRadar { ais, radar, tracker }))
            }
            _ => Sensing::Perfect { detection_range_m: self.detection_range_m },
        }
    }

    /// Refuses a table that belongs to the other kind, or lacks one of its own. The numbers of the
    /// tables are checked with the first encounter of every stratum, by the simulator.
    pub(crate) fn validate(&self, table: &str) -> Result<(), Error> {
        let tables = self.ais.is_some() || self.radar.is_some() || self.tracker.is_some();
        match self.kind {
            SensingKind::Perfect => require(
                !tables,
                || format!("{table}.kind"),
                || "= \"perfect\" has no ais, radar or tracker; write \"ais_radar\"".to_owned(),
            )?,
            SensingKind::AisRadar => {
                require(
                    self.detection_range_m.is_none(),
                    || format!("{table}.detection_range_m"),
                    || "belongs to kind = \"perfect\"; a radar has range_m_max".to_owned(),
                )?;
                require(
                    self.tracker.is_some() && (self.ais.is_some() || self.radar.is_some()),
                    || format!("{table}.tracker"),
                    || "and `ais` or `radar` are needed with kind = \"ais_radar\"".to_owned(),
                )?;
            }
        }
        self.detection_range_m
            .map_or(Ok(()), |range_m| positive(table, "detection_range_m", range_m))
    }
}

fn ais(spec: AisSpec) -> Ais {
    Ais {
        carried: spec.carried,
        class_a_length_m_min: spec.class_a_length_m_min,
        dropout: spec.dropout,
        position_sd_m: spec.position_sd_m,
        sog_sd_mps: spec.sog_sd_mps,
        cog_sd_rad: deg(spec.cog_sd_deg),
        heading_sd_rad: deg(spec.heading_sd_deg),
        first_delay_s_mean: spec.first_delay_s_mean,
        static_wrong: spec.static_wrong,
        static_missing: spec.static_missing,
        latency_s: spec.latency_s,
    }
}

fn radar(spec: RadarSpec) -> Radar {
    Radar {
        rotation_s: spec.rotation_s,
        range_sd_m: spec.range_sd_m,
        bearing_sd_rad: deg(spec.bearing_sd_deg),
        detection_probability: spec.detection_probability,
        range_m_half: spec.range_m_half,
        range_m_max: spec.range_m_max,
        clutter_per_scan: spec.clutter_per_scan,
        clutter_range_m: spec.clutter_range_m,
        latency_s: spec.latency_s,
    }
}
