//! A named scene in the style of the paper that it stands for: the ships at the moments that count,
//! with start, goal, hulls, safety circles and headings, beside distance, course and speed over
//! time.
//!
//! The style is that of Figs. 14 to 17 of J. Zhuang, R. Bucknall, J. Luo, H. Sun, Y. Liu, C. Huang,
//! "Collision Avoidance for Unmanned Surface Vehicles based on COLREGS": (a) the original headings,
//! (b) the manoeuvre, (c) the whole paths; own ship's in blue, obstacles' in pink. With several
//! obstacles there are two moments of the manoeuvre, as in Fig. 17.

use crate::canvas::{Area, At, Ink, Pen, Sheet, Type, sheet};
use crate::case_figure;
use crate::case_marks::Mark;
use crate::figure::Figure;
use crate::input::Case;
use crate::number::fixed;
use crate::plan_view::{PlanView, Pose, pose_at, safety_border};
use crate::time_charts;
use geom::{Vec2, angle};
use record::{Outcome, ShipTrack, Trace};

const WIDTH: f64 = 1000.0;
const VIEW: f64 = 440.0;
const CHARTS: f64 = 130.0;
const EDGE: f64 = 12.0;
const GAP: f64 = 14.0;
/// Length of the line that shows a heading, pixels.
const HEADING: f64 = 34.0;

/// What a panel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shows {
    /// The whole scene, nobody has moved.
    Start,
    /// Around own ship, with the paths so far.
    Near,
    /// The whole scene, with the whole paths.
    Paths,
}

/// A panel: what it shows, when, and what is said of it.
#[derive(Clone, Debug, PartialEq)]
struct Moment {
    shows: Shows,
    time_s: f64,
    text: String,
}

/// The picture of a named scene; its file has the name of the scene.
pub(crate) fn figure(case: &Case) -> Figure {
    let trace = &case.trace;
    let name = &case.row.id.stratum;
    let is_plain = |c: char| c.is_alphanumeric() || c == '_';
    Figure {
        stem: format!("scene-{}", name.replace(|c: char| !is_plain(c), "-")),
        title: name.to_string(),
        caption:
            "Own ship and her path blue, obstacles and theirs pink, hulls at their true size, \
                  S start, G goal; the lines ahead are headings. Dashed around each obstacle: the \
                  safety radius."
                .to_owned(),
        svg: (trace.samples() > 0).then(|| draw(case)),
        table: case_figure::table(trace),
    }
}

fn draw(case: &Case) -> String {
    let trace = &case.trace;
    let moments = moments(trace);
    let charts_top = 34.0 + VIEW + 56.0;
    let label = format!("the scene {}", case.row.id.stratum);
    sheet(WIDTH, charts_top + CHARTS + 40.0, &label, |sheet| {
        for ((moment, area), letter) in moments.iter().zip(areas(&moments)).zip('a'..) {
            panel(sheet, area, trace, moment, letter);
        }
        let marks: Vec<Mark> = moments
            .iter()
            .zip('a'..)
            .map(|(m, letter)| Mark { letter, time_s: m.time_s, text: m.text.clone(), bad: false })
            .collect();
        let charts = Area::new(58.0, charts_top, WIDTH - 70.0, CHARTS);
        time_charts::draw(sheet, charts, trace, &marks);
    })
}

/// The start, the closest point (with several obstacles those of the first and of the last), the
/// end.
fn moments(trace: &Trace) -> Vec<Moment> {
    let mut closest: Vec<(f64, f64, usize)> = Vec::new();
    for (target, pair) in trace.pairs.iter().enumerate() {
        let (distance_m, time_s) = pair.minimum.of(trace.distance);
        closest.push((time_s, distance_m, target));
    }
    closest.sort_by(|a, b| a.0.total_cmp(&b.0));
    if closest.len() > 2 {
        closest.drain(1..closest.len() - 1);
    }
    let near = closest.into_iter().map(|(time_s, distance_m, target)| {
        let with = match trace.pairs.len() {
            1 => String::new(),
            _ => format!(" to {}", target + 1),
        };
        let text = format!("closest{with}, {} m", fixed(Some(distance_m), 1));
        Moment { shows: Shows::Near, time_s, text }
    });
    let start = Moment { shows: Shows::Start, time_s: 0.0, text: "original headings".to_owned() };
    let ended = match trace.outcome {
        Outcome::Completed => "paths".to_owned(),
        other => other.name().replace('_', " "),
    };
    let end = Moment { shows: Shows::Paths, time_s: trace.end_s, text: ended };
    [start].into_iter().chain(near).chain([end]).collect()
}

/// Panels side by side; those around own ship are the wider ones.
fn areas(moments: &[Moment]) -> Vec<Area> {
    let room = WIDTH - 2.0 * EDGE - GAP * (moments.len() - 1) as f64;
    let near = moments.iter().filter(|m| m.shows == Shows::Near).count();
    let whole = if near > 1 { 205.0 } else { 268.0 };
    let close = (room - whole * (moments.len() - near) as f64) / near.max(1) as f64;
    let mut x = EDGE;
    let mut areas = Vec::new();
    for moment in moments {
        let width = if moment.shows == Shows::Near { close } else { whole };
        areas.push(Area::new(x, 34.0, width, VIEW));
        x += width + GAP;
    }
    areas
}

fn panel(sheet: &mut Sheet, area: Area, trace: &Trace, moment: &Moment, letter: char) {
    let now = |track: &ShipTrack| pose_at(track, trace.sample_s, moment.time_s);
    let own = now(&trace.own);
    let start_m = trace.own.position_m(0);
    let goal_m = trace.route.last().map(|waypoint| waypoint.position_m);
    let view = match moment.shows {
        Shows::Near => PlanView::around(area, own.position_m, near_radius_m(trace, moment.time_s)),
        Shows::Start | Shows::Paths => {
            // where obstacles go after they have been passed would make all the rest small
            let own = (0..trace.own.len()).map(|k| trace.own.position_m(k));
            let starts = trace.targets.iter().map(|target| target.position_m(0));
            PlanView::holding(area, &own.chain(starts).chain(goal_m).collect::<Vec<Vec2>>())
        }
    };
    let route = std::iter::once(start_m).chain(trace.route.iter().map(|w| w.position_m));
    view.line(sheet, route, Pen::new(Ink::Grid, 1.5));
    let so_far = |track: &ShipTrack| -> Vec<Vec2> {
        let until = (moment.time_s / trace.sample_s).floor() as usize;
        let before = (0..track.len().min(until + 1)).map(|k| track.position_m(k));
        before.chain([now(track).position_m]).collect()
    };
    for (i, target) in trace.targets.iter().enumerate() {
        view.line(sheet, so_far(target), Pen::new(Ink::Target, 1.7));
        let pose = now(target);
        let border = safety_border(trace, &target.ship.hull, pose);
        view.polygon(sheet, &border, Ink::Target, 0.07);
        view.outline(sheet, &border, Pen::new(Ink::Target, 1.2).dashed(4.0));
        ship(sheet, &view, target, pose, Ink::Target);
        if trace.targets.len() > 1 {
            number(sheet, &view, pose, i + 1);
        }
    }
    view.line(sheet, so_far(&trace.own), Pen::new(Ink::Own, 2.0));
    ship(sheet, &view, &trace.own, own, Ink::Own);
    if moment.shows != Shows::Near {
        view.mark(sheet, start_m, "S");
        goal_m.into_iter().for_each(|goal_m| view.mark(sheet, goal_m, "G"));
    }
    let title = format!("({letter}) {} s: {}", fixed(Some(moment.time_s), 0), moment.text);
    view.furniture(sheet, &title);
}

/// The next ship and its safety circle are seen whole.
fn near_radius_m(trace: &Trace, time_s: f64) -> f64 {
    let own_m = pose_at(&trace.own, trace.sample_s, time_s).position_m;
    let apart_m = trace.targets.iter().map(|track| {
        (pose_at(track, trace.sample_s, time_s).position_m - own_m).norm()
            + track.ship.hull.length_m / 2.0
    });
    (apart_m.fold(f64::INFINITY, f64::min).min(3.0 * trace.safety_radius_m) + trace.safety_radius_m)
        .max(1.6 * trace.safety_radius_m)
        * 1.08
}

/// A hull and the line of its heading.
fn ship(sheet: &mut Sheet, view: &PlanView, track: &ShipTrack, pose: Pose, ink: Ink) {
    view.ship(sheet, &track.ship.hull, pose, ink, 0.9);
    let ahead = angle::unit(pose.psi_rad);
    let from = view.at(pose.position_m);
    let tip = from + Vec2::new(ahead.y, -ahead.x) * HEADING;
    sheet.clipped_path(&view.area, &[from, tip], Pen::new(ink, 1.1));
}

/// An obstacle's number, behind it.
fn number(sheet: &mut Sheet, view: &PlanView, pose: Pose, number: usize) {
    let ahead = angle::unit(pose.psi_rad);
    let at = view.at(pose.position_m) - Vec2::new(ahead.y, -ahead.x) * 13.0;
    if view.area.contains(at) {
        let look = Type::new(11.0, Ink::Target, At::Middle).bold();
        sheet.text(&number.to_string(), at.x, at.y, look);
    }
}
