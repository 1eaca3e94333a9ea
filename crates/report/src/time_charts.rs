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
    let actual = unwrapped_deg((0..trace.samples()).map(|k| trace.own.cog_rad(k)), None);
    let ordered = unwrapped_deg(trace.orders.iter().map(|order| order.course_rad), actual.first());
    let all = || actual.iter().chain(&ordered).copied();
    let (low, high) = (all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max));
    let room = (0.06 * (high - low)).max(5.0);
    let panel = chart(sheet, area, trace, "own course, deg", (low - room, high + room), marks);
    panel.curve(sheet, &steps(trace, &ordered), Pen::new(Ink::Muted, 1.4).dashed(3.0));
    panel.curve(sheet, &over_time(trace, &actual), Pen::new(Ink::Own, 2.0));
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
    let mut last = f64::MIN;
    for mark in marks {
        let x = panel.px(mark.time_s.clamp(0.0, panel.x.1));
        let ink = if mark.bad { Ink::Fail } else { Ink::Muted };
        sheet.line((x, area.y), (x, area.bottom()), Pen::new(ink, 1.0).faint(0.7));
        // Letters of moments close to one another stand side by side.
        last = x.max(last + 9.0);
        let look = Type::new(10.0, ink, At::Middle).bold();
        sheet.text(&mark.letter.to_string(), last, area.y - 8.0, look);
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

/// Degrees without jumps at north, starting near `near` or within [0, 360).
fn unwrapped_deg(angles_rad: impl Iterator<Item = f64>, near: Option<&f64>) -> Vec<f64> {
    let mut unwrapped: Vec<f64> = Vec::new();
    for angle_rad in angles_rad {
        let next = match unwrapped.last().or(near) {
            Some(&last) => last + to_deg(wrap(angle_rad - geom::units::deg(last))),
            None => to_deg(angle_rad).rem_euclid(360.0),
        };
        unwrapped.push(next);
    }
    unwrapped
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::units::deg;

    #[test]
    fn courses_run_over_north_without_a_jump() {
        let courses = [350.0, 358.0, 4.0, 12.0].map(deg);
        let found = unwrapped_deg(courses.into_iter(), None);
        for (value, expected) in found.iter().zip([350.0, 358.0, 364.0, 372.0]) {
            assert!((value - expected).abs() < 1e-9, "{found:?}");
        }
        let near = unwrapped_deg([deg(5.0)].into_iter(), Some(&355.0));
        assert!((near[0] - 365.0).abs() < 1e-9);
    }
}
