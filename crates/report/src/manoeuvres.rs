//! Sea trials of the vessels, drawn: turning circle, zigzags and crash stop, a row for each vessel.

use crate::axis::Panel;
use crate::canvas::{Area, At, Ink, Pen, Sheet, Type, sheet};
use crate::number::fixed;
use geom::Vec2;

/// The trials of one vessel. What she could not do is empty.
#[derive(Clone, Debug)]
pub struct Trials {
    /// Her name.
    pub name: String,
    /// Length over all, metres.
    pub length_m: f64,
    /// Approach speed, m/s.
    pub approach_mps: f64,
    /// The turning circle, metres north and east; the old course is north.
    pub turn_m: Vec<Vec2>,
    /// Zigzags by 10 and 20 degrees: time, heading and rudder, seconds and degrees.
    pub zigzag: [Vec<[f64; 3]>; 2],
    /// Crash stop: time and speed, seconds and m/s.
    pub stop: Vec<[f64; 2]>,
}

const WIDTH: f64 = 1060.0;
const ROW_HEIGHT: f64 = 250.0;
const PANEL_HEIGHT: f64 = ROW_HEIGHT - 84.0;
const PANEL_WIDTH: f64 = 205.0;

/// A whole SVG document.
pub fn manoeuvres_picture(vessels: &[Trials]) -> String {
    let height = ROW_HEIGHT * vessels.len() as f64 + 8.0;
    sheet(WIDTH, height, "sea trials of the vessels", |sheet| {
        for (row, trials) in vessels.iter().enumerate() {
            draw_row(sheet, ROW_HEIGHT * row as f64, trials);
        }
    })
}

fn draw_row(sheet: &mut Sheet, top: f64, trials: &Trials) {
    let title = format!(
        "{}, {} m, from {} m/s",
        trials.name,
        fixed(Some(trials.length_m), 1),
        fixed(Some(trials.approach_mps), 1)
    );
    sheet.text(&title, 12.0, top + 16.0, Type::new(13.0, Ink::Text, At::Left).bold());
    let area = |column: usize| {
        Area::new(48.0 + 258.0 * column as f64, top + 42.0, PANEL_WIDTH, PANEL_HEIGHT)
    };
    draw_turn(sheet, area(0), trials);
    for (k, history) in trials.zigzag.iter().enumerate() {
        draw_zigzag(sheet, area(1 + k), history, [10.0, 20.0][k]);
    }
    draw_stop(sheet, area(3), trials);
}

fn draw_turn(sheet: &mut Sheet, area: Area, trials: &Trials) {
    head(sheet, area, "turning circle, lengths");
    if trials.turn_m.is_empty() {
        return nothing(sheet, area, "does not come round");
    }
    let lengths = |m: f64| m / trials.length_m;
    let (mut low, mut high) = (Vec2::new(0.0, 0.0), Vec2::new(1.0, 1.0));
    for point in &trials.turn_m {
        low = low.inf(&(point / trials.length_m));
        high = high.sup(&(point / trials.length_m));
    }
    // equal aspect: the wider of both ranges decides
    let room = 0.08 * (high - low).max();
    let per_length = (area.width / (high.y - low.y + 2.0 * room))
        .min(area.height / (high.x - low.x + 2.0 * room));
    let half = Vec2::new(area.height, area.width) / (2.0 * per_length);
    let middle = (low + high) / 2.0;
    let panel = Panel {
        area,
        x: (middle.y - half.y, middle.y + half.y),
        y: (middle.x - half.x, middle.x + half.x),
    };
    panel.x_axis(sheet, 4.0, "across the old course");
    panel.y_axis(sheet, 4.0, "", |_, label| label);
    let track: Vec<(f64, f64)> =
        trials.turn_m.iter().map(|p| (lengths(p.y), lengths(p.x))).collect();
    panel.curve(sheet, &thinned(&track), Pen::new(Ink::Own, 1.8));
    sheet.dot(panel.at(0.0, 0.0), 2.6, Ink::Own);
    panel.frame(sheet);
}

fn draw_zigzag(sheet: &mut Sheet, area: Area, history: &[[f64; 3]], angle_deg: f64) {
    let name = fixed(Some(angle_deg), 0);
    head(sheet, area, &format!("zigzag {name}/{name}, degrees"));
    let Some(&[end_s, ..]) = history.last() else {
        return nothing(sheet, area, "does not answer her rudder");
    };
    let most = history.iter().map(|[_, psi, _]| psi.abs()).fold(angle_deg, f64::max) * 1.15;
    let panel = Panel { area, x: (0.0, end_s), y: (-most, most) };
    panel.x_axis(sheet, 4.0, "seconds");
    panel.y_axis(sheet, 4.0, "", |_, label| label);
    let curve = |value: fn(&[f64; 3]) -> f64| {
        thinned(&history.iter().map(|point| (point[0], value(point))).collect::<Vec<_>>())
    };
    panel.curve(sheet, &curve(|point| point[2]), Pen::new(Ink::Nominal, 1.2).dashed(4.0));
    panel.curve(sheet, &curve(|point| point[1]), Pen::new(Ink::Own, 1.8));
    panel.frame(sheet);
}

fn draw_stop(sheet: &mut Sheet, area: Area, trials: &Trials) {
    head(sheet, area, "crash stop, m/s");
    let Some(&[end_s, _]) = trials.stop.last() else {
        return nothing(sheet, area, "does not stop");
    };
    let panel = Panel { area, x: (0.0, end_s), y: (0.0, trials.approach_mps * 1.08) };
    panel.x_axis(sheet, 4.0, "seconds");
    panel.y_axis(sheet, 4.0, "", |_, label| label);
    let curve: Vec<(f64, f64)> = trials.stop.iter().map(|&[t_s, u]| (t_s, u)).collect();
    panel.curve(sheet, &thinned(&curve), Pen::new(Ink::Own, 1.8));
    panel.frame(sheet);
}

fn head(sheet: &mut Sheet, area: Area, text: &str) {
    sheet.text(text, area.x, area.y - 11.0, Type::new(11.5, Ink::Text, At::Left));
}

fn nothing(sheet: &mut Sheet, area: Area, text: &str) {
    let (x, y) = (area.x + area.width / 2.0, area.y + area.height / 2.0);
    sheet.text(text, x, y, Type::new(12.0, Ink::Muted, At::Middle));
}

/// At most some hundred points: more are below a pixel. Ends and corners of a rudder stay.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let every = points.len().div_ceil(400).max(1);
    let kept = |i: usize| {
        let jumps = |j: usize| (points[j].1 - points[j - 1].1).abs() > 5.0;
        let near = i > 0 && jumps(i) || i + 1 < points.len() && jumps(i + 1);
        i.is_multiple_of(every) || i + 1 == points.len() || near
    };
    (0..points.len()).filter(|&i| kept(i)).map(|i| points[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_vessel_cannot_do_is_said() {
        let trials = Trials {
            name: "raft".to_owned(),
            length_m: 5.0,
            approach_mps: 2.0,
            turn_m: Vec::new(),
            zigzag: [Vec::new(), Vec::new()],
            stop: Vec::new(),
        };
        let picture = manoeuvres_picture(&[trials]);
        for words in ["raft, 5.0 m", "does not come round", "does not answer", "does not stop"] {
            assert!(picture.contains(words), "{words}");
        }
    }

    #[test]
    fn thinning_keeps_the_ends_and_the_jumps() {
        let points: Vec<(f64, f64)> =
            (0..2000).map(|i| (f64::from(i), if i < 1001 { 10.0 } else { -10.0 })).collect();
        let kept = thinned(&points);
        assert!(kept.len() < 500);
        for i in [0, 1000, 1001, 1999] {
            assert!(kept.contains(&points[i]), "{i}");
        }
    }
}
