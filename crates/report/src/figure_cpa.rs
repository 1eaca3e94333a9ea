//! Smallest hull-to-hull distance of each stratum.

use crate::axis::{Panel, round_step};
use crate::canvas::{Area, At, Ink, Pen, Sheet, Type, sheet};
use crate::figure::{DataTable, Figure};
use crate::group::Group;
use crate::number::{count, fixed, short_count, shortened};
use record::DistanceKind;

const WIDTH: f64 = 900.0;
const LEFT: f64 = 150.0;
const RIGHT: f64 = 110.0;
const TOP: f64 = 30.0;
const ROW: f64 = 58.0;

/// One row of bars for each group.
pub(crate) fn figure(groups: &[Group], safety_radius_m: f64, distance: DistanceKind) -> Figure {
    let known: u64 = groups.iter().map(|group| group.tally.cpa_hull_m.n()).sum();
    let unknown: u64 = groups.iter().map(|group| group.tally.cpa_unknown).sum();
    let span = Span::of(groups, safety_radius_m);
    let marked = match distance {
        DistanceKind::Hull => "the dashed line is the safety radius",
        DistanceKind::Centre => {
            "the safety radius of this campaign is between reference points and has no line here"
        }
    };
    Figure {
        stem: "cpa".to_owned(),
        title: "Smallest distance".to_owned(),
        caption: format!(
            "Smallest distance between the hulls in each run, n = {}; {} more runs of unknown \
             distance are not drawn. Bars of {} m, each row to its own scale; {marked}; \
             the bar at 0 is contact. {} runs lie beyond the right end.",
            count(known),
            count(unknown),
            fixed(Some(span.bin_m), span.decimals()),
            count(groups.iter().map(|group| span.beyond(group)).sum()),
        ),
        svg: (known > 0).then(|| draw(groups, &span, safety_radius_m, distance)),
        table: table(groups),
    }
}

fn table(groups: &[Group]) -> DataTable {
    let mut table = DataTable::new(&[
        "stratum",
        "n",
        "distance unknown",
        "contact",
        "1 % below, m",
        "5 % below, m",
        "half below, m",
        "95 % below, m",
    ]);
    for Group { name, tally, summary } in groups {
        table.push(vec![
            name.clone(),
            count(tally.n),
            count(tally.cpa_unknown),
            count(tally.collisions),
            fixed(summary.min_cpa_m.p01, 1),
            fixed(summary.min_cpa_m.p05, 1),
            fixed(summary.min_cpa_m.median, 1),
            fixed(tally.cpa_quantile_m(950), 1),
        ]);
    }
    table
}

/// The distances that are shown, and how wide a bar is.
struct Span {
    end_m: f64,
    bin_m: f64,
}

/// Bars over the whole width, about.
const BARS: f64 = 90.0;

impl Span {
    /// Up to what 99 in 100 runs of every group keep below, and past the safety radius.
    fn of(groups: &[Group], safety_radius_m: f64) -> Self {
        let end_m = groups
            .iter()
            .filter_map(|group| group.tally.cpa_hull_m.quantile_permille(990).number())
            .fold(1.25 * safety_radius_m, f64::max);
        let bin_m = round_step(end_m, BARS).max(0.1);
        Self { end_m: (end_m / bin_m).ceil().max(1.0) * bin_m, bin_m }
    }

    fn decimals(&self) -> usize {
        usize::from(self.bin_m < 1.0)
    }

    fn beyond(&self, group: &Group) -> u64 {
        let histogram = &group.tally.cpa_hull_m;
        let inside: u64 = histogram
            .occupied()
            .filter(|(edge, _)| *edge < self.end_m - 1e-6)
            .map(|(_, k)| k)
            .sum();
        histogram.n() - inside
    }

    /// Counts of the bars. Contact (the distance 0) is kept apart and comes first.
    fn bars(&self, group: &Group) -> (u64, Vec<u64>) {
        let mut bars = vec![0; (self.end_m / self.bin_m).round() as usize];
        for (edge, k) in group.tally.cpa_hull_m.occupied() {
            // Edges are decimal: a small lift keeps 0.3 / 0.1 from falling into the bar before.
            if let Some(bar) = bars.get_mut((edge / self.bin_m + 1e-6).floor() as usize) {
                *bar += k;
            }
        }
        let contact = group.tally.collisions.min(bars.first().copied().unwrap_or(0));
        if let Some(first) = bars.first_mut() {
            *first -= contact;
        }
        (contact, bars)
    }
}

fn draw(groups: &[Group], span: &Span, radius_m: f64, distance: DistanceKind) -> String {
    let height = TOP + ROW * groups.len() as f64 + 44.0;
    let all = Area::new(LEFT, TOP, WIDTH - LEFT - RIGHT, ROW * groups.len() as f64);
    let panel = Panel { area: all, x: (0.0, span.end_m), y: (0.0, 1.0) };
    sheet(WIDTH, height, "smallest hull-to-hull distance of each stratum", |sheet| {
        panel.x_axis(sheet, 8.0, "smallest distance between the hulls, m");
        for (i, group) in groups.iter().enumerate() {
            draw_row(sheet, &panel, span, group, TOP + ROW * i as f64, radius_m);
        }
        if distance == DistanceKind::Hull {
            let x = panel.px(radius_m);
            sheet.line((x, TOP - 4.0), (x, all.bottom()), Pen::new(Ink::Text, 1.2).dashed(4.0));
            let label = format!("safety radius {} m", fixed(Some(radius_m), 0));
            sheet.text(&label, x, TOP - 13.0, Type::new(11.0, Ink::Text, At::Middle));
        }
        sheet.text("half below", WIDTH - 12.0, TOP - 13.0, Type::new(11.0, Ink::Muted, At::Right));
    })
}

fn draw_row(sheet: &mut Sheet, panel: &Panel, span: &Span, group: &Group, top: f64, radius_m: f64) {
    let base = top + ROW;
    let (contact, bars) = span.bars(group);
    let highest = bars.iter().copied().fold(contact, u64::max).max(1) as f64;
    let scale = (ROW - 12.0) / highest;
    for (bin, &k) in bars.iter().enumerate() {
        let (from, to) = (bin as f64 * span.bin_m, (bin + 1) as f64 * span.bin_m);
        let ink = if to <= radius_m + 1e-9 { Ink::Warn } else { Ink::Good };
        let (x, height) = (panel.px(from), k as f64 * scale);
        // A bar of few runs among many must still be seen.
        let height = if k > 0 { height.max(1.5) } else { 0.0 };
        let width = panel.px(to) - x - 1.0;
        sheet.fill(&Area::new(x + 0.5, base - height, width, height), ink, 1.0);
    }
    if contact > 0 {
        let height = (contact as f64 * scale).max(3.0);
        sheet.fill(&Area::new(panel.area.x - 7.0, base - height, 6.0, height), Ink::Fail, 1.0);
        let label = short_count(contact);
        let look = Type::new(11.0, Ink::Fail, At::Right).bold();
        sheet.text(&label, panel.area.x - 10.0, base - 7.0, look);
    }
    sheet.line((panel.area.x - 8.0, base), (panel.area.right(), base), Pen::new(Ink::Muted, 1.0));
    let name = Type::new(12.0, Ink::Text, At::Left);
    sheet.text(&shortened(&group.name, 20), 8.0, base - ROW / 2.0 - 6.0, name);
    let small = Type::new(11.0, Ink::Muted, At::Left);
    sheet.text(&format!("n = {}", count(group.tally.n)), 8.0, base - ROW / 2.0 + 9.0, small);
    let median = fixed(group.summary.min_cpa_m.median, 1);
    let look = Type::new(12.0, Ink::Text, At::Right);
    sheet.text(&format!("{median} m"), WIDTH - 12.0, base - ROW / 2.0, look);
}
