//! Colours, strokes and lettering: hue is the joint, line style is the side.

use std::fmt;

use super::scene::Lettering;

/// Family list of every SVG: the first is what pictures are drawn with, the others are close in width.
pub(super) const FONT: &str = "DejaVu Sans, Verdana, Bitstream Vera Sans, Arial, sans-serif";

/// Red, green and blue, each to 255.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Color(pub [u8; 3]);

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

pub(super) const INK: Color = Color::hex(0x1f2328);
pub(super) const MUTED: Color = Color::hex(0x59636e);
pub(super) const GRID: Color = Color::hex(0xe4e7eb);
pub(super) const WHITE: Color = Color::hex(0xffffff);

/// Letters of this size [px].
pub(super) const fn letters(size: f64, color: Color) -> Lettering {
    Lettering { size, bold: false, color }
}

/// Bold letters of this size [px].
pub(super) const fn bold(size: f64, color: Color) -> Lettering {
    Lettering { size, bold: true, color }
}

/// Okabe and Ito's colours without yellow and black, then two of Tol's: told apart with any colour vision.
const HUES: [u32; 8] = [0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0x56b4e9, 0xe69f00, 0x332288, 0x882255];

/// Colour of the joint (or run) with this index, from 0.
pub(super) fn hue(index: usize) -> Color {
    Color::hex(HUES[index % HUES.len()])
}

/// How a line is drawn; lengths in pixels of the figure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub color: Color,
    pub width: f64,
    /// Lengths of dash and gap; empty for a solid line.
    pub dash: &'static [f64],
}

impl Stroke {
    /// A line without gaps.
    pub(super) const fn solid(color: Color, width: f64) -> Self {
        Self { color, width, dash: &[] }
    }

    /// A joint in a legend: thick, and as thin as its curves where its colour comes round again.
    pub(super) fn swatch(joint: usize, joints: usize) -> Self {
        let line = Self::link(joint, joints);
        if joint < HUES.len() { Self { width: 4.0, ..line } } else { line }
    }

    /// Link side: solid. Later joints are thinner, so that curves that lie on each other all show.
    pub(super) fn link(joint: usize, joints: usize) -> Self {
        Self::solid(hue(joint), 2.4 - thinning(joint, joints))
    }

    /// Motor side: dashed and thinner.
    pub(super) fn motor(joint: usize, joints: usize) -> Self {
        Self { color: hue(joint), width: 1.7 - 0.5 * thinning(joint, joints), dash: &[6.0, 3.0] }
    }

    /// A third line beside link and motor, in the joint's colour: dotted.
    pub(super) fn dotted(joint: usize, joints: usize) -> Self {
        Self { color: hue(joint), width: 1.5 - 0.4 * thinning(joint, joints), dash: &[1.5, 2.5] }
    }

    /// The reference: dark and dotted, on top of what follows it.
    pub(super) fn reference() -> Self {
        Self { color: INK, width: 1.3, dash: &[2.0, 4.0] }
    }

    /// Several whole runs in one axis: every other one is dashed and thinner, and so are colours that come round again.
    pub(super) fn run(index: usize) -> Self {
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
