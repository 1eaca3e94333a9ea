//! Hull-to-hull distance that two ships would come to on their present courses and speeds.
//!
//! The hulls do not turn in the prediction, so the target's outline can be shrunk to a point by
//! growing own ship's outline with it (Minkowski difference); what is left is the distance from a
//! ray to a convex polygon, which is exact.

use record::Ship;

/// North and east, metres or m/s.
pub type Plane = (f64, f64);

/// A ship as the prediction needs it.
#[derive(Clone, Copy, Debug)]
pub struct Posed<'a> {
    /// Who.
    pub ship: &'a Ship,
    /// Heading, radians.
    pub psi_rad: f64,
}

/// Smallest hull-to-hull distance from now on, metres; 0 on contact. `position_m` and
/// `velocity_mps` are the target's less own ship's.
pub fn predicted_clearance_m(
    own: Posed<'_>,
    target: Posed<'_>,
    position_m: Plane,
    velocity_mps: Plane,
) -> f64 {
    let grown = minkowski(&outline(target, 1.0), &outline(own, -1.0));
    let start = (-position_m.0, -position_m.1);
    let along = (-velocity_mps.0, -velocity_mps.1);
    let corners = grown.len();
    let edge = |i: usize| (grown[i], grown[(i + 1) % corners]);
    let inside = (0..corners).all(|i| {
        let (a, b) = edge(i);
        cross(minus(b, a), minus(start, a)) >= 0.0
    });
    if inside || (0..corners).any(|i| ray_meets(start, along, edge(i))) {
        return 0.0;
    }
    (0..corners)
        .map(|i| {
            let (a, b) = edge(i);
            let to_edge = point_to_segment_m(start, a, minus(b, a), 1.0);
            to_edge.min(point_to_segment_m(a, start, along, f64::INFINITY))
        })
        .fold(f64::INFINITY, f64::min)
}

/// Corners turned to the heading, times `sign`.
fn outline(posed: Posed<'_>, sign: f64) -> Vec<Plane> {
    let (sin, cos) = libm::sincos(posed.psi_rad);
    let corners = posed.ship.hull.corners_body_m();
    let turn = |x: f64, y: f64| (sign * (cos * x - sin * y), sign * (sin * x + cos * y));
    corners.iter().map(|c| turn(c.x, c.y)).collect()
}

/// The sum of two convex polygons whose corners run in the positive sense.
fn minkowski(a: &[Plane], b: &[Plane]) -> Vec<Plane> {
    let lowest = |p: &[Plane]| {
        let less = |i: usize, j: usize| (p[i].1, p[i].0) < (p[j].1, p[j].0);
        (1..p.len()).fold(0, |best, i| if less(i, best) { i } else { best })
    };
    let (first_a, first_b) = (lowest(a), lowest(b));
    let corner = |p: &[Plane], first: usize, i: usize| p[(first + i) % p.len()];
    let (mut i, mut j) = (0, 0);
    let mut sum = Vec::with_capacity(a.len() + b.len());
    while i < a.len() || j < b.len() {
        let (at_a, at_b) = (corner(a, first_a, i), corner(b, first_b, j));
        sum.push((at_a.0 + at_b.0, at_a.1 + at_b.1));
        let turn =
            cross(minus(corner(a, first_a, i + 1), at_a), minus(corner(b, first_b, j + 1), at_b));
        let (step_a, step_b) = (i < a.len(), j < b.len());
        if step_a && (turn >= 0.0 || !step_b) {
            i += 1;
        }
        if step_b && (turn <= 0.0 || !step_a) {
            j += 1;
        }
    }
    sum
}

/// Whether the ray meets the edge.
fn ray_meets(start: Plane, along: Plane, (a, b): (Plane, Plane)) -> bool {
    let edge = minus(b, a);
    let denominator = cross(along, edge);
    if denominator.abs() < 1e-12 {
        return false;
    }
    let offset = minus(a, start);
    let on_ray = cross(offset, edge) / denominator;
    let on_edge = cross(offset, along) / denominator;
    on_ray >= 0.0 && (0.0..=1.0).contains(&on_edge)
}

/// Distance from `point` to the points `from + u along` with `u` in [0, `u_max`].
fn point_to_segment_m(point: Plane, from: Plane, along: Plane, u_max: f64) -> f64 {
    let length_squared = along.0 * along.0 + along.1 * along.1;
    let offset = minus(point, from);
    let u = if length_squared > 1e-12 {
        ((offset.0 * along.0 + offset.1 * along.1) / length_squared).clamp(0.0, u_max)
    } else {
        0.0
    };
    let gap = (offset.0 - u * along.0, offset.1 - u * along.1);
    (gap.0 * gap.0 + gap.1 * gap.1).sqrt()
}

fn minus(a: Plane, b: Plane) -> Plane {
    (a.0 - b.0, a.1 - b.1)
}

fn cross(a: Plane, b: Plane) -> f64 {
    a.0 * b.1 - a.1 * b.0
}
