//! The scripted scenes of the kit, and how they are turned, moved and shown.

use super::SHIFT_M;
use super::answers::Answers;
use crate::{
    Command, Mission, OwnShip, OwnState, Planner, PlannerStream, Situation, TargetTrack, Waypoint,
};
use geom::{Vec2, angle, units::deg, wrap};
use std::panic::{AssertUnwindSafe, catch_unwind};

const BEATS: u32 = 40;
/// Own ship's largest speed in every scene, m/s.
const SPEED_MPS_MAX: f64 = 12.0;

/// A scripted encounter.
///
/// Two in three are as good as a laboratory; in every third one own ship drifts, tracks come with
/// the covariance of an estimate, and there is land on the chart.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    mission: Mission,
    own: OwnState,
    targets: Vec<TargetTrack>,
}

impl Scene {
    pub(super) fn new(number: u64) -> Self {
        let mut stream = PlannerStream::new(0x5ea_0000 + number);
        let mut between = |low: f64, high: f64| low + (high - low) * stream.uniform();
        let speed_mps = between(5.0, 9.0);
        let psi_rad = between(-3.1, 3.1);
        let position_m = Vec2::new(between(-500.0, 500.0), between(-500.0, 500.0));
        let off_rad = between(-0.1, 0.1);
        let goal_m = position_m + angle::unit(wrap(psi_rad + off_rad)) * between(3000.0, 6000.0);
        let own = OwnState::steady(position_m, psi_rad, speed_mps);
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
        let scene = Self { mission, own, targets };
        if number % 3 == 2 { scene.at_sea(number) } else { scene }
    }

    /// With what a laboratory has not: drift, estimates instead of truth, land.
    fn at_sea(mut self, number: u64) -> Self {
        let mut stream = PlannerStream::new(0xa75ea + number);
        let mut between = |low: f64, high: f64| low + (high - low) * stream.uniform();
        let drift_mps = angle::unit(between(-3.1, 3.1)) * between(0.1, 0.8);
        let own = &mut self.own;
        own.velocity_mps += drift_mps;
        own.cog_rad = angle::direction(own.velocity_mps);
        own.sog_mps = own.velocity_mps.norm();
        own.yaw_rate_radps = between(-0.02, 0.02);
        for target in &mut self.targets {
            let (along_m, across_m) = (between(5.0, 40.0), between(5.0, 40.0));
            let speed_per_place = between(0.02, 0.05);
            let axis = angle::unit(between(-3.1, 3.1));
            target.covariance = covariance(axis, along_m, across_m, speed_per_place);
            target.since_update_s = between(0.0, 9.0);
        }
        let ahead_m = self.mission.goal_m() + Vec2::new(between(100.0, 400.0), 150.0);
        let corners_m = [(0.0, 0.0), (90.0, 20.0), (40.0, 130.0)];
        self.mission.hazards = vec![corners_m.map(|(x, y)| ahead_m + Vec2::new(x, y)).to_vec()];
        self
    }

    /// Turned clockwise about the origin.
    pub(super) fn turned(&self, by_rad: f64) -> Self {
        let mut scene = self.clone();
        let turn = |v: &mut Vec2| *v = angle::rotate(*v, by_rad);
        for waypoint in &mut scene.mission.route {
            turn(&mut waypoint.position_m);
        }
        scene.mission.hazards.iter_mut().flatten().for_each(turn);
        turn(&mut scene.own.position_m);
        turn(&mut scene.own.velocity_mps);
        scene.own.psi_rad = wrap(scene.own.psi_rad + by_rad);
        scene.own.cog_rad = wrap(scene.own.cog_rad + by_rad);
        for target in &mut scene.targets {
            turn(&mut target.position_m);
            turn(&mut target.velocity_mps);
            target.cog_rad = wrap(target.cog_rad + by_rad);
            target.psi_rad = target.psi_rad.map(|psi_rad| wrap(psi_rad + by_rad));
            target.covariance = turned_covariance(&target.covariance, by_rad);
        }
        scene
    }

    pub(super) fn moved(&self, by_m: Vec2) -> Self {
        let mut scene = self.clone();
        for waypoint in &mut scene.mission.route {
            waypoint.position_m += by_m;
        }
        scene.mission.hazards.iter_mut().flatten().for_each(|corner_m| *corner_m += by_m);
        scene.own.position_m += by_m;
        for target in &mut scene.targets {
            target.position_m += by_m;
        }
        scene
    }

    pub(super) fn permuted(&self) -> Self {
        let mut scene = self.clone();
        scene.targets.reverse();
        scene
    }

    /// Shows the scene to a planner; none if it panics.
    pub(super) fn run(&self, planner: &mut dyn Planner) -> Option<Answers> {
        self.show(planner, || {})
    }

    /// The same, while another planner works on the next scene.
    pub(super) fn run_beside(
        &self,
        planner: &mut dyn Planner,
        other: &mut dyn Planner,
    ) -> Option<Answers> {
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

/// Of (north, east, north velocity, east velocity): standard deviations of the place along and
/// across an axis in metres, those of the velocity as a share of them a second, and a correlation
/// of one half between place and velocity.
fn covariance(axis: Vec2, along_m: f64, across_m: f64, speed_per_place: f64) -> [[f64; 4]; 4] {
    let (c, s) = (axis.x, axis.y);
    let (a, b) = (along_m * along_m, across_m * across_m);
    let place =
        [[a * c * c + b * s * s, (a - b) * c * s], [(a - b) * c * s, a * s * s + b * c * c]];
    let scale =
        [[1.0, 0.5 * speed_per_place], [0.5 * speed_per_place, speed_per_place * speed_per_place]];
    std::array::from_fn(|i| std::array::from_fn(|j| place[i % 2][j % 2] * scale[i / 2][j / 2]))
}

/// The covariance of the same estimate in a scene that was turned clockwise.
fn turned_covariance(covariance: &[[f64; 4]; 4], by_rad: f64) -> [[f64; 4]; 4] {
    let unit = angle::unit(by_rad);
    let turn = [[unit.x, -unit.y], [unit.y, unit.x]];
    // one rotation for each block of two by two
    let entry = |i: usize, j: usize| -> f64 {
        let (row, column) = (i / 2 * 2, j / 2 * 2);
        let pairs = [(0, 0), (0, 1), (1, 0), (1, 1)];
        pairs
            .map(|(k, l)| turn[i % 2][k] * covariance[row + k][column + l] * turn[j % 2][l])
            .iter()
            .sum()
    };
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}
