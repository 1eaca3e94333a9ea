//! What own ship's planner perceives: tracks, never the truth.
//!
//! The way of a measurement: [`ais`] and [`radar`] look at the world, [`fused`] holds their answers
//! back for their latency, [`tracker`] makes tracks of them with the filter of [`kalman`].

pub mod ais;
pub mod fused;
pub mod kalman;
pub mod perfect;
pub mod radar;
mod track;
pub mod tracker;

pub use perfect::own_state;
pub(crate) use perfect::track_of;

use crate::ship::Ship;
use planner_api::TargetTrack;
use record::{Encounter, Sensing};

/// The sensors of own ship.
#[derive(Clone, Debug)]
pub enum Sensors {
    /// The laboratory's.
    Perfect(perfect::Perfect),
    /// AIS, radar and tracker.
    Fused(Box<fused::Fused>),
}

impl Sensors {
    /// The sensors of one encounter.
    pub fn new(encounter: &Encounter, targets: &[Ship]) -> Self {
        match &encounter.sensing {
            Sensing::Perfect { detection_range_m } => {
                Self::Perfect(perfect::Perfect::new(*detection_range_m, targets.len()))
            }
            Sensing::AisRadar(sensing) => {
                Self::Fused(Box::new(fused::Fused::new(sensing, encounter, targets)))
            }
        }
    }

    /// Looks at the world at `t_s` and writes the tracks.
    pub fn look(&mut self, t_s: f64, own: &Ship, targets: &[Ship], tracks: &mut Vec<TargetTrack>) {
        match self {
            Self::Perfect(perfect) => perfect.look(t_s, own, targets, tracks),
            Self::Fused(fused) => fused.look(t_s, own, targets, tracks),
        }
    }

    /// The target behind a track that the planner was shown, by its latest measurement; `None` for
    /// a track of clutter and for a number that no track has.
    pub fn target_of(&self, track: u32, tracks: &[TargetTrack]) -> Option<u8> {
        let known = tracks.iter().any(|t| t.id == track);
        match self {
            Self::Perfect(_) => known.then_some(track as u8),
            Self::Fused(fused) => fused.target_of(track).filter(|_| known),
        }
    }

    /// First detection of target `index` and first confirmed track, seconds.
    pub fn first_s(&self, index: usize) -> (Option<f64>, Option<f64>) {
        match self {
            Self::Perfect(perfect) => (perfect.first_s(index), perfect.first_s(index)),
            Self::Fused(fused) => fused.first_s(index),
        }
    }
}

/// One measurement on its way to the tracker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// When it was true, seconds.
    pub t_s: f64,
    /// When the tracker gets it, seconds.
    pub ready_s: f64,
    /// The target it came from; `None` for clutter. For the record, never for the tracker.
    pub origin: Option<u8>,
    /// Position, metres north and east.
    pub position_m: geom::Vec2,
    /// Its covariance, m^2.
    pub position_m2: kalman::Cov,
    /// What an AIS report says besides; `None` for a radar plot.
    pub report: Option<Report>,
}

/// The rest of an AIS report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Who says so.
    pub mmsi: u32,
    /// Velocity over ground, m/s.
    pub velocity_mps: geom::Vec2,
    /// Its covariance, (m/s)^2.
    pub velocity_mps2: kalman::Cov,
    /// Heading, radians.
    pub psi_rad: Option<f64>,
    /// Length and beam, metres.
    pub size_m: Option<(f64, f64)>,
}
