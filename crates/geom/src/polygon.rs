//! Simple polygons: outlines of land, piers and shoals.

use crate::Vec2;
use std::fmt;

/// Why a list of corners is no simple polygon. Corners and edges count from 1; edge `i` goes from
/// corner `i` to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PolygonFault {
    /// Fewer than three corners.
    TooFewCorners(usize),
    /// A coordinate that is not finite.
    NotFinite(usize),
    /// Two corners at one place.
    SameCorner(usize, usize),
    /// Two edges that touch or cross.
    Crossing(usize, usize),
}

impl fmt::Display for PolygonFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFewCorners(count) => {
                write!(f, "has {count} corners; a polygon has at least 3")
            }
            Self::NotFinite(i) => write!(f, "corner {i} is not finite"),
            Self::SameCorner(i, k) => write!(f, "corners {i} and {k} lie at one place"),
            Self::Crossing(i, k) => write!(
                f,
                "edge {i} meets edge {k}; go around the outline once, without crossing it"
            ),
        }
    }
}

/// The edges of a polygon, the last one back to the first corner.
pub fn edges(corners: &[Vec2]) -> impl Iterator<Item = [Vec2; 2]> + '_ {
    (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]])
}

/// What is wrong with a polygon; none if it is simple. Costs the square of its corners.
pub fn fault(corners: &[Vec2]) -> Option<PolygonFault> {
    let n = corners.len();
    if n < 3 {
        return Some(PolygonFault::TooFewCorners(n));
    }
    if let Some(i) = corners.iter().position(|c| !(c.x.is_finite() && c.y.is_finite())) {
        return Some(PolygonFault::NotFinite(i + 1));
    }
    for i in 0..n {
        for k in i + 1..n {
            if corners[i] == corners[k] {
                return Some(PolygonFault::SameCorner(i + 1, k + 1));
            }
        }
    }
    let edge = |i: usize| [corners[i], corners[(i + 1) % n]];
    for i in 0..n {
        for k in i + 1..n {
            let meets = if k == i + 1 {
                folds_back(edge(i), edge(k))
            } else if i == 0 && k == n - 1 {
                folds_back(edge(k), edge(i))
            } else {
                touch(edge(i), edge(k))
            };
            if meets {
                return Some(PolygonFault::Crossing(i + 1, k + 1));
            }
        }
    }
    None
}

/// Whether a point lies inside, by counting the edges that a ray to the north crosses. On an edge
/// either answer may come.
pub fn contains(corners: &[Vec2], point: Vec2) -> bool {
    let crossed = edges(corners).filter(|[a, b]| {
        (a.y > point.y) != (b.y > point.y)
            && point.x < a.x + (b.x - a.x) * ((point.y - a.y) / (b.y - a.y))
    });
    crossed.count() % 2 == 1
}

/// Whether the second edge, which starts where the first ends, runs back over it.
fn folds_back([a, b]: [Vec2; 2], [_, c]: [Vec2; 2]) -> bool {
    let (along, on) = (b - a, c - b);
    along.perp(&on).abs() <= 0.0 && along.dot(&on) < 0.0
}

fn touch([a, b]: [Vec2; 2], [c, d]: [Vec2; 2]) -> bool {
    let side = |p: Vec2, q: Vec2, r: Vec2| (q - p).perp(&(r - p));
    let (c_side, d_side) = (side(a, b, c), side(a, b, d));
    let (a_side, b_side) = (side(c, d, a), side(c, d, b));
    let between = |p: Vec2, q: Vec2, r: Vec2| {
        r.x >= p.x.min(q.x) && r.x <= p.x.max(q.x) && r.y >= p.y.min(q.y) && r.y <= p.y.max(q.y)
    };
    let on = |side: f64, p: Vec2, q: Vec2, r: Vec2| side.abs() <= 0.0 && between(p, q, r);
    (c_side * d_side < 0.0 && a_side * b_side < 0.0)
        || on(c_side, a, b, c)
        || on(d_side, a, b, d)
        || on(a_side, c, d, a)
        || on(b_side, c, d, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(corners: &[(f64, f64)]) -> Vec<Vec2> {
        corners.iter().map(|&(x, y)| Vec2::new(x, y)).collect()
    }

    #[test]
    fn faults_are_named_with_their_place() {
        let fault = |corners: &[(f64, f64)]| fault(&polygon(corners));
        assert_eq!(fault(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)]), None);
        // a bay is no fault
        assert_eq!(fault(&[(0.0, 0.0), (9.0, 0.0), (4.0, 2.0), (9.0, 9.0), (0.0, 9.0)]), None);
        assert_eq!(fault(&[(0.0, 0.0), (4.0, 0.0)]), Some(PolygonFault::TooFewCorners(2)));
        assert_eq!(
            fault(&[(0.0, 0.0), (4.0, f64::NAN), (4.0, 3.0)]),
            Some(PolygonFault::NotFinite(2))
        );
        assert_eq!(
            fault(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 0.0)]),
            Some(PolygonFault::SameCorner(1, 4))
        );
        let bow_tie = [(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)];
        assert_eq!(fault(&bow_tie), Some(PolygonFault::Crossing(1, 3)));
        let spike = [(0.0, 0.0), (8.0, 0.0), (4.0, 0.0), (0.0, 4.0)];
        assert_eq!(fault(&spike), Some(PolygonFault::Crossing(1, 2)));
        let touching = [(0.0, 0.0), (8.0, 0.0), (8.0, 4.0), (4.0, 0.0), (0.0, 4.0)];
        assert_eq!(fault(&touching), Some(PolygonFault::Crossing(1, 3)));
    }

    #[test]
    fn inside_is_told_from_a_bay() {
        let horseshoe = polygon(&[
            (0.0, 0.0),
            (9.0, 0.0),
            (9.0, 3.0),
            (3.0, 3.0),
            (3.0, 6.0),
            (9.0, 6.0),
            (9.0, 9.0),
            (0.0, 9.0),
        ]);
        assert!(contains(&horseshoe, Vec2::new(6.0, 1.0)));
        assert!(contains(&horseshoe, Vec2::new(1.0, 4.5)));
        assert!(!contains(&horseshoe, Vec2::new(6.0, 4.5)));
        assert!(!contains(&horseshoe, Vec2::new(-1.0, 4.5)));
    }
}
