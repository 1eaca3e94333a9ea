//! Relative courses, drawn from the part of the circle where the wanted class lies.

use crate::Distribution;
use crate::wanted::Arc;
use geom::units::deg;
use record::Stream;
use std::f64::consts::TAU;

/// A law of the relative course, cut down to an arc if it is uniform; in radians, unwrapped.
#[derive(Clone, Debug)]
pub struct Courses<'a> {
    law: &'a Distribution,
    /// Where a uniform law and the arc meet: at most twice around the circle, and the ends.
    parts_rad: [(f64, f64); 3],
    total_rad: f64,
}

impl<'a> Courses<'a> {
    /// The courses of `law`, which is in degrees, that lie in `arc`.
    pub fn new(law: &'a Distribution, arc: Arc) -> Self {
        let mut courses = Self { law, parts_rad: [(0.0, 0.0); 3], total_rad: 0.0 };
        let Distribution::Uniform([low_deg, high_deg]) = law else {
            return courses;
        };
        let (low_rad, high_rad) = (deg(*low_deg), deg(*high_deg));
        if arc.half_width_rad >= TAU / 2.0 {
            courses.parts_rad[0] = (low_rad, high_rad);
            courses.total_rad = high_rad - low_rad;
            return courses;
        }
        let mut count = 0;
        for turn in -2..=2 {
            let middle_rad = arc.centre_rad + f64::from(turn) * TAU;
            let from_rad = low_rad.max(middle_rad - arc.half_width_rad);
            let to_rad = high_rad.min(middle_rad + arc.half_width_rad);
            if from_rad < to_rad && count < courses.parts_rad.len() {
                courses.parts_rad[count] = (from_rad, to_rad);
                courses.total_rad += to_rad - from_rad;
                count += 1;
            }
        }
        courses
    }

    /// Whether no course of the law can be of the wanted class.
    pub fn is_empty(&self) -> bool {
        matches!(self.law, Distribution::Uniform(_)) && self.total_rad <= 0.0
    }

    /// Draws one course, radians.
    pub fn draw(&self, stream: &mut Stream) -> f64 {
        if !matches!(self.law, Distribution::Uniform(_)) {
            return deg(self.law.draw(stream));
        }
        let mut left_rad = stream.uniform() * self.total_rad;
        for (from_rad, to_rad) in self.parts_rad {
            if left_rad < to_rad - from_rad {
                return from_rad + left_rad;
            }
            left_rad -= to_rad - from_rad;
        }
        // the last part's end, where rounding has left a remainder
        self.parts_rad.iter().map(|part| part.1).fold(f64::NEG_INFINITY, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::{EncounterId, Purpose, Seed, Streams};
    use std::f64::consts::PI;

    #[test]
    fn an_arc_across_the_cut_of_the_circle_is_found_on_both_ends() {
        let law = Distribution::Uniform([-180.0, 180.0]);
        let courses = Courses::new(&law, Arc { centre_rad: PI, half_width_rad: deg(20.0) });
        assert!((courses.total_rad - deg(40.0)).abs() < 1e-12);
        let mut stream =
            Streams::new(Seed(3), &EncounterId::new("x", 0)).stream(Purpose::Geometry, 0);
        let mut port = 0;
        for _ in 0..10_000 {
            let course_rad = courses.draw(&mut stream);
            assert!((course_rad.abs() - PI).abs() <= deg(20.0) + 1e-12, "{course_rad}");
            port += i32::from(course_rad < 0.0);
        }
        // five standard deviations of a fair coin
        assert!((port - 5000).abs() < 250, "{port}");
    }

    #[test]
    fn a_law_outside_the_arc_is_empty() {
        let law = Distribution::Uniform([-10.0, 10.0]);
        assert!(Courses::new(&law, Arc { centre_rad: PI, half_width_rad: 0.3 }).is_empty());
        let around = Distribution::Uniform([170.0, 190.0]);
        assert!(!Courses::new(&around, Arc { centre_rad: PI, half_width_rad: 0.3 }).is_empty());
    }
}
