//! The outline of a ship's hull at the waterline.

use crate::{Vec2, angle};
use serde::{Deserialize, Serialize};

/// Half the outline, starboard side from bow to stern, as fractions of half length and half beam.
/// A pointed bow, a long parallel body and a transom; every point is extreme, so the outline is
/// its own convex hull.
const HALF_OUTLINE: [(f64, f64); 7] = [
    (1.0, 0.0),
    (0.85, 0.45),
    (0.60, 0.80),
    (0.20, 0.98),
    (-0.30, 1.0),
    (-0.75, 0.92),
    (-1.0, 0.70),
];

/// Number of corners of every outline.
pub const CORNERS: usize = 2 * HALF_OUTLINE.len() - 1;

/// A convex hull outline of given length and beam. The body frame has x forward and y to
/// starboard; its origin is the point whose position a ship reports.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HullOutline {
    /// Length over all, in metres.
    pub length_m: f64,
    /// Beam, in metres.
    pub beam_m: f64,
    /// Midships, forward of the reported point, in metres.
    pub midships_forward_m: f64,
    /// Centre line, to starboard of the reported point, in metres.
    pub midships_starboard_m: f64,
}

impl HullOutline {
    /// An outline whose reported point is midships on the centre line.
    pub const fn centred(length_m: f64, beam_m: f64) -> Self {
        Self { length_m, beam_m, midships_forward_m: 0.0, midships_starboard_m: 0.0 }
    }

    /// The corners in the body frame, from the bow over starboard, in metres.
    pub fn corners_body_m(&self) -> [Vec2; CORNERS] {
        let midships = Vec2::new(self.midships_forward_m, self.midships_starboard_m);
        std::array::from_fn(|i| {
            let ((x, y), side) = if i < HALF_OUTLINE.len() {
                (HALF_OUTLINE[i], 1.0)
            } else {
                (HALF_OUTLINE[CORNERS - i], -1.0)
            };
            midships + Vec2::new(x * self.length_m / 2.0, side * y * self.beam_m / 2.0)
        })
    }

    /// The corners in the north-east plane for a ship at `position_m` with heading `psi_rad`.
    pub fn corners_m(&self, position_m: Vec2, psi_rad: f64) -> [Vec2; CORNERS] {
        self.corners_body_m().map(|corner| position_m + angle::rotate(corner, psi_rad))
    }

    /// Radius of the circle around the reported point that holds the outline, in metres.
    pub fn radius_m(&self) -> f64 {
        self.corners_body_m().iter().map(|c| c.norm()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outline_has_the_length_and_beam_and_is_convex() {
        let corners = HullOutline::centred(12.0, 3.5).corners_body_m();
        let extent = |f: fn(&Vec2) -> f64| {
            let values = corners.map(|c| f(&c));
            values.iter().fold(f64::MIN, |a, &b| a.max(b))
                - values.iter().fold(f64::MAX, |a, &b| a.min(b))
        };
        assert!((extent(|c| c.x) - 12.0).abs() < 1e-12);
        assert!((extent(|c| c.y) - 3.5).abs() < 1e-12);
        for i in 0..CORNERS {
            let (a, b, c) = (corners[i], corners[(i + 1) % CORNERS], corners[(i + 2) % CORNERS]);
            assert!((b - a).perp(&(c - b)) > 0.0, "corner {i} is not extreme");
        }
    }

    #[test]
    fn reference_point_moves_the_outline() {
        let hull = HullOutline { midships_forward_m: 3.0, ..HullOutline::centred(12.0, 3.5) };
        assert!((hull.corners_body_m()[0].x - 9.0).abs() < 1e-12);
        assert!((hull.radius_m() - 9.0).abs() < 1e-12);
    }
}
