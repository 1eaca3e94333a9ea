//! A run as it was up to a beat, and from there one manoeuvre of own ship: would it have cleared?
//!
//! The whole world is run again, with the same weather, the other ships minding or not minding own
//! ship as they do, and land. A manoeuvre is one of the grid of the rules specification, section
//! 10 ([`Manoeuvre`]), or to keep course and speed. Own ship knows nothing here and needs nothing,
//! so her sensors are left out.

use crate::peer::MakePeer;
use crate::way::{Manoeuvre, Side};
use crate::world::{Scratch, run_among};
use geom::wrap;
use planner_api::{Command, Mission, OwnState, Planner, Situation};
use record::{Encounter, Order, Outcome, RunUntil, Sensing};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::sync::atomic::AtomicU64;

/// One run, ready to be ended otherwise.
#[derive(Debug)]
pub struct Evasions<'a> {
    encounter: Encounter,
    orders: &'a [Order],
}

impl<'a> Evasions<'a> {
    /// Of an encounter and the orders of own ship, one a beat, that led into it.
    pub fn new(encounter: &Encounter, orders: &'a [Order]) -> Self {
        let mut encounter = encounter.clone();
        encounter.sensing = Sensing::Perfect { detection_range_m: None };
        // her manoeuvre leads to no goal
        encounter.run.until = RunUntil::PastAndClear;
        Self { encounter, orders }
    }

    /// Whether no hull and no land is touched where own ship begins a manoeuvre, or keeps course
    /// and speed, at beat `from` (0 is the start; at most the number of orders).
    pub fn clears(
        &self,
        from: usize,
        manoeuvre: Option<Manoeuvre>,
        peers: &mut MakePeer<'_>,
        (scratch, beat): (&mut Scratch, &AtomicU64),
    ) -> bool {
        let mut pilot = Pilot::new(&self.orders[..from], manoeuvre);
        let trace = run_among(&self.encounter, &mut pilot, peers, scratch, beat);
        matches!(trace.outcome, Outcome::Completed | Outcome::Truncated)
    }
}

/// Gives the orders of a run, and then those of a manoeuvre.
struct Pilot<'a> {
    orders: &'a [Order],
    manoeuvre: Option<Manoeuvre>,
    beat: usize,
    speed_mps_max: f64,
    /// Course and speed over ground with which the manoeuvre began.
    began: Option<(f64, f64)>,
}

impl<'a> Pilot<'a> {
    fn new(orders: &'a [Order], manoeuvre: Option<Manoeuvre>) -> Self {
        Self { orders, manoeuvre, beat: 0, speed_mps_max: 0.0, began: None }
    }

    fn manoeuvre(&mut self, own: &OwnState) -> Command {
        let speed_mps = own.sog_mps.min(self.speed_mps_max);
        let (course_rad, speed_mps) = *self.began.get_or_insert((own.cog_rad, speed_mps));
        let turned_rad = wrap(own.cog_rad - course_rad);
        let turn = |side: Side, angle_rad: f64| match side {
            Side::Starboard => wrap(course_rad + angle_rad),
            Side::Port => wrap(course_rad - angle_rad),
        };
        let (course_rad, speed_mps) = match self.manoeuvre {
            None => (course_rad, speed_mps),
            Some(Manoeuvre::QuarterTurn(side)) => (turn(side, FRAC_PI_2), speed_mps),
            // an order straight back would leave the side open; one that is not far ahead of her
            // course would take the rudder off
            Some(Manoeuvre::HalfTurn(side)) if turned_rad.abs() < FRAC_PI_4 => {
                (turn(side, 0.75 * PI), speed_mps)
            }
            Some(Manoeuvre::HalfTurn(side)) => (turn(side, PI), speed_mps),
            Some(Manoeuvre::TurnAndStop(side)) => (turn(side, FRAC_PI_2), 0.0),
            Some(Manoeuvre::CrashStop) => (course_rad, 0.0),
        };
        Command::course_speed(course_rad, speed_mps)
    }
}

impl Planner for Pilot<'_> {
    fn reset(&mut self, mission: &Mission) {
        self.speed_mps_max = mission.own.speed_mps_max;
    }

    fn plan(&mut self, situation: &Situation<'_>) -> Command {
        let order = self.orders.get(self.beat);
        self.beat += 1;
        match order {
            Some(order) => Command::course_speed(order.course_rad, order.speed_mps),
            None => self.manoeuvre(&situation.own),
        }
    }
}
