//! A traffic that was measured, drawn: a map of its tracks with the closest points, and its samples
//! with the fitted laws.

use crate::axis::Panel;
use crate::canvas::{Area, At, Ink, Pen, Sheet, Type, sheet};
use geom::Vec2;

/// What is drawn.
#[derive(Clone, Debug)]
pub struct Traffic {
    /// Name of the file.
    pub name: String,
    /// How many ships there are.
    pub ships: usize,
    /// Tracks, metres north and east; a gap starts a new piece.
    pub tracks: Vec<Vec<Vec2>>,
    /// Where ships were closest.
    pub closest_m: Vec<Vec2>,
    /// Samples, at most six.
    pub samples: Vec<Sample>,
}

/// A sample and its law.
#[derive(Clone, Debug)]
pub struct Sample {
    /// What was measured, with its unit.
    pub name: String,
    /// The values.
    pub values: Vec<f64>,
    /// Values and densities of the law; empty without one.
    pub law: Vec<(f64, f64)>,
    /// What is said of the law.
    pub note: String,
}

const WIDTH: f64 = 1100.0;
const HEIGHT: f64 = 640.0;
const MAP: Area = Area { x: 62.0, y: 64.0, width: 440.0, height: 500.0 };
const CHART: (f64, f64) = (225.0, 118.0);

/// A whole SVG document.
pub fn traffic_picture(traffic: &Traffic) -> String {
    sheet(WIDTH, HEIGHT, "a measured traffic", |sheet| {
        let title = format!(
            "{}: {} ships, {} encounters",
            traffic.name,
            traffic.ships,
            traffic.closest_m.len()
        );
        sheet.text(&title, 12.0, 20.0, Type::new(14.0, Ink::Text, At::Left).bold());
        map(sheet, traffic);
        for (k, sample) in traffic.samples.iter().take(6).enumerate() {
            let (column, row) = ((k % 2) as f64, (k / 2) as f64);
            let area = Area::new(575.0 + 283.0 * column, 64.0 + 197.0 * row, CHART.0, CHART.1);
            chart(sheet, area, sample);
        }
    })
}

/// Equal aspect; the middle nine tenths of all points decide, so that a few ships far away do not
/// make the rest a dot.
fn map(sheet: &mut Sheet, traffic: &Traffic) {
    head(sheet, MAP, "tracks (blue), closest points of encounters (pink); km from the middle", "");
    let all = || traffic.tracks.iter().flatten();
    let (Some(north), Some(east)) = (range(all().map(|p| p.x)), range(all().map(|p| p.y))) else {
        return nothing(sheet, MAP, "no tracks");
    };
    let per_m = (MAP.width / (east.1 - east.0)).min(MAP.height / (north.1 - north.0));
    let half = Vec2::new(MAP.height, MAP.width) / (2.0 * per_m * 1000.0);
    let middle = Vec2::new(north.0 + north.1, east.0 + east.1) / 2000.0;
    let panel = Panel {
        area: MAP,
        x: (middle.y - half.y, middle.y + half.y),
        y: (middle.x - half.x, middle.x + half.x),
    };
    panel.x_axis(sheet, 5.0, "km east");
    panel.y_axis(sheet, 6.0, "", |_, label| label);
    for track in &traffic.tracks {
        let points: Vec<(f64, f64)> = track.iter().map(|p| (p.y / 1e3, p.x / 1e3)).collect();
        panel.curve(sheet, &points, Pen::new(Ink::Own, 0.8).faint(0.6));
    }
    for at in &traffic.closest_m {
        let at = panel.at(at.y / 1e3, at.x / 1e3);
        if MAP.contains(at) {
            sheet.dot(at, 2.8, Ink::Target);
        }
    }
    panel.frame(sheet);
}

/// The middle 98 % of the values, and some room.
fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)? as f64;
    let at = |share: f64| sorted[(share * last).round() as usize];
    let (low, high) = (at(0.01), at(0.99));
    let room = (0.05 * (high - low)).max(50.0);
    Some((low - room, high + room))
}

fn chart(sheet: &mut Sheet, area: Area, sample: &Sample) {
    head(sheet, area, &format!("{}, n = {}", sample.name, sample.values.len()), &sample.note);
    let low = sample.values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = sample.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if sample.values.len() < 2 || low >= high {
        return nothing(sheet, area, "nothing to draw");
    }
    let bars = bars(&sample.values, low, high);
    let width = (high - low) / bars.len() as f64;
    let highest = bars.iter().chain(sample.law.iter().map(|(_, y)| y)).copied().fold(0.0, f64::max);
    let panel = Panel { area, x: (low, high), y: (0.0, 1.1 * highest) };
    panel.x_axis(sheet, 4.0, "");
    for (k, density) in bars.iter().enumerate() {
        let (from, to) = (low + width * k as f64, low + width * (k + 1) as f64);
        let top = panel.at(from, *density);
        let bar = Area::new(top.x, top.y, panel.px(to) - top.x - 0.8, area.bottom() - top.y);
        sheet.fill(&bar, Ink::Own, 0.45);
    }
    panel.curve(sheet, &sample.law, Pen::new(Ink::Target, 2.0));
    panel.frame(sheet);
}

/// Densities of equal classes, about the root of the sample's size.
fn bars(values: &[f64], low: f64, high: f64) -> Vec<f64> {
    let count = ((values.len() as f64).sqrt().ceil() as usize).clamp(5, 40);
    let width = (high - low) / count as f64;
    let mut bars = vec![0.0; count];
    for value in values {
        let k = (((value - low) / width) as usize).min(count - 1);
        bars[k] += 1.0 / (values.len() as f64 * width);
    }
    bars
}

fn head(sheet: &mut Sheet, area: Area, text: &str, note: &str) {
    let lift = if note.is_empty() { 11.0 } else { 25.0 };
    sheet.text(text, area.x, area.y - lift, Type::new(11.5, Ink::Text, At::Left));
    if !note.is_empty() {
        sheet.text(note, area.x, area.y - 10.0, Type::new(10.5, Ink::Muted, At::Left));
    }
}

fn nothing(sheet: &mut Sheet, area: Area, text: &str) {
    let (x, y) = (area.x + area.width / 2.0, area.y + area.height / 2.0);
    sheet.text(text, x, y, Type::new(12.0, Ink::Muted, At::Middle));
    sheet.frame(&area, Pen::new(Ink::Muted, 1.0));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_a_density() {
        let values: Vec<f64> = (0..100).map(f64::from).collect();
        let bars = bars(&values, 0.0, 99.0);
        assert_eq!(bars.len(), 10);
        let whole: f64 = bars.iter().map(|bar| bar * 9.9).sum();
        assert!((whole - 1.0).abs() < 1e-12, "{whole}");
    }

    #[test]
    fn what_is_not_there_is_said() {
        let sample = Sample {
            name: "length, m".to_owned(),
            values: Vec::new(),
            law: Vec::new(),
            note: "not in this file".to_owned(),
        };
        let traffic = Traffic {
            name: "a.csv".to_owned(),
            ships: 0,
            tracks: Vec::new(),
            closest_m: Vec::new(),
            samples: vec![sample],
        };
        let picture = traffic_picture(&traffic);
        for words in ["a.csv: 0 ships", "no tracks", "not in this file", "nothing to draw"] {
            assert!(picture.contains(words), "{words}");
        }
    }
}
