//! The grid of candidate velocities: courses around the wish, speeds from 0 to the largest.

use geom::{Vec2, math, units::deg};

/// Courses relative to the wish, as (cosine, sine), the wish first and then alternately to
/// starboard and port; so that of equal candidates the one to starboard wins.
#[derive(Clone, Debug)]
pub struct Grid {
    turns: Vec<(f64, f64)>,
    speed_step_mps: f64,
    speeds_mps: Vec<f64>,
}

impl Grid {
    /// Courses within `course_deg_max` of the wish by `course_step_deg`.
    pub fn new(course_deg_max: f64, course_step_deg: f64, speed_step_mps: f64) -> Self {
        let steps = (course_deg_max / course_step_deg + 1e-9).floor() as u32;
        let mut turns = vec![(1.0, 0.0)];
        for step in 1..=steps {
            let (sin, cos) = math::sin_cos(deg(f64::from(step) * course_step_deg));
            turns.extend([(cos, sin), (cos, -sin)]);
        }
        Self { turns, speed_step_mps, speeds_mps: Vec::new() }
    }

    /// Sets the speeds: every step from 0 to the largest.
    pub fn reset(&mut self, speed_mps_max: f64) {
        let steps = (speed_mps_max / self.speed_step_mps + 1e-9).floor() as u32;
        self.speeds_mps.clear();
        self.speeds_mps.extend((0..=steps).map(|step| f64::from(step) * self.speed_step_mps));
    }

    /// Number of candidates without the wish itself.
    pub fn len(&self) -> usize {
        self.turns.len() * self.speeds_mps.len()
    }

    /// Whether there is no candidate, as before the first reset.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The candidate of least cost. `penalty` is what a candidate costs beyond its squared distance
    /// from the wish; it is asked only where that distance alone does not exceed the best.
    pub fn cheapest(&self, wish_mps: Vec2, direction: Vec2, penalty: impl Fn(Vec2) -> f64) -> Vec2 {
        let mut best = (penalty(wish_mps), wish_mps);
        if best.0 <= 0.0 {
            return wish_mps;
        }
        let wish_speed_mps = wish_mps.norm();
        for &(cos, sin) in &self.turns {
            let course = Vec2::new(
                cos * direction.x - sin * direction.y,
                sin * direction.x + cos * direction.y,
            );
            for &speed_mps in &self.speeds_mps {
                // law of cosines: the squared distance needs no vector
                let distance = speed_mps * speed_mps + wish_speed_mps * wish_speed_mps
                    - 2.0 * speed_mps * wish_speed_mps * cos;
                if distance >= best.0 {
                    continue;
                }
                let velocity_mps = course * speed_mps;
                let cost = distance + penalty(velocity_mps);
                if cost < best.0 {
                    best = (cost, velocity_mps);
                }
            }
        }
        best.1
    }
}
