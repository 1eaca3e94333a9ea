//! Failures over relative bearing and speed ratio.

use crate::axis::Panel;
use crate::canvas::{Area, At, Ink, Pen, Sheet, Type, sheet};
use crate::figure::{DataTable, Figure};
use crate::number::{NONE, count, fixed, per_cent, per_cent_or_none, short_count};
use crate::weighted::of_draws;
use std::collections::BTreeMap;
use summary::{BEARING_SECTORS, BoundedRate, Cell, CellKey, Tally};

const WIDTH: f64 = 1000.0;
const LEFT: f64 = 62.0;
const TOP: f64 = 64.0;
const ROW: f64 = 30.0;

/// The map of all runs; of weighted ones without bounds.
pub(crate) fn figure(tally: &Tally, weighted: bool) -> Figure {
    let cells = tally.map.cells();
    let n: u64 = cells.values().map(|cell| cell.n).sum();
    let mut table = DataTable::new(&[
        "relative bearing, deg",
        "speed ratio",
        "n",
        "collisions",
        "failures",
        "rate",
        "lower 95 %",
        "upper 95 %",
    ]);
    for (key, cell) in &cells {
        let (lower, upper) = key.ratio();
        let rate = BoundedRate::new(cell.failures, 0, cell.n);
        let part = |bound| if weighted { NONE.to_owned() } else { per_cent(bound) };
        table.push(vec![
            format!("{} ± 7.5", fixed(Some(key.bearing_deg()), 0)),
            upper.map_or_else(|| format!("over {lower:.2}"), |u| format!("{lower:.2} to {u:.2}")),
            count(cell.n),
            count(cell.collisions),
            count(cell.failures),
            per_cent_or_none(rate.rate),
            part(rate.lower_95),
            part(rate.upper_95),
        ]);
    }
    Figure {
        stem: "bearing_speed".to_owned(),
        title: "Failures over relative bearing and speed ratio".to_owned(),
        caption: format!(
            "Each cell: failures over encounters, by the target's relative bearing at the start \
             (sectors of 15 degrees, starboard positive) and target speed over own speed. A \
             failure is a collision, a broken safety radius or an unknown outcome. n = {} in {} \
             cells; empty cells had no encounter. Cells with few encounters say little: the table \
             has their bounds.{}",
            count(n),
            cells.len(),
            of_draws(weighted),
        ),
        svg: (n > 0).then(|| draw(&cells)),
        table,
    }
}

/// Upper ends of the colours, as a share; the first is for none at all.
const STEPS: [(f64, &str); 5] =
    [(0.0, "none"), (0.01, "to 1 %"), (0.05, "to 5 %"), (0.2, "to 20 %"), (1.0, "over 20 %")];

pub(crate) fn step(share: f64) -> u8 {
    STEPS.iter().position(|(end, _)| share <= *end).unwrap_or(STEPS.len() - 1) as u8
}

fn draw(cells: &BTreeMap<CellKey, Cell>) -> String {
    let bands = cells.keys().map(|key| key.band).max().unwrap_or(0) + 1;
    let area = Area::new(LEFT, TOP, WIDTH - LEFT - 14.0, ROW * f64::from(bands));
    let half = 7.5;
    // Sectors from the one right of astern on the port side to astern: -165 to 180 degrees.
    let panel = Panel { area, x: (-165.0 - half, 180.0 + half), y: (0.0, f64::from(bands)) };
    sheet(WIDTH, area.bottom() + 44.0, "failures by bearing and speed ratio", |sheet| {
        draw_key(sheet);
        for (key, cell) in cells {
            draw_cell(sheet, &panel, *key, cell);
        }
        for bearing in (-165..=180).step_by(30).map(|b| f64::from(b) + 15.0) {
            let look = Type::new(11.0, Ink::Muted, At::Middle);
            let x = panel.px(bearing);
            sheet.text(&fixed(Some(bearing), 0), x, area.bottom() + 11.0, look);
        }
        for band in 0..bands {
            let y = panel.py(f64::from(band) + 0.5);
            let (lower, upper) = CellKey { sector: 0, band }.ratio();
            let label =
                if upper.is_some() { format!("{lower:.2}") } else { format!("≥ {lower}") };
            sheet.text(&label, LEFT - 6.0, y, Type::new(11.0, Ink::Muted, At::Right));
        }
        let middle = area.x + area.width / 2.0;
        let look = Type::new(11.0, Ink::Text, At::Middle);
        let title = "relative bearing of the target at the start, degrees (port negative)";
        sheet.text(title, middle, area.bottom() + 28.0, look);
        let look = Type::new(11.0, Ink::Text, At::Left).bold();
        sheet.text("speed ratio, from", 4.0, TOP - 12.0, look);
        panel.frame(sheet);
        debug_assert_eq!(u64::from(BEARING_SECTORS), 24);
    })
}

pub(crate) fn draw_key(sheet: &mut Sheet) {
    let mut x = LEFT + 220.0;
    sheet.text("share failed", x - 8.0, 18.0, Type::new(11.0, Ink::Text, At::Right));
    for (i, (_, label)) in STEPS.iter().enumerate() {
        sheet.fill(&Area::new(x, 10.0, 16.0, 16.0), Ink::Heat(i as u8), 1.0);
        sheet.frame(&Area::new(x, 10.0, 16.0, 16.0), Pen::new(Ink::Muted, 0.8));
        sheet.text(label, x + 21.0, 18.0, Type::new(11.0, Ink::Text, At::Left));
        x += 84.0;
    }
}

fn draw_cell(sheet: &mut Sheet, panel: &Panel, key: CellKey, cell: &Cell) {
    let middle = panel.at(key.bearing_deg(), f64::from(key.band) + 0.5);
    let width = panel.px(15.0) - panel.px(0.0);
    let area =
        Area::new(middle.x - width / 2.0 + 0.5, middle.y - ROW / 2.0 + 0.5, width - 1.0, ROW - 1.0);
    let step = step(cell.failures as f64 / cell.n as f64);
    sheet.fill(&area, Ink::Heat(step), 1.0);
    let ink = Ink::on_heat(step);
    let failures = Type::new(11.0, ink, At::Middle);
    let failures = if cell.failures > 0 { failures.bold() } else { failures };
    sheet.text(&short_count(cell.failures), middle.x, middle.y - 6.0, failures);
    let of = Type::new(9.0, ink, At::Middle);
    sheet.text(&format!("of {}", short_count(cell.n)), middle.x, middle.y + 7.0, of);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_rise_with_the_share() {
        assert_eq!([0.0, 0.001, 0.01, 0.02, 0.2, 0.21, 1.0].map(step), [0, 1, 1, 2, 3, 4, 4]);
    }
}
