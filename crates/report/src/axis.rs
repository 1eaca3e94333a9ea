//! Axes: round ticks, a panel with labels, values to pixels.

use crate::canvas::{Area, At, Ink, Pen, Sheet, Type};
use geom::Vec2;

/// Steps of 1, 2 or 5 times a power of ten, so that about `wanted` of them cover the range. With
/// plain multiplication only: a logarithm's last bit could move a tick.
pub(crate) fn round_step(range: f64, wanted: f64) -> f64 {
    let rough = (range / wanted).max(1e-9);
    let mut power = 1.0;
    while power > rough {
        power /= 10.0;
    }
    while power * 10.0 <= rough {
        power *= 10.0;
    }
    [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|&s| s >= rough).unwrap_or(power)
}

/// The ticks from `low` to `high`, with their labels.
pub(crate) fn ticks(low: f64, high: f64, wanted: f64) -> Vec<(f64, String)> {
    ticks_every(low, high, round_step(high - low, wanted))
}

fn ticks_every(low: f64, high: f64, step: f64) -> Vec<(f64, String)> {
    let decimals = if step >= 1.0 {
        0
    } else if step >= 0.1 {
        1
    } else if step >= 0.01 {
        2
    } else {
        4
    };
    let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
    (first..=last)
        .map(|i| {
            let value = i as f64 * step;
            (value, crate::number::fixed(Some(value), decimals))
        })
        .collect()
}

/// A rectangle with two linear axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Panel {
    pub(crate) area: Area,
    pub(crate) x: (f64, f64),
    pub(crate) y: (f64, f64),
}

const LABEL: f64 = 11.0;

impl Panel {
    pub(crate) fn px(&self, x: f64) -> f64 {
        self.area.x + (x - self.x.0) / (self.x.1 - self.x.0) * self.area.width
    }

    pub(crate) fn py(&self, y: f64) -> f64 {
        self.area.bottom() - (y - self.y.0) / (self.y.1 - self.y.0) * self.area.height
    }

    pub(crate) fn at(&self, x: f64, y: f64) -> Vec2 {
        Vec2::new(self.px(x), self.py(y))
    }

    /// Vertical grid lines with labels below.
    pub(crate) fn x_axis(&self, sheet: &mut Sheet, wanted: f64, title: &str) {
        for (value, label) in ticks(self.x.0, self.x.1, wanted) {
            let x = self.px(value);
            sheet.line((x, self.area.y), (x, self.area.bottom()), Pen::new(Ink::Grid, 1.0));
            let look = Type::new(LABEL, Ink::Muted, At::Middle);
            sheet.text(&label, x, self.area.bottom() + 11.0, look);
        }
        if !title.is_empty() {
            let middle = self.area.x + self.area.width / 2.0;
            let look = Type::new(LABEL, Ink::Text, At::Middle);
            sheet.text(title, middle, self.area.bottom() + 27.0, look);
        }
    }

    /// Horizontal grid lines with labels on the left; `word` writes a value.
    pub(crate) fn y_axis(
        &self,
        sheet: &mut Sheet,
        wanted: f64,
        title: &str,
        word: impl Fn(f64, String) -> String,
    ) {
        for (value, label) in ticks(self.y.0, self.y.1, wanted) {
            self.y_tick(sheet, value, &word(value, label));
        }
        if !title.is_empty() {
            let look = Type::new(LABEL, Ink::Text, At::Left).bold();
            sheet.text(title, self.area.x, self.area.y - 9.0, look);
        }
    }

    pub(crate) fn y_tick(&self, sheet: &mut Sheet, value: f64, label: &str) {
        let y = self.py(value);
        sheet.line((self.area.x, y), (self.area.right(), y), Pen::new(Ink::Grid, 1.0));
        sheet.text(label, self.area.x - 6.0, y, Type::new(LABEL, Ink::Muted, At::Right));
    }

    pub(crate) fn frame(&self, sheet: &mut Sheet) {
        sheet.frame(&self.area, Pen::new(Ink::Muted, 1.0));
    }

    /// A line through values, cut at the panel's border.
    pub(crate) fn curve(&self, sheet: &mut Sheet, points: &[(f64, f64)], pen: Pen) {
        let points: Vec<Vec2> = points.iter().map(|&(x, y)| self.at(x, y)).collect();
        sheet.clipped_path(&self.area, &points, pen);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_enough() {
        for (range, wanted, step) in
            [(1.0, 5.0, 0.2), (730.0, 6.0, 200.0), (0.003, 4.0, 0.001), (10.0, 10.0, 1.0)]
        {
            assert!((round_step(range, wanted) - step).abs() < 1e-12, "{range}");
        }
    }

    #[test]
    fn ticks_lie_inside() {
        let labels: Vec<String> = ticks(-0.5, 1.0, 3.0).into_iter().map(|t| t.1).collect();
        assert_eq!(labels, ["\u{2212}0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(ticks(90.0, 270.0, 4.0).len(), 4);
    }
}
