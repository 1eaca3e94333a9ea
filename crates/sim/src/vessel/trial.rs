//! Sea trials: turning circle, zigzag and crash stop of a model, by rudder and engine alone.
//!
//! The manoeuvres and what is measured are those of the IMO's standards for ship manoeuvrability,
//! resolution MSC.137(76), annex, section 4.2: from straight ahead at the approach speed, the
//! engine left alone, in calm deep water. Nothing here enters a campaign.

use super::{Model, State, Steering, ThreeDof};
use geom::units::deg;
use geom::{Vec2, angle};

/// What the helmsman does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// Rudder angle, radians, positive where it turns the ship to starboard.
    pub rudder_rad: f64,
    /// The engine.
    pub engine: Engine,
}

/// What the engine does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Engine {
    /// What holds this speed straight ahead, m/s.
    Holds(f64),
    /// Full astern.
    Astern,
}

/// The turning circle.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// Along the old course until the heading has changed by 90 degrees, metres.
    pub advance_m: f64,
    /// Across it until then, metres.
    pub transfer_m: f64,
    /// Across it until the heading has changed by 180 degrees, metres.
    pub tactical_diameter_m: f64,
    /// Twice speed over yaw rate at the end, metres.
    pub final_diameter_m: f64,
    /// Speed at the end as a share of the approach speed.
    pub speed_share: f64,
    /// Positions, metres north and east; the old course is north.
    pub track_m: Vec<Vec2>,
}

/// A zigzag.
#[derive(Clone, Debug, PartialEq)]
pub struct ZigZag {
    /// By how much the heading goes on after the rudder is reversed, first and second time, rad.
    pub overshoot_rad: [f64; 2],
    /// Time of the first reversal, seconds.
    pub reach_s: f64,
    /// Time, heading and rudder or its order, seconds and radians.
    pub history: Vec<[f64; 3]>,
}

/// A stop with the engine full astern.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// Until she lies still, seconds.
    pub time_s: f64,
    /// Along the track, metres.
    pub track_reach_m: f64,
    /// Along the old course, metres.
    pub head_reach_m: f64,
    /// Time and speed, seconds and m/s.
    pub history: Vec<[f64; 2]>,
}

const DT_S: f64 = 0.1;
/// No trial lasts longer.
const STEPS_MAX: usize = 60_000;
/// A rudder angle that all models know: that of the standard turning circle.
const FULL_RAD: f64 = deg(35.0);

impl Model {
    /// Moves through `dt_s` seconds under a rudder angle and an engine order.
    ///
    /// A kinematic ship has no rudder: 35 degrees are her largest turn rate, less is in proportion.
    pub fn by_hand(&self, state: &State, order: &Order, dt_s: f64) -> State {
        let calm = Vec2::zeros();
        match self {
            Self::Kinematic(ship) => {
                let gain = if order.engine == Engine::Astern { -1.0 } else { 0.0 };
                ship.by_hand(state, order.rudder_rad / FULL_RAD, gain, dt_s)
            }
            Self::ThreeDof(ship) => {
                let (thrust_n, side_n) = forces_n(ship, order);
                ship.step_with(state, calm, dt_s, |_, _| (thrust_n, side_n, 0))
            }
            Self::Nomoto(ship) => {
                let rudder_rad = order.rudder_rad;
                ship.step_with(state, calm, dt_s, |_, &[u, ..]| match order.engine {
                    Engine::Holds(speed_mps) => (rudder_rad, (speed_mps - u) / ship.surge_s),
                    Engine::Astern => (rudder_rad, -ship.acceleration_mps2_max),
                })
            }
        }
    }
}

/// Thrust and side force of an order, N.
fn forces_n(ship: &ThreeDof, order: &Order) -> (f64, f64) {
    let p = &ship.propulsion;
    let thrust_n = match order.engine {
        Engine::Holds(speed_mps) => ship.thrust_at_n(speed_mps),
        Engine::Astern => -p.astern_n_max,
    };
    let (thrust_n, aside_n) = match p.steering {
        Steering::Proportional { angle_rad_max } => {
            let share = (order.rudder_rad / angle_rad_max).clamp(-1.0, 1.0);
            (thrust_n, share * p.side_n_max)
        }
        Steering::Azimuth => {
            let pull = geom::unit(order.rudder_rad) * thrust_n;
            (pull.x, pull.y.clamp(-p.side_n_max, p.side_n_max))
        }
    };
    (thrust_n, aside_n * p.rudder_arm_m.signum())
}

/// Turns with the rudder at an angle until the heading has changed by a turn and a half; `None`
/// for a ship that does not come round.
pub fn turning_circle(model: &Model, approach_mps: f64, rudder_rad: f64) -> Option<Turn> {
    let order = Order { rudder_rad, engine: Engine::Holds(approach_mps) };
    let mut sailed = Sailed::new(model, approach_mps);
    let mut marks = [None, None];
    let mut track_m = vec![Vec2::zeros()];
    for _ in 0..STEPS_MAX {
        let before = sailed;
        sailed.advance(model, &order);
        track_m.push(sailed.state.position_m);
        for (mark, at_rad) in marks.iter_mut().zip([deg(90.0), deg(180.0)]) {
            if mark.is_none() && sailed.turned_rad.abs() >= at_rad {
                *mark = Some(before.position_at(&sailed, at_rad));
            }
        }
        if sailed.turned_rad.abs() >= deg(540.0) {
            break;
        }
    }
    let [Some(quarter_m), Some(half_m)] = marks else { return None };
    let end = &sailed.state;
    let speed_mps = end.through_water_mps().norm();
    Some(Turn {
        advance_m: quarter_m.x,
        transfer_m: quarter_m.y.abs(),
        tactical_diameter_m: half_m.y.abs(),
        final_diameter_m: 2.0 * speed_mps / end.yaw_rate_radps.abs(),
        speed_share: speed_mps / approach_mps,
        track_m,
    })
}

/// A zigzag with rudder and heading of the same size, to starboard first; `None` for a ship that
/// does not answer her rudder.
pub fn zigzag(model: &Model, approach_mps: f64, angle_rad: f64) -> Option<ZigZag> {
    let mut sailed = Sailed::new(model, approach_mps);
    let mut side = 1.0;
    let mut reversals_s = Vec::new();
    let mut furthest_rad = [0f64; 2];
    let mut history = Vec::new();
    for step in 0..STEPS_MAX {
        let t_s = step as f64 * DT_S;
        history.push([t_s, sailed.turned_rad, side * angle_rad]);
        if side * sailed.turned_rad >= angle_rad {
            reversals_s.push(t_s);
            side = -side;
        }
        if let 1..=2 = reversals_s.len() {
            let k = reversals_s.len() - 1;
            furthest_rad[k] = furthest_rad[k].max(-side * sailed.turned_rad);
        }
        if reversals_s.len() == 4 {
            let overshoot_rad = furthest_rad.map(|rad| rad - angle_rad);
            return Some(ZigZag { overshoot_rad, reach_s: reversals_s[0], history });
        }
        let engine = Engine::Holds(approach_mps);
        sailed.advance(model, &Order { rudder_rad: side * angle_rad, engine });
    }
    None
}

/// Full astern from the approach speed until she lies still; `None` for a ship that never does.
pub fn crash_stop(model: &Model, approach_mps: f64) -> Option<Stop> {
    let order = Order { rudder_rad: 0.0, engine: Engine::Astern };
    let mut sailed = Sailed::new(model, approach_mps);
    let (mut track_reach_m, mut history) = (0.0, vec![[0.0, approach_mps]]);
    for step in 1..STEPS_MAX {
        let from_m = sailed.state.position_m;
        sailed.advance(model, &order);
        track_reach_m += (sailed.state.position_m - from_m).norm();
        let time_s = step as f64 * DT_S;
        history.push([time_s, sailed.state.surge_mps]);
        if sailed.state.surge_mps <= 0.0 {
            let head_reach_m = sailed.state.position_m.x;
            return Some(Stop { time_s, track_reach_m, head_reach_m, history });
        }
    }
    None
}

/// A ship under way and how far she has turned, over all turns.
#[derive(Clone, Copy)]
struct Sailed {
    state: State,
    turned_rad: f64,
}

impl Sailed {
    fn new(model: &Model, approach_mps: f64) -> Self {
        let state = model.settled(State::ahead(Vec2::zeros(), 0.0, approach_mps));
        Self { state, turned_rad: 0.0 }
    }

    fn advance(&mut self, model: &Model, order: &Order) {
        let next = model.by_hand(&self.state, order, DT_S);
        self.turned_rad += angle::wrap(next.psi_rad - self.state.psi_rad);
        self.state = next;
    }

    /// Position where the heading has changed by `at_rad`, between two steps.
    fn position_at(&self, next: &Self, at_rad: f64) -> Vec2 {
        let (from, to) = (self.turned_rad.abs(), next.turned_rad.abs());
        let share = (at_rad - from) / (to - from);
        self.state.position_m.lerp(&next.state.position_m, share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vessel::{GUNNERUS, Kinematic, VIKNES};

    const KINEMATIC: Model = Model::Kinematic(Kinematic {
        yaw_rate_radps_max: 0.05,
        acceleration_mps2_max: 0.25,
        speed_mps_max: 10.0,
    });

    /// Radius 5 m/s over 0.05 rad/s: a circle of 100 m.
    #[test]
    fn a_kinematic_ship_turns_on_her_circle() {
        for rudder_rad in [FULL_RAD, -FULL_RAD] {
            let turn = turning_circle(&KINEMATIC, 5.0, rudder_rad).unwrap();
            assert!((turn.advance_m - 100.0).abs() < 0.01, "{}", turn.advance_m);
            assert!((turn.transfer_m - 100.0).abs() < 0.01);
            assert!((turn.tactical_diameter_m - 200.0).abs() < 0.01);
            assert!((turn.final_diameter_m - 200.0).abs() < 1e-9);
        }
    }

    /// v^2 / 2a and v / a; no overshoot without inertia in yaw.
    #[test]
    fn a_kinematic_ship_stops_by_her_deceleration_and_never_overshoots() {
        let stop = crash_stop(&KINEMATIC, 5.0).unwrap();
        assert!((stop.head_reach_m - 50.0).abs() < 1e-6, "{}", stop.head_reach_m);
        assert!((stop.time_s - 20.0).abs() < 0.11);
        let zigzag = zigzag(&KINEMATIC, 5.0, deg(10.0)).unwrap();
        let step_rad = 0.05 * DT_S;
        assert!(zigzag.overshoot_rad.iter().all(|&rad| (0.0..=step_rad).contains(&rad)));
    }

    /// Full astern against the resistance: m u' = -(T + a u + b u^2), in closed form by the mean
    /// value theorem between the decelerations at both ends.
    #[test]
    fn a_crash_stop_lies_between_its_bounds() {
        let stop = crash_stop(&Model::ThreeDof(&VIKNES), 7.0).unwrap();
        let least = 6550.0 / 3980.0;
        let most = (6550.0 + 50.0 * 7.0 + 135.0 * 49.0) / 3980.0;
        assert!(stop.time_s < 7.0 / least && stop.time_s > 7.0 / most, "{}", stop.time_s);
        assert!(
            stop.head_reach_m < 49.0 / (2.0 * least) && stop.head_reach_m > 49.0 / (2.0 * most)
        );
        assert!((stop.track_reach_m - stop.head_reach_m).abs() < 1e-9);
    }

    /// The heading goes on by what the yaw rate carries it: inertia overshoots.
    #[test]
    fn inertia_overshoots_and_both_sides_are_alike() {
        let model = Model::ThreeDof(&GUNNERUS);
        let zigzag = zigzag(&model, 5.0, deg(20.0)).unwrap();
        assert!(zigzag.overshoot_rad.iter().all(|&rad| rad > deg(0.5)), "{zigzag:?}");
        let [starboard, port] =
            [1.0, -1.0].map(|side| turning_circle(&model, 5.0, side * FULL_RAD).unwrap());
        assert!((starboard.tactical_diameter_m - port.tactical_diameter_m).abs() < 1e-9);
    }
}
