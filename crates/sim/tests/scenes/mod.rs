//! Encounters and planners that several test files use.
#![allow(dead_code, reason = "each test file uses a part")]

use geom::{HullOutline, Vec2, units::deg};
use planner_api::{Command, Mission, Planner, Situation};
use record::{
    DistanceKind, Encounter, EncounterId, Fluctuation, Intent, Motion, OwnShip, RunLimits,
    RunUntil, Seed, Sensing, Target, Trace, Tracker, Vessel, Visibility, Waves, Waypoint, Weather,
    Wind,
};
use std::sync::atomic::AtomicU64;

pub(crate) fn kinematic() -> Vessel {
    Vessel::Kinematic {
        yaw_rate_radps_max: deg(6.0),
        acceleration_mps2_max: 0.5,
        speed_mps_max: 12.0,
    }
}

pub(crate) fn viknes() -> Vessel {
    Vessel::Model("viknes".to_owned())
}

/// A tracker that loses no frame and expects accelerations as large as it is told.
pub(crate) const fn tracker(acceleration_sd_mps2: f64) -> Tracker {
    Tracker {
        acceleration_sd_mps2,
        speed_sd_mps: 8.0,
        gate: 13.8,
        confirm_hits: 3,
        confirm_scans: 5,
        radar_coast_s_max: 20.0,
        ais_coast_s_max: 95.0,
        frame_drop: 0.0,
    }
}

/// A meeting of own ship, from the origin to the north at 7 m/s, with one target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    pub(crate) target_course_rad: f64,
    pub(crate) target_mps: f64,
    pub(crate) target_length_m: f64,
    pub(crate) miss_m: f64,
    pub(crate) tcpa_s: f64,
    pub(crate) step_s: f64,
}

impl Default for Meeting {
    fn default() -> Self {
        Self {
            target_course_rad: deg(-120.0),
            target_mps: 6.0,
            target_length_m: 40.0,
            miss_m: 20.0,
            tcpa_s: 150.0,
            step_s: 0.5,
        }
    }
}

impl Meeting {
    pub(crate) fn encounter(&self, own: Vessel, target: Vessel) -> Encounter {
        let velocity = Vec2::new(7.0, 0.0);
        let other = geom::unit(self.target_course_rad) * self.target_mps;
        let relative = other - velocity;
        let side = Vec2::new(-relative.y, relative.x) / relative.norm();
        let position_m = side * self.miss_m - relative * self.tcpa_s;
        let start = |position_m, psi_rad, speed_mps| Motion { position_m, psi_rad, speed_mps };
        Encounter {
            id: EncounterId::new("test", 0),
            seed: Seed(1),
            weight: 1.0,
            own: OwnShip {
                hull: HullOutline::centred(8.45, 2.71),
                vessel: own,
                start: start(Vec2::zeros(), 0.0, 7.0),
                route: vec![Waypoint { position_m: Vec2::new(7000.0, 0.0), speed_mps: None }],
                cruise_mps: 7.0,
            },
            targets: vec![Target {
                hull: HullOutline::centred(self.target_length_m, self.target_length_m / 6.0),
                vessel: target,
                start: start(position_m, self.target_course_rad, self.target_mps),
                intent: Intent::HoldCourse,
            }],
            hazards: Vec::new(),
            weather: Weather::default(),
            sensing: Sensing::Perfect { detection_range_m: None },
            visibility: Visibility::InSight,
            asked: None,
            safety_radius_m: 150.0,
            distance: DistanceKind::Hull,
            run: RunLimits {
                step_s: self.step_s,
                beat_s: 1.0,
                duration_s_max: 1200.0,
                until: RunUntil::PastAndClear,
            },
        }
    }
}

/// Everything that the weather can do.
pub(crate) fn rough() -> Weather {
    Weather {
        // sets east as the wind does: against it the two would cancel
        current_mps: Vec2::new(0.3, 0.5),
        current_noise: Some(Fluctuation { sd_mps: 0.1, time_constant_s: 120.0 }),
        wind: Some(Wind {
            velocity_mps: Vec2::new(-6.0, 5.0),
            gusts: Fluctuation { sd_mps: 2.0, time_constant_s: 15.0 },
            leeway: 0.03,
        }),
        waves: Some(Waves {
            drift_mps: Vec2::new(-0.05, 0.05),
            drift_sd_mps: 0.1,
            yaw_rate_sd_radps: deg(0.5),
            time_constant_s: 4.0,
            length_m_ref: 10.0,
        }),
    }
}

/// A course and a speed at certain times.
#[derive(Clone, Debug)]
pub(crate) struct Orders(pub(crate) Vec<(f64, f64, f64)>);

impl Planner for Orders {
    fn reset(&mut self, _: &Mission) {}

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let due = self.0.iter().rev().find(|(t_s, _, _)| situation.t_s >= *t_s);
        let (_, course_rad, speed_mps) = *due.unwrap_or(&self.0[0]);
        Command::course_speed(course_rad, speed_mps)
    }
}

/// North at 7 m/s, whatever comes.
pub(crate) fn hold() -> Orders {
    Orders(vec![(0.0, 0.0, 7.0)])
}

/// Turns away from every target that is nearer than 500 m, by an angle that depends smoothly on
/// what it sees: a planner with feedback, odd under mirroring.
#[derive(Clone, Debug)]
pub(crate) struct Shy {
    pub(crate) course_rad: f64,
}

impl Planner for Shy {
    fn reset(&mut self, _: &Mission) {}

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let mut wish = geom::unit(self.course_rad);
        for track in situation.tracks {
            let away = situation.own.position_m - track.position_m;
            let range_m = away.norm();
            if range_m < 500.0 {
                wish += away / range_m * (500.0 - range_m) / 250.0;
            }
        }
        let course_rad = geom::wrap(geom::angle::direction(wish));
        Command::course_speed(course_rad, 7.0)
    }
}

/// The encounter turned about the origin and shifted.
pub(crate) fn moved(encounter: &Encounter, angle_rad: f64, shift_m: Vec2) -> Encounter {
    let mut moved = encounter.clone();
    let place = |p: &mut Vec2| *p = geom::angle::rotate(*p, angle_rad) + shift_m;
    let turn = |m: &mut Motion| m.psi_rad = geom::wrap(m.psi_rad + angle_rad);
    place(&mut moved.own.start.position_m);
    turn(&mut moved.own.start);
    moved.own.route.iter_mut().for_each(|w| place(&mut w.position_m));
    for target in &mut moved.targets {
        place(&mut target.start.position_m);
        turn(&mut target.start);
    }
    moved
}

/// The encounter seen in a mirror that lies along north.
pub(crate) fn mirrored(encounter: &Encounter) -> Encounter {
    let mut image = encounter.clone();
    let flip = |m: &mut Motion| {
        m.position_m.y = -m.position_m.y;
        m.psi_rad = -m.psi_rad;
    };
    flip(&mut image.own.start);
    image.own.route.iter_mut().for_each(|w| w.position_m.y = -w.position_m.y);
    image.targets.iter_mut().for_each(|t| flip(&mut t.start));
    image
}

pub(crate) fn run(encounter: &Encounter, planner: &mut dyn Planner) -> Trace {
    sim::check(encounter).expect("the encounter is sound");
    sim::run(encounter, planner, &mut sim::Scratch::default(), &AtomicU64::new(0))
}
