//! What happened: states, orders and contacts of one run, sampled once a beat.
//!
//! Made by `sim`, read by `rules`, `stl` and `report`. Sample `k` is at `k * sample_s`; a distance
//! that decides something is refined within the step and carries its own time.

use crate::{EncounterId, Outcome, Waypoint, encounter::DistanceKind, encounter::Visibility};
use geom::{HeadOnSector, HullOutline, Vec2};
use serde::{Deserialize, Serialize};

/// One run, whole. Plain data: the judge sees this and nothing else.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trace {
    /// Which encounter.
    pub id: EncounterId,
    /// How it ended.
    pub outcome: Outcome,
    /// When it ended, seconds.
    pub end_s: f64,
    /// Interval of the samples, seconds (the beat).
    pub sample_s: f64,
    /// Distance that own ship shall keep, metres, measured as `distance` says.
    pub safety_radius_m: f64,
    /// The one kind of distance of this campaign.
    pub distance: DistanceKind,
    /// In sight of one another, or not.
    pub visibility: Visibility,
    /// Own ship's planned route and speed (m/s).
    pub route: Vec<Waypoint>,
    /// Planned speed, m/s.
    pub cruise_mps: f64,
    /// Own ship.
    pub own: ShipTrack,
    /// The other ships, in the order of the encounter.
    pub targets: Vec<ShipTrack>,
    /// Own ship against each target, in the same order.
    pub pairs: Vec<Pair>,
    /// Smallest distance from own hull to a hazard, metres; absent without hazards.
    pub hazard_m_min: Option<f64>,
    /// The planner's order of each beat: course (rad, clockwise from north), speed (m/s).
    pub orders: Vec<Order>,
    /// What the planner declared.
    pub alerts: Vec<Alert>,
    /// What the planner counted.
    pub events: PlannerEvents,
    /// The head-on sector by which the planner says that it classifies; absent where it states
    /// none. A declaration, no event of the run: no part of the digest.
    pub planner_sector: Option<HeadOnSector>,
    /// The last words of a planner that failed. No part of the digest.
    pub planner_detail: Option<String>,
    /// The contact that ended the run.
    pub contact: Option<Contact>,
    /// Own ship came to her last waypoint, by the condition that ends a run which goes on to it.
    /// It follows from the tracks and is no part of the digest.
    pub goal_reached: bool,
    /// The same encounter with own ship on its route, not avoiding.
    pub nominal: Option<Nominal>,
    /// The last safe instants of each pair (rules specification, section 10) that reached stage 3,
    /// where they were computed. Not part of the digest: they depend on the rule set.
    pub last_minute: Option<Vec<Option<LastMinute>>>,
    /// The run ended in a contact, and no manoeuvre of own ship begun at any beat from the first at
    /// which she could act clears all targets and hazards; absent where it was not computed. No
    /// part of the digest either.
    pub unavoidable: Option<bool>,
}

impl Trace {
    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.own.north_m.len()
    }
}

/// What does not change about a ship.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ship {
    /// Outline.
    pub hull: HullOutline,
    /// Declared largest yaw rate, rad/s.
    pub yaw_rate_radps_max: f64,
    /// Declared largest speed, m/s.
    pub speed_mps_max: f64,
    /// Slowest speed at which she steers, m/s; absent where the model declares none.
    pub steerage_mps: Option<f64>,
    /// In what distance she stops; absent where nobody says.
    pub stopping: Option<Stopping>,
}

/// A declared stopping model: how far a ship goes along her track after full astern.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stopping {
    /// The highest speed that is declared, m/s.
    pub speed_mps_max: f64,
    /// Track reach, metres, from equal steps of speed up to the highest: entry `i` from
    /// `(i + 1) / STEPS` of it.
    pub reach_m: [f64; Self::STEPS],
}

impl Stopping {
    /// Number of declared speeds.
    pub const STEPS: usize = 8;

    /// Track reach from a speed, metres. Straight lines between the declared speeds, which lie
    /// above the curve of a ship that takes longer the faster she goes; beyond the highest with the
    /// square of the speed.
    pub fn distance_m(&self, speed_mps: f64) -> f64 {
        let at = (speed_mps / self.speed_mps_max).max(0.0) * Self::STEPS as f64;
        if at >= Self::STEPS as f64 {
            let faster = at / Self::STEPS as f64;
            return self.reach_m[Self::STEPS - 1] * faster * faster;
        }
        let step = at as usize;
        let lower_m = if step == 0 { 0.0 } else { self.reach_m[step - 1] };
        lower_m + (self.reach_m[step] - lower_m) * (at - step as f64)
    }
}

/// Samples of one ship, one array for each signal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShipTrack {
    /// Who.
    pub ship: Ship,
    /// Metres north.
    pub north_m: Vec<f64>,
    /// Metres east.
    pub east_m: Vec<f64>,
    /// Heading, radians clockwise from north, wrapped.
    pub psi_rad: Vec<f64>,
    /// Velocity over ground towards north, m/s.
    pub vel_north_mps: Vec<f64>,
    /// Velocity over ground towards east, m/s.
    pub vel_east_mps: Vec<f64>,
    /// Speed ahead through the water, m/s.
    pub stw_mps: Vec<f64>,
    /// Yaw rate, rad/s.
    pub yaw_rate_radps: Vec<f64>,
}

impl ShipTrack {
    /// A track without samples, with room for some.
    pub fn with_capacity(ship: Ship, samples: usize) -> Self {
        let room = || Vec::with_capacity(samples);
        Self {
            ship,
            north_m: room(),
            east_m: room(),
            psi_rad: room(),
            vel_north_mps: room(),
            vel_east_mps: room(),
            stw_mps: room(),
            yaw_rate_radps: room(),
        }
    }

    /// Position at sample `k`, metres.
    pub fn position_m(&self, k: usize) -> Vec2 {
        Vec2::new(self.north_m[k], self.east_m[k])
    }

    /// Velocity over ground at sample `k`, m/s.
    pub fn velocity_mps(&self, k: usize) -> Vec2 {
        Vec2::new(self.vel_north_mps[k], self.vel_east_mps[k])
    }

    /// Speed over ground at sample `k`, m/s.
    pub fn sog_mps(&self, k: usize) -> f64 {
        geom::math::length(self.vel_north_mps[k], self.vel_east_mps[k])
    }

    /// Course over ground at sample `k`; the heading where the ship does not move.
    pub fn cog_rad(&self, k: usize) -> f64 {
        let velocity = self.velocity_mps(k);
        if velocity.norm_squared() < 1e-12 {
            self.psi_rad[k]
        } else {
            geom::angle::direction(velocity)
        }
    }

    /// All signals, in the order in which the digest takes them.
    pub fn signals(&self) -> [&Vec<f64>; 7] {
        [
            &self.north_m,
            &self.east_m,
            &self.psi_rad,
            &self.vel_north_mps,
            &self.vel_east_mps,
            &self.stw_mps,
            &self.yaw_rate_radps,
        ]
    }

    /// All signals, to change them alike.
    pub fn signals_mut(&mut self) -> [&mut Vec<f64>; 7] {
        [
            &mut self.north_m,
            &mut self.east_m,
            &mut self.psi_rad,
            &mut self.vel_north_mps,
            &mut self.vel_east_mps,
            &mut self.stw_mps,
            &mut self.yaw_rate_radps,
        ]
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.north_m.len()
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.north_m.is_empty()
    }
}

/// Own ship against one target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// Hull-to-hull distance, metres: entry `k` is the smallest over the interval that ends at
    /// sample `k` (entry 0: at the start). While the ships are too far apart for it to matter the
    /// entry is a lower bound, centre distance less both radii; the minimum itself is exact.
    pub hull_m: Vec<f64>,
    /// The smallest distances of the run, refined within the step.
    pub minimum: PairMinimum,
    /// First detection by a sensor of own ship, seconds.
    pub detected_s: Option<f64>,
    /// Track confirmed, seconds.
    pub tracked_s: Option<f64>,
}

/// Smallest distances of a pair and when they were.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PairMinimum {
    /// Hull to hull, metres; 0 on contact.
    pub hull_m: f64,
    /// When, seconds.
    pub hull_s: f64,
    /// Reference point to reference point, metres.
    pub centre_m: f64,
    /// When, seconds.
    pub centre_s: f64,
}

impl PairMinimum {
    /// The distance of the campaign's kind and its time: (metres, seconds).
    pub const fn of(&self, kind: DistanceKind) -> (f64, f64) {
        match kind {
            DistanceKind::Hull => (self.hull_m, self.hull_s),
            DistanceKind::Centre => (self.centre_m, self.centre_s),
        }
    }
}

/// What the planner ordered at a beat.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Order {
    /// Course, radians clockwise from north, wrapped.
    pub course_rad: f64,
    /// Speed, m/s.
    pub speed_mps: f64,
}

/// A conflict that the planner declared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Alert {
    /// When, seconds.
    pub t_s: f64,
    /// Index of the target.
    pub target: u8,
    /// The rule it says it follows, in its own words; may be empty.
    pub rule: String,
}

/// What the planner counted of itself, from its own report.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlannerEvents {
    /// Beats at which an inner loop met its cap.
    pub inner_loop_cap: u32,
    /// Beats at which a limit of the planner cut its own order (speed clamped at 0, and the like).
    pub limited: u32,
    /// Beats at which it was inside a safety circle and called that safe.
    pub inside_called_safe: u32,
    /// Beats at which its class of some target differed from the beat before.
    pub class_changes: u32,
    /// Beats at which a receding target was treated as a danger.
    pub receding_flagged: u32,
    /// Passes of inner loops, in all.
    pub passes: u32,
}

/// A contact of two hulls, or of a hull and a hazard.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// When, seconds.
    pub t_s: f64,
    /// With what.
    pub with: ContactWith,
    /// Closing speed at the point of contact along its normal, m/s.
    pub impact_mps: f64,
    /// Impulse of the contact, newton seconds.
    pub impulse_ns: f64,
    /// Kinetic energy lost in it, joules.
    pub energy_lost_j: f64,
}

/// What was touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactWith {
    /// The target with this index.
    Target(u8),
    /// The hazard with this index.
    Hazard(u8),
}

/// The encounter without avoidance: own ship follows its route at its planned speed, targets
/// follow their scripts and do not react, noise is the same. Sampled like the trace.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Nominal {
    /// Own ship. Her track may be longer than those of the others, never shorter: where the run
    /// outlasts the encounter without avoidance she goes on until the end of the run.
    pub own: ShipTrack,
    /// The other ships.
    pub targets: Vec<ShipTrack>,
    /// Smallest distances of each pair; not ended by a contact.
    pub minima: Vec<PairMinimum>,
}

/// The last safe instants of one pair on the nominal track (rules specification, section 10).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LastMinute {
    /// Own ship alone, with the turns that Rules 14 and 17(c) allow her, to avoid contact.
    pub own: LastInstant,
    /// Own ship alone, with every turn, to avoid contact.
    pub own_any_turn: LastInstant,
    /// Own ship alone, with the allowed turns, to avoid a near miss.
    pub own_near_miss: LastInstant,
    /// The target alone, to avoid contact.
    pub target: LastInstant,
}

/// A last safe instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LastInstant {
    /// The nominal track never comes to the critical distance.
    NeverCritical,
    /// Already too late at the start.
    BeforeStart,
    /// Seconds from the start; on the grid.
    At(f64),
    /// Likewise, from a kinematic guess because the ship declares no model.
    Indicative(f64),
}
