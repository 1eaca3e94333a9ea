//! One encounter: the whole scene, the closest point, and what happened over time.

use crate::canvas::{Area, At, Ink, Pen, Sheet, Type, sheet, text_width};
use crate::case_marks::{Mark, marks};
use crate::figure::{DataTable, Figure};
use crate::input::Case;
use crate::number::{NONE, fixed};
use crate::plan_view::{PlanView, Pose, pose_at, safety_border, size_m};
use crate::time_charts;
use geom::units::to_deg;
use geom::{Vec2, angle};
use record::{DistanceKind, Trace};

const WIDTH: f64 = 1000.0;
const VIEW: f64 = 440.0;
const CHARTS: f64 = 130.0;
const LINE: f64 = 16.0;

/// The pictures of an encounter.
pub(crate) fn figure(case: &Case) -> Figure {
    let trace = &case.trace;
    let kind = match trace.distance {
        DistanceKind::Hull => "between hulls",
        DistanceKind::Centre => "between reference points",
    };
    Figure {
        stem: format!("case-{}", case.row.id.file_stem()),
        title: case.row.id.to_string(),
        caption: format!(
            "One encounter, {}. Own ship blue, targets pink, hulls at their true size; S start, \
             G goal, dashed grey the track without avoiding. Numbers along tracks are seconds{}. \
             Right: around the closest point, with the border that no {} may cross, {} m {kind}. \
             Far apart, the distance drawn is a lower bound. Dashed in the charts: the planner's \
             order, and the safety radius.",
            case.row.id,
            if trace.targets.len() > 1 { ", targets are numbered at their start" } else { "" },
            match trace.distance {
                DistanceKind::Hull => "hull",
                DistanceKind::Centre => "reference point",
            },
            fixed(Some(trace.safety_radius_m), 0),
        ),
        svg: (trace.samples() > 0).then(|| draw(case)),
        table: table(trace),
    }
}

/// About this many rows, whatever the length of the run.
const ROWS: usize = 24;

/// Course, speed and distance at some two dozen moments.
pub(crate) fn table(trace: &Trace) -> DataTable {
    let mut table = DataTable::new(&[
        "time, s",
        "own course, deg",
        "own speed, m/s",
        "smallest distance between hulls, m",
    ]);
    let every = trace.samples().div_ceil(ROWS).max(1);
    for k in (0..trace.samples()).step_by(every) {
        let distances = trace.pairs.iter().filter_map(|pair| pair.hull_m.get(k).copied());
        let nearest = distances.reduce(f64::min);
        table.push(vec![
            fixed(Some(k as f64 * trace.sample_s), 1),
            fixed(Some(to_deg(trace.own.cog_rad(k)).rem_euclid(360.0)), 1),
            fixed(Some(trace.own.sog_mps(k)), 2),
            nearest.map_or_else(|| NONE.to_owned(), |m| fixed(Some(m), 1)),
        ]);
    }
    table
}

fn draw(case: &Case) -> String {
    let trace = &case.trace;
    let marks = marks(trace, &case.judgement);
    let lines = mark_lines(&marks);
    let charts_top = 30.0 + VIEW + 56.0;
    let lines_top = charts_top + CHARTS + 52.0;
    let height = lines_top + LINE * lines.len() as f64 + 8.0;
    let label = format!("tracks of encounter {}", case.row.id);
    sheet(WIDTH, height, &label, |sheet| {
        let overview = Area::new(12.0, 30.0, 516.0, VIEW);
        let close = Area::new(548.0, 30.0, VIEW, VIEW);
        draw_overview(sheet, overview, case);
        draw_closest(sheet, close, case);
        let charts = Area::new(58.0, charts_top, WIDTH - 70.0, CHARTS);
        time_charts::draw(sheet, charts, trace, &marks);
        for (i, (letter, text, bad)) in lines.iter().enumerate() {
            let y = lines_top + LINE * i as f64;
            let ink = if *bad { Ink::Fail } else { Ink::Text };
            sheet.text(letter, 20.0, y, Type::new(11.0, ink, At::Middle).bold());
            sheet.text(text, 32.0, y, Type::new(11.0, ink, At::Left));
        }
    })
}

/// The marks as lines of text that fit the sheet: letter, text, and whether it is bad.
fn mark_lines(marks: &[Mark]) -> Vec<(String, String, bool)> {
    let mut lines = Vec::new();
    for mark in marks {
        let mut letter = mark.letter.to_string();
        let mut line = format!("{} s", fixed(Some(mark.time_s), 1));
        for word in mark.text.split_whitespace() {
            if text_width(&line, 11.0) + text_width(word, 11.0) > WIDTH - 60.0 {
                let full = std::mem::take(&mut line);
                lines.push((std::mem::take(&mut letter), full, mark.bad));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        lines.push((letter, line, mark.bad));
    }
    lines
}

/// Goals farther than this times the size of the tracks are shown by an arrow.
const GOAL_REACH: f64 = 1.4;

fn draw_overview(sheet: &mut Sheet, area: Area, case: &Case) {
    let trace = &case.trace;
    let positions = |track: &record::ShipTrack| -> Vec<Vec2> {
        (0..track.len()).map(|k| track.position_m(k)).collect()
    };
    let own = positions(&trace.own);
    let targets: Vec<Vec<Vec2>> = trace.targets.iter().map(positions).collect();
    let mut shown: Vec<Vec2> = own.iter().chain(targets.iter().flatten()).copied().collect();
    shown.extend(case.encounter.hazards.iter().flatten());
    let start = own[0];
    let goal = trace.route.last().map(|waypoint| waypoint.position_m);
    let tracks_m = size_m(&shown);
    if let Some(goal) = goal {
        shown.push(goal);
        if size_m(&shown) > GOAL_REACH * tracks_m {
            shown.pop();
        }
    }
    let view = PlanView::holding(area, &shown);
    for hazard in &case.encounter.hazards {
        view.polygon(sheet, hazard, Ink::Muted, 0.5);
    }
    let route = std::iter::once(start).chain(trace.route.iter().map(|w| w.position_m));
    view.line(sheet, route, Pen::new(Ink::Grid, 1.5));
    if let Some(nominal) = &trace.nominal {
        view.line(sheet, positions(&nominal.own), Pen::new(Ink::Nominal, 1.3).dashed(5.0));
    }
    for target in targets {
        view.line(sheet, target, Pen::new(Ink::Target, 1.6));
    }
    view.line(sheet, own, Pen::new(Ink::Own, 1.8));
    let every = crate::axis::round_step(trace.end_s, 7.0).max(trace.sample_s);
    let times: Vec<f64> =
        (0..).map(|i| f64::from(i) * every).take_while(|t| *t <= trace.end_s + 1e-9).collect();
    let marks =
        std::iter::once(start).chain(goal).map(|mark_m| around(view.at(mark_m), 18.0, 18.0));
    let mut labels = Labels { taken: marks.collect() };
    draw_moments(sheet, &view, trace, &times, Some(&mut labels));
    view.mark(sheet, start, "S");
    if let Some(goal) = goal {
        view.mark(sheet, goal, "G");
    }
    view.furniture(sheet, "tracks");
}

/// Hulls at several moments. Own ship's carry their times, on the side away from the others; a
/// single target's too. Several targets would hide one another's: they carry their numbers.
fn draw_moments(
    sheet: &mut Sheet,
    view: &PlanView,
    trace: &Trace,
    times: &[f64],
    mut labels: Option<&mut Labels>,
) {
    let several = trace.targets.len() > 1;
    let tracks = || trace.targets.iter().map(|t| (t, Ink::Target)).chain([(&trace.own, Ink::Own)]);
    for (moment, &time_s) in times.iter().enumerate() {
        let poses: Vec<_> = tracks().map(|(t, _)| pose_at(t, trace.sample_s, time_s)).collect();
        let middle = poses.iter().map(|p| p.position_m).sum::<Vec2>() / poses.len() as f64;
        for (i, ((track, ink), pose)) in tracks().zip(&poses).enumerate() {
            view.ship(sheet, &track.ship.hull, *pose, ink, 0.3);
            let Some(labels) = labels.as_deref_mut() else { continue };
            let numbered = several && ink == Ink::Target;
            if numbered && moment == 0 {
                labels.beside(sheet, view, *pose, middle, ink, &(i + 1).to_string());
            } else if !numbered && moment > 0 {
                labels.beside(sheet, view, *pose, middle, ink, &fixed(Some(time_s), 0));
            }
        }
    }
}

/// Labels of one panel: where two would lie on one another the later one is left out.
struct Labels {
    taken: Vec<Area>,
}

impl Labels {
    /// A small text abeam of a ship, on the side on which the others are not, or on the other side
    /// where there is no room.
    fn beside(
        &mut self,
        sheet: &mut Sheet,
        view: &PlanView,
        pose: Pose,
        others_m: Vec2,
        ink: Ink,
        text: &str,
    ) {
        const SIZE: f64 = 9.5;
        let at = view.at(pose.position_m);
        if !view.area.contains(at) {
            return;
        }
        let abeam = angle::unit(pose.psi_rad + std::f64::consts::FRAC_PI_2);
        let away = if abeam.dot(&(pose.position_m - others_m)) >= 0.0 { 1.0 } else { -1.0 };
        for side in [away, -away] {
            let offset = Vec2::new(abeam.y, -abeam.x) * (side * 11.0);
            let (width, middle) = (text_width(text, SIZE), at + offset);
            let (anchor, shift) = if offset.x > 4.0 {
                (At::Left, width / 2.0)
            } else if offset.x < -4.0 {
                (At::Right, -width / 2.0)
            } else {
                (At::Middle, 0.0)
            };
            let place = around(middle + Vec2::new(shift, 0.0), width, SIZE);
            if self.taken.iter().all(|other| !overlap(other, &place)) {
                self.taken.push(place);
                sheet.text(text, middle.x, middle.y, Type::new(SIZE, ink, anchor));
                return;
            }
        }
    }
}

fn around(middle: Vec2, width: f64, height: f64) -> Area {
    Area::new(middle.x - width / 2.0, middle.y - height / 2.0, width, height)
}

fn overlap(a: &Area, b: &Area) -> bool {
    a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom()
}

fn draw_closest(sheet: &mut Sheet, area: Area, case: &Case) {
    let trace = &case.trace;
    let nearest = (trace.pairs.iter().zip(&trace.targets))
        .min_by(|a, b| {
            let distance_m = |pair: &record::Pair| pair.minimum.of(trace.distance).0;
            distance_m(a.0).total_cmp(&distance_m(b.0))
        })
        .map(|(pair, target)| (pair.minimum.of(trace.distance), target));
    let ((distance_m, time_s), target) = match nearest {
        Some((minimum, target)) => (minimum, Some(target)),
        None => ((f64::NAN, trace.end_s), None),
    };
    let own = pose_at(&trace.own, trace.sample_s, time_s);
    let other = target.map(|track| pose_at(track, trace.sample_s, time_s));
    let apart_m = other.map_or(0.0, |pose| (pose.position_m - own.position_m).norm());
    let target_length_m = target.map_or(0.0, |track| track.ship.hull.length_m);
    let border = safety_border(trace, &trace.own.ship.hull, own);
    let radius_m = (trace.safety_radius_m + trace.own.ship.hull.length_m / 2.0)
        .max(apart_m + target_length_m / 2.0)
        .max(10.0)
        * 1.12;
    let view = PlanView::around(area, own.position_m, radius_m);
    for hazard in &case.encounter.hazards {
        view.polygon(sheet, hazard, Ink::Muted, 0.5);
    }
    view.polygon(sheet, &border, Ink::Own, 0.07);
    view.outline(sheet, &border, Pen::new(Ink::Own, 1.4).dashed(5.0));
    for track in &trace.targets {
        view.line(sheet, (0..track.len()).map(|k| track.position_m(k)), Pen::new(Ink::Target, 1.4));
    }
    view.line(
        sheet,
        (0..trace.own.len()).map(|k| trace.own.position_m(k)),
        Pen::new(Ink::Own, 1.6),
    );
    let fastest = (0..trace.own.len()).map(|k| trace.own.sog_mps(k)).fold(1.0, f64::max);
    let every = crate::axis::round_step(radius_m / fastest, 1.5).max(trace.sample_s);
    let nearby: Vec<f64> = [-2.0, -1.0, 1.0, 2.0]
        .map(|i| time_s + i * every)
        .into_iter()
        .filter(|t| *t >= 0.0 && *t <= trace.end_s)
        .collect();
    draw_moments(sheet, &view, trace, &nearby, None);
    for track in &trace.targets {
        let pose = pose_at(track, trace.sample_s, time_s);
        view.ship(sheet, &track.ship.hull, pose, Ink::Target, 0.9);
    }
    view.ship(sheet, &trace.own.ship.hull, own, Ink::Own, 0.9);
    let title = match trace.distance {
        _ if distance_m.is_nan() => "the end".to_owned(),
        DistanceKind::Hull => format!("closest: {} m between hulls", fixed(Some(distance_m), 1)),
        DistanceKind::Centre => {
            format!("closest: {} m between reference points", fixed(Some(distance_m), 1))
        }
    };
    let title = format!("{title}, at {} s (hulls every {} s)", fixed(Some(time_s), 1), every);
    view.furniture(sheet, &title);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::sheet;
    use geom::units::deg;

    /// Ships that hardly move would write all their times into one place.
    #[test]
    fn labels_do_not_lie_on_one_another() {
        let view = PlanView::around(Area::new(0.0, 0.0, 400.0, 400.0), Vec2::zeros(), 1000.0);
        let mut labels = Labels { taken: vec![around(view.at(Vec2::zeros()), 18.0, 18.0)] };
        let svg = sheet(400.0, 400.0, "labels", |sheet| {
            for k in 0..40 {
                let position_m = Vec2::new(f64::from(k), 0.0);
                let pose = Pose { position_m, psi_rad: deg(90.0) };
                labels.beside(sheet, &view, pose, Vec2::zeros(), Ink::Own, &k.to_string());
            }
        });
        let places = &labels.taken[1..];
        assert!(!places.is_empty() && places.len() < 40, "{}", places.len());
        assert_eq!(svg.matches("<text").count(), places.len());
        for (i, a) in labels.taken.iter().enumerate() {
            assert!(labels.taken[..i].iter().all(|b| !overlap(a, b)), "{i}");
        }
    }
}
