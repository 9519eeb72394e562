//! Colours, strokes and lettering: hue is the joint, line style is the side.

use std::fmt;

use super::scene::Lettering;

/// Family list of every SVG: the first is what pictures are drawn with, the others are close in width.
pub(crate) const FONT: &str = "DejaVu Sans, Verdana, Bitstream Vera Sans, Arial, sans-serif";

/// Red, green and blue, each to 255.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Color(pub [u8; 3]);

impl Color {
    /// As CSS writes it, `0x1f2328` for `#1f2328`.
    const fn hex(hex: u32) -> Self {
        let [_, red, green, blue] = hex.to_be_bytes();
        Self([red, green, blue])
    }
}

impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self([red, green, blue]) = self;
        write!(f, "#{red:02x}{green:02x}{blue:02x}")
    }
}

pub(crate) const INK: Color = Color::hex(0x1f2328);
pub(crate) const MUTED: Color = Color::hex(0x59636e);
pub(crate) const GRID: Color = Color::hex(0xe4e7eb);
pub(crate) const WHITE: Color = Color::hex(0xffffff);

/// Where a page is dark, what each colour becomes: light enough for what is drawn on [`DARK`], 4.5 : 1 and more.
pub(crate) fn in_the_dark() -> impl Iterator<Item = (Color, Color)> {
    let hues = HUES.into_iter().zip(DARK_HUES).map(|(light, dark)| (Color::hex(light), Color::hex(dark)));
    let [paper, ink, muted, grid] = [DARK, 0xe6e8ea, 0x9aa4ae, 0x2c3238].map(Color::hex);
    let [pushed, stopped, limit, holds] = [0x3b2c17, 0x47252a, 0xff8a80, 0x48a878].map(Color::hex);
    let marks = [(PUSHED, pushed), (STOPPED, stopped), (LIMIT.color, limit), (HOLDS, holds)];
    [(WHITE, paper), (INK, ink), (MUTED, muted), (GRID, grid)].into_iter().chain(marks).chain(hues)
}

/// Spans in which links are pushed.
pub(crate) const PUSHED: Color = Color::hex(0xfdebd3);
/// Spans in which the guard has stopped the robot.
pub(crate) const STOPPED: Color = Color::hex(0xf7d9d9);
/// Cells of maps, from the best to the worst, the same on every page, with [letters](PAPER_INK) of their own.
pub(crate) const SHADES: [Color; 6] = [
    Color::hex(0x08519c),
    Color::hex(0x2171b5),
    Color::hex(0x6baed6),
    Color::hex(0x9ecae1),
    Color::hex(0xc6dbef),
    Color::hex(0xe6eff8),
];
/// Letters on dark and on light shades.
pub(crate) const PAPER_INK: [Color; 2] = [Color::hex(0xfefefe), Color::hex(0x10212b)];
/// Where a loop holds.
pub(crate) const HOLDS: Color = Color::hex(0x3f9b6b);
/// How much bands hide of what is behind them.
pub(crate) const OPACITY: f32 = 0.3;
/// A limit.
pub(crate) const LIMIT: Stroke =
    Stroke { color: Color::hex(0xb3261e), width: 1.2, dash: &[7.0, 3.0, 1.5, 3.0] };

/// Letters of this size [px].
pub(crate) const fn letters(size: f64, color: Color) -> Lettering {
    Lettering { size, bold: false, color }
}

/// Bold letters of this size [px].
pub(crate) const fn bold(size: f64, color: Color) -> Lettering {
    Lettering { size, bold: true, color }
}

/// Okabe and Ito's colours without yellow and black, then two of Tol's: told apart with any colour vision.
const HUES: [u32; 8] = [0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0x56b4e9, 0xe69f00, 0x332288, 0x882255];

/// The same on a dark page.
const DARK_HUES: [u32; 8] = [0x4ea8e0, 0xf28a3c, 0x2fc79a, 0xe39ac4, 0x9bd5f7, 0xf2c14e, 0x9a8cf0, 0xd9719f];

/// A dark page, that of `report.css`.
const DARK: u32 = 0x15181b;

/// Colour of the joint (or run) with this index, from 0.
pub(crate) fn hue(index: usize) -> Color {
    Color::hex(HUES[index % HUES.len()])
}

/// How a line is drawn; lengths in pixels of the figure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke {
    pub color: Color,
    pub width: f64,
    /// Lengths of dash and gap; empty for a solid line.
    pub dash: &'static [f64],
}

impl Stroke {
    /// A line without gaps.
    pub(crate) const fn solid(color: Color, width: f64) -> Self {
        Self { color, width, dash: &[] }
    }

    /// A joint in a legend: thick, and as thin as its curves where its colour comes round again.
    pub(crate) fn swatch(joint: usize, joints: usize) -> Self {
        let line = Self::link(joint, joints);
        if joint < HUES.len() { Self { width: 4.0, ..line } } else { line }
    }

    /// Link side: solid. Later joints are thinner, so that curves that lie on each other all show.
    pub(crate) fn link(joint: usize, joints: usize) -> Self {
        Self::solid(hue(joint), 2.4 - thinning(joint, joints))
    }

    /// Motor side: dashed and thinner.
    pub(crate) fn motor(joint: usize, joints: usize) -> Self {
        Self { color: hue(joint), width: 1.7 - 0.5 * thinning(joint, joints), dash: &[6.0, 3.0] }
    }

    /// A third line beside link and motor, in the joint's colour: dotted.
    pub(crate) fn dotted(joint: usize, joints: usize) -> Self {
        Self { color: hue(joint), width: 1.5 - 0.4 * thinning(joint, joints), dash: &[1.5, 2.5] }
    }

    /// The reference: dark and dotted, on top of what follows it.
    pub(crate) fn reference() -> Self {
        Self { color: INK, width: 1.3, dash: &[2.0, 4.0] }
    }

    /// Several whole runs in one axis: every other one is dashed and thinner, and so are colours that come round again.
    pub(crate) fn run(index: usize) -> Self {
        let broken = index % 2 + 2 * (index / HUES.len()).min(1);
        let dash: &[f64] = [&[][..], &[8.0, 5.0], &[2.0, 3.0], &[8.0, 3.0, 2.0, 3.0]][broken];
        Self { color: hue(index), width: if dash.is_empty() { 2.6 } else { 1.8 }, dash }
    }
}

/// From 0 at the first joint to 1.2 px at the last; with more joints than colours, joints whose colour comes round again are
/// all thinner than the others.
fn thinning(joint: usize, joints: usize) -> f64 {
    match (joint / HUES.len(), joints > HUES.len()) {
        (0, false) => 1.2 * joint as f64 / (joints.max(2) - 1) as f64,
        (0, true) => 0.4 * joint as f64 / HUES.len() as f64,
        _ => 1.2 + 0.2 * (joint - HUES.len()) as f64 / HUES.len() as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::{Color, DARK, GRID, PUSHED, STOPPED, WHITE, in_the_dark};

    /// Relative luminance of sRGB, as WCAG 2 has it.
    fn luminance(Color(rgb): Color) -> f64 {
        let linear = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        let [red, green, blue] = rgb.map(linear);
        0.2126 * red + 0.7152 * green + 0.0722 * blue
    }

    #[test]
    fn what_is_drawn_on_a_dark_page_is_seen() {
        let behind = [WHITE, GRID, PUSHED, STOPPED];
        for (light, dark) in in_the_dark().filter(|(light, _)| !behind.contains(light)) {
            let contrast = (luminance(dark) + 0.05) / (luminance(Color::hex(DARK)) + 0.05);
            assert!(contrast >= 4.5, "{light} as {dark}: {contrast:.2}");
        }
    }
}
