//! A sheet to draw on: plotters' SVG backend with fractions of a pixel.
//!
//! plotters rounds to whole pixels, clamps at the border and has neither equal aspect nor a theme.
//! So everything is drawn ten times as large and shown at its size by the view box, what leaves a
//! panel is clipped here, and every colour is one of [`Ink`], which the page replaces by variables
//! of its style sheet (a figure on its own keeps the light colours). Text stays text.

use crate::clip::{clip_path, clip_polygon, dashes};
use crate::font;
use crate::simplify::{TOLERANCE_PX, simplify};
use geom::Vec2;
use plotters::prelude::{DrawingBackend, FontStyle, RGBColor, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontDesc, FontFamily, ShapeStyle, TextStyle};

/// Units of the SVG in one pixel of the sheet.
const SCALE: f64 = 10.0;

/// The colours of every figure. Their values are different, so that a theme can tell them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ink {
    Paper,
    Text,
    Muted,
    Grid,
    /// Own ship, blue.
    Own,
    /// Targets, pink.
    Target,
    /// Broken.
    Fail,
    /// Too close.
    Warn,
    /// Kept.
    Good,
    /// Where own ship would have gone.
    Nominal,
    /// Steps of a scale from few to many, 0 to 4; the same in every theme.
    Heat(u8),
    /// Text on the scale.
    OnHeat(bool),
}

impl Ink {
    /// Those that a theme replaces, with the names of the variables.
    pub(crate) const THEMED: [(Self, &str); 11] = [
        (Self::Paper, "--paper"),
        (Self::Text, "--text"),
        (Self::Muted, "--muted"),
        (Self::Grid, "--grid"),
        (Self::Own, "--own"),
        (Self::Target, "--target"),
        (Self::Fail, "--fail"),
        (Self::Warn, "--warn"),
        (Self::Good, "--good"),
        (Self::Nominal, "--nominal"),
        (Self::Heat(0), "--none"),
    ];

    /// The colour of words on a step of the scale of shares; on the first, which has the theme's
    /// colour, the theme's.
    pub(crate) const fn on_heat(step: u8) -> Self {
        match step {
            0 => Self::Text,
            step => Self::OnHeat(step >= 3),
        }
    }

    pub(crate) const fn rgb(self) -> (u8, u8, u8) {
        match self {
            Self::Paper => (0xff, 0xff, 0xff),
            Self::Text => (0x1b, 0x1f, 0x24),
            Self::Muted => (0x57, 0x60, 0x6a),
            Self::Grid => (0xdd, 0xe2, 0xe8),
            Self::Own => (0x1f, 0x5f, 0xbf),
            Self::Target => (0xd6, 0x33, 0x84),
            Self::Fail => (0xb4, 0x23, 0x18),
            Self::Warn => (0xc7, 0x7a, 0x0a),
            Self::Good => (0x3b, 0x7d, 0x6e),
            Self::Nominal => (0x8b, 0x95, 0xa1),
            Self::Heat(0) => (0xe8, 0xf0, 0xf7),
            Self::Heat(1) => (0xfd, 0xe0, 0xa6),
            Self::Heat(2) => (0xf7, 0xa4, 0x5a),
            Self::Heat(3) => (0xdc, 0x5b, 0x3a),
            Self::Heat(_) => (0x8c, 0x1d, 0x2c),
            Self::OnHeat(false) => (0x1b, 0x1f, 0x23),
            Self::OnHeat(true) => (0xff, 0xff, 0xfe),
        }
    }

    pub(crate) fn hex(self) -> String {
        let (r, g, b) = self.rgb();
        format!("#{r:02X}{g:02X}{b:02X}")
    }

    fn style(self, opacity: f64, width_px: f64) -> ShapeStyle {
        let (r, g, b) = self.rgb();
        ShapeStyle {
            color: RGBColor(r, g, b).mix(opacity),
            filled: true,
            stroke_width: (width_px * SCALE).round() as u32,
        }
    }
}

/// A line: colour, width in pixels, opacity, and dashes in pixels (0: solid).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pen {
    pub(crate) ink: Ink,
    pub(crate) width: f64,
    pub(crate) opacity: f64,
    pub(crate) dash: f64,
}

impl Pen {
    pub(crate) const fn new(ink: Ink, width: f64) -> Self {
        Self { ink, width, opacity: 1.0, dash: 0.0 }
    }

    pub(crate) const fn dashed(self, dash: f64) -> Self {
        Self { dash, ..self }
    }

    pub(crate) const fn faint(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

/// Where a text stands from its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum At {
    Left,
    Middle,
    Right,
}

/// How a text looks. The point is at half its height.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Type {
    pub(crate) size: f64,
    pub(crate) ink: Ink,
    pub(crate) at: At,
    pub(crate) bold: bool,
}

impl Type {
    pub(crate) const fn new(size: f64, ink: Ink, at: At) -> Self {
        Self { size, ink, at, bold: false }
    }

    pub(crate) const fn bold(self) -> Self {
        Self { bold: true, ..self }
    }
}

/// A rectangle on the sheet, pixels from its upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Area {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Area {
    pub(crate) const fn new(x: f64, y: f64, width: f64, height: f64) -> Self {
        Self { x, y, width, height }
    }

    pub(crate) fn right(&self) -> f64 {
        self.x + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.y + self.height
    }

    pub(crate) fn contains(&self, p: Vec2) -> bool {
        p.x >= self.x && p.x <= self.right() && p.y >= self.y && p.y <= self.bottom()
    }
}

/// Draws a sheet. The result is a whole SVG document with its fonts inside.
pub(crate) fn sheet(width: f64, height: f64, label: &str, draw: impl FnOnce(&mut Sheet)) -> String {
    let mut text = String::new();
    let size = ((width * SCALE).round() as u32, (height * SCALE).round() as u32);
    {
        let mut sheet = Sheet { backend: SVGBackend::with_string(&mut text, size) };
        sheet.fill(&Area::new(0.0, 0.0, width, height), Ink::Paper, 1.0);
        draw(&mut sheet);
        sheet.backend.present().expect(IN_MEMORY);
    }
    let body = text.split_once('\n').map_or("", |(_, body)| body);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n<style>{}</style>\n{body}",
        size.0,
        size.1,
        escape(label),
        font::face_css(),
    )
}

/// Width of a text in pixels, roughly: enough to keep labels apart.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    text.chars()
        .map(|c| match c {
            'i' | 'l' | 'j' | '.' | ',' | ' ' | ':' | ';' | '\'' | '|' | '/' | '(' | ')' => 0.28,
            'm' | 'w' | 'M' | 'W' | '%' | '@' => 0.86,
            'A'..='Z' => 0.66,
            _ => 0.56,
        })
        .sum::<f64>()
        * size
}

const IN_MEMORY: &str = "drawing into a text in memory cannot fail";

pub(crate) struct Sheet<'a> {
    backend: SVGBackend<'a>,
}

impl Sheet<'_> {
    pub(crate) fn fill(&mut self, area: &Area, ink: Ink, opacity: f64) {
        if area.width <= 0.0 || area.height <= 0.0 {
            return;
        }
        let (from, to) = (px(area.x, area.y), px(area.right(), area.bottom()));
        let style = ink.style(opacity, 0.0);
        self.backend.draw_rect(from, to, &style, true).expect(IN_MEMORY);
    }

    pub(crate) fn frame(&mut self, area: &Area, pen: Pen) {
        let (l, t, r, b) = (area.x, area.y, area.right(), area.bottom());
        let corners = [(l, t), (r, t), (r, b), (l, b), (l, t)].map(|(x, y)| Vec2::new(x, y));
        self.path(&corners, pen);
    }

    pub(crate) fn line(&mut self, from: (f64, f64), to: (f64, f64), pen: Pen) {
        self.path(&[Vec2::new(from.0, from.1), Vec2::new(to.0, to.1)], pen);
    }

    pub(crate) fn path(&mut self, points: &[Vec2], pen: Pen) {
        if points.len() < 2 {
            return;
        }
        let style = pen.ink.style(pen.opacity, pen.width);
        let points = simplify(points, TOLERANCE_PX);
        if pen.dash > 0.0 {
            for piece in dashes(&points, pen.dash) {
                let piece = piece.iter().map(|p| px(p.x, p.y)).collect::<Vec<_>>();
                self.backend.draw_path(piece, &style).expect(IN_MEMORY);
            }
        } else {
            let points = points.iter().map(|p| px(p.x, p.y)).collect::<Vec<_>>();
            self.backend.draw_path(points, &style).expect(IN_MEMORY);
        }
    }

    /// A path of which only what lies inside the area is drawn.
    pub(crate) fn clipped_path(&mut self, area: &Area, points: &[Vec2], pen: Pen) {
        for piece in clip_path(area, points) {
            self.path(&piece, pen);
        }
    }

    /// A polygon of which only what lies inside the area is filled.
    pub(crate) fn clipped_polygon(&mut self, area: &Area, points: &[Vec2], ink: Ink, opacity: f64) {
        let points = clip_polygon(area, points);
        if points.len() > 2 {
            let points = points.iter().map(|p| px(p.x, p.y)).collect::<Vec<_>>();
            self.backend.fill_polygon(points, &ink.style(opacity, 0.0)).expect(IN_MEMORY);
        }
    }

    pub(crate) fn dot(&mut self, at: Vec2, radius: f64, ink: Ink) {
        let style = ink.style(1.0, 0.0);
        let radius = (radius * SCALE).round() as u32;
        self.backend.draw_circle(px(at.x, at.y), radius, &style, true).expect(IN_MEMORY);
    }

    pub(crate) fn text(&mut self, text: &str, x: f64, y: f64, look: Type) {
        let (r, g, b) = look.ink.rgb();
        // plotters divides the size by 1.24 on its way into the SVG.
        let size = look.size * SCALE * 1.24;
        let style = if look.bold { FontStyle::Bold } else { FontStyle::Normal };
        let font = FontDesc::new(FontFamily::Name(font::STACK), size, style);
        let anchor = match look.at {
            At::Left => HPos::Left,
            At::Middle => HPos::Center,
            At::Right => HPos::Right,
        };
        let color = RGBColor(r, g, b);
        let style = TextStyle::from(font).color(&color).pos(Pos::new(anchor, VPos::Center));
        self.backend.draw_text(text, &style, px(x, y)).expect(IN_MEMORY);
    }
}

fn px(x: f64, y: f64) -> (i32, i32) {
    ((x * SCALE).round() as i32, (y * SCALE).round() as i32)
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheet_has_its_size_its_fonts_and_escaped_text() {
        let svg = sheet(120.0, 40.0, "a < b", |sheet| {
            sheet.text("x & y", 3.0, 3.0, Type::new(11.0, Ink::Text, At::Left));
        });
        assert!(svg.starts_with("<svg xmlns"));
        assert!(svg.contains("width=\"120\" height=\"40\" viewBox=\"0 0 1200 400\""));
        assert!(svg.contains("aria-label=\"a &lt; b\""));
        assert!(svg.contains("x &amp; y") && svg.contains("font-size=\"110\""));
        assert!(svg.contains("@font-face") && svg.trim_end().ends_with("</svg>"));
    }

    #[test]
    fn themed_colours_are_different() {
        let mut seen: Vec<String> = Ink::THEMED.iter().map(|(ink, _)| ink.hex()).collect();
        seen.extend((1..5).map(|step| Ink::Heat(step).hex()));
        seen.extend([Ink::OnHeat(false).hex(), Ink::OnHeat(true).hex()]);
        let count = seen.len();
        seen.sort();
        seen.dedup();
        assert_eq!(seen.len(), count);
    }
}
