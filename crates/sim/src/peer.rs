//! A target that runs a planner of the registry: the one under test, too, so that it meets itself.
//!
//! She perceives every other ship without error, own ship as track 0 and the other targets after
//! her, because a second chain of sensors would test the sensors and not the meeting.

use crate::sensing::{own_state, track_of};
use crate::ship::Ship;
use crate::vessel::Helm;
use planner_api::{Mission, Planner, Situation, TargetTrack, Waypoint};
use record::{Encounter, Purpose, Streams, Visibility};

/// Makes the planner of this name; `None` where there is none.
pub type MakePeer<'a> = dyn FnMut(&str) -> Option<Box<dyn Planner>> + 'a;

/// A target's planner.
pub struct Peer {
    planner: Box<dyn Planner>,
    mission: Mission,
    visual_range_m: Option<f64>,
    tracks: Vec<TargetTrack>,
}

impl std::fmt::Debug for Peer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Peer").field("mission", &self.mission).finish_non_exhaustive()
    }
}

impl Peer {
    /// The planner of target `index`, told to go straight on at the speed she has.
    pub fn new(
        planner: Box<dyn Planner>,
        encounter: &Encounter,
        index: usize,
        ship: &Ship,
    ) -> Self {
        let target = &encounter.targets[index];
        let limits = ship.model.limits();
        let streams = Streams::new(encounter.seed, &encounter.id);
        let stream_seed = streams.stream(Purpose::Planner, index as u8 + 1).next_u64();
        let start = &target.start;
        let way_m = start.speed_mps.max(1.0) * encounter.run.duration_s_max;
        let position_m = start.position_m + geom::unit(start.psi_rad) * way_m;
        let mission = Mission {
            own: planner_api::OwnShip {
                length_m: target.hull.length_m,
                beam_m: target.hull.beam_m,
                speed_mps_max: limits.speed_mps_max,
                yaw_rate_radps_max: limits.yaw_rate_radps_max,
                acceleration_mps2_max: limits.acceleration_mps2_max,
            },
            route: vec![Waypoint { position_m, speed_mps: None }],
            cruise_mps: start.speed_mps,
            safety_radius_m: encounter.safety_radius_m,
            between_centres: encounter.distance == record::DistanceKind::Centre,
            beat_s: encounter.run.beat_s,
            hazards: encounter.hazards.clone(),
            stream_seed,
        };
        let visual_range_m = match encounter.visibility {
            Visibility::InSight => None,
            Visibility::Restricted { visual_range_m } => Some(visual_range_m),
        };
        Self { planner, mission, visual_range_m, tracks: Vec::new() }
    }

    /// Told once. May panic, as planners do.
    pub fn reset(&mut self) {
        self.planner.reset(&self.mission);
    }

    /// Her order of the beat at `t_s`; `None` for one that cannot be carried out.
    pub fn plan(&mut self, t_s: f64, index: usize, own: &Ship, targets: &[Ship]) -> Option<Helm> {
        self.tracks.clear();
        self.tracks.push(track_of(0, own, t_s));
        let others = targets.iter().enumerate().filter(|(other, _)| *other != index);
        self.tracks.extend(others.map(|(other, ship)| track_of(other + 1, ship, t_s)));
        let me = &targets[index];
        let own = own_state(me);
        let Self { visual_range_m, ref tracks, .. } = *self;
        let situation = Situation { t_s, own, tracks, visual_range_m };
        let command = self.planner.plan(&situation);
        let limit_mps = self.mission.own.speed_mps_max;
        let (course_rad, speed_mps) = command.order.checked(limit_mps, own.psi_rad).ok()?;
        Some(Helm::over_ground(course_rad, speed_mps, me.current_mps()))
    }
}
