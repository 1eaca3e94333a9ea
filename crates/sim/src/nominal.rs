//! The encounter without avoidance: own ship on her route at cruise speed, targets by their
//! scripts, no contact. It fixes onset of risk, class and role, the same for every planner.
//!
//! Ships do not react to one another here, so each goes from beat to beat on her own: in closed
//! form while nothing changes, by her model in steps otherwise.
//!
//! Of a run, own ship's track goes on as long as the run where that outlasts the encounter without
//! avoidance: the judges take her nominal heading and speed off those of the run, sample by sample,
//! and a yaw frozen at the last beat would leave that of the weather for an alteration of hers.

use crate::approach::Approach;
use crate::check::check;
use crate::ending::{Ending, Other};
use crate::intent::{Route, Script};
use crate::interval::{Hulls, Interval};
use crate::recorder;
use crate::ship::Ship;
use crate::voyage::{Left, Wake};
use crate::weather::Environment;
use record::{Encounter, Nominal, ShipTrack};

/// The nominal track of an encounter; `None` where [`check`] refuses it.
///
/// It ends when own ship is past and clear on it (and at her goal, if the run is to end there),
/// or at the longest duration; that does not depend on any planner.
pub fn nominal(encounter: &Encounter) -> Option<Nominal> {
    lasting(encounter, 0)
}

/// The same; own ship has `samples` samples at least.
pub(crate) fn lasting(encounter: &Encounter, samples: usize) -> Option<Nominal> {
    check(encounter).ok()?;
    let wakes = encounter.targets.iter().map(|_| None);
    Some(begin(encounter, Environment::new(encounter), wakes, samples))
}

/// The same from what is left of a run of this encounter, whose targets have these tracks.
pub(crate) fn after(
    encounter: &Encounter,
    left: Left,
    tracks: &[ShipTrack],
    samples: usize,
) -> Nominal {
    let Left { mut environment, wakes } = left;
    environment.rewind();
    begin(encounter, environment, wakes.into_iter().zip(tracks).map(Some), samples)
}

fn begin<'a>(
    encounter: &Encounter,
    environment: Environment,
    wakes: impl Iterator<Item = Option<(Wake, &'a ShipTrack)>>,
    own_samples: usize,
) -> Nominal {
    let (own_ship, ships) = environment.ships(encounter).expect("the encounter was checked");
    let mut route = Route::new(&own_ship, &encounter.own.route, encounter.own.cruise_mps);
    if !environment.is_steady() {
        route = route.in_weather();
    }
    let room = samples(encounter);
    let own = Sailor::new(own_ship, Script::Follow(route), None, room);
    let targets = encounter
        .targets
        .iter()
        .zip(ships)
        .zip(wakes)
        .map(|((target, ship), wake)| {
            let script =
                Script::of(&target.intent, &ship, target.start.speed_mps, encounter.visibility);
            Sailor::new(ship, script, wake, room)
        })
        .collect();
    sail(encounter, environment, own, targets, own_samples)
}

fn samples(encounter: &Encounter) -> usize {
    (encounter.run.duration_s_max / encounter.run.beat_s) as usize + 2
}

/// A ship with her script and her track.
struct Sailor<'a> {
    ship: Ship,
    script: Script,
    track: ShipTrack,
    /// What a run found already, and the samples of it, as long as it lasts.
    wake: Option<(Wake, &'a ShipTrack)>,
}

impl<'a> Sailor<'a> {
    fn new(
        mut ship: Ship,
        script: Script,
        wake: Option<(Wake, &'a ShipTrack)>,
        room: usize,
    ) -> Self {
        ship.closed_form = true;
        let track = recorder::track_of(&ship, room);
        Self { ship, script, track, wake }
    }

    /// Puts her into the weather of a beat, as ship `number`, and takes a sample.
    fn sample(&mut self, number: usize, environment: &Environment) {
        if let Some((wake, track)) = &self.wake {
            let k = self.track.len();
            if let Some([pose, _]) = wake.beat(k) {
                self.ship.pose = pose;
                recorder::copy(&mut self.track, track, k);
                return;
            }
        }
        if let Some((wake, _)) = self.wake.take() {
            (self.ship, self.script) = wake.after();
        }
        environment.apply(number, &mut self.ship);
        recorder::sample(&mut self.track, &self.ship.state, self.ship.pose.velocity_mps);
    }

    /// Goes through the beat that starts at step `step`.
    fn advance(&mut self, step: u64, steps_a_beat: u64, step_s: f64) {
        if let Some((wake, _)) = &self.wake
            && let Some(poses) = wake.beat(self.track.len() - 1)
        {
            [self.ship.before, self.ship.pose] = poses;
            return;
        }
        self.script.steer(&mut self.ship, step as f64 * step_s, None);
        let before = self.ship.pose;
        if self.ship.is_straight() {
            let beat_s = steps_a_beat as f64 * step_s;
            self.ship.advance((step + steps_a_beat) as f64 * step_s, beat_s);
        } else {
            for k in step..step + steps_a_beat {
                self.ship.advance((k + 1) as f64 * step_s, step_s);
            }
        }
        self.ship.before = before;
    }
}

fn sail(
    encounter: &Encounter,
    mut environment: Environment,
    mut own: Sailor<'_>,
    mut targets: Vec<Sailor<'_>>,
    own_samples: usize,
) -> Nominal {
    let run = encounter.run;
    let steps_a_beat = (run.beat_s / run.step_s).round() as u64;
    let goal_m = encounter.own.route.last().map_or(own.ship.pose.position_m, |w| w.position_m);
    let mut ending = Ending::new(encounter, own.ship.model.limits().yaw_rate_radps_max);
    // no hull geometry on the way: `settle` needs little of it once the track is known
    let mut approaches: Vec<Approach> = targets
        .iter()
        .map(|t| Approach::new(f64::NEG_INFINITY, hulls(&own, t), &own.ship.pose, &t.ship.pose))
        .collect();
    let mut bounds_m: Vec<Vec<f64>> =
        targets.iter().map(|_| Vec::with_capacity(samples(encounter))).collect();
    let mut step = 0;
    loop {
        let t_s = step as f64 * run.step_s;
        environment.advance();
        own.sample(0, &environment);
        for (target, number) in targets.iter_mut().zip(1..) {
            target.sample(number, &environment);
        }
        for (bounds_m, approach) in bounds_m.iter_mut().zip(&mut approaches) {
            bounds_m.push(approach.take_interval_m());
        }
        let others = targets.iter().map(|t| Other {
            pose: &t.ship.pose,
            radii_m: own.ship.hull.radius_m + t.ship.hull.radius_m,
        });
        let to_goal_m = (goal_m - own.ship.pose.position_m).norm();
        if ending.is_over(t_s, &own.ship.pose, others, to_goal_m) || t_s >= run.duration_s_max {
            break;
        }
        own.advance(step, steps_a_beat, run.step_s);
        for (target, approach) in targets.iter_mut().zip(&mut approaches) {
            target.advance(step, steps_a_beat, run.step_s);
            let interval = Interval {
                start_s: t_s,
                dt_s: run.beat_s,
                own: [&own.ship.before, &own.ship.pose],
                target: [&target.ship.before, &target.ship.pose],
            };
            approach.advance(&interval, hulls(&own, target));
        }
        step += steps_a_beat;
    }
    while own.track.len() < own_samples {
        own.advance(step, steps_a_beat, run.step_s);
        step += steps_a_beat;
        environment.advance();
        own.sample(0, &environment);
    }
    let minima =
        targets.iter().zip(&mut approaches).zip(&bounds_m).map(|((t, approach), bounds)| {
            let poses = |k: usize| [recorder::pose(&own.track, k), recorder::pose(&t.track, k)];
            approach.settle(bounds, hulls(&own, t), poses, run.beat_s)
        });
    let minima = minima.collect();
    Nominal { own: own.track, targets: targets.into_iter().map(|t| t.track).collect(), minima }
}

fn hulls<'a>(own: &'a Sailor<'_>, target: &'a Sailor<'_>) -> Hulls<'a> {
    Hulls { own: &own.ship.hull, target: &target.ship.hull }
}
