//! A small closed loop: kinematic vessels on a plane, one planner, targets that keep course and
//! speed. It stands in for the simulator, which is another crate.

use geom::{Vec2, angle, units::deg, wrap};
use planner_api::{
    Command, Mission, Order, OwnShip, OwnState, Planner, PlannerEvents, Situation, TargetTrack,
    Waypoint,
};
use std::f64::consts::FRAC_PI_2;

/// A vessel in the paper's numbers: x east, y north in metres, m/s, counter-clockwise degrees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vessel(pub f64, pub f64, pub f64, pub f64);

impl Vessel {
    pub(crate) fn position_m(self) -> Vec2 {
        Vec2::new(self.1, self.0)
    }
    pub(crate) fn course_rad(self) -> f64 {
        wrap(FRAC_PI_2 - deg(self.3))
    }
    pub(crate) fn velocity_mps(self) -> Vec2 {
        angle::unit(self.course_rad()) * self.2
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Scene {
    pub(crate) own: Vessel,
    pub(crate) goal: (f64, f64),
    pub(crate) targets: Vec<Vessel>,
    pub(crate) radius_m: f64,
    pub(crate) detection_m: f64,
    pub(crate) duration_s: usize,
    pub(crate) cruise_mps: f64,
    pub(crate) turn_rate_deg: f64,
    /// Length of every target where distances are from hull to hull.
    pub(crate) target_length_m: Option<f64>,
    /// When every target alters (seconds), and by how much to starboard (degrees).
    pub(crate) alters: Option<(f64, f64)>,
    /// Outlines of land, corners in metres (x east, y north).
    pub(crate) land: Vec<Vec<(f64, f64)>>,
}

impl Scene {
    /// Section 4.2: own ship at (0, 0), 8 m/s, course 90, R = 150 m, detection 800 m.
    pub(crate) fn paper(goal_y: f64, targets: &[Vessel]) -> Self {
        Self {
            own: Vessel(0.0, 0.0, 8.0, 90.0),
            goal: (0.0, goal_y),
            targets: targets.to_vec(),
            radius_m: 150.0,
            detection_m: 800.0,
            duration_s: 1200,
            cruise_mps: 8.0,
            turn_rate_deg: 6.0,
            target_length_m: None,
            alters: None,
            land: Vec::new(),
        }
    }

    /// A target as she is at a moment.
    fn target(&self, target: Vessel, t_s: f64) -> Vessel {
        let sailed = |from: Vessel, for_s: f64| {
            let to_m = from.position_m() + from.velocity_mps() * for_s;
            Vessel(to_m.y, to_m.x, from.2, from.3)
        };
        match self.alters {
            Some((at_s, by_deg)) if t_s > at_s => {
                let Vessel(x, y, speed, course_deg) = sailed(target, at_s);
                sailed(Vessel(x, y, speed, course_deg - by_deg), t_s - at_s)
            }
            _ => sailed(target, t_s),
        }
    }

    pub(crate) fn mission(&self) -> Mission {
        let at = |&(x, y): &(f64, f64)| Vec2::new(y, x);
        Mission {
            own: OwnShip {
                length_m: 8.0,
                beam_m: 2.5,
                speed_mps_max: 12.0,
                yaw_rate_radps_max: deg(self.turn_rate_deg),
                acceleration_mps2_max: 0.5,
            },
            route: vec![Waypoint {
                position_m: Vec2::new(self.goal.1, self.goal.0),
                speed_mps: None,
            }],
            cruise_mps: self.cruise_mps,
            safety_radius_m: self.radius_m,
            between_centres: self.target_length_m.is_none(),
            beat_s: 1.0,
            hazards: self.land.iter().map(|outline| outline.iter().map(at).collect()).collect(),
            stream_seed: 7,
        }
    }

    pub(crate) fn tracks(&self, t_s: f64, own_m: Vec2) -> Vec<TargetTrack> {
        let track = |(id, v): (usize, &Vessel)| TargetTrack {
            length_m: self.target_length_m,
            age_s: t_s,
            ..track(id as u32, self.target(*v, t_s), 0.0)
        };
        self.targets
            .iter()
            .enumerate()
            .map(track)
            .filter(|t| (t.position_m - own_m).norm() <= self.detection_m)
            .collect()
    }

    /// Own ship's first order, at the start.
    pub(crate) fn first_order(&self, planner: &mut dyn Planner) -> (f64, f64) {
        planner.reset(&self.mission());
        let own = OwnState::steady(self.own.position_m(), self.own.course_rad(), self.own.2);
        let tracks = self.tracks(0.0, own.position_m);
        let situation = Situation { t_s: 0.0, own, tracks: &tracks, visual_range_m: None };
        course_speed(planner.plan(&situation), self.own.course_rad())
    }

    pub(crate) fn run(&self, planner: &mut dyn Planner) -> Run {
        planner.reset(&self.mission());
        let (mut position_m, mut psi, mut speed) =
            (self.own.position_m(), self.own.course_rad(), self.own.2);
        let mut beats = Vec::new();
        let mut cpa =
            vec![Cpa { range_m: f64::INFINITY, t_s: 0.0, bearing_rad: 0.0, contact_rad: 0.0 }; 8];
        let goal_m = Vec2::new(self.goal.1, self.goal.0);
        let mut goal_s = None;
        for beat in 0..self.duration_s {
            let t_s = beat as f64;
            let own = OwnState::steady(position_m, psi, speed);
            let tracks = self.tracks(t_s, position_m);
            let situation = Situation { t_s, own, tracks: &tracks, visual_range_m: None };
            let (course, ordered) = course_speed(planner.plan(&situation), psi);
            beats.push(Beat { t_s, position_m, psi_rad: psi, speed_mps: speed });
            for step in 0..10 {
                let limit = deg(0.1 * self.turn_rate_deg);
                let turn = wrap(course - psi).clamp(-limit, limit);
                psi = wrap(psi + turn);
                speed = (speed + (ordered - speed).clamp(-0.05, 0.05)).clamp(0.0, 12.0);
                position_m += angle::unit(psi) * (speed * 0.1);
                let now_s = t_s + 0.1 * f64::from(step + 1);
                for (target, cpa) in self.targets.iter().zip(&mut cpa) {
                    let target = self.target(*target, now_s);
                    let los = target.position_m() - position_m;
                    if los.norm() < cpa.range_m {
                        let bearing_rad = wrap(angle::direction(los) - psi);
                        let contact_rad = wrap(angle::direction(-los) - target.course_rad());
                        *cpa = Cpa { range_m: los.norm(), t_s: now_s, bearing_rad, contact_rad };
                    }
                }
            }
            if goal_s.is_none() && (position_m - goal_m).norm() < 120.0 {
                goal_s = Some(t_s);
                break;
            }
        }
        cpa.truncate(self.targets.len());
        Run { beats, cpa, goal_s, events: planner.events() }
    }
}

pub(crate) fn track(id: u32, v: Vessel, t_s: f64) -> TargetTrack {
    TargetTrack {
        id,
        position_m: v.position_m() + v.velocity_mps() * t_s,
        velocity_mps: v.velocity_mps(),
        cog_rad: if v.2 > 0.0 { v.course_rad() } else { 0.0 },
        sog_mps: v.2,
        psi_rad: Some(v.course_rad()),
        length_m: None,
        beam_m: None,
        covariance: [[0.0; 4]; 4],
        age_s: t_s,
        since_update_s: 0.0,
    }
}

pub(crate) fn course_speed(command: Command, psi_rad: f64) -> (f64, f64) {
    match command.order {
        Order::CourseSpeed { course_rad, speed_mps } => (course_rad, speed_mps),
        Order::Velocity { velocity_mps } if velocity_mps.norm() > 0.0 => {
            (angle::direction(velocity_mps), velocity_mps.norm())
        }
        Order::Velocity { .. } => (psi_rad, 0.0),
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Beat {
    pub(crate) t_s: f64,
    pub(crate) position_m: Vec2,
    pub(crate) psi_rad: f64,
    pub(crate) speed_mps: f64,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Cpa {
    pub(crate) range_m: f64,
    pub(crate) t_s: f64,
    /// Of the target from own bow, clockwise.
    pub(crate) bearing_rad: f64,
    /// Of own ship from the target's bow, clockwise.
    pub(crate) contact_rad: f64,
}

#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) beats: Vec<Beat>,
    pub(crate) cpa: Vec<Cpa>,
    pub(crate) goal_s: Option<f64>,
    pub(crate) events: PlannerEvents,
}

impl Run {
    /// The first departure of own heading from the start of more than `limit_deg`: positive to
    /// starboard, 0 if there is none.
    pub(crate) fn first_turn(&self, limit_deg: f64) -> f64 {
        let psi_0 = self.beats[0].psi_rad;
        let offsets = self.beats.iter().map(|b| wrap(b.psi_rad - psi_0));
        offsets.into_iter().find(|o| o.abs() > deg(limit_deg)).map_or(0.0, f64::signum)
    }

    /// Largest departure to (starboard, port) up to the first target's CPA, degrees.
    pub(crate) fn offsets_deg(&self) -> (f64, f64) {
        let psi_0 = self.beats[0].psi_rad;
        let until = self.cpa[0].t_s;
        let offsets = self.beats.iter().filter(|b| b.t_s <= until);
        offsets.fold((0.0, 0.0), |(s, p): (f64, f64), b| {
            let o = wrap(b.psi_rad - psi_0).to_degrees();
            (s.max(o), p.max(-o))
        })
    }

    /// By how much a starboard alteration is taken back before the first target's CPA, degrees.
    pub(crate) fn reversal_deg(&self) -> f64 {
        let psi_0 = self.beats[0].psi_rad;
        let until = self.cpa[0].t_s;
        let mut largest = (0.0f64, 0.0f64);
        for beat in self.beats.iter().filter(|b| b.t_s < until) {
            let offset_deg = wrap(beat.psi_rad - psi_0).to_degrees();
            largest.0 = largest.0.max(offset_deg);
            largest.1 = largest.1.max(largest.0 - offset_deg);
        }
        largest.1
    }

    pub(crate) fn range_m_min(&self) -> f64 {
        self.cpa.iter().map(|c| c.range_m).fold(f64::INFINITY, f64::min)
    }
}

/// A planner of the registry with options laid over its own.
pub(crate) fn planner(name: &str, changes: &str) -> Box<dyn Planner> {
    let registry = planners::registry();
    let entry = registry.get(name).expect("a registered name");
    let changes = changes.parse().expect("a TOML table");
    let options = entry.resolve(&changes).expect("known options");
    (entry.make)(&options).expect("values that it can take")
}
