//! The scene from above: north up, the same scale both ways, hulls at their true size.

use crate::axis::round_step;
use crate::canvas::{Area, At, Ink, Pen, Sheet, Type, text_width};
use crate::number::fixed;
use geom::{HullOutline, Vec2, angle};
use record::{DistanceKind, ShipTrack, Trace};

/// A window on the plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlanView {
    pub(crate) area: Area,
    centre_m: Vec2,
    metres_per_px: f64,
}

impl PlanView {
    /// Shows a circle around a point (metres north and east).
    pub(crate) fn around(area: Area, centre_m: Vec2, radius_m: f64) -> Self {
        let metres_per_px = (2.0 * radius_m / area.width.min(area.height)).max(1e-3);
        Self { area, centre_m, metres_per_px }
    }

    /// Shows all of these points with a margin.
    pub(crate) fn holding(area: Area, points_m: &[Vec2]) -> Self {
        let (low, high) = extent(points_m);
        let size = high - low;
        let metres_per_px = (size.y / area.width).max(size.x / area.height).max(0.02) * 1.16;
        Self { area, centre_m: (low + high) / 2.0, metres_per_px }
    }

    pub(crate) fn at(&self, point_m: Vec2) -> Vec2 {
        let from_centre = (point_m - self.centre_m) / self.metres_per_px;
        Vec2::new(
            self.area.x + self.area.width / 2.0 + from_centre.y,
            self.area.y + self.area.height / 2.0 - from_centre.x,
        )
    }

    fn all(&self, points_m: impl IntoIterator<Item = Vec2>) -> Vec<Vec2> {
        points_m.into_iter().map(|point| self.at(point)).collect()
    }

    /// Frame, scale bar and an arrow to the north.
    pub(crate) fn furniture(&self, sheet: &mut Sheet, title: &str) {
        let area = &self.area;
        sheet.frame(area, Pen::new(Ink::Muted, 1.0));
        sheet.text(title, area.x, area.y - 10.0, Type::new(12.0, Ink::Text, At::Left).bold());
        let mut length_m = round_step(area.width * self.metres_per_px, 4.0);
        if length_m / self.metres_per_px > 0.4 * area.width {
            length_m /= 2.0;
        }
        let (x, y) = (area.x + 14.0, area.bottom() - 14.0);
        let end = x + length_m / self.metres_per_px;
        sheet.line((x, y), (end, y), Pen::new(Ink::Text, 2.0));
        for tick in [x, end] {
            sheet.line((tick, y - 4.0), (tick, y + 4.0), Pen::new(Ink::Text, 1.5));
        }
        let decimals = usize::from(length_m < 1.0);
        let label = format!("{} m", fixed(Some(length_m), decimals));
        let room = text_width(&label, 11.0) + 6.0;
        let behind = Area::new((x + end - room) / 2.0, y - 18.0, room, 13.0);
        sheet.fill(&behind, Ink::Paper, 0.85);
        sheet.text(&label, (x + end) / 2.0, y - 11.0, Type::new(11.0, Ink::Text, At::Middle));
        let (x, y) = (area.right() - 18.0, area.y + 22.0);
        sheet.line((x, y + 14.0), (x, y - 6.0), Pen::new(Ink::Text, 1.5));
        let head = [(x - 4.0, y), (x, y - 8.0), (x + 4.0, y)].map(|(x, y)| Vec2::new(x, y));
        sheet.path(&head, Pen::new(Ink::Text, 1.5));
        sheet.text("N", x - 10.0, y + 3.0, Type::new(11.0, Ink::Text, At::Middle));
    }

    pub(crate) fn line(
        &self,
        sheet: &mut Sheet,
        points_m: impl IntoIterator<Item = Vec2>,
        pen: Pen,
    ) {
        // Points nearer than a third of a pixel add nothing but size.
        let mut points: Vec<Vec2> = Vec::new();
        let all = self.all(points_m);
        for (i, &point) in all.iter().enumerate() {
            let far = points.last().is_none_or(|last| (point - last).norm() > 0.33);
            if far || i + 1 == all.len() {
                points.push(point);
            }
        }
        sheet.clipped_path(&self.area, &points, pen);
    }

    pub(crate) fn polygon(&self, sheet: &mut Sheet, corners_m: &[Vec2], ink: Ink, opacity: f64) {
        let corners = self.all(corners_m.iter().copied());
        sheet.clipped_polygon(&self.area, &corners, ink, opacity);
    }

    pub(crate) fn outline(&self, sheet: &mut Sheet, corners_m: &[Vec2], pen: Pen) {
        let closed = corners_m.iter().chain(corners_m.first()).copied();
        let corners = self.all(closed);
        sheet.clipped_path(&self.area, &corners, pen);
    }

    /// A ship at her true size, with a dot where that is too small to be seen.
    pub(crate) fn ship(
        &self,
        sheet: &mut Sheet,
        hull: &HullOutline,
        pose: Pose,
        ink: Ink,
        fill: f64,
    ) {
        let corners = hull.corners_m(pose.position_m, pose.psi_rad);
        self.polygon(sheet, &corners, ink, fill);
        self.outline(sheet, &corners, Pen::new(ink, 1.1));
        let at = self.at(pose.position_m);
        if hull.length_m / self.metres_per_px < 9.0 && self.area.contains(at) {
            sheet.dot(at, 2.6, ink);
            let ahead = angle::unit(pose.psi_rad);
            let tip = at + Vec2::new(ahead.y, -ahead.x) * 10.0;
            sheet.clipped_path(&self.area, &[at, tip], Pen::new(ink, 1.4));
        }
    }

    /// A mark such as S or G in a small disc; one that lies outside becomes an arrow at the border
    /// with the distance.
    pub(crate) fn mark(&self, sheet: &mut Sheet, point_m: Vec2, letter: &str) {
        let at = self.at(point_m);
        let look = Type::new(11.0, Ink::Paper, At::Middle).bold();
        if self.area.contains(at) {
            sheet.dot(at, 8.0, Ink::Own);
            sheet.text(letter, at.x, at.y, look);
            return;
        }
        let area = &self.area;
        let inside = Vec2::new(
            at.x.clamp(area.x + 14.0, area.right() - 14.0),
            at.y.clamp(area.y + 14.0, area.bottom() - 14.0),
        );
        sheet.dot(inside, 8.0, Ink::Own);
        sheet.text(letter, inside.x, inside.y, look);
        let away_km = (at - inside).norm() * self.metres_per_px / 1000.0;
        let label = format!("{} km on", fixed(Some(away_km), 1));
        let right = inside.x + 14.0 + text_width(&label, 10.0) < area.right();
        let (x, side) =
            if right { (inside.x + 12.0, At::Left) } else { (inside.x - 12.0, At::Right) };
        sheet.text(&label, x, inside.y, Type::new(10.0, Ink::Own, side));
    }
}

fn extent(points_m: &[Vec2]) -> (Vec2, Vec2) {
    let first = points_m.first().copied().unwrap_or_else(Vec2::zeros);
    points_m.iter().fold((first, first), |(low, high), point| (low.inf(point), high.sup(point)))
}

/// Largest side of the box around the points, metres.
pub(crate) fn size_m(points_m: &[Vec2]) -> f64 {
    let (low, high) = extent(points_m);
    (high - low).max()
}

/// Where a ship is and looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    pub(crate) position_m: Vec2,
    pub(crate) psi_rad: f64,
}

/// The pose at any time of a trace, straight between samples, held at its ends.
pub(crate) fn pose_at(track: &ShipTrack, sample_s: f64, time_s: f64) -> Pose {
    let last = track.len() - 1;
    let exact = (time_s / sample_s).clamp(0.0, last as f64);
    let k = (exact.floor() as usize).min(last);
    let next = (k + 1).min(last);
    let part = exact - k as f64;
    let turn = geom::wrap(track.psi_rad[next] - track.psi_rad[k]);
    Pose {
        position_m: track.position_m(k) + (track.position_m(next) - track.position_m(k)) * part,
        psi_rad: geom::wrap(track.psi_rad[k] + turn * part),
    }
}

/// The border of the region around a ship that no other hull, or reference point, may enter: with
/// distances from hull to hull the hull grown by the radius, between reference points a circle.
pub(crate) fn safety_border(trace: &Trace, hull: &HullOutline, pose: Pose) -> Vec<Vec2> {
    const STEPS: usize = 90;
    let radius_m = trace.safety_radius_m;
    let corners = match trace.distance {
        DistanceKind::Hull => hull.corners_m(pose.position_m, pose.psi_rad).to_vec(),
        DistanceKind::Centre => vec![pose.position_m],
    };
    // The farthest point of the grown hull in each direction; the hull is convex.
    (0..STEPS)
        .filter_map(|i| {
            let direction = angle::unit(i as f64 * std::f64::consts::TAU / STEPS as f64);
            let farthest =
                corners.iter().max_by(|a, b| direction.dot(a).total_cmp(&direction.dot(b)))?;
            Some(farthest + direction * radius_m)
        })
        .collect()
}
