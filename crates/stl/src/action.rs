//! What own ship did about a target: offsets of course and speed from what she held before, and
//! the runs that made them (rules specification, section 5).
//!
//! The nominal track's course and speed are subtracted first, from the runs as from the offsets:
//! a turn that the route asked for is then neither credited nor blamed.

use crate::life::{Duty, Life};
use crate::params::Params;
use crate::risk::samples_of;
use crate::runs::{Run, heading_runs, speed_runs};
use crate::signals::wrapped_rad;
use record::{ShipTrack, Trace};

/// Own ship's deviation from her nominal track.
#[derive(Clone, Debug)]
pub struct Deviation {
    /// Heading less nominal heading, unwrapped, radians.
    pub heading_rad: Vec<f64>,
    /// Whether there was a nominal track to subtract.
    pub planned: bool,
    /// Speed over ground, m/s.
    pub speed_mps: Vec<f64>,
    /// Speed less nominal speed, m/s.
    pub speed_change_mps: Vec<f64>,
    /// Runs of the heading.
    pub turns: Vec<Run>,
    /// Runs of the speed.
    pub speed_changes: Vec<Run>,
}

impl Deviation {
    /// Of the trace's own ship.
    pub fn of(trace: &Trace, params: &Params) -> Self {
        let samples = trace.samples();
        let nominal = trace.nominal.as_ref().map(|n| &n.own).filter(|own| !own.is_empty());
        let held = |track: &ShipTrack, k: usize| k.min(track.len() - 1);
        let mut heading_rad = Vec::with_capacity(samples);
        let mut before = 0.0;
        let speed_mps: Vec<f64> = (0..samples).map(|k| speed(&trace.own, k)).collect();
        let mut speed_change_mps = Vec::with_capacity(samples);
        for (k, sog_mps) in speed_mps.iter().enumerate() {
            let (planned_rad, planned_mps) =
                nominal.map_or((0.0, 0.0), |n| (n.psi_rad[held(n, k)], speed(n, held(n, k))));
            before += wrapped_rad(trace.own.psi_rad[k] - planned_rad - before);
            heading_rad.push(before);
            speed_change_mps.push(sog_mps - planned_mps);
        }
        let yaw_rate_on =
            (trace.own.ship.yaw_rate_radps_max / 2.0).min(params.run.yaw_rate_on_radps);
        let turns = heading_runs(&heading_rad, &speed_mps, yaw_rate_on, params, trace.sample_s);
        let speed_changes = speed_runs(&speed_change_mps, &speed_mps, params, trace.sample_s);
        let planned = nominal.is_some();
        Self { heading_rad, planned, speed_mps, speed_change_mps, turns, speed_changes }
    }

    /// Whether a run of the heading leads back towards the planned one.
    pub fn turns_back(&self, run: &Run) -> bool {
        self.planned && self.heading_rad[run.end].abs() < self.heading_rad[run.start].abs()
    }

    /// Whether a run of the speed leads back towards the planned one.
    pub fn regains(&self, run: &Run) -> bool {
        let off = &self.speed_change_mps;
        self.planned && off[run.end].abs() < off[run.start].abs()
    }
}

/// What own ship did for one target in the window of action.
#[derive(Clone, Debug)]
pub struct Action {
    /// `x`: signed offset of the heading, radians, positive to starboard; 0 without way, when how
    /// she lies is no manoeuvre.
    pub turn_rad: Vec<f64>,
    /// `x_u`: loss of speed as a share of the speed before.
    pub speed_cut: Vec<f64>,
    /// First sample at which an offset may be the action's: what she did before is what it is
    /// measured from.
    pub from: usize,
    /// The run whose side counts.
    pub counted: Option<Run>,
    /// +1 or -1, the side of the first run that counts; 0 without one.
    pub side: f64,
    /// Start of the first run back, at which the action is over.
    pub returns: Option<usize>,
    /// Runs of the heading that belong to this target and begin in the window.
    pub turns: Vec<Run>,
    /// Runs of the speed, likewise.
    pub speed_changes: Vec<Run>,
}

impl Action {
    /// For the pair `target` of `lives`, in the window of `duty`.
    pub fn of(
        deviation: &Deviation,
        lives: &[Life<'_>],
        target: usize,
        duty: &Duty,
        params: &Params,
        sample_s: f64,
    ) -> Self {
        let mine = |run: &&Run| {
            (duty.begin..=duty.end).contains(&run.start)
                && belongs(run.start, lives, target, params, sample_s)
        };
        // Back to the plan from a departure too slow to be a run: not an action either.
        let to_plan = |run: &&Run| {
            let toward = |k: usize| deviation.heading_rad[k] * run.change.signum();
            deviation.planned
                && toward(run.start) < 0.0
                && toward(run.end) < params.turn_detectable_rad
                && settled(&lives[target], run.start, params)
        };
        let turns = deviation.turns.iter().filter(mine).skip_while(to_plan).copied();
        let turns: Vec<Run> = turns.collect();
        // Likewise the planned speed, after a slow loss of it.
        let to_speed = |run: &&Run| {
            let off_mps = |k: usize| deviation.speed_change_mps[k];
            let least_mps = params.speed_detectable * deviation.speed_mps[run.start];
            deviation.planned
                && run.change > 0.0
                && off_mps(run.start) < 0.0
                && off_mps(run.end) < least_mps
                && settled(&lives[target], run.start, params)
        };
        let speed_changes = deviation.speed_changes.iter().filter(mine).skip_while(to_speed);
        let speed_changes: Vec<Run> = speed_changes.copied().collect();
        let first = turns.iter().chain(&speed_changes).map(|run| run.start).min();
        let (from, to) = match duty.reference {
            Some(k) => (k, k + 1),
            None => {
                let at = first.unwrap_or(duty.onset);
                (at.saturating_sub(samples_of(params.reference_s, sample_s)), at.max(1))
            }
        };
        let mean = |values: &[f64]| values[from..to].iter().sum::<f64>() / (to - from) as f64;
        let heading_0 = mean(&deviation.heading_rad);
        let change_0 = mean(&deviation.speed_change_mps);
        let speed_0 = mean(&deviation.speed_mps);
        let cut = |change: &f64| if speed_0 > 0.0 { (change_0 - change) / speed_0 } else { 0.0 };
        let back_from = |action: &Run, run: &Run| {
            run.change * action.change < 0.0
                && run.start > action.start
                && settled(&lives[target], run.start, params)
        };
        // A turn back to the route is no action, however large (section 5), unless there was little
        // to turn back from and it is an alteration to the other side of what she held first.
        let crosses = |first: &Run, run: &Run| {
            let from_first =
                |k: usize| deviation.heading_rad[k] - deviation.heading_rad[first.start];
            let past = from_first(run.end) * run.change.signum() >= params.turn_action_rad;
            past && from_first(run.start) * first.change.signum() < params.turn_action_rad
        };
        let way_back = |run: &Run| {
            turns.first().is_some_and(|first| back_from(first, run) && !crosses(first, run))
        };
        let acts = |run: &&Run| run.change.abs() >= params.turn_action_rad && !way_back(run);
        let counted = turns.iter().find(acts).or_else(|| turns.first()).copied();
        let side = counted.map_or(0.0, |run| run.change.signum());
        let back = |run: &&Run| counted.is_some_and(|action| back_from(&action, run));
        let turned = |(heading, speed): (&f64, &f64)| {
            if *speed < params.run.moving_mps { 0.0 } else { heading - heading_0 }
        };
        Self {
            // Unwrapped: a ship that turns 200 degrees to port is not 160 to starboard.
            turn_rad: deviation.heading_rad.iter().zip(&deviation.speed_mps).map(turned).collect(),
            speed_cut: deviation.speed_change_mps.iter().map(cut).collect(),
            from: first.unwrap_or(duty.onset).max(duty.begin),
            counted,
            side,
            returns: turns.iter().find(back).map(|run| run.start),
            turns,
            speed_changes,
        }
    }

    /// Whether an action that may count began at or before sample `k`.
    pub fn begun_by(&self, k: usize, speed_mps: &[f64], params: &Params) -> bool {
        let slows =
            |run: &Run| run.start <= k && -run.change >= params.speed_action * speed_mps[run.start];
        let turns = |run: &Run| run.start <= k && run.change.abs() >= params.turn_action_rad;
        self.turns.iter().any(turns) || self.speed_changes.iter().any(slows)
    }
}

/// A run belongs to every target whose risk, extended before its start, contains the start of the
/// run; where none does, to the target with the next onset. Where nothing lies ahead on the plan
/// either (section 5 does not say), it belongs to all whose window of action holds it: she may have
/// put off a meeting that the plan has behind it.
fn belongs(
    start: usize,
    lives: &[Life<'_>],
    target: usize,
    params: &Params,
    sample_s: f64,
) -> bool {
    let lead = samples_of(params.attribution_lead_s, sample_s);
    let answers = |life: &Life<'_>| {
        life.attention.iter().any(|o| o.start <= start.saturating_add(lead) && start < o.end)
    };
    if lives.iter().any(answers) {
        return answers(&lives[target]);
    }
    let next = |life: &Life<'_>| {
        life.attention.iter().map(|open| open.start).filter(|onset| *onset > start).min()
    };
    let soonest = lives.iter().filter_map(next).min();
    soonest.is_none_or(|onset| next(&lives[target]) == Some(onset))
}

/// Nothing is left to do: the prediction keeps clear, or the closest point is past.
fn settled(life: &Life<'_>, k: usize, params: &Params) -> bool {
    life.actual.tcpa_s[k] < 0.0 || !life.actual.predicted_within(k, params.minimum_m)
}

fn speed(track: &ShipTrack, k: usize) -> f64 {
    let (north, east) = (track.vel_north_mps[k], track.vel_east_mps[k]);
    (north * north + east * east).sqrt()
}
