//! What of a line or a polygon lies inside an area, and how a line becomes dashes.

use crate::canvas::Area;
use geom::Vec2;

/// Cuts a path into dashes of equal length with gaps of the same.
pub(crate) fn dashes(points: &[Vec2], length: f64) -> Vec<Vec<Vec2>> {
    let mut pieces = Vec::new();
    let (mut drawing, mut left) = (true, length);
    let mut piece = vec![points[0]];
    for pair in points.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        while (to - from).norm() > left {
            from += (to - from).normalize() * left;
            if drawing {
                piece.push(from);
                pieces.push(std::mem::take(&mut piece));
            }
            piece = vec![from];
            drawing = !drawing;
            left = length;
        }
        left -= (to - from).norm();
        piece.push(to);
    }
    if drawing && piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}

/// The parts of a path inside an area (Liang and Barsky, segment by segment).
pub(crate) fn clip_path(area: &Area, points: &[Vec2]) -> Vec<Vec<Vec2>> {
    let mut pieces: Vec<Vec<Vec2>> = Vec::new();
    let mut open = false;
    for pair in points.windows(2) {
        let Some((from, to)) = clip_segment(area, pair[0], pair[1]) else {
            open = false;
            continue;
        };
        match pieces.last_mut() {
            Some(piece) if open => piece.push(to),
            _ => pieces.push(vec![from, to]),
        }
        open = area.contains(pair[1]);
    }
    pieces
}

fn clip_segment(area: &Area, from: Vec2, to: Vec2) -> Option<(Vec2, Vec2)> {
    let step = to - from;
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (p, q) in [
        (-step.x, from.x - area.x),
        (step.x, area.right() - from.x),
        (-step.y, from.y - area.y),
        (step.y, area.bottom() - from.y),
    ] {
        if p.abs() < 1e-12 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            enter = enter.max(q / p);
        } else {
            leave = leave.min(q / p);
        }
    }
    (enter <= leave).then(|| (from + step * enter, from + step * leave))
}

/// The part of a polygon inside an area (Sutherland and Hodgman).
pub(crate) fn clip_polygon(area: &Area, points: &[Vec2]) -> Vec<Vec2> {
    let sides: [(Vec2, f64); 4] = [
        (Vec2::new(1.0, 0.0), area.x),
        (Vec2::new(-1.0, 0.0), -area.right()),
        (Vec2::new(0.0, 1.0), area.y),
        (Vec2::new(0.0, -1.0), -area.bottom()),
    ];
    let mut kept = points.to_vec();
    for (inwards, offset) in sides {
        let depth = |p: &Vec2| inwards.dot(p) - offset;
        let before = std::mem::take(&mut kept);
        for (i, &to) in before.iter().enumerate() {
            let from = before[(i + before.len() - 1) % before.len()];
            let (a, b) = (depth(&from), depth(&to));
            if (a < 0.0) != (b < 0.0) {
                kept.push(from + (to - from) * (a / (a - b)));
            }
            if b >= 0.0 {
                kept.push(to);
            }
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Area = Area::new(0.0, 0.0, 10.0, 10.0);

    #[test]
    fn path_is_cut_at_the_border_and_comes_back() {
        let path = [(5.0, 5.0), (15.0, 5.0), (15.0, 8.0), (5.0, 8.0)].map(|(x, y)| Vec2::new(x, y));
        let pieces = clip_path(&AREA, &path);
        assert_eq!(pieces.len(), 2);
        assert_eq!(pieces[0], [Vec2::new(5.0, 5.0), Vec2::new(10.0, 5.0)]);
        assert_eq!(pieces[1], [Vec2::new(10.0, 8.0), Vec2::new(5.0, 8.0)]);
        assert!(clip_path(&AREA, &[Vec2::new(11.0, 0.0), Vec2::new(20.0, 9.0)]).is_empty());
    }

    #[test]
    fn polygon_is_cut_at_the_border() {
        let square =
            [(5.0, 5.0), (15.0, 5.0), (15.0, 15.0), (5.0, 15.0)].map(|(x, y)| Vec2::new(x, y));
        let kept = clip_polygon(&AREA, &square);
        assert_eq!(kept.len(), 4);
        assert!(kept.iter().all(|p| AREA.contains(*p)));
        assert!(clip_polygon(&AREA, &square.map(|p| p + Vec2::new(9.0, 0.0))).is_empty());
    }

    #[test]
    fn dashes_cover_half_of_the_path() {
        let path = [Vec2::new(0.0, 0.0), Vec2::new(7.0, 0.0), Vec2::new(7.0, 5.0)];
        let length: f64 = dashes(&path, 1.0)
            .iter()
            .flat_map(|piece| piece.windows(2).map(|w| (w[1] - w[0]).norm()).collect::<Vec<_>>())
            .sum();
        assert!((length - 6.0).abs() < 1e-9, "{length}");
    }
}
