//! The laboratory setting: every ship within a range is tracked without error and without delay.

use crate::ship::Ship;
use geom::angle;
use planner_api::{OwnState, TargetTrack};

/// Sensors that do not err.
#[derive(Clone, Debug)]
pub struct Perfect {
    range_m_max: Option<f64>,
    tracked: Vec<Tracked>,
}

/// What is known of one target's track.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tracked {
    /// First detection, seconds.
    pub first_s: Option<f64>,
    /// Start of the present track, seconds.
    since_s: Option<f64>,
}

/// Squared speed below which a ship has no course of her own, (m/s)^2; that of a trace.
const STOPPED_MPS2: f64 = 1e-12;

impl Perfect {
    /// Sees `targets` ships within a range, metres; absent: at any range.
    pub fn new(range_m_max: Option<f64>, targets: usize) -> Self {
        Self { range_m_max, tracked: vec![Tracked::default(); targets] }
    }

    /// Looks at the world at `t_s` and writes the tracks. The number of a track is the index of
    /// its target.
    pub fn look(&mut self, t_s: f64, own: &Ship, targets: &[Ship], tracks: &mut Vec<TargetTrack>) {
        tracks.clear();
        for (index, target) in targets.iter().enumerate() {
            let tracked = &mut self.tracked[index];
            let range_m = (target.pose.position_m - own.pose.position_m).norm();
            if self.range_m_max.is_some_and(|limit_m| range_m > limit_m) {
                tracked.since_s = None;
                continue;
            }
            tracked.first_s.get_or_insert(t_s);
            let since_s = *tracked.since_s.get_or_insert(t_s);
            tracks.push(track_of(index, target, t_s - since_s));
        }
    }

    /// First detection of target `index`, seconds. With perfect sensing its track is confirmed at
    /// the same time.
    pub fn first_s(&self, index: usize) -> Option<f64> {
        self.tracked[index].first_s
    }
}

pub(crate) fn track_of(index: usize, target: &Ship, age_s: f64) -> TargetTrack {
    let velocity_mps = target.pose.velocity_mps;
    let stopped = velocity_mps.norm_squared() < STOPPED_MPS2;
    TargetTrack {
        id: index as u32,
        position_m: target.pose.position_m,
        velocity_mps,
        cog_rad: if stopped { 0.0 } else { geom::wrap(angle::direction(velocity_mps)) },
        sog_mps: velocity_mps.norm(),
        psi_rad: Some(target.state.psi_rad),
        length_m: Some(target.outline.length_m),
        beam_m: Some(target.outline.beam_m),
        covariance: [[0.0; 4]; 4],
        age_s,
        since_update_s: 0.0,
    }
}

/// Own ship as her own navigation knows her.
pub fn own_state(own: &Ship) -> OwnState {
    let velocity_mps = own.pose.velocity_mps;
    let stopped = velocity_mps.norm_squared() < STOPPED_MPS2;
    let psi_rad = own.state.psi_rad;
    OwnState {
        position_m: own.pose.position_m,
        psi_rad,
        velocity_mps,
        cog_rad: if stopped { psi_rad } else { geom::wrap(angle::direction(velocity_mps)) },
        sog_mps: velocity_mps.norm(),
        stw_mps: own.state.surge_mps,
        yaw_rate_radps: own.state.yaw_rate_radps,
    }
}
