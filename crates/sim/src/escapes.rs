//! What one ship alone could still do: from each instant of the nominal track a last-minute
//! manoeuvre, the other ship going straight on (rules specification, section 10).
//!
//! A manoeuvre is what the ship's own model makes of the largest order: hard over until the heading
//! has changed by a quarter or half of a circle and steady on that course, full astern, or both. A
//! rudder held for ever would bring her back to where she was; the literature's manoeuvre ends when
//! she is out of danger.
//!
//! The way of a manoeuvre is the same from every instant at which the ship has the same speed, so
//! it is integrated once, in her own frame and through the water, and then laid on each instant.
//! Known limits: the momentary yaw rate and sway of that instant are left out, ways from speeds
//! within [`SAME_SPEED_MPS`] are taken as one, and what is left of the velocity over ground (the
//! drift) stays as it is at that instant. Hazards are not looked at.

use crate::pose::Pose;
use crate::vessel::Model;
use crate::way::{Body, Clock, Manoeuvre, Passing, Way};
use geom::{HullOutline, Vec2};
use record::{Encounter, Nominal, ShipTrack, Vessel};

/// Speeds through the water nearer than this have one way, m/s.
pub const SAME_SPEED_MPS: f64 = 0.05;
/// Time between two instants, seconds (section 10: the grid).
const GRID_S: f64 = 1.0;
/// Response lag of a ship whose dynamics nobody declares, seconds (section 10).
const LAG_S: f64 = 10.0;

/// The forks of one encounter.
#[derive(Debug)]
pub struct Escapes<'a> {
    nominal: &'a Nominal,
    own: Mover,
    targets: Vec<Mover>,
    clock: Clock,
    /// Samples from one instant to the next.
    stride: usize,
}

impl<'a> Escapes<'a> {
    /// From the nominal track of an encounter; `None` for an encounter that has no vessels to fork.
    pub fn new(encounter: &Encounter, nominal: &'a Nominal) -> Option<Self> {
        let run = &encounter.run;
        let own = Mover::new(&encounter.own.hull, &encounter.own.vessel, 0.0)?;
        let targets = encounter.targets.iter().map(|target| {
            // a kinematic target stands for one whose dynamics nobody knows
            let known = matches!(target.vessel, Vessel::Model(_));
            Mover::new(&target.hull, &target.vessel, if known { 0.0 } else { LAG_S })
        });
        Some(Self {
            nominal,
            own,
            targets: targets.collect::<Option<_>>()?,
            clock: Clock { beat_s: run.beat_s, step_s: run.step_s },
            stride: ((GRID_S / run.beat_s).round() as usize).max(1),
        })
    }

    /// Number of instants, from the start to the closest point of the pair on the nominal track.
    pub fn instants(&self, target: usize) -> usize {
        let closest_s = self.nominal.minima[target].hull_s;
        let last = (closest_s / self.time_s(1)) as usize;
        last.min((self.nominal.targets[target].len() - 1) / self.stride) + 1
    }

    /// Time of an instant, seconds.
    pub fn time_s(&self, instant: usize) -> f64 {
        (instant * self.stride) as f64 * self.clock.beat_s
    }

    /// Own ship begins a manoeuvre at an instant and the target goes straight on: by how much
    /// more than `than_m` the hulls stay apart at least, metres (a lower bound); `None` where they
    /// come to `than_m` or nearer.
    pub fn own_clears(
        &mut self,
        target: usize,
        instant: usize,
        manoeuvre: Manoeuvre,
        than_m: f64,
    ) -> Option<f64> {
        let k = instant * self.stride;
        let (track, other_track) = (&self.nominal.own, &self.nominal.targets[target]);
        let (fork, other) = (Fork { track, other_track, k }, &self.targets[target].body);
        self.own.clears(other, fork, manoeuvre, self.clock, than_m)
    }

    /// The same with the target manoeuvring and own ship going straight on.
    pub fn target_clears(
        &mut self,
        target: usize,
        instant: usize,
        manoeuvre: Manoeuvre,
        than_m: f64,
    ) -> Option<f64> {
        let k = instant * self.stride;
        let (other_track, track) = (&self.nominal.own, &self.nominal.targets[target]);
        let fork = Fork { track, other_track, k };
        self.targets[target].clears(&self.own.body, fork, manoeuvre, self.clock, than_m)
    }

    /// Whether what the target could do is a guess, because no model of hers is declared.
    pub fn is_indicative(&self, target: usize) -> bool {
        self.targets[target].lag_s > 0.0
    }

    /// How much less than the bounds above a manoeuvre of own ship clears by for each instant that
    /// it is begun later, metres at most. Absent where the nominal tracks are not straight at
    /// constant speed: there is no such bound then.
    pub fn own_loss_m(&self, target: usize) -> Option<f64> {
        self.loss_m(&self.own, &self.nominal.own, &self.nominal.targets[target])
    }

    /// The same of the target's manoeuvres.
    pub fn target_loss_m(&self, target: usize) -> Option<f64> {
        let (own, other) = (&self.nominal.own, &self.nominal.targets[target]);
        self.loss_m(&self.targets[target], other, own)
    }

    /// Between beginning now and one instant later the ship is, at any time, no further apart than
    /// she goes in that time before and after, and turned by no more than she turns in it.
    fn loss_m(&self, mover: &Mover, track: &ShipTrack, other: &ShipTrack) -> Option<f64> {
        if !(is_straight(track) && is_straight(other)) {
            return None;
        }
        let (over_ground_mps, surge_mps) = (track.velocity_mps(0), track.stw_mps[0]);
        let drift_mps = (over_ground_mps - geom::unit(track.psi_rad[0]) * surge_mps).norm();
        let swing_mps = mover.body.hull.radius_m * mover.model.limits().yaw_rate_radps_max;
        // room for the sway of a turn and a yaw rate above the declared one
        const ROOM: f64 = 1.25;
        let fastest_mps = over_ground_mps.norm() + surge_mps + drift_mps + swing_mps;
        Some(ROOM * fastest_mps * self.time_s(1))
    }
}

fn is_straight(track: &ShipTrack) -> bool {
    let constant = |signal: &[f64]| signal.iter().all(|x| (x - signal[0]).abs() <= 0.0);
    [&track.psi_rad, &track.vel_north_mps, &track.vel_east_mps, &track.stw_mps]
        .into_iter()
        .all(|signal| constant(signal))
}

/// A ship that may manoeuvre, and the ways of her manoeuvres so far.
#[derive(Debug)]
struct Mover {
    body: Body,
    model: Model,
    lag_s: f64,
    ways: Vec<Way>,
}

impl Mover {
    fn new(outline: &HullOutline, vessel: &Vessel, lag_s: f64) -> Option<Self> {
        let model = Model::of(vessel)?;
        Some(Self { body: Body::new(outline), model, lag_s, ways: Vec::new() })
    }

    /// Whether the hulls stay more than `than_m` apart, and by how much more at least, where this
    /// ship begins a manoeuvre and the other one goes straight on.
    fn clears(
        &mut self,
        other: &Body,
        fork: Fork<'_>,
        manoeuvre: Manoeuvre,
        clock: Clock,
        than_m: f64,
    ) -> Option<f64> {
        let Fork { track, other_track, k } = fork;
        let surge_mps = track.stw_mps[k];
        let way = self.way(manoeuvre, surge_mps, clock);
        let heading = geom::unit(track.psi_rad[k]);
        let drift_mps = track.velocity_mps(k) - heading * surge_mps;
        let seen = |v: Vec2| Vec2::new(heading.dot(&v), heading.x * v.y - heading.y * v.x);
        let start = Pose {
            position_m: seen(other_track.position_m(k) - track.position_m(k)),
            velocity_mps: seen(other_track.velocity_mps(k) - drift_mps),
            heading: seen(geom::unit(other_track.psi_rad[k])),
            yaw_rate_radps: 0.0,
        };
        let way = &self.ways[way];
        Passing { way, body: &self.body, other, start, clock }.slack_m(than_m)
    }

    /// The way of a manoeuvre from this speed, sailed once.
    fn way(&mut self, manoeuvre: Manoeuvre, surge_mps: f64, clock: Clock) -> usize {
        let same = |way: &Way| {
            way.manoeuvre == manoeuvre && (way.surge_mps - surge_mps).abs() <= SAME_SPEED_MPS
        };
        self.ways.iter().position(same).unwrap_or_else(|| {
            let way = Way::sail(&self.model, manoeuvre, surge_mps, self.lag_s, clock);
            self.ways.push(way);
            self.ways.len() - 1
        })
    }
}

/// Where a manoeuvre begins: sample `k` of the nominal tracks of the ship and of the other one.
#[derive(Clone, Copy)]
struct Fork<'a> {
    track: &'a ShipTrack,
    other_track: &'a ShipTrack,
    k: usize,
}
