//! The distance that a planner keeps from a target, between reference points.

use planner_api::{Mission, TargetTrack};
use serde::{Deserialize, Serialize};

/// Added to half of both lengths where distances are from hull to hull, metres.
const HULL_ALLOWANCE_M: f64 = 5.0;

/// Length taken for a target that does not report one, metres: the longest of the default campaign,
/// because too wide a berth is the safer error. The default of every planner's
/// `unknown_length_m`.
pub const UNKNOWN_LENGTH_M: f64 = 120.0;

/// What R is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RadiusKind {
    /// As the campaign measures distances: `centre` between centres, else `hull`.
    Mission,
    /// For each target: safety radius + half of both lengths + 5 m.
    Hull,
    /// The safety radius between reference points, as in the paper's own scenes.
    Centre,
}

/// R of each target for one mission.
#[derive(Clone, Copy, Debug)]
pub struct Clearance {
    safety_radius_m: f64,
    own_length_m: f64,
    hull: bool,
    unknown_length_m: f64,
}

impl Clearance {
    /// For this mission; `unknown_length_m` stands in for a length that no track reports.
    pub fn new(mission: &Mission, kind: RadiusKind, unknown_length_m: f64) -> Self {
        let hull = match kind {
            RadiusKind::Mission => !mission.between_centres,
            RadiusKind::Hull => true,
            RadiusKind::Centre => false,
        };
        let (safety_radius_m, own_length_m) = (mission.safety_radius_m, mission.own.length_m);
        Self { safety_radius_m, own_length_m, hull, unknown_length_m }
    }

    /// The same with a larger safety radius.
    #[must_use]
    pub fn widened(self, by_m: f64) -> Self {
        Self { safety_radius_m: self.safety_radius_m + by_m, ..self }
    }

    /// Distance between reference points at which the safety radius is just kept, metres.
    pub fn radius_m(&self, track: &TargetTrack) -> f64 {
        self.safety_radius_m + self.hulls_m(track)
    }

    /// What the hulls take of a distance between reference points, metres; 0 between centres.
    pub fn hulls_m(&self, track: &TargetTrack) -> f64 {
        if !self.hull {
            return 0.0;
        }
        let length_m = track.length_m.unwrap_or(self.unknown_length_m);
        0.5 * (self.own_length_m + length_m) + HULL_ALLOWANCE_M
    }
}
