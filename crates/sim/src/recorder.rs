//! Samples of a ship, one a beat, and the trace of a run that has none.

use crate::pose::Pose;
use crate::ship::Ship;
use crate::vessel::State;
use geom::Vec2;
use record::{Encounter, Outcome, PlannerEvents, ShipTrack, Trace, trace};

/// An empty track of a ship with room for `samples`.
pub fn track_of(ship: &Ship, samples: usize) -> ShipTrack {
    let limits = ship.model.limits();
    let who = trace::Ship {
        hull: ship.outline,
        yaw_rate_radps_max: limits.yaw_rate_radps_max,
        speed_mps_max: limits.speed_mps_max,
        steerage_mps: limits.steerage_mps,
        stopping: ship.stopping,
    };
    ShipTrack::with_capacity(who, samples)
}

/// Adds one sample; `velocity_mps` is over ground.
#[inline]
pub fn sample(track: &mut ShipTrack, state: &State, velocity_mps: Vec2) {
    track.north_m.push(state.position_m.x);
    track.east_m.push(state.position_m.y);
    track.psi_rad.push(state.psi_rad);
    track.vel_north_mps.push(velocity_mps.x);
    track.vel_east_mps.push(velocity_mps.y);
    track.stw_mps.push(state.surge_mps);
    track.yaw_rate_radps.push(state.yaw_rate_radps);
}

/// Adds sample `k` of another track.
pub(crate) fn copy(track: &mut ShipTrack, from: &ShipTrack, k: usize) {
    for (signal, from) in track.signals_mut().into_iter().zip(from.signals()) {
        signal.push(from[k]);
    }
}

/// The pose at sample `k` of a track.
pub fn pose(track: &ShipTrack, k: usize) -> Pose {
    Pose {
        position_m: track.position_m(k),
        velocity_mps: track.velocity_mps(k),
        heading: geom::unit(track.psi_rad[k]),
        yaw_rate_radps: track.yaw_rate_radps[k],
    }
}

/// The trace of an encounter that was not run.
pub(crate) fn not_run(encounter: &Encounter) -> Trace {
    let empty = |hull| {
        let ship = trace::Ship {
            hull,
            yaw_rate_radps_max: 0.0,
            speed_mps_max: 0.0,
            steerage_mps: None,
            stopping: None,
        };
        ShipTrack::with_capacity(ship, 0)
    };
    Trace {
        id: encounter.id.clone(),
        outcome: Outcome::Invalid,
        end_s: 0.0,
        sample_s: encounter.run.beat_s,
        safety_radius_m: encounter.safety_radius_m,
        distance: encounter.distance,
        visibility: encounter.visibility,
        route: encounter.own.route.clone(),
        cruise_mps: encounter.own.cruise_mps,
        own: empty(encounter.own.hull),
        targets: Vec::new(),
        pairs: Vec::new(),
        hazard_m_min: None,
        orders: Vec::new(),
        alerts: Vec::new(),
        events: PlannerEvents::default(),
        contact: None,
        planner_sector: None,
        planner_detail: None,
        goal_reached: false,
        nominal: None,
        last_minute: None,
        unavoidable: None,
    }
}
