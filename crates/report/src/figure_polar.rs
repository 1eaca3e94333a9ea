//! Failures and collisions around the compass, bow up.

use crate::canvas::{Area, At, Ink, Pen, Sheet, Type, sheet};
use crate::figure::{DataTable, Figure};
use crate::figure_map::{draw_key, step};
use crate::number::{count, fixed, per_cent_or_none, short_count};
use crate::weighted::{of_draws, part_bounds};
use geom::units::deg;
use geom::{Vec2, angle};
use summary::{BEARING_SECTORS, BoundedRate, CellKey, Tally};

const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 500.0;
const RADIUS: f64 = 205.0;
const HOLE: f64 = 62.0;
const HALF_SECTOR_DEG: f64 = 180.0 / BEARING_SECTORS as f64;

/// The polar maps of all runs; of weighted ones without bounds.
pub(crate) fn figure(tally: &Tally, weighted: bool) -> Figure {
    let sectors = sectors(tally);
    let n: u64 = sectors.iter().map(|sector| sector.n).sum();
    let mut table = DataTable::new(&[
        "relative bearing, deg",
        "n",
        "failures",
        "rate",
        "95 % bounds",
        "collisions",
        "rate",
        "95 % bounds",
    ]);
    for sector in sectors.iter().filter(|sector| sector.n > 0) {
        let mut row = vec![
            format!("{} ± {HALF_SECTOR_DEG}", fixed(Some(sector.bearing_deg), 0)),
            count(sector.n),
        ];
        for k in [sector.failures, sector.collisions] {
            let rate = BoundedRate::new(k, 0, sector.n);
            row.push(count(k));
            row.push(per_cent_or_none(rate.rate));
            row.push(part_bounds(&rate, weighted));
        }
        table.push(row);
    }
    Figure {
        stem: "polar".to_owned(),
        title: "Failures around the compass".to_owned(),
        caption: format!(
            "By the first target's relative bearing at the start, bow up, sectors of 15 degrees. \
             Left: failures (collision, broken safety radius, unknown outcome); right: collisions \
             alone. Large: how many; small: of how many encounters. n = {} in {} of {} sectors; \
             empty sectors had no encounter. Dashed: 22.5 degrees abaft the beam (Rule 13).{}",
            count(n),
            table.rows.len(),
            BEARING_SECTORS,
            of_draws(weighted),
        ),
        svg: (n > 0).then(|| draw(&sectors)),
        table,
    }
}

#[derive(Clone, Copy, Default)]
struct Sector {
    bearing_deg: f64,
    n: u64,
    failures: u64,
    collisions: u64,
}

fn sectors(tally: &Tally) -> Vec<Sector> {
    let mut sectors: Vec<Sector> = (0..BEARING_SECTORS)
        .map(|sector| {
            let bearing_deg = CellKey { sector, band: 0 }.bearing_deg();
            Sector { bearing_deg, ..Sector::default() }
        })
        .collect();
    for (key, cell) in tally.map.cells() {
        let sector = &mut sectors[usize::from(key.sector)];
        sector.n += cell.n;
        sector.failures += cell.failures;
        sector.collisions += cell.collisions;
    }
    sectors
}

fn draw(sectors: &[Sector]) -> String {
    sheet(WIDTH, HEIGHT, "failures around the compass", |sheet| {
        draw_key(sheet);
        let titles = ["failures", "collisions"];
        let counts: [fn(&Sector) -> u64; 2] = [|s| s.failures, |s| s.collisions];
        for (i, (title, k)) in titles.into_iter().zip(counts).enumerate() {
            let centre = Vec2::new(WIDTH * (0.25 + 0.5 * i as f64), 272.0);
            rose(sheet, centre, sectors, k);
            let at = Type::new(12.0, Ink::Text, At::Middle).bold();
            sheet.text(title, centre.x, centre.y + 30.0, at);
        }
    })
}

fn rose(sheet: &mut Sheet, centre: Vec2, sectors: &[Sector], k: fn(&Sector) -> u64) {
    let all = Area::new(0.0, 0.0, WIDTH, HEIGHT);
    // North-east to the sheet: up is the bow, right is starboard.
    let at = |bearing_deg: f64, radius: f64| {
        let unit = angle::unit(deg(bearing_deg));
        centre + Vec2::new(unit.y, -unit.x) * radius
    };
    for sector in sectors {
        let from = sector.bearing_deg - HALF_SECTOR_DEG;
        let arc = |radius: f64| (0..=5).map(move |i| (from + 3.0 * f64::from(i), radius));
        let mut outline: Vec<Vec2> =
            arc(RADIUS).chain(arc(HOLE).rev()).map(|(bearing, r)| at(bearing, r)).collect();
        outline.push(outline[0]);
        if sector.n > 0 {
            let step = step(k(sector) as f64 / sector.n as f64);
            sheet.clipped_polygon(&all, &outline, Ink::Heat(step), 1.0);
            let ink = Ink::on_heat(step);
            let middle = at(sector.bearing_deg, 0.82 * RADIUS);
            let number = Type::new(12.0, ink, At::Middle);
            let number = if k(sector) > 0 { number.bold() } else { number };
            sheet.text(&short_count(k(sector)), middle.x, middle.y - 6.0, number);
            let of = format!("of {}", short_count(sector.n));
            sheet.text(&of, middle.x, middle.y + 7.0, Type::new(9.0, ink, At::Middle));
        }
        sheet.path(&outline, Pen::new(Ink::Paper, 1.5));
    }
    for bearing in [-112.5, 112.5] {
        let line = [at(bearing, HOLE), at(bearing, RADIUS + 8.0)];
        sheet.path(&line, Pen::new(Ink::Text, 1.2).dashed(4.0));
    }
    for bearing in [0.0, 90.0, 180.0, -90.0] {
        let p = at(bearing, RADIUS + 14.0);
        let label = format!("{}°", fixed(Some(bearing), 0));
        sheet.text(&label, p.x, p.y, Type::new(11.0, Ink::Muted, At::Middle));
    }
    let hull = geom::HullOutline::centred(40.0, 16.0).corners_m(Vec2::zeros(), 0.0);
    let hull: Vec<Vec2> = hull.iter().map(|c| centre + Vec2::new(c.y, -c.x)).collect();
    sheet.clipped_polygon(&all, &hull, Ink::Own, 0.9);
}
