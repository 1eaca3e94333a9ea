//! How another ship would pass if this one altered course now: the prediction on which a target
//! chooses her alteration.
//!
//! She turns at the rate that her model declares, at constant speed over ground, on an arc of a
//! circle and then straight on; the other ship goes straight on. Sway and the way of getting into
//! the turn are left out: it is what a navigator reckons, not what the ship will do.

use crate::pose::Pose;
use geom::{Vec2, cpa, segment_min_distance};

/// Chords in place of the arc: at 90 degrees each leaves it by 0.2 % of the radius.
const CHORDS: usize = 12;

/// A ship that may alter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turning {
    /// Where she is, metres north and east.
    pub(crate) position_m: Vec2,
    /// Course over ground, rad.
    pub(crate) course_rad: f64,
    /// Speed over ground, m/s.
    pub(crate) speed_mps: f64,
    /// Rate at which she turns, rad/s.
    pub(crate) yaw_rate_radps: f64,
}

/// The closest point of a passage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Passage {
    /// Distance between the reference points, metres.
    pub(crate) dcpa_m: f64,
    /// Whether the other ship is then on her port side: she has passed astern of one that crosses,
    /// or port to port with one that comes to meet her.
    pub(crate) to_port: bool,
}

impl Turning {
    /// The passage of `other` after an alteration by `change_rad`, positive to starboard.
    pub(crate) fn passage(&self, change_rad: f64, other: &Pose) -> Passage {
        let side = if change_rad < 0.0 { -1.0 } else { 1.0 };
        let radius_m = self.speed_mps / self.yaw_rate_radps;
        let ahead = geom::unit(self.course_rad);
        let starboard = Vec2::new(-ahead.y, ahead.x);
        // the other ship as seen from her, after turning through an angle
        let seen_m = |turned_rad: f64| {
            let turned = geom::unit(turned_rad);
            let own_m = (ahead * turned.y + starboard * (side * (1.0 - turned.x))) * radius_m;
            let other_m = other.velocity_mps * (turned_rad / self.yaw_rate_radps);
            other.position_m + other_m - self.position_m - own_m
        };
        let course = |turned_rad: f64| geom::unit(self.course_rad + side * turned_rad);
        let turn_rad = change_rad.abs();
        let mut least = Closest::new(seen_m(0.0), course(0.0));
        if turn_rad > 0.0 {
            let chord_rad = turn_rad / CHORDS as f64;
            for k in 0..CHORDS {
                let (from_rad, to_rad) = (chord_rad * k as f64, chord_rad * (k + 1) as f64);
                let (from_m, to_m) = (seen_m(from_rad), seen_m(to_rad));
                let (_, fraction) = segment_min_distance(from_m, to_m);
                least.look(from_m + (to_m - from_m) * fraction, course(to_rad));
            }
        }
        let (from_m, course) = (seen_m(turn_rad), course(turn_rad));
        let relative_mps = other.velocity_mps - course * self.speed_mps;
        let after_s = cpa(from_m, relative_mps).tcpa_s.unwrap_or(0.0).max(0.0);
        least.look(from_m + relative_mps * after_s, course);
        Passage { dcpa_m: least.distance_m, to_port: least.to_port }
    }
}

struct Closest {
    distance_m: f64,
    to_port: bool,
}

impl Closest {
    fn new(seen_m: Vec2, course: Vec2) -> Self {
        Self { distance_m: seen_m.norm(), to_port: course.x * seen_m.y - course.y * seen_m.x < 0.0 }
    }

    fn look(&mut self, seen_m: Vec2, course: Vec2) {
        let seen = Self::new(seen_m, course);
        if seen.distance_m < self.distance_m {
            *self = seen;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::units::deg;
    use proptest::prelude::*;

    fn north(speed_mps: f64, yaw_rate_radps: f64) -> Turning {
        Turning { position_m: Vec2::zeros(), course_rad: 0.0, speed_mps, yaw_rate_radps }
    }

    fn other(position_m: Vec2, velocity_mps: Vec2) -> Pose {
        Pose { position_m, velocity_mps, heading: Vec2::new(1.0, 0.0), yaw_rate_radps: 0.0 }
    }

    /// A quarter of a circle past a point that lies still: the circle's centre, a point ahead of
    /// which she turns off, and one beside her new course.
    #[test]
    fn quarter_of_a_circle_is_known_in_closed_form() {
        let ship = north(6.0, 0.06);
        let passes =
            |x: f64, y: f64| ship.passage(deg(90.0), &other(Vec2::new(x, y), Vec2::zeros()));
        let centre = passes(0.0, 100.0);
        assert!((centre.dcpa_m - 100.0).abs() < 0.3 && !centre.to_port, "{centre:?}");
        let ahead = passes(300.0, 0.0);
        assert!(
            (ahead.dcpa_m - (10f64.sqrt() - 1.0) * 100.0).abs() < 0.3 && ahead.to_port,
            "{ahead:?}"
        );
        let beside = passes(130.0, 800.0);
        assert!((beside.dcpa_m - 30.0).abs() < 1e-9 && beside.to_port, "{beside:?}");
    }

    #[test]
    fn keeping_on_is_the_closest_point_of_straight_motion() {
        let seen = other(Vec2::new(900.0, -300.0), Vec2::new(-4.0, 3.0));
        let passage = north(6.0, 0.06).passage(0.0, &seen);
        let exact = cpa(seen.position_m, seen.velocity_mps - Vec2::new(6.0, 0.0));
        assert!((passage.dcpa_m - exact.dcpa_m).abs() < 1e-9);
    }

    proptest! {
        /// A mirror changes the side and nothing else.
        #[test]
        fn mirror_image_is_exact(
            x in -900f64..900.0, y in -900f64..900.0, vx in -9f64..9.0, vy in -9f64..9.0,
            change in -1.5f64..1.5,
        ) {
            let ship = north(6.0, 0.03);
            let seen = ship.passage(change, &other(Vec2::new(x, y), Vec2::new(vx, vy)));
            let image = ship.passage(-change, &other(Vec2::new(x, -y), Vec2::new(vx, -vy)));
            prop_assert_eq!(seen.dcpa_m.to_bits(), image.dcpa_m.to_bits());
            prop_assert!(seen.to_port != image.to_port);
        }
    }
}
