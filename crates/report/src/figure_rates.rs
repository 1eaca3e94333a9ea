//! Rates of each stratum with their exact bounds.

use crate::axis::Panel;
use crate::canvas::{Area, At, Ink, Pen, Sheet, Type, sheet};
use crate::figure::{DataTable, Figure};
use crate::number::{count, per_cent, per_cent_or_none};
use summary::{BoundedRate, StratumSummary};

const WIDTH: f64 = 900.0;
const LEFT: f64 = 150.0;
const TOP: f64 = 34.0;
const ROW: f64 = 26.0;

/// Collisions and breaches of the safety radius: point and two-sided 95 % bounds. `of` says what
/// the lines are, and how many runs.
pub(crate) fn figure(strata: &[StratumSummary], of: &str) -> Figure {
    let mut table = DataTable::new(&[
        "stratum",
        "n",
        "unknown",
        "collisions",
        "rate",
        "lower 95 %",
        "upper 95 %",
        "radius broken",
        "rate",
        "lower 95 %",
        "upper 95 %",
    ]);
    for stratum in strata {
        let mut row = vec![stratum.name.clone(), count(stratum.n), count(stratum.unknown)];
        for rate in [&stratum.collision, &stratum.safety_radius] {
            row.push(count(rate.k));
            row.push(per_cent_or_none(rate.rate));
            row.push(per_cent(rate.lower_95));
            row.push(per_cent(rate.upper_95));
        }
        table.push(row);
    }
    let n: u64 = strata.iter().map(|stratum| stratum.n).sum();
    let (dot, line) = if strata.iter().any(|stratum| stratum.weighted.is_some()) {
        (
            "the weighted share, where it rests on enough encounters",
            "two-sided 95 % betting bounds, which hold for weights; counts are of the draws",
        )
    } else {
        ("the share seen", "exact two-sided 95 % bounds (Clopper-Pearson)")
    };
    Figure {
        stem: "rates".to_owned(),
        title: "Rates and their bounds".to_owned(),
        caption: format!(
            "Share of encounters with a collision (left) and with the safety radius broken \
             (right), {of}. Dot: {dot}; line: {line}; runs of unknown outcome count as failures in \
             the upper bound. Each side has its own scale.",
        ),
        svg: (n > 0).then(|| draw(strata)),
        table,
    }
}

fn draw(strata: &[StratumSummary]) -> String {
    let height = TOP + ROW * strata.len() as f64 + 44.0;
    sheet(WIDTH, height, "rates of each stratum with exact bounds", |sheet| {
        for (i, stratum) in strata.iter().enumerate() {
            let y = TOP + ROW * (i as f64 + 0.5);
            let look = Type::new(12.0, Ink::Text, At::Right);
            sheet.text(&crate::number::shortened(&stratum.name, 22), LEFT - 12.0, y, look);
        }
        let width = (WIDTH - LEFT - 60.0) / 2.0;
        for (i, (title, ink)) in
            [("collision", Ink::Fail), ("safety radius broken", Ink::Warn)].into_iter().enumerate()
        {
            let area =
                Area::new(LEFT + (width + 40.0) * i as f64, TOP, width, ROW * strata.len() as f64);
            let rates: Vec<BoundedRate> =
                strata.iter().map(|s| [s.collision, s.safety_radius][i]).collect();
            draw_side(sheet, area, title, &rates, ink);
        }
    })
}

fn draw_side(sheet: &mut Sheet, area: Area, title: &str, rates: &[BoundedRate], ink: Ink) {
    let end = rates.iter().filter(|r| r.n > 0).map(|r| r.upper_95).fold(0.0, f64::max).min(1.0);
    let panel = Panel { area, x: (0.0, 100.0 * end * 1.04), y: (0.0, rates.len() as f64) };
    panel.x_axis(sheet, 5.0, "per cent of encounters");
    panel.frame(sheet);
    sheet.text(title, area.x, area.y - 12.0, Type::new(13.0, Ink::Text, At::Left).bold());
    for (i, rate) in rates.iter().enumerate() {
        if rate.n == 0 {
            continue;
        }
        let y = area.y + ROW * (i as f64 + 0.5);
        let (low, high) = (panel.px(100.0 * rate.lower_95), panel.px(100.0 * rate.upper_95));
        sheet.line((low, y), (high, y), Pen::new(ink, 2.5));
        for x in [low, high] {
            sheet.line((x, y - 4.0), (x, y + 4.0), Pen::new(ink, 1.5));
        }
        if let Some(seen) = rate.rate {
            sheet.dot(panel.at(100.0 * seen, rates.len() as f64 - i as f64 - 0.5), 4.0, ink);
        }
    }
}
