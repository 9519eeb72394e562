//! Lines of text as outlines of the fonts that this crate carries: the same on a machine without fonts.

use std::sync::LazyLock;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

use super::scene::{Anchor, Lettering, Text};

static REGULAR: LazyLock<Face<'static>> = LazyLock::new(|| face(include_bytes!("fonts/regular.ttf")));
static BOLD: LazyLock<Face<'static>> = LazyLock::new(|| face(include_bytes!("fonts/bold.ttf")));

fn face(data: &'static [u8]) -> Face<'static> {
    Face::parse(data, 0).expect("a font that the tests draw with")
}

fn of(lettering: Lettering) -> &'static Face<'static> {
    if lettering.bold { &BOLD } else { &REGULAR }
}

/// How far a line of text reaches from its start to its end [px].
pub(crate) fn width(content: &str, lettering: Lettering) -> f64 {
    let (_, end) = layout(of(lettering), content);
    f64::from(end) * scale(lettering)
}

/// The outlines of a text, about the point it stands at [px, right and down].
pub(crate) fn outline(text: &Text, pen: &mut dyn OutlineBuilder) {
    let face = of(text.lettering);
    let (glyphs, end) = layout(face, &text.content);
    let start = match text.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * f64::from(end),
        Anchor::End => -f64::from(end),
    };
    let scale = scale(text.lettering);
    for (glyph, right) in glyphs {
        let right = start + f64::from(right);
        let mut placed = Placed { pen, at: text.at, right, scale, upwards: text.upwards };
        // A space has none.
        let _ = face.outline_glyph(glyph, &mut placed);
    }
}

/// Pixels a font unit.
fn scale(lettering: Lettering) -> f64 {
    lettering.size / f64::from(of(lettering).units_per_em())
}

/// Glyphs with their distances from the start, and the end, in font units.
fn layout(face: &Face, content: &str) -> (Vec<(GlyphId, i32)>, i32) {
    let (mut glyphs, mut end) = (Vec::new(), 0);
    for character in content.chars() {
        let glyph = face.glyph_index(character).unwrap_or_default();
        end += glyphs.last().map_or(0, |&(before, _)| kerning(face, before, glyph));
        glyphs.push((glyph, end));
        end += i32::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    }
    (glyphs, end)
}

/// How much further apart than usual two glyphs stand, in font units; mostly negative.
fn kerning(face: &Face, before: GlyphId, glyph: GlyphId) -> i32 {
    let tables = face.tables().kern.iter().flat_map(|kern| kern.subtables);
    let mut horizontal = tables.filter(|table| table.horizontal && !table.variable);
    horizontal.find_map(|table| table.glyphs_kerning(before, glyph)).map_or(0, i32::from)
}

/// Takes a glyph's outline from font units, up, to its place on the page.
struct Placed<'a> {
    pen: &'a mut dyn OutlineBuilder,
    at: [f64; 2],
    /// Of the glyph's origin, in font units.
    right: f64,
    scale: f64,
    upwards: bool,
}

impl Placed<'_> {
    #[expect(clippy::cast_possible_truncation, reason = "outlines are drawn in f32")]
    fn on_page(&self, x: f32, y: f32) -> (f32, f32) {
        let (along, above) = (self.scale * (self.right + f64::from(x)), self.scale * f64::from(y));
        let [x, y] = self.at;
        let [x, y] = if self.upwards { [x - above, y - along] } else { [x + along, y - above] };
        (x as f32, y as f32)
    }
}

impl OutlineBuilder for Placed<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.on_page(x, y);
        self.pen.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.on_page(x, y);
        self.pen.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.on_page(x1, y1), self.on_page(x, y));
        self.pen.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.on_page(x1, y1), self.on_page(x2, y2), self.on_page(x, y));
        self.pen.curve_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.pen.close();
    }
}

#[cfg(test)]
mod tests {
    use super::{Lettering, REGULAR, of, width};
    use crate::report::draw::style::INK;

    const TEXT: Lettering = Lettering { size: 20.48, bold: false, color: INK };

    /// DejaVu Sans has 2048 units to the em: a hundredth of a pixel each at this size.
    #[test]
    fn widths_are_those_of_the_font() {
        // Advances as fonttools reads them: A 1401, V 1401, 0 1303; the pair A V stands 131 closer.
        for (text, units) in [("", 0), ("A", 1401), ("00", 2606), ("AV", 1401 + 1401 - 131)] {
            let found = width(text, TEXT);
            assert!((found - 0.01 * f64::from(units)).abs() < 1e-9, "{text}: {found}");
        }
        assert!(width("joint", Lettering { bold: true, ..TEXT }) > width("joint", TEXT));
    }

    /// All that figures write has a glyph.
    #[test]
    fn both_fonts_have_the_symbols() {
        let symbols = "σₗσₘqₗuₘφΛ²⁻⁰¹²³⁴⁵⁶⁷⁸⁹×−·|αωΔ∞≤…äßŽЖ";
        for lettering in [TEXT, Lettering { bold: true, ..TEXT }] {
            let missing: Vec<char> =
                symbols.chars().filter(|&c| of(lettering).glyph_index(c).is_none()).collect();
            assert!(missing.is_empty(), "{missing:?}");
        }
        assert_eq!(REGULAR.units_per_em(), 2048);
    }
}
