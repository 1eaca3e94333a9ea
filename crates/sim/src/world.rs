//! The loop: an encounter and a planner become a trace.
//!
//! Time is `step * step_s`. Once a beat: sample, end?, ask the planner, steer everybody, all on
//! the same snapshot; then the steps of the beat: all move, then every pair is looked at.

use crate::approach::Approach;
use crate::check::check;
use crate::contact::{Inertia, Party, collide};
use crate::ending::{Ending, Other};
use crate::hazard::{Hazards, Touch};
use crate::intent::Script;
use crate::interval::{Hulls, Interval};
use crate::peer::{MakePeer, Peer};
use crate::pilot::{Pilot, mission};
use crate::pose::Pose;
use crate::recorder;
use crate::sensing::{Sensors, own_state};
use crate::ship::Ship;
use crate::vessel::Helm;
use crate::voyage::{Left, Voyage, Wakes};
use crate::weather::Environment;
use planner_api::{CommandError, Planner, Situation, TargetTrack};
use record::{
    Alert, Contact, ContactWith, Encounter, Intent, Order, Outcome, Pair, PlannerEvents, ShipTrack,
    Trace, Visibility,
};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};

/// Buffers that a worker keeps from run to run. They carry nothing over.
#[derive(Debug, Default)]
pub struct Scratch {
    tracks: Vec<TargetTrack>,
}

/// Runs one encounter under a planner.
///
/// `beat` is raised by one before and after every call into the planner, so that a watchdog on
/// another thread can see a call that does not return. A planner's panic is caught and becomes
/// the outcome; the caller may install a panic hook to keep it quiet. An encounter that
/// [`check`] refuses gives `Outcome::Invalid` without samples. `nominal` and `last_minute` are
/// left empty. Targets under a planner need [`run_among`]; here they make the encounter invalid.
pub fn run(
    encounter: &Encounter,
    planner: &mut dyn Planner,
    scratch: &mut Scratch,
    beat: &AtomicU64,
) -> Trace {
    run_among(encounter, planner, &mut |_| None, scratch, beat)
}

/// As [`run`], and `peers` makes the planners of targets. An encounter whose peer is not known,
/// panics or orders nonsense is `Outcome::Invalid` from then on: that is no fault of the planner
/// under test in its own place.
pub fn run_among(
    encounter: &Encounter,
    planner: &mut dyn Planner,
    peers: &mut MakePeer<'_>,
    scratch: &mut Scratch,
    beat: &AtomicU64,
) -> Trace {
    go(encounter, planner, peers, (scratch, beat), false).trace
}

/// As [`run_among`], and it keeps what the nominal track can take from the run.
pub fn voyage(
    encounter: &Encounter,
    planner: &mut dyn Planner,
    peers: &mut MakePeer<'_>,
    scratch: &mut Scratch,
    beat: &AtomicU64,
) -> Voyage {
    go(encounter, planner, peers, (scratch, beat), true)
}

fn go(
    encounter: &Encounter,
    planner: &mut dyn Planner,
    peers: &mut MakePeer<'_>,
    (scratch, beat): (&mut Scratch, &AtomicU64),
    keeps_wakes: bool,
) -> Voyage {
    let not_run = || Voyage { trace: recorder::not_run(encounter), left: None };
    if check(encounter).is_err() {
        return not_run();
    }
    let mut world = World::new(encounter, keeps_wakes);
    if !world.board_peers(peers) {
        return not_run();
    }
    let mission = mission(encounter, &world.own);
    let mut pilot = Pilot { planner, beat, mission, last_words: None };
    // what it declares of itself ends no run
    let planner_sector = pilot.call(|planner, _| planner.head_on_sector()).unwrap_or_default();
    pilot.last_words = None;
    let (outcome, end_s) = world.sail(&mut pilot, scratch);
    let planner_detail = pilot.last_words.take();
    let (trace, left) = world.into_trace(outcome, end_s, pilot.events());
    Voyage { trace: Trace { planner_detail, planner_sector, ..trace }, left }
}

/// Below this lower bound every hull distance of a trace is exact, metres: beyond what any rule
/// set compares a hull distance of a small craft with, and beyond twice the safety radius.
const NEAR_M_MIN: f64 = 300.0;

struct World<'a> {
    encounter: &'a Encounter,
    own: Ship,
    targets: Vec<Ship>,
    /// Targets under a planner, with their indices.
    peers: Vec<(usize, Peer)>,
    scripts: Vec<Script>,
    approaches: Vec<Approach>,
    sensors: Sensors,
    ending: Ending,
    environment: Environment,
    wakes: Wakes,
    hazards: Hazards,
    own_track: ShipTrack,
    target_tracks: Vec<ShipTrack>,
    hull_m: Vec<Vec<f64>>,
    orders: Vec<Order>,
    alerts: Vec<Alert>,
    contact: Option<Contact>,
}

impl<'a> World<'a> {
    fn new(encounter: &'a Encounter, keeps_wakes: bool) -> Self {
        let environment = Environment::new(encounter);
        let (own, targets) = environment.ships(encounter).expect("the encounter was checked");
        let scripts = encounter.targets.iter().zip(&targets).map(|(target, ship)| {
            Script::of(&target.intent, ship, target.start.speed_mps, encounter.visibility)
        });
        let near_m = NEAR_M_MIN.max(2.0 * encounter.safety_radius_m);
        let approaches = targets.iter().map(|target| {
            let hulls = Hulls { own: &own.hull, target: &target.hull };
            Approach::new(near_m, hulls, &own.pose, &target.pose)
        });
        let run = &encounter.run;
        let room = (run.duration_s_max / run.beat_s) as usize + 2;
        let followed = keeps_wakes && !environment.is_steady();
        Self {
            encounter,
            wakes: if followed { Wakes::new(targets.len(), room) } else { Wakes::default() },
            scripts: scripts.collect(),
            peers: Vec::new(),
            approaches: approaches.collect(),
            sensors: Sensors::new(encounter, &targets),
            ending: Ending::new(encounter, own.model.limits().yaw_rate_radps_max),
            environment,
            hazards: Hazards::new(&encounter.hazards, &own),
            own_track: recorder::track_of(&own, room),
            target_tracks: targets.iter().map(|t| recorder::track_of(t, room)).collect(),
            hull_m: targets.iter().map(|_| Vec::with_capacity(room)).collect(),
            orders: Vec::with_capacity(room),
            alerts: Vec::new(),
            contact: None,
            own,
            targets,
        }
    }

    /// Puts the planners of targets on board; whether all of them are there and ready.
    fn board_peers(&mut self, make: &mut MakePeer<'_>) -> bool {
        for (index, target) in self.encounter.targets.iter().enumerate() {
            let Intent::Planner(name) = &target.intent else { continue };
            let Some(planner) = make(name) else { return false };
            let mut peer = Peer::new(planner, self.encounter, index, &self.targets[index]);
            if catch_unwind(AssertUnwindSafe(|| peer.reset())).is_err() {
                return false;
            }
            self.peers.push((index, peer));
            // without her planner she keeps her course
            self.wakes.close(index, || (self.targets[index].clone(), self.scripts[index].clone()));
        }
        true
    }

    /// Orders of the targets for this beat; whether every one could be carried out.
    fn steer_targets(&mut self, t_s: f64, beat: &AtomicU64) -> bool {
        for (index, target) in self.targets.iter_mut().enumerate() {
            let (script, helm) = (&mut self.scripts[index], target.helm());
            script.steer(target, t_s, Some(&self.own.pose));
            if script.has_reacted() {
                self.wakes.close(index, || (target.clone().with_helm(helm), script.clone()));
            }
        }
        // an order moves nobody before all have theirs
        for (index, peer) in &mut self.peers {
            let (own, targets) = (&self.own, &self.targets);
            beat.fetch_add(1, Ordering::Relaxed);
            let plan = AssertUnwindSafe(|| peer.plan(t_s, *index, own, targets));
            let helm = catch_unwind(plan).ok().flatten();
            beat.fetch_add(1, Ordering::Relaxed);
            let Some(helm) = helm else { return false };
            self.targets[*index].steer(helm, t_s);
        }
        true
    }

    /// Beats until the end: how the run ended and when (seconds).
    fn sail(&mut self, pilot: &mut Pilot<'_>, scratch: &mut Scratch) -> (Outcome, f64) {
        let run = self.encounter.run;
        let steps_a_beat = (run.beat_s / run.step_s).round() as u64;
        if let Err(outcome) = pilot.call(|planner, mission| planner.reset(mission)) {
            return (outcome, 0.0);
        }
        let mut step = 0;
        loop {
            let t_s = step as f64 * run.step_s;
            self.weather();
            self.sample();
            if self.is_over(t_s) {
                return (Outcome::Completed, t_s);
            }
            if t_s >= run.duration_s_max {
                return (Outcome::Truncated, t_s);
            }
            self.sensors.look(t_s, &self.own, &self.targets, &mut scratch.tracks);
            match self.ask(pilot, t_s, &scratch.tracks) {
                Ok(helm) => self.own.steer(helm, t_s),
                Err(outcome) => return (outcome, t_s),
            }
            if !self.steer_targets(t_s, pilot.beat) {
                return (Outcome::Invalid, t_s);
            }
            self.wakes.begin(&self.targets);
            for _ in 0..steps_a_beat {
                if let Some(contact) = self.step(step) {
                    // within a beat there is nowhere to go on from
                    self.wakes = Wakes::default();
                    self.contact = Some(contact);
                    let outcome = match contact.with {
                        ContactWith::Target(_) => Outcome::Collision,
                        ContactWith::Hazard(_) => Outcome::Grounding,
                    };
                    return (outcome, contact.t_s);
                }
                step += 1;
            }
            self.wakes.end(&self.targets);
        }
    }

    fn weather(&mut self) {
        self.environment.advance();
        self.environment.apply(0, &mut self.own);
        for (target, number) in self.targets.iter_mut().zip(1..) {
            self.environment.apply(number, target);
        }
    }

    fn sample(&mut self) {
        recorder::sample(&mut self.own_track, &self.own.state, self.own.pose.velocity_mps);
        for (track, ship) in self.target_tracks.iter_mut().zip(&self.targets) {
            recorder::sample(track, &ship.state, ship.pose.velocity_mps);
        }
        for (hull_m, approach) in self.hull_m.iter_mut().zip(&mut self.approaches) {
            hull_m.push(approach.take_interval_m());
        }
    }

    fn is_over(&mut self, t_s: f64) -> bool {
        let own = &self.own;
        let goal_m = self.encounter.own.route.last().map_or(own.pose.position_m, |w| w.position_m);
        let others = self.targets.iter().map(|target| Other {
            pose: &target.pose,
            radii_m: own.hull.radius_m + target.hull.radius_m,
        });
        self.ending.is_over(t_s, &own.pose, others, (goal_m - own.pose.position_m).norm())
    }

    /// The planner's order of this beat, checked and recorded.
    fn ask(
        &mut self,
        pilot: &mut Pilot<'_>,
        t_s: f64,
        tracks: &[TargetTrack],
    ) -> Result<Helm, Outcome> {
        let own = own_state(&self.own);
        let visual_range_m = match self.encounter.visibility {
            Visibility::InSight => None,
            Visibility::Restricted { visual_range_m } => Some(visual_range_m),
        };
        let situation = Situation { t_s, own, tracks, visual_range_m };
        let command = pilot.call(|planner, _| planner.plan(&situation))?;
        let speed_mps_max = pilot.mission.own.speed_mps_max;
        let (course_rad, speed_mps) =
            command.order.checked(speed_mps_max, own.psi_rad).map_err(|error| match error {
                CommandError::NonFinite => Outcome::PlannerNonFinite,
                CommandError::OutOfRange => Outcome::PlannerOutOfRange,
            })?;
        self.orders.push(Order { course_rad, speed_mps });
        // an alert about a track that does not exist declares nothing
        let sensors = &self.sensors;
        self.alerts.extend(command.alerts.into_iter().filter_map(|alert| {
            let target = sensors.target_of(alert.track, tracks)?;
            Some(Alert { t_s, target, rule: alert.rule })
        }));
        Ok(Helm::over_ground(course_rad, speed_mps, self.own.current_mps()))
    }

    /// One step: all move, then every pair is looked at. The earliest contact, if there is one.
    fn step(&mut self, step: u64) -> Option<Contact> {
        let dt_s = self.encounter.run.step_s;
        let (start_s, end_s) = (step as f64 * dt_s, (step + 1) as f64 * dt_s);
        self.own.advance(end_s, dt_s);
        let mut first: Option<(f64, usize)> = None;
        for (index, target) in self.targets.iter_mut().enumerate() {
            target.advance(end_s, dt_s);
            let interval = Interval {
                start_s,
                dt_s,
                own: [&self.own.before, &self.own.pose],
                target: [&target.before, &target.pose],
            };
            let hulls = Hulls { own: &self.own.hull, target: &target.hull };
            if let Some(fraction) = self.approaches[index].advance(&interval, hulls)
                && first.is_none_or(|(earliest, _)| fraction < earliest)
            {
                first = Some((fraction, index));
            }
        }
        let ashore = self.hazards.advance(&self.own, start_s, dt_s);
        match (first, ashore) {
            (Some((fraction, index)), None) => Some(self.contact(start_s, dt_s, fraction, index)),
            (Some((fraction, index)), Some(touch)) if fraction <= touch.fraction => {
                Some(self.contact(start_s, dt_s, fraction, index))
            }
            (_, Some(touch)) => Some(self.grounding(start_s, dt_s, &touch)),
            (None, None) => None,
        }
    }

    fn grounding(&self, start_s: f64, dt_s: f64, touch: &Touch) -> Contact {
        let own = &self.own;
        let pose = Pose::between(&own.before, &own.pose, dt_s, touch.fraction);
        let impact = self.hazards.impact(touch, &own.hull, pose, Inertia::of(own));
        Contact {
            t_s: start_s + touch.fraction * dt_s,
            with: ContactWith::Hazard(touch.hazard),
            impact_mps: impact.closing_mps,
            impulse_ns: impact.impulse_ns,
            energy_lost_j: impact.energy_lost_j,
        }
    }

    fn contact(&self, start_s: f64, dt_s: f64, fraction: f64, index: usize) -> Contact {
        let target = &self.targets[index];
        let at = |ship: &Ship| Pose::between(&ship.before, &ship.pose, dt_s, fraction);
        let own =
            Party { hull: &self.own.hull, pose: at(&self.own), inertia: Inertia::of(&self.own) };
        let other = Party { hull: &target.hull, pose: at(target), inertia: Inertia::of(target) };
        let impact = collide(&own, &other).impact;
        Contact {
            t_s: start_s + fraction * dt_s,
            with: ContactWith::Target(index as u8),
            impact_mps: impact.closing_mps,
            impulse_ns: impact.impulse_ns,
            energy_lost_j: impact.energy_lost_j,
        }
    }

    fn into_trace(
        mut self,
        outcome: Outcome,
        end_s: f64,
        events: PlannerEvents,
    ) -> (Trace, Option<Left>) {
        let sample_s = self.encounter.run.beat_s;
        let mut pairs = Vec::with_capacity(self.targets.len());
        for (index, target) in self.targets.iter().enumerate() {
            let hull_m = std::mem::take(&mut self.hull_m[index]);
            let hulls = Hulls { own: &self.own.hull, target: &target.hull };
            let (own, other) = (&self.own_track, &self.target_tracks[index]);
            let poses = |k: usize| [recorder::pose(own, k), recorder::pose(other, k)];
            let minimum = self.approaches[index].settle(&hull_m, hulls, poses, sample_s);
            let (detected_s, tracked_s) = self.sensors.first_s(index);
            pairs.push(Pair { hull_m, minimum, detected_s, tracked_s });
        }
        let wakes = self.wakes.closed(self.targets.into_iter().zip(self.scripts));
        let left = wakes.map(|wakes| Left { environment: self.environment, wakes });
        let trace = Trace {
            outcome,
            end_s,
            own: self.own_track,
            targets: self.target_tracks,
            pairs,
            hazard_m_min: self.hazards.least_m(),
            orders: self.orders,
            alerts: self.alerts,
            events,
            contact: self.contact,
            goal_reached: self.ending.goal_reached(),
            ..recorder::not_run(self.encounter)
        };
        (trace, left)
    }
}
