//! Hand-written voyages for the tests of this crate: a scripted ship, and a scene of several.

use crate::RuleSet;
use crate::pair::outline_distance_m;
use geom::units::deg;
use geom::{HullOutline, Vec2, math, wrap};
use record::{
    Contact, ContactWith, DistanceKind, EncounterId, Nominal, Outcome, Pair, PairMinimum,
    PlannerEvents, Ship, ShipTrack, Trace, Visibility,
};

/// Steps of a script within a sample of one second.
const STEPS: usize = 10;

pub(crate) fn rules() -> RuleSet {
    RuleSet::parse(include_str!("../../../campaigns/rulesets/usv-oe2023-v1.toml")).unwrap()
}

pub(crate) fn ship(length_m: f64, beam_m: f64) -> Ship {
    Ship {
        hull: HullOutline::centred(length_m, beam_m),
        yaw_rate_radps_max: deg(20.0),
        speed_mps_max: 20.0,
        steerage_mps: None,
        stopping: None,
    }
}

/// A ship that does what she is told, in steps of a tenth of a second.
#[derive(Clone, Debug)]
pub(crate) struct Script {
    ship: Ship,
    position_m: Vec2,
    psi_rad: f64,
    speed_mps: f64,
    current_mps: Vec2,
    /// Position, heading, speed, yaw rate at each step.
    states: Vec<(Vec2, f64, f64, f64)>,
}

impl Script {
    pub(crate) fn new(ship: Ship, north_m: f64, east_m: f64, psi_rad: f64, speed_mps: f64) -> Self {
        let position_m = Vec2::new(north_m, east_m);
        let states = vec![(position_m, wrap(psi_rad), speed_mps, 0.0)];
        Self { ship, position_m, psi_rad, speed_mps, current_mps: Vec2::zeros(), states }
    }

    pub(crate) fn drift(mut self, north_mps: f64, east_mps: f64) -> Self {
        self.current_mps = Vec2::new(north_mps, east_mps);
        self
    }

    pub(crate) fn hold(mut self, duration_s: f64) -> Self {
        for _ in 0..(duration_s * STEPS as f64).round() as usize {
            self.step(0.0);
        }
        self
    }

    /// Turns by a signed angle at a rate, both in degrees.
    pub(crate) fn turn(mut self, angle_deg: f64, rate_deg_s: f64) -> Self {
        let steps = (angle_deg.abs() / rate_deg_s * STEPS as f64).round().max(1.0);
        let rate = deg(angle_deg) / steps * STEPS as f64;
        for _ in 0..steps as usize {
            self.step(rate);
        }
        self
    }

    pub(crate) fn speed_to(mut self, speed_mps: f64, rate_mps2: f64) -> Self {
        let change = speed_mps - self.speed_mps;
        let steps = (change.abs() / rate_mps2 * STEPS as f64).round().max(1.0);
        for _ in 0..steps as usize {
            self.speed_mps += change / steps;
            self.step(0.0);
        }
        self
    }

    fn step(&mut self, rate_radps: f64) {
        let dt = 1.0 / STEPS as f64;
        let (sin, cos) = math::sin_cos(self.psi_rad + rate_radps * dt / 2.0);
        let through_mps = Vec2::new(cos, sin) * self.speed_mps;
        self.position_m += (through_mps + self.current_mps) * dt;
        self.psi_rad += rate_radps * dt;
        self.states.push((self.position_m, wrap(self.psi_rad), self.speed_mps, rate_radps));
    }

    pub(crate) fn seconds(&self) -> usize {
        (self.states.len() - 1) / STEPS
    }

    pub(crate) fn track(&self) -> ShipTrack {
        let mut track = ShipTrack::with_capacity(self.ship.clone(), self.seconds() + 1);
        for &(position_m, psi_rad, speed_mps, rate_radps) in self.states.iter().step_by(STEPS) {
            let (sin, cos) = math::sin_cos(psi_rad);
            let velocity_mps = Vec2::new(cos, sin) * speed_mps + self.current_mps;
            track.north_m.push(position_m.x);
            track.east_m.push(position_m.y);
            track.psi_rad.push(psi_rad);
            track.vel_north_mps.push(velocity_mps.x);
            track.vel_east_mps.push(velocity_mps.y);
            track.stw_mps.push(speed_mps);
            track.yaw_rate_radps.push(rate_radps);
        }
        track
    }

    /// The same ship holding her first heading and speed for as long.
    fn straight(&self, seconds: usize) -> Self {
        let (position_m, psi_rad, speed_mps, _) = self.states[0];
        let start = Self::new(self.ship.clone(), position_m.x, position_m.y, psi_rad, speed_mps);
        start.drift(self.current_mps.x, self.current_mps.y).hold(seconds as f64)
    }

    fn corners(&self, step: usize) -> Vec<Vec2> {
        let (position_m, psi_rad, ..) = self.states[step];
        self.ship.hull.corners_m(position_m, psi_rad).to_vec()
    }
}

/// Own ship and her targets; the shortest script ends the run.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    own: Script,
    targets: Vec<Script>,
    nominal: Option<Script>,
    nominal_targets: Option<Vec<Script>>,
    without_nominal: bool,
    distance: DistanceKind,
    pub(crate) visibility: Visibility,
}

impl Scene {
    pub(crate) fn new(own: Script, target: Script) -> Self {
        Self {
            own,
            targets: vec![target],
            nominal: None,
            nominal_targets: None,
            without_nominal: false,
            distance: DistanceKind::Hull,
            visibility: Visibility::InSight,
        }
    }

    pub(crate) fn and(mut self, target: Script) -> Self {
        self.targets.push(target);
        self
    }

    /// Own ship's route, where it is not straight.
    pub(crate) fn nominal(mut self, own: Script) -> Self {
        self.nominal = Some(own);
        self
    }

    /// What the targets would have done had own ship not avoided.
    pub(crate) fn nominal_targets(mut self, targets: Vec<Script>) -> Self {
        self.nominal_targets = Some(targets);
        self
    }

    pub(crate) fn without_nominal(mut self) -> Self {
        self.without_nominal = true;
        self
    }

    pub(crate) fn centre(mut self) -> Self {
        self.distance = DistanceKind::Centre;
        self
    }

    pub(crate) fn trace(&self) -> Trace {
        let all = self.targets.iter().map(Script::seconds).chain([self.own.seconds()]);
        let mut seconds = all.min().unwrap();
        let mut contact = None;
        for (i, target) in self.targets.iter().enumerate() {
            let radii_m = self.own.ship.hull.radius_m() + target.ship.hull.radius_m();
            let touches = |step: &usize| {
                let near = (self.own.states[*step].0 - target.states[*step].0).norm() < radii_m;
                near && outline_distance_m(&self.own.corners(*step), &target.corners(*step)) <= 0.0
            };
            if let Some(step) = (0..=seconds * STEPS).find(touches) {
                // the run ends with the sample after the contact
                seconds = seconds.min(step.div_ceil(STEPS));
                contact = Some(Contact {
                    t_s: step as f64 / STEPS as f64,
                    with: ContactWith::Target(i as u8),
                    impact_mps: 1.0,
                    impulse_ns: 1.0,
                    energy_lost_j: 1.0,
                });
            }
        }
        let cut = |track: ShipTrack| cut(track, seconds + 1);
        let pairs = self.targets.iter().map(|t| pair(&self.own, t, seconds)).collect();
        Trace {
            id: EncounterId::new("test", 0),
            outcome: if contact.is_some() { Outcome::Collision } else { Outcome::Completed },
            end_s: seconds as f64,
            sample_s: 1.0,
            safety_radius_m: 150.0,
            distance: self.distance,
            visibility: self.visibility,
            route: Vec::new(),
            cruise_mps: self.own.states[0].2,
            own: cut(self.own.track()),
            targets: self.targets.iter().map(|t| cut(t.track())).collect(),
            pairs,
            hazard_m_min: None,
            orders: Vec::new(),
            alerts: Vec::new(),
            events: PlannerEvents::default(),
            contact,
            planner_sector: None,
            planner_detail: None,
            goal_reached: false,
            nominal: (!self.without_nominal).then(|| self.make_nominal(seconds)),
            last_minute: None,
            unavoidable: None,
        }
    }

    fn make_nominal(&self, seconds: usize) -> Nominal {
        // as the product's: it goes on past its own CPA, whatever own ship did
        let long = seconds + 300;
        let own = self.nominal.clone().unwrap_or_else(|| self.own.straight(long));
        let targets = self.nominal_targets.clone().unwrap_or_else(|| {
            let unfinished = |t: &Script| {
                if t.seconds() < long {
                    t.clone().hold((long - t.seconds()) as f64)
                } else {
                    t.clone()
                }
            };
            self.targets.iter().map(unfinished).collect()
        });
        let n = targets.iter().map(Script::seconds).chain([own.seconds()]).min().unwrap();
        Nominal {
            minima: targets.iter().map(|t| pair(&own, t, n).minimum).collect(),
            own: cut(own.track(), n + 1),
            targets: targets.iter().map(|t| cut(t.track(), n + 1)).collect(),
        }
    }
}

fn cut(mut track: ShipTrack, samples: usize) -> ShipTrack {
    for signal in track.signals_mut() {
        signal.truncate(samples);
    }
    track
}

/// Hull distances at whole seconds, and in tenths around the closest of them (elsewhere no interval
/// between two seconds holds a smaller one than its ends).
fn pair(own: &Script, target: &Script, seconds: usize) -> Pair {
    let radii_m = own.ship.hull.radius_m() + target.ship.hull.radius_m();
    let centre_m = |step: usize| (own.states[step].0 - target.states[step].0).norm();
    let hulls_m = |step: usize| outline_distance_m(&own.corners(step), &target.corners(step));
    // a lower bound far away
    let at_m = |step: usize| match (centre_m(step) - radii_m).max(0.0) {
        far_m if far_m > 260.0 => far_m,
        _ => hulls_m(step),
    };
    let whole_m: Vec<f64> = (0..=seconds).map(|k| at_m(k * STEPS)).collect();
    let close_m = whole_m.iter().copied().fold(f64::INFINITY, f64::min) + 25.0;
    let far = f64::INFINITY;
    let mut minimum = PairMinimum { hull_m: far, hull_s: 0.0, centre_m: far, centre_s: 0.0 };
    let mut hull_m = Vec::with_capacity(seconds + 1);
    let mut interval_m = f64::INFINITY;
    for step in 0..=seconds * STEPS {
        let t_s = step as f64 / STEPS as f64;
        let (k, whole) = (step / STEPS, step % STEPS == 0);
        let here_m = if whole {
            whole_m[k]
        } else if whole_m[k].min(whole_m[k + 1]) < close_m {
            at_m(step)
        } else {
            f64::INFINITY
        };
        if centre_m(step) < minimum.centre_m {
            (minimum.centre_m, minimum.centre_s) = (centre_m(step), t_s);
        }
        if here_m < minimum.hull_m {
            (minimum.hull_m, minimum.hull_s) = (here_m, t_s);
        }
        interval_m = interval_m.min(here_m);
        if whole {
            hull_m.push(interval_m);
            interval_m = f64::INFINITY;
        }
    }
    Pair { hull_m, minimum, detected_s: Some(0.0), tracked_s: Some(0.0) }
}
