//! Mutants: any planner of the registry with one fault in what it sees or what it orders.
//!
//! A gate is worth what it catches, so each mutant is a fault that a real change could bring. They
//! are named `mutant:FAULT:PLANNER`, such as `mutant:late-5s:zhuang`, and wrap the planner from
//! outside: no planner knows of them. Source: statistics specification, section 5, item 7.

use geom::{Vec2, wrap};
use planner_api::{
    Command, Mission, Order, Planner, PlannerEntry, PlannerEvents, Registry, Situation, TargetTrack,
};
use std::collections::VecDeque;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// The word before the fault.
pub const PREFIX: &str = "mutant:";

/// One fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Port and starboard exchanged: it plans in the mirror.
    SignFlip,
    /// The safety radius that it is told is 10 % smaller.
    RadiusLess,
    /// Every order is carried out 5 s late.
    Late,
    /// Only the track with the lowest number is seen.
    FirstTargetOnly,
    /// Targets are taken for 30 % slower than they are.
    TargetsSlow,
    /// Ships abaft the beam are not seen.
    BlindAstern,
    /// Ships beyond 400 m are not seen.
    ShortSighted,
    /// Half of every alteration, measured from the way to the goal.
    HalfTurn,
    /// Own speed is ordered at 60 %.
    HalfSpeed,
    /// Plans once in 20 s and holds the order between.
    Stale,
}

/// Every fault with its name and what it does.
pub const FAULTS: [(Fault, &str, &str); 10] = [
    (Fault::SignFlip, "sign-flip", "port and starboard exchanged"),
    (Fault::RadiusLess, "radius-10", "safety radius 10 % smaller"),
    (Fault::Late, "late-5s", "orders carried out 5 s late"),
    (Fault::FirstTargetOnly, "first-target-only", "sees one target only"),
    (Fault::TargetsSlow, "targets-slow", "takes targets for 30 % slower"),
    (Fault::BlindAstern, "blind-astern", "does not see ships abaft the beam"),
    (Fault::ShortSighted, "short-sighted", "sees no ship beyond 400 m"),
    (Fault::HalfTurn, "half-turn", "half of every alteration"),
    (Fault::HalfSpeed, "half-speed", "orders 60 % of the speed"),
    (Fault::Stale, "stale", "plans once in 20 s"),
];

/// The registry with the mutant of this name, if it is one's name.
pub fn with_mutant(registry: Registry, name: &str) -> Result<Registry, String> {
    let Some(rest) = name.strip_prefix(PREFIX) else { return Ok(registry) };
    let (fault, base) = rest
        .split_once(':')
        .ok_or_else(|| format!("`{name}` is no mutant; one looks like {PREFIX}late-5s:zhuang"))?;
    let known = || FAULTS.iter().map(|(_, word, _)| *word).collect::<Vec<_>>().join(", ");
    let (fault, _, what) = FAULTS
        .into_iter()
        .find(|(_, word, _)| *word == fault)
        .ok_or_else(|| format!("there is no fault `{fault}`; there are {}", known()))?;
    if registry.get(name).is_ok() {
        return Ok(registry);
    }
    let shared = Arc::new(registry);
    let base = shared.get(base).map_err(|e| e.to_string())?;
    let make = {
        let (shared, base) = (Arc::clone(&shared), base.name.clone());
        move |options: &planner_api::Options| {
            let inner = (shared.get(&base)?.make)(options)?;
            Ok(Box::new(Mutant::new(fault, inner)) as Box<dyn Planner>)
        }
    };
    let mutant = PlannerEntry {
        name: name.to_owned(),
        summary: format!("{}, but {what}", base.name),
        caught_by: None,
        options: base.options.clone(),
        make: Box::new(make),
    };
    let all = shared.entries().iter().map(|entry| delegate(&shared, entry));
    Ok(all.fold(Registry::new(), Registry::with).with(mutant))
}

/// An entry of the same planner, made by the registry that is shared.
fn delegate(shared: &Arc<Registry>, entry: &PlannerEntry) -> PlannerEntry {
    let (registry, name) = (Arc::clone(shared), entry.name.clone());
    PlannerEntry {
        name: entry.name.clone(),
        summary: entry.summary.clone(),
        caught_by: entry.caught_by.clone(),
        options: entry.options.clone(),
        make: Box::new(move |options| (registry.get(&name)?.make)(options)),
    }
}

/// How much smaller the radius is.
const RADIUS_FACTOR: f64 = 0.9;
/// How late orders are, seconds.
const LATE_S: f64 = 5.0;
/// What targets are slowed by.
const TARGET_SPEED_FACTOR: f64 = 0.7;
/// How far the short-sighted one sees, metres.
const SIGHT_M: f64 = 400.0;
/// What own speed is ordered at.
const OWN_SPEED_FACTOR: f64 = 0.6;
/// How long the stale one holds its order, seconds.
const STALE_S: f64 = 20.0;

/// A planner with a fault.
struct Mutant {
    fault: Fault,
    inner: Box<dyn Planner>,
    goal_m: Vec2,
    seen: Vec<TargetTrack>,
    /// Orders that wait, with the time at which they were given, seconds.
    orders: VecDeque<(f64, Command)>,
}

impl Mutant {
    fn new(fault: Fault, inner: Box<dyn Planner>) -> Self {
        Self { fault, inner, goal_m: Vec2::zeros(), seen: Vec::new(), orders: VecDeque::new() }
    }

    /// What the fault leaves of the tracks.
    fn look(&mut self, situation: &Situation<'_>) {
        let own = situation.own;
        let first = situation.tracks.iter().map(|track| track.id).min();
        self.seen.clear();
        for track in situation.tracks {
            let mut track = *track;
            let line_m = track.position_m - own.position_m;
            let bearing_rad = wrap(geom::angle::direction(line_m) - own.psi_rad);
            let seen = match self.fault {
                Fault::FirstTargetOnly => Some(track.id) == first,
                Fault::BlindAstern => bearing_rad.abs() <= FRAC_PI_2,
                Fault::ShortSighted => line_m.norm() <= SIGHT_M,
                _ => true,
            };
            match self.fault {
                Fault::TargetsSlow => {
                    track.velocity_mps *= TARGET_SPEED_FACTOR;
                    track.sog_mps *= TARGET_SPEED_FACTOR;
                }
                Fault::SignFlip => mirror_track(&mut track),
                _ => {}
            }
            if seen {
                self.seen.push(track);
            }
        }
    }

    /// What the fault makes of the order.
    fn spoil(&mut self, situation: &Situation<'_>, command: Command) -> Command {
        match self.fault {
            Fault::SignFlip => changed(command, |course_rad, speed_mps| (-course_rad, speed_mps)),
            Fault::HalfSpeed => {
                changed(command, |course_rad, speed_mps| (course_rad, OWN_SPEED_FACTOR * speed_mps))
            }
            Fault::HalfTurn => {
                let way_rad = geom::angle::direction(self.goal_m - situation.own.position_m);
                changed(command, |course_rad, speed_mps| {
                    (wrap(way_rad + 0.5 * wrap(course_rad - way_rad)), speed_mps)
                })
            }
            Fault::Late => self.delayed(situation.t_s, command),
            _ => command,
        }
    }

    /// The order of [`LATE_S`] ago, or the first one while there is none that old.
    fn delayed(&mut self, t_s: f64, command: Command) -> Command {
        self.orders.push_back((t_s, command));
        while self.orders.get(1).is_some_and(|(given_s, _)| *given_s <= t_s - LATE_S) {
            self.orders.pop_front();
        }
        self.orders.front().map_or_else(|| unreachable!(), |(_, command)| command.clone())
    }
}

impl Planner for Mutant {
    fn reset(&mut self, mission: &Mission) {
        let mut mission = mission.clone();
        self.goal_m = mission.goal_m();
        self.orders.clear();
        match self.fault {
            Fault::RadiusLess => mission.safety_radius_m *= RADIUS_FACTOR,
            Fault::SignFlip => {
                mission.route.iter_mut().for_each(|w| w.position_m = mirror(w.position_m));
            }
            _ => {}
        }
        self.inner.reset(&mission);
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        if self.fault == Fault::Stale
            && let Some((given_s, held)) = self.orders.front()
            && situation.t_s - given_s < STALE_S
        {
            return held.clone();
        }
        self.look(situation);
        let mut own = situation.own;
        if self.fault == Fault::SignFlip {
            own.position_m = mirror(own.position_m);
            own.velocity_mps = mirror(own.velocity_mps);
            own.psi_rad = -own.psi_rad;
            own.cog_rad = -own.cog_rad;
            own.yaw_rate_radps = -own.yaw_rate_radps;
        }
        let command = self.inner.plan(&Situation { own, tracks: &self.seen, ..*situation });
        if self.fault == Fault::Stale {
            self.orders.clear();
            self.orders.push_back((situation.t_s, command.clone()));
        }
        self.spoil(situation, command)
    }

    fn events(&self) -> PlannerEvents {
        self.inner.events()
    }
}

/// The same point on the other side of the meridian through the origin.
fn mirror(v: Vec2) -> Vec2 {
    Vec2::new(v.x, -v.y)
}

fn mirror_track(track: &mut TargetTrack) {
    track.position_m = mirror(track.position_m);
    track.velocity_mps = mirror(track.velocity_mps);
    track.cog_rad = -track.cog_rad;
    track.psi_rad = track.psi_rad.map(|psi_rad| -psi_rad);
    for (i, row) in track.covariance.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            if (i + j) % 2 == 1 {
                *entry = -*entry;
            }
        }
    }
}

/// The order with another course and speed, in the form in which it came.
fn changed(mut command: Command, change: impl Fn(f64, f64) -> (f64, f64)) -> Command {
    command.order = match command.order {
        Order::CourseSpeed { course_rad, speed_mps } => {
            let (course_rad, speed_mps) = change(course_rad, speed_mps);
            Order::CourseSpeed { course_rad, speed_mps }
        }
        Order::Velocity { velocity_mps } => {
            let course_rad = geom::angle::direction(velocity_mps);
            let (course_rad, speed_mps) = change(course_rad, velocity_mps.norm());
            Order::Velocity { velocity_mps: geom::unit(course_rad) * speed_mps }
        }
    };
    command
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_api::{OwnShip, OwnState, Waypoint};

    /// Orders north at a speed that says how many tracks it saw.
    struct Counts;

    impl Planner for Counts {
        fn reset(&mut self, _: &Mission) {}
        fn plan(&mut self, situation: &Situation<'_>) -> Command {
            let speed_mps = situation.tracks.len() as f64 + situation.t_s / 100.0;
            Command::course_speed(0.4, speed_mps)
        }
    }

    fn track(id: u32, north_m: f64, east_m: f64) -> TargetTrack {
        TargetTrack {
            id,
            position_m: Vec2::new(north_m, east_m),
            velocity_mps: Vec2::zeros(),
            cog_rad: 0.0,
            sog_mps: 0.0,
            psi_rad: None,
            length_m: None,
            beam_m: None,
            covariance: [[0.0; 4]; 4],
            age_s: 0.0,
            since_update_s: 0.0,
        }
    }

    /// What the fault orders at each second, with two ships ahead and astern.
    fn orders(fault: Fault, seconds: u32) -> Vec<(f64, f64)> {
        let mut mutant = Mutant::new(fault, Box::new(Counts));
        let own = OwnShip {
            length_m: 8.0,
            beam_m: 2.0,
            speed_mps_max: 10.0,
            yaw_rate_radps_max: 0.5,
            acceleration_mps2_max: 1.0,
        };
        mutant.reset(&Mission {
            own,
            route: vec![Waypoint { position_m: Vec2::new(1000.0, 0.0), speed_mps: None }],
            cruise_mps: 5.0,
            safety_radius_m: 100.0,
            between_centres: false,
            beat_s: 1.0,
            hazards: Vec::new(),
            stream_seed: 0,
        });
        let tracks = [track(0, 300.0, 0.0), track(1, -900.0, 0.0)];
        let state = OwnState {
            position_m: Vec2::zeros(),
            psi_rad: 0.0,
            velocity_mps: Vec2::zeros(),
            cog_rad: 0.0,
            sog_mps: 0.0,
            stw_mps: 0.0,
            yaw_rate_radps: 0.0,
        };
        (0..seconds)
            .map(|t| {
                let t_s = f64::from(t);
                let seen = Situation { t_s, own: state, tracks: &tracks, visual_range_m: None };
                match mutant.plan(&seen).order {
                    Order::CourseSpeed { course_rad, speed_mps } => (course_rad, speed_mps),
                    Order::Velocity { .. } => panic!("another form"),
                }
            })
            .collect()
    }

    #[test]
    fn each_fault_does_what_its_name_says() {
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} is not {b}");
        let first = |fault| orders(fault, 1)[0];
        near(first(Fault::SignFlip).0, -0.4);
        near(first(Fault::HalfTurn).0, 0.2);
        near(first(Fault::HalfSpeed).1, 1.2);
        for fault in [Fault::FirstTargetOnly, Fault::BlindAstern, Fault::ShortSighted] {
            near(first(fault).1, 1.0);
        }
        near(first(Fault::TargetsSlow).1, 2.0);
        let late = orders(Fault::Late, 8);
        near(late[4].1, 2.0);
        near(late[5].1, 2.0);
        near(late[6].1, 2.01);
        near(late[7].1, 2.02);
        let stale = orders(Fault::Stale, 22);
        near(stale[19].1, 2.0);
        near(stale[20].1, 2.2);
        near(stale[21].1, 2.2);
    }

    #[test]
    fn mutants_are_found_by_name_and_unknown_ones_refused() {
        let name = "mutant:late-5s:zhuang";
        let registry = with_mutant(planners::registry(), name).unwrap();
        let entry = registry.get(name).unwrap();
        assert!((entry.make)(&entry.options).is_ok());
        assert_eq!(registry.entries().len(), planners::registry().entries().len() + 1);
        let wrong = with_mutant(planners::registry(), "mutant:lazy:zhuang").unwrap_err();
        assert!(wrong.contains("late-5s"), "{wrong}");
        assert!(with_mutant(planners::registry(), "mutant:late-5s:nobody").is_err());
    }
}
