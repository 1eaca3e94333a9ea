//! Range, course and speed over time, beside the scene.

use crate::axis::Panel;
use crate::canvas::{Area, At, Ink, Pen, Sheet, Type};
use crate::case_marks::Mark;
use crate::number::fixed;
use geom::units::to_deg;
use geom::wrap;
use record::{DistanceKind, Trace};

/// Draws the three charts over a width, with the marked moments in each.
pub(crate) fn draw(sheet: &mut Sheet, area: Area, trace: &Trace, marks: &[Mark]) {
    const GAP: f64 = 56.0;
    let width = (area.width - 2.0 * GAP) / 3.0;
    let at = |i: f64| Area::new(area.x + i * (width + GAP), area.y, width, area.height);
    range(sheet, at(0.0), trace, marks);
    course(sheet, at(1.0), trace, marks);
    speed(sheet, at(2.0), trace, marks);
}

fn range(sheet: &mut Sheet, area: Area, trace: &Trace, marks: &[Mark]) {
    let lines: Vec<Vec<f64>> = (0..trace.pairs.len().min(trace.targets.len()))
        .map(|target| match trace.distance {
            DistanceKind::Hull => trace.pairs[target].hull_m.clone(),
            DistanceKind::Centre => (0..trace.samples().min(trace.targets[target].len()))
                .map(|k| (trace.targets[target].position_m(k) - trace.own.position_m(k)).norm())
                .collect(),
        })
        .collect();
    let highest = lines.iter().flatten().copied().fold(trace.safety_radius_m, f64::max);
    let title = match trace.distance {
        DistanceKind::Hull => "distance between hulls, m",
        DistanceKind::Centre => "distance between reference points, m",
    };
    let panel = chart(sheet, area, trace, title, (0.0, 1.05 * highest), marks);
    let radius_m = trace.safety_radius_m;
    let ends = [(0.0, radius_m), (trace.end_s, radius_m)];
    panel.curve(sheet, &ends, Pen::new(Ink::Text, 1.2).dashed(4.0));
    for (target, values) in lines.iter().enumerate() {
        panel.curve(sheet, &over_time(trace, values), Pen::new(Ink::Target, 1.8));
        let (distance_m, time_s) = trace.pairs[target].minimum.of(trace.distance);
        sheet.dot(panel.at(time_s, distance_m.min(panel.y.1)), 3.2, Ink::Target);
    }
}

fn course(sheet: &mut Sheet, area: Area, trace: &Trace, marks: &[Mark]) {
    let cogs = (0..trace.samples()).map(|k| trace.own.cog_rad(k));
    let orders = trace.orders.iter().map(|order| order.course_rad);
    let (actual, ordered) = courses_deg(cogs, orders);
    let all = || actual.iter().chain(&ordered).copied();
    let (low, high) = (all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max));
    let room = (0.06 * (high - low)).max(5.0);
    let panel = chart(sheet, area, trace, "own course, deg", (low - room, high + room), marks);
    for part in without_jumps(&steps(trace, &ordered)) {
        panel.curve(sheet, part, Pen::new(Ink::Muted, 1.4).dashed(3.0));
    }
    for part in without_jumps(&over_time(trace, &actual)) {
        panel.curve(sheet, part, Pen::new(Ink::Own, 2.0));
    }
}

fn speed(sheet: &mut Sheet, area: Area, trace: &Trace, marks: &[Mark]) {
    let own: Vec<f64> = (0..trace.samples()).map(|k| trace.own.sog_mps(k)).collect();
    let ordered: Vec<f64> = trace.orders.iter().map(|order| order.speed_mps).collect();
    let targets: Vec<Vec<f64>> = trace
        .targets
        .iter()
        .map(|track| (0..track.len()).map(|k| track.sog_mps(k)).collect())
        .collect();
    let all = own.iter().chain(&ordered).chain(targets.iter().flatten()).copied();
    let highest = all.fold(1.0, f64::max);
    let panel = chart(sheet, area, trace, "speed, m/s", (0.0, 1.1 * highest), marks);
    for values in &targets {
        panel.curve(sheet, &over_time(trace, values), Pen::new(Ink::Target, 1.4));
    }
    panel.curve(sheet, &steps(trace, &ordered), Pen::new(Ink::Muted, 1.4).dashed(3.0));
    panel.curve(sheet, &over_time(trace, &own), Pen::new(Ink::Own, 2.0));
}

/// An empty chart with its axes and marks.
fn chart(
    sheet: &mut Sheet,
    area: Area,
    trace: &Trace,
    title: &str,
    y: (f64, f64),
    marks: &[Mark],
) -> Panel {
    let panel = Panel { area, x: (0.0, trace.end_s.max(trace.sample_s)), y };
    panel.x_axis(sheet, 5.0, "time, s");
    let is_course = title.ends_with("deg");
    panel.y_axis(sheet, 5.0, "", |value, label| {
        if is_course { fixed(Some(value.rem_euclid(360.0)), 0) } else { label }
    });
    let head = Type::new(11.0, Ink::Text, At::Left).bold();
    sheet.text(title, area.x, area.y - 24.0, head);
    panel.frame(sheet);
    let at = |mark: &Mark| panel.px(mark.time_s.clamp(0.0, panel.x.1));
    let letters = side_by_side(&marks.iter().map(at).collect::<Vec<f64>>(), area.right());
    for (mark, letter_x) in marks.iter().zip(letters) {
        let x = at(mark);
        let ink = if mark.bad { Ink::Fail } else { Ink::Muted };
        sheet.line((x, area.y), (x, area.bottom()), Pen::new(ink, 1.0).faint(0.7));
        let look = Type::new(10.0, ink, At::Middle).bold();
        sheet.text(&mark.letter.to_string(), letter_x, area.y - 8.0, look);
    }
    panel
}

fn over_time(trace: &Trace, values: &[f64]) -> Vec<(f64, f64)> {
    values.iter().enumerate().map(|(k, &value)| (k as f64 * trace.sample_s, value)).collect()
}

/// An order holds until the next one.
fn steps(trace: &Trace, values: &[f64]) -> Vec<(f64, f64)> {
    let hold = |(k, &value): (usize, &f64)| {
        let from = k as f64 * trace.sample_s;
        [(from, value), ((from + trace.sample_s).min(trace.end_s), value)]
    };
    let all = values.iter().enumerate().flat_map(hold);
    let mut corners: Vec<(f64, f64)> = Vec::new();
    for point in all {
        // Of a run of equal orders only its two ends are corners.
        let flat = |a: &(f64, f64)| (a.1 - point.1).abs() < 1e-9;
        if corners.len() > 1 && corners[corners.len() - 2..].iter().all(flat) {
            corners.pop();
        }
        corners.push(point);
    }
    corners
}

/// Where the letters of moments stand: close ones side by side, none beyond `right`.
fn side_by_side(wanted: &[f64], right: f64) -> Vec<f64> {
    const APART: f64 = 9.0;
    let mut places = wanted.to_vec();
    for i in 1..places.len() {
        places[i] = places[i].max(places[i - 1] + APART);
    }
    let mut limit = right;
    for place in places.iter_mut().rev() {
        *place = place.min(limit);
        limit = *place - APART;
    }
    places
}

/// A ship that turns farther than this in one run is drawn by the compass: a chart of some thousand
/// degrees shows nothing.
const TURNED_DEG_MAX: f64 = 720.0;

/// Own courses and the orders in degrees. The courses do not jump at north; an order is within half
/// a turn of the course that the ship has when it is given.
fn courses_deg(
    actual_rad: impl Iterator<Item = f64>,
    ordered_rad: impl Iterator<Item = f64>,
) -> (Vec<f64>, Vec<f64>) {
    let mut actual: Vec<f64> = Vec::new();
    for angle_rad in actual_rad {
        let first = to_deg(angle_rad).rem_euclid(360.0);
        actual.push(actual.last().map_or(first, |&last| near_deg(angle_rad, last)));
    }
    let all = || actual.iter().copied();
    if all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min) > TURNED_DEG_MAX {
        actual.iter_mut().for_each(|course| *course = course.rem_euclid(360.0));
    }
    let last = actual.last().copied().unwrap_or(0.0);
    let order = |(k, angle_rad): (usize, f64)| near_deg(angle_rad, *actual.get(k).unwrap_or(&last));
    let ordered = ordered_rad.enumerate().map(order).collect();
    (actual, ordered)
}

/// An angle in degrees, within half a turn of another.
fn near_deg(angle_rad: f64, other_deg: f64) -> f64 {
    other_deg + to_deg(wrap(angle_rad - geom::units::deg(other_deg)))
}

/// The pieces of a curve of courses between jumps of more than half a turn.
fn without_jumps(points: &[(f64, f64)]) -> impl Iterator<Item = &[(f64, f64)]> {
    points.chunk_by(|a, b| (a.1 - b.1).abs() <= 180.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::units::deg;

    fn close(found: &[f64], expected: &[f64]) -> bool {
        found.len() == expected.len()
            && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9)
    }

    #[test]
    fn courses_run_over_north_without_a_jump_and_orders_stay_beside_them() {
        let courses = [350.0, 358.0, 4.0, 12.0].map(deg);
        // the last order is farther than half a turn from the one before, and not from the ship
        let orders = [5.0, 90.0, 170.0, 340.0].map(deg);
        let (actual, ordered) = courses_deg(courses.into_iter(), orders.into_iter());
        assert!(close(&actual, &[350.0, 358.0, 364.0, 372.0]), "{actual:?}");
        assert!(close(&ordered, &[365.0, 450.0, 530.0, 340.0]), "{ordered:?}");
    }

    #[test]
    fn a_ship_that_spins_is_drawn_by_the_compass_and_cut_where_it_passes_north() {
        let spinning = (0..20).map(|k| deg(100.0 * f64::from(k)));
        let (actual, _) = courses_deg(spinning, std::iter::empty());
        assert!(actual.iter().all(|course| (0.0..360.0).contains(course)), "{actual:?}");
        let points: Vec<(f64, f64)> = actual.iter().map(|&course| (0.0, course)).collect();
        let parts: Vec<usize> = without_jumps(&points).map(<[_]>::len).collect();
        assert_eq!(parts, [4, 4, 3, 4, 3, 2]);
    }

    #[test]
    fn letters_stand_apart_and_inside() {
        let places = side_by_side(&[10.0, 12.0, 95.0, 99.0, 100.0], 100.0);
        assert!(close(&places, &[10.0, 19.0, 82.0, 91.0, 100.0]), "{places:?}");
    }
}
