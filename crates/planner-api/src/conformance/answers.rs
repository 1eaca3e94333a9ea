//! What a planner answered in a scene, and how two answers differ.

use crate::{Command, CommandError, Order, PlannerEvents};
use geom::wrap;

/// Largest difference of course (radians) and speed (m/s) between a scene and the same scene turned
/// or moved: far above rounding, far below anything a helmsman could see.
const TOLERANCE: f64 = 1e-6;
/// Below this speed a course means nothing, m/s.
const STILL_MPS: f64 = 1e-6;

/// What a planner answered in a scene.
pub(super) struct Answers {
    pub(super) commands: Vec<Command>,
    /// Course and speed, or why there are none.
    pub(super) orders: Vec<Result<(f64, f64), CommandError>>,
    pub(super) events: PlannerEvents,
}

impl Answers {
    pub(super) fn differs_in_a_bit(&self, other: Option<&Self>) -> Option<String> {
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

    pub(super) fn differs_by_more_than_rounding(
        &self,
        other: Option<&Self>,
        turn_rad: f64,
    ) -> Option<String> {
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
