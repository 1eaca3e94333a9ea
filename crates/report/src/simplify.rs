//! Leaves out the points of a path that nobody could see.
//!
//! A track has a point for every sample, most of them on a straight line, and an SVG spends a
//! dozen bytes on each. The path that is left runs through points of the old one and passes every
//! other within a tolerance (Ramer 1972; Douglas and Peucker 1973).

use geom::Vec2;

/// Half of what plotters' whole units, a tenth of a pixel each, could show.
pub(crate) const TOLERANCE_PX: f64 = 0.05;

/// The points that stay, in order, the first and the last among them.
pub(crate) fn simplify(points: &[Vec2], tolerance_px: f64) -> Vec<Vec2> {
    let Some(last) = points.len().checked_sub(1).filter(|last| *last > 1) else {
        return points.to_vec();
    };
    let mut stays = vec![false; points.len()];
    (stays[0], stays[last]) = (true, true);
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let away = |k: &usize| distance_px(points[*k], points[from], points[to]);
        let farthest = (from + 1..to).max_by(|a, b| away(a).total_cmp(&away(b)));
        if let Some(k) = farthest.filter(|k| away(k) > tolerance_px) {
            stays[k] = true;
            open.extend([(from, k), (k, to)]);
        }
    }
    points.iter().zip(stays).filter(|(_, stays)| *stays).map(|(point, _)| *point).collect()
}

/// Distance of a point from a piece of a line, so that a path that comes back is not lost.
fn distance_px(point: Vec2, from: Vec2, to: Vec2) -> f64 {
    let along = to - from;
    let length2 = along.norm_squared();
    let part =
        if length2 > 0.0 { ((point - from).dot(&along) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (point - from - along * part).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_lines_lose_their_middle_and_corners_stay() {
        let mut path: Vec<Vec2> = (0..50).map(|i| Vec2::new(f64::from(i), 0.0)).collect();
        path.extend((1..50).map(|i| Vec2::new(49.0, f64::from(i))));
        let corners = [(0.0, 0.0), (49.0, 0.0), (49.0, 49.0)].map(|(x, y)| Vec2::new(x, y));
        assert_eq!(simplify(&path, TOLERANCE_PX), corners);
    }

    #[test]
    fn a_way_out_and_back_keeps_its_far_end() {
        let path = [0.0, 5.0, 9.0, 4.0, 0.0].map(|x| Vec2::new(x, 1.0));
        assert_eq!(simplify(&path, TOLERANCE_PX), [0.0, 9.0, 0.0].map(|x| Vec2::new(x, 1.0)));
    }

    #[test]
    fn every_point_left_out_lies_within_the_tolerance_of_what_is_left() {
        let path: Vec<Vec2> = (0..400)
            .map(|i| {
                let s = f64::from(i) * 0.02;
                Vec2::new(100.0 * s, 100.0 * geom::math::sin(s) + 3.0 * geom::math::cos(9.0 * s))
            })
            .collect();
        let left = simplify(&path, 0.5);
        assert!(left.len() < path.len() / 3, "{} of {} stayed", left.len(), path.len());
        for point in &path {
            let away = left
                .windows(2)
                .map(|pair| distance_px(*point, pair[0], pair[1]))
                .fold(f64::INFINITY, f64::min);
            assert!(away <= 0.5, "{point} lies {away} px off");
        }
    }
}
