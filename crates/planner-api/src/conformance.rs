//! The conformance kit: what every planner must satisfy, whoever wrote it.
//!
//! An author's own test is one line:
//!
//! ```
//! # use planner_api::{Command, Mission, Planner, Situation, conformance};
//! # struct Mine { course_rad: f64 }
//! # impl Planner for Mine {
//! #     fn reset(&mut self, mission: &Mission) {
//! #         let goal_m = mission.goal_m();
//! #         self.course_rad = 0.0 * goal_m.x;
//! #     }
//! #     fn plan(&mut self, situation: &Situation<'_>) -> Command {
//! #         Command::course_speed(situation.own.cog_rad, situation.own.sog_mps)
//! #     }
//! # }
//! let findings = conformance::check(&|| Box::new(Mine { course_rad: 0.0 }));
//! assert!(findings.is_empty(), "{findings:#?}");
//! ```
//!
//! The kit shows a planner a few dozen scripted scenes in open water: own ship and up to four
//! targets on straight lines, whatever is ordered. So the same inputs can be shown again turned,
//! moved or in another order, and the answers compared beat by beat. The scenes come from a fixed
//! stream and are nowhere symmetric, so that rounding cannot tip a balance. Costs some 10,000
//! calls and 200 makings of the planner.

use crate::{
    Command, CommandError, Mission, Order, OwnShip, OwnState, Planner, PlannerEvents,
    PlannerStream, Situation, TargetTrack, Waypoint,
};
use geom::{Vec2, angle, units::deg, wrap};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What is asked of a planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Check {
    /// It answers: no panic.
    Answers,
    /// Its orders are finite and in range ([`Order::checked`]).
    InRange,
    /// Two planners made alike answer alike, bit for bit.
    Deterministic,
    /// After `reset` it answers as a new one would, bit for bit, and its events start again.
    ResetsCompletely,
    /// Another planner at work beside it changes nothing, bit for bit: no shared state, no random
    /// numbers but its own stream.
    OwnStreamOnly,
    /// A turned scene turns the order by as much.
    RotationIndifferent,
    /// A moved scene leaves the order as it is.
    TranslationIndifferent,
    /// The order of the tracks does not matter.
    PermutationStable,
}

impl Check {
    /// All of them, in order.
    pub const ALL: [Self; 8] = [
        Self::Answers,
        Self::InRange,
        Self::Deterministic,
        Self::ResetsCompletely,
        Self::OwnStreamOnly,
        Self::RotationIndifferent,
        Self::TranslationIndifferent,
        Self::PermutationStable,
    ];
}

/// A check that a planner does not satisfy.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The check.
    pub check: Check,
    /// Scenes in which it fails.
    pub scenes_failed: usize,
    /// Scenes in all.
    pub scenes: usize,
    /// The first of them.
    pub example: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { check, scenes_failed, scenes, example } = self;
        write!(f, "{check:?}: fails in {scenes_failed} of {scenes} scenes, first {example}")
    }
}

/// Largest difference of course (radians) and speed (m/s) between a scene and the same scene turned
/// or moved: far above rounding, far below anything a helmsman could see.
const TOLERANCE: f64 = 1e-6;
/// Below this speed a course means nothing, m/s.
const STILL_MPS: f64 = 1e-6;
const SCENES: u64 = 24;
const BEATS: u32 = 40;
/// Own ship's largest speed in every scene, m/s.
const SPEED_MPS_MAX: f64 = 12.0;
/// Turns in radians; odd ones, so that every quadrant boundary is crossed.
const TURNS_RAD: [f64; 3] = [0.83, 2.31, -1.97];
const SHIFT_M: Vec2 = Vec2::new(12_345.25, -6_789.5);

/// Every check that the planner fails, in the order of [`Check`]; none if it conforms.
pub fn check(make: &dyn Fn() -> Box<dyn Planner>) -> Vec<Finding> {
    let mut findings: Vec<Finding> = Vec::new();
    let mut used = make();
    let scenes = SCENES as usize;
    for number in 0..SCENES {
        let scene = Scene::new(number);
        for (check, what) in check_scene(make, used.as_mut(), &scene) {
            let example = format!("scene {number}: {what}");
            match findings.iter_mut().find(|finding| finding.check == check) {
                Some(finding) => finding.scenes_failed += 1,
                None => {
                    findings.push(Finding { check, scenes_failed: 1, scenes, example });
                }
            }
            if check == Check::Answers {
                used = make();
            }
        }
    }
    findings.sort_by_key(|finding| finding.check);
    findings
}

/// At most one failure of each check.
fn check_scene(
    make: &dyn Fn() -> Box<dyn Planner>,
    used: &mut dyn Planner,
    scene: &Scene,
) -> Vec<(Check, String)> {
    let mut failed = Vec::new();
    let Some(alone) = scene.run(make().as_mut()) else {
        return vec![(Check::Answers, "it panicked".to_owned())];
    };
    let in_range = alone.orders.iter().zip(1..).find_map(|(order, beat)| {
        order.as_ref().err().map(|error| format!("beat {beat}: {error}"))
    });
    failed.extend(in_range.map(|what| (Check::InRange, what)));

    let mut other = make();
    let again = scene.run(other.as_mut());
    failed.extend(alone.differs_in_a_bit(again.as_ref()).map(|w| (Check::Deterministic, w)));
    // `used` comes from another scene
    let reset = scene.run(used);
    failed.extend(alone.differs_in_a_bit(reset.as_ref()).map(|w| (Check::ResetsCompletely, w)));
    let beside = scene.run_beside(make().as_mut(), other.as_mut());
    failed.extend(alone.differs_in_a_bit(beside.as_ref()).map(|w| (Check::OwnStreamOnly, w)));

    let mut compare = |check: Check, changed: &Scene, turn_rad: f64| {
        let answers = changed.run(make().as_mut());
        let difference = alone.differs_by_more_than_rounding(answers.as_ref(), turn_rad);
        if let Some(what) = difference
            && failed.iter().all(|(known, _)| *known != check)
        {
            failed.push((check, what));
        }
    };
    for turn_rad in TURNS_RAD {
        compare(Check::RotationIndifferent, &scene.turned(turn_rad), turn_rad);
    }
    compare(Check::TranslationIndifferent, &scene.moved(SHIFT_M), 0.0);
    compare(Check::PermutationStable, &scene.permuted(), 0.0);
    failed
}

/// What a planner answered in a scene.
struct Answers {
    commands: Vec<Command>,
    /// Course and speed, or why there are none.
    orders: Vec<Result<(f64, f64), CommandError>>,
    events: PlannerEvents,
}

impl Answers {
    fn differs_in_a_bit(&self, other: Option<&Self>) -> Option<String> {
        let Some(other) = other else {
            return Some("it panicked".to_owned());
        };
        let beats = self.commands.iter().zip(&other.commands).zip(1..);
        for ((a, b), beat) in beats {
            if bits(a) != bits(b) || a.alerts != b.alerts {
                return Some(format!("beat {beat}: {:?} and then {:?}", a.order, b.order));
            }
        }
        let (a, b) = (self.events, other.events);
        (a != b).then(|| format!("events {a:?} and then {b:?}"))
    }

    fn differs_by_more_than_rounding(&self, other: Option<&Self>, turn_rad: f64) -> Option<String> {
        let Some(other) = other else {
            return Some("it panicked".to_owned());
        };
        let beats = self.orders.iter().zip(&other.orders).zip(1..);
        for ((a, b), beat) in beats {
            // an order that is out of range is a finding of its own
            let (Ok((course_a, speed_a)), Ok((course_b, speed_b))) = (a, b) else {
                if a.is_ok() != b.is_ok() {
                    return Some(format!("beat {beat}: {a:?} and then {b:?}"));
                }
                continue;
            };
            let still = speed_a.min(*speed_b) < STILL_MPS;
            let course_rad = if still { 0.0 } else { wrap(course_b - course_a - turn_rad).abs() };
            let speed_mps = (speed_a - speed_b).abs();
            if course_rad > TOLERANCE || speed_mps > TOLERANCE {
                return Some(format!(
                    "beat {beat}, turned by {:.1} deg: course differs by {:.6} deg, speed by \
                     {speed_mps:.6} m/s",
                    turn_rad.to_degrees(),
                    course_rad.to_degrees()
                ));
            }
        }
        None
    }
}

/// An order as bits, so that NaN equals itself.
fn bits(command: &Command) -> (bool, u64, u64) {
    match command.order {
        Order::CourseSpeed { course_rad, speed_mps } => {
            (true, course_rad.to_bits(), speed_mps.to_bits())
        }
        Order::Velocity { velocity_mps } => {
            (false, velocity_mps.x.to_bits(), velocity_mps.y.to_bits())
        }
    }
}

/// A scripted encounter.
#[derive(Clone, Debug)]
struct Scene {
    mission: Mission,
    own: OwnState,
    targets: Vec<TargetTrack>,
}

impl Scene {
    fn new(number: u64) -> Self {
        let mut stream = PlannerStream::new(0x5ea_0000 + number);
        let mut between = |low: f64, high: f64| low + (high - low) * stream.uniform();
        let speed_mps = between(5.0, 9.0);
        let psi_rad = between(-3.1, 3.1);
        let position_m = Vec2::new(between(-500.0, 500.0), between(-500.0, 500.0));
        let off_rad = between(-0.1, 0.1);
        let goal_m = position_m + angle::unit(wrap(psi_rad + off_rad)) * between(3000.0, 6000.0);
        let own = OwnState {
            position_m,
            psi_rad,
            velocity_mps: angle::unit(psi_rad) * speed_mps,
            cog_rad: psi_rad,
            sog_mps: speed_mps,
            stw_mps: speed_mps,
            yaw_rate_radps: 0.0,
        };
        let targets = (0..1 + number % 4)
            .map(|id| {
                // meets own ship after this time, but for a miss in any direction
                let (tcpa_s, miss_m) = (between(15.0, 150.0), between(5.0, 280.0));
                let target_mps = between(1.0, 12.0);
                let course_rad = between(-3.1, 3.1);
                let velocity_mps = angle::unit(course_rad) * target_mps;
                let miss = angle::unit(between(-3.1, 3.1)) * miss_m;
                let from_own_m = (own.velocity_mps - velocity_mps) * tcpa_s + miss;
                TargetTrack {
                    id: 3 * id as u32 + 1,
                    position_m: position_m + from_own_m,
                    velocity_mps,
                    cog_rad: course_rad,
                    sog_mps: target_mps,
                    psi_rad: (id != 2).then_some(course_rad),
                    length_m: (id != 1).then_some(between(8.0, 120.0)),
                    beam_m: None,
                    covariance: [[0.0; 4]; 4],
                    age_s: 30.0,
                    since_update_s: 0.0,
                }
            })
            .collect();
        let mission = Mission {
            own: OwnShip {
                length_m: 8.45,
                beam_m: 2.71,
                speed_mps_max: SPEED_MPS_MAX,
                yaw_rate_radps_max: deg(12.0),
                acceleration_mps2_max: 0.5,
            },
            route: vec![Waypoint { position_m: goal_m, speed_mps: None }],
            cruise_mps: speed_mps,
            safety_radius_m: 150.0,
            between_centres: number.is_multiple_of(2),
            beat_s: 1.0,
            hazards: Vec::new(),
            stream_seed: 0xc0de + number,
        };
        Self { mission, own, targets }
    }

    /// Turned clockwise about the origin.
    fn turned(&self, by_rad: f64) -> Self {
        let mut scene = self.clone();
        let turn = |v: &mut Vec2| *v = angle::rotate(*v, by_rad);
        for waypoint in &mut scene.mission.route {
            turn(&mut waypoint.position_m);
        }
        turn(&mut scene.own.position_m);
        turn(&mut scene.own.velocity_mps);
        scene.own.psi_rad = wrap(scene.own.psi_rad + by_rad);
        scene.own.cog_rad = wrap(scene.own.cog_rad + by_rad);
        for target in &mut scene.targets {
            turn(&mut target.position_m);
            turn(&mut target.velocity_mps);
            target.cog_rad = wrap(target.cog_rad + by_rad);
            target.psi_rad = target.psi_rad.map(|psi_rad| wrap(psi_rad + by_rad));
        }
        scene
    }

    fn moved(&self, by_m: Vec2) -> Self {
        let mut scene = self.clone();
        for waypoint in &mut scene.mission.route {
            waypoint.position_m += by_m;
        }
        scene.own.position_m += by_m;
        for target in &mut scene.targets {
            target.position_m += by_m;
        }
        scene
    }

    fn permuted(&self) -> Self {
        let mut scene = self.clone();
        scene.targets.reverse();
        scene
    }

    /// Shows the scene to a planner; none if it panics.
    fn run(&self, planner: &mut dyn Planner) -> Option<Answers> {
        self.show(planner, || {})
    }

    /// The same, while another planner works on the next scene.
    fn run_beside(&self, planner: &mut dyn Planner, other: &mut dyn Planner) -> Option<Answers> {
        let elsewhere = self.moved(SHIFT_M).turned(1.1);
        let mission =
            Mission { stream_seed: !self.mission.stream_seed, ..elsewhere.mission.clone() };
        catch_unwind(AssertUnwindSafe(|| other.reset(&mission))).ok()?;
        let situation = elsewhere.situation(0, &elsewhere.targets);
        self.show(planner, || {
            other.plan(&situation);
        })
    }

    fn show(&self, planner: &mut dyn Planner, mut between: impl FnMut()) -> Option<Answers> {
        let run = || {
            planner.reset(&self.mission);
            let mut tracks = self.targets.clone();
            let mut commands = Vec::new();
            for beat in 0..BEATS {
                let t_s = f64::from(beat) * self.mission.beat_s;
                for (track, target) in tracks.iter_mut().zip(&self.targets) {
                    track.position_m = target.position_m + target.velocity_mps * t_s;
                }
                commands.push(planner.plan(&self.situation(beat, &tracks)));
                between();
            }
            let checked = |c: &Command| c.order.checked(SPEED_MPS_MAX, self.own.psi_rad);
            let orders = commands.iter().map(checked).collect();
            Answers { commands, orders, events: planner.events() }
        };
        catch_unwind(AssertUnwindSafe(run)).ok()
    }

    fn situation<'a>(&self, beat: u32, tracks: &'a [TargetTrack]) -> Situation<'a> {
        let t_s = f64::from(beat) * self.mission.beat_s;
        let position_m = self.own.position_m + self.own.velocity_mps * t_s;
        let own = OwnState { position_m, ..self.own };
        Situation { t_s, own, tracks, visual_range_m: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    /// A planner with one fault, or none.
    #[derive(Default)]
    struct Faulty {
        fault: Option<Check>,
        beats: u32,
        made: u64,
        stream: Option<PlannerStream>,
    }

    static MADE: AtomicU64 = AtomicU64::new(0);
    static CALLS: AtomicU64 = AtomicU64::new(0);

    impl Planner for Faulty {
        fn reset(&mut self, mission: &Mission) {
            self.stream = Some(PlannerStream::new(mission.stream_seed));
            if self.fault != Some(Check::ResetsCompletely) {
                self.beats = 0;
            }
        }

        fn plan(&mut self, situation: &Situation<'_>) -> Command {
            self.beats += 1;
            let calls = CALLS.fetch_add(1, Ordering::Relaxed);
            let own_m = situation.own.position_m;
            let first = situation.tracks[0].position_m - own_m;
            let nearest = situation.tracks.iter().map(|t| (t.position_m - own_m).norm());
            let range_m = nearest.fold(f64::INFINITY, f64::min);
            // Lawful: its own stream, time since reset, what lies around.
            let noise = self.stream.as_mut().expect("reset").uniform();
            let speed = 3.0 + noise + 0.01 * f64::from(self.beats) + 1e-3 * range_m.min(1e3);
            let (course, speed) = match self.fault {
                None | Some(Check::ResetsCompletely) => (0.0, speed),
                Some(Check::Answers) if self.beats == 7 => panic!("on purpose"),
                Some(Check::InRange) if self.beats == 7 => (0.0, -1.0),
                Some(Check::Deterministic) => (0.0, speed + 1e-12 * self.made as f64),
                Some(Check::OwnStreamOnly) => (0.0, speed + 1e-3 * (calls % 2) as f64),
                Some(Check::RotationIndifferent) => (0.1 * situation.own.psi_rad, speed),
                Some(Check::TranslationIndifferent) => (1e-4 * own_m.norm(), speed),
                Some(Check::PermutationStable) => (1e-4 * first.norm(), speed),
                _ => (0.0, speed),
            };
            Command::course_speed(wrap(situation.own.cog_rad + course), speed)
        }
    }

    fn failed(fault: Option<Check>) -> Vec<Check> {
        let make = || -> Box<dyn Planner> {
            let made = MADE.fetch_add(1, Ordering::Relaxed);
            Box::new(Faulty { fault, made, ..Faulty::default() })
        };
        check(&make).into_iter().map(|finding| finding.check).collect()
    }

    #[test]
    fn a_planner_without_fault_has_no_finding() {
        assert_eq!(failed(None), []);
    }

    /// Every check finds the fault that it is for, and most of them nothing else.
    #[test]
    fn every_fault_is_found() {
        for fault in [
            Check::Answers,
            Check::InRange,
            Check::ResetsCompletely,
            Check::RotationIndifferent,
            Check::TranslationIndifferent,
            Check::PermutationStable,
        ] {
            assert_eq!(failed(Some(fault)), [fault]);
        }
        assert!(failed(Some(Check::Deterministic)).contains(&Check::Deterministic));
    }

    /// A counter that all planners share is found when another one works beside.
    #[test]
    fn shared_state_is_found() {
        assert!(failed(Some(Check::OwnStreamOnly)).contains(&Check::OwnStreamOnly));
    }
}
