//! Reaction times of each stratum, as the share that has acted by then.

use crate::axis::Panel;
use crate::canvas::{Area, At, Ink, Pen, Sheet, Type, sheet};
use crate::figure::{DataTable, Figure};
use crate::group::Group;
use crate::number::{count, fixed, shortened};
use summary::{TimeSummary, Times};

const WIDTH: f64 = 900.0;
const COLUMNS: usize = 3;
const CELL_HEIGHT: f64 = 190.0;

/// One panel for each group, two curves in each.
pub(crate) fn figure(groups: &[Group]) -> Figure {
    let n: u64 = groups.iter().map(|group| group.tally.reaction.n()).sum();
    let censored: u64 = groups.iter().map(|group| group.summary.reaction_time_s.censored).sum();
    let end_s = end_s(groups);
    Figure {
        stem: "reaction".to_owned(),
        title: "Reaction times".to_owned(),
        caption: format!(
            "Share of the runs at risk that have acted, over the time since risk opened on the \
             nominal track, n = {}. Solid: first detectable alteration; dashed: first readily \
             apparent one. Runs that altered before count as 0 s. {} runs never made a detectable \
             one or were cut short before: the curve stays below the top by their share.",
            count(n),
            count(censored),
        ),
        svg: (n > 0).then(|| draw(groups, end_s)),
        table: table(groups),
    }
}

fn table(groups: &[Group]) -> DataTable {
    let mut table = DataTable::new(&[
        "stratum",
        "alteration",
        "runs at risk",
        "half by, s",
        "95 % by, s",
        "all by, s",
        "never or cut short",
        "early",
    ]);
    for group in groups {
        let mut push = |what: &str, times: &TimeSummary| {
            table.push(vec![
                group.name.clone(),
                what.to_owned(),
                count(times.n),
                fixed(times.median, 1),
                fixed(times.p95, 1),
                fixed(times.max, 1),
                count(times.censored),
                count(times.early),
            ]);
        };
        push("detectable", &group.summary.reaction_time_s);
        push("readily apparent", &group.summary.apparent_manoeuvre_s);
    }
    table
}

/// Up to where 99 in 100 of those that acted have done so, in every group.
fn end_s(groups: &[Group]) -> f64 {
    let acted_by = |times: &Times| {
        let acted = times.histogram.n() - times.histogram.censored() - times.histogram.above();
        let rank = (acted * 99).div_ceil(100);
        (rank > 0).then(|| times.histogram.at_rank(rank).number()).flatten()
    };
    let times = groups.iter().flat_map(|group| [&group.tally.reaction, &group.tally.apparent]);
    times.filter_map(acted_by).fold(10.0, f64::max) * 1.05
}

fn draw(groups: &[Group], end_s: f64) -> String {
    let columns = groups.len().clamp(1, COLUMNS);
    let rows = groups.len().div_ceil(columns);
    let cell = WIDTH / columns as f64;
    sheet(WIDTH, CELL_HEIGHT * rows as f64 + 26.0, "reaction times", |sheet| {
        for (i, group) in groups.iter().enumerate() {
            let (row, column) = (i / columns, i % columns);
            let area = Area::new(
                cell * column as f64 + 50.0,
                CELL_HEIGHT * row as f64 + 30.0,
                cell - 68.0,
                CELL_HEIGHT - 64.0,
            );
            let last = i + columns >= groups.len();
            draw_panel(sheet, area, group, end_s, last);
        }
    })
}

fn draw_panel(sheet: &mut Sheet, area: Area, group: &Group, end_s: f64, last: bool) {
    let panel = Panel { area, x: (0.0, end_s), y: (0.0, 1.0) };
    panel.x_axis(sheet, 5.0, if last { "seconds since risk opened" } else { "" });
    for share in [0.0, 0.5, 1.0] {
        panel.y_tick(sheet, share, &format!("{} %", fixed(Some(100.0 * share), 0)));
    }
    let name = Type::new(12.0, Ink::Text, At::Left).bold();
    sheet.text(&shortened(&group.name, 22), area.x, area.y - 12.0, name);
    let n = group.tally.reaction.n();
    let look = Type::new(11.0, Ink::Muted, At::Right);
    sheet.text(&format!("n = {}", count(n)), area.right(), area.y - 12.0, look);
    if n == 0 {
        let (x, y) = (area.x + area.width / 2.0, area.y + area.height / 2.0);
        sheet.text("no run at risk", x, y, Type::new(12.0, Ink::Muted, At::Middle));
    } else {
        let curves = [
            (&group.tally.apparent, Pen::new(Ink::Own, 2.0).dashed(4.0)),
            (&group.tally.reaction, Pen::new(Ink::Own, 2.2)),
        ];
        for (times, pen) in curves {
            panel.curve(sheet, &share_acted(times, end_s), pen);
        }
        if group.summary.reaction_time_s.censored == n {
            let (x, y) = (area.x + area.width / 2.0, area.y + area.height / 2.0);
            sheet.text("no run acted", x, y, Type::new(12.0, Ink::Muted, At::Middle));
        }
    }
    panel.frame(sheet);
}

/// Corners of the curve: it rises at the upper edge of each bin, so it never runs ahead.
fn share_acted(times: &Times, end_s: f64) -> Vec<(f64, f64)> {
    const BIN_S: f64 = 0.1;
    let n = times.n().max(1) as f64;
    let mut points = Vec::new();
    let mut seen = 0;
    for (edge, k) in times.histogram.occupied() {
        let at = if edge > 0.0 { edge + BIN_S } else { 0.0 };
        points.push((at, seen as f64 / n));
        seen += k;
        points.push((at, seen as f64 / n));
    }
    points.insert(0, (0.0, 0.0));
    points.push((end_s, seen as f64 / n));
    // One corner for each half pixel is enough for the eye, and keeps the file small.
    let mut thinned: Vec<(f64, f64)> = Vec::new();
    for point in points {
        let near = |a: &(f64, f64)| {
            (a.0 - point.0).abs() < end_s / 600.0 && (a.1 - point.1).abs() < 1.0 / 400.0
        };
        if !thinned.last().is_some_and(near) {
            thinned.push(point);
        }
    }
    thinned.push((end_s, seen as f64 / n));
    thinned
}
