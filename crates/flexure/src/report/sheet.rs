//! The page of a figure: title, one legend for all panels, and the SVG text.

use kuva::backend::svg::SvgBackend;
use kuva::render::render::{Primitive, Scene, TextAnchor};

use crate::report::style::{FONT, INK, MUTED, Stroke};

/// A figure being drawn, in pixels.
pub(super) struct Sheet {
    pub scene: Scene,
}

impl Sheet {
    /// An empty white page with its title and subtitle (either may be empty).
    pub(super) fn new(width: f64, height: f64, title: &str, subtitle: &str) -> Self {
        let mut scene = Scene::new(width, height);
        scene.font_family = Some(FONT.to_owned());
        scene.text_color = Some(INK.to_owned());
        let mut sheet = Self { scene };
        sheet.fitted_text(30.0, title, 21, INK, true);
        sheet.fitted_text(52.0, subtitle, 14, MUTED, false);
        sheet
    }

    /// A line of text starting at `x`.
    pub(super) fn text(&mut self, (x, y): (f64, f64), content: &str, size: u32, color: &str, bold: bool) {
        self.scene.add(Primitive::Text {
            x,
            y,
            content: plain(content),
            size,
            anchor: TextAnchor::Start,
            rotate: None,
            bold,
            color: Some(color.into()),
        });
    }

    /// A legend in rows from `y` down: each entry a piece of its line and its name. Returns the height of the rows.
    pub(super) fn legend(&mut self, y: f64, entries: &[(String, Stroke)]) -> f64 {
        const SAMPLE: f64 = 26.0;
        const ROW: f64 = 22.0;
        let (mut x, mut row) = (MARGIN, 0.0);
        for (name, stroke) in entries {
            let advance = SAMPLE + 6.0 + text_width(name, 14) + 14.0;
            if x > MARGIN && x + advance > self.scene.width {
                (x, row) = (MARGIN, row + ROW);
            }
            self.scene.add(Primitive::Line {
                x1: x,
                y1: y + row - 4.5,
                x2: x + SAMPLE,
                y2: y + row - 4.5,
                stroke: stroke.color.into(),
                stroke_width: stroke.width.max(1.8),
                stroke_dasharray: stroke.dasharray(1.0),
            });
            self.text((x + SAMPLE + 6.0, y + row), name, 14, INK, false);
            x += advance;
        }
        row + ROW
    }

    /// The SVG, scalable to any width.
    pub(super) fn finish(self) -> String {
        let (width, height) = (self.scene.width, self.scene.height);
        let svg = SvgBackend::new().render_scene(&self.scene);
        svg.replacen("<svg ", &format!("<svg viewBox=\"0 0 {width} {height}\" role=\"img\" "), 1)
    }

    /// Text that shrinks until it fits the page: titles come from users.
    fn fitted_text(&mut self, y: f64, content: &str, size: u32, color: &str, bold: bool) {
        let room = self.scene.width - 2.0 * MARGIN;
        let size = (9..=size).rev().find(|&size| text_width(content, size) <= room).unwrap_or(9);
        if !content.is_empty() {
            self.text((MARGIN, y), content, size, color, bold);
        }
    }
}

/// White border on the left and the right.
pub(super) const MARGIN: f64 = 24.0;

/// Room for a text, a little more than DejaVu Sans takes.
pub(super) fn text_width(content: &str, size: u32) -> f64 {
    0.59 * f64::from(size) * content.chars().count() as f64
}

/// kuva reads `$…$` as mathematics, and XML has no control characters.
fn plain(content: &str) -> String {
    content.chars().filter(|c| !c.is_control()).collect::<String>().replace('$', "\\$")
}
