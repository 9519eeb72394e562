//! Colours, strokes and lettering: hue is the joint, line style is the side.

/// Family list of every figure: the first is what [`png`](super::png) bundles, the others are close in width.
pub(super) const FONT: &str = "DejaVu Sans, Verdana, Bitstream Vera Sans, Arial, sans-serif";

pub(super) const INK: &str = "#1f2328";
pub(super) const MUTED: &str = "#59636e";
pub(super) const GRID: &str = "#e4e7eb";

/// Okabe and Ito's colours without yellow and black, then two of Tol's: told apart with any colour vision.
const HUES: [&str; 8] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#332288", "#882255"];

/// Colour of the joint (or run) with this index, from 0.
pub(super) fn hue(index: usize) -> &'static str {
    HUES[index % HUES.len()]
}

/// How a curve is drawn; lengths in pixels of the figure.
#[derive(Clone, Debug)]
pub(super) struct Stroke {
    pub color: &'static str,
    pub width: f64,
    /// Lengths of dash and gap; empty for a solid line.
    pub dash: &'static [u8],
}

impl Stroke {
    /// Link side: solid. Later joints are thinner, so that curves that lie on each other all show.
    pub(super) fn link(joint: usize, joints: usize) -> Self {
        Self { color: hue(joint), width: 2.4 - thinning(joint, joints), dash: &[] }
    }

    /// Motor side: dashed and thinner.
    pub(super) fn motor(joint: usize, joints: usize) -> Self {
        Self { color: hue(joint), width: 1.7 - 0.5 * thinning(joint, joints), dash: &[6, 3] }
    }

    /// The reference: dark and dotted, on top of what follows it.
    pub(super) fn reference() -> Self {
        Self { color: INK, width: 1.3, dash: &[2, 4] }
    }

    /// Several whole runs in one axis: every other one is dashed and thinner, and so are colours that come round again.
    pub(super) fn run(index: usize) -> Self {
        let broken = index % 2 + 2 * (index / HUES.len()).min(1);
        let dash: &[u8] = [&[][..], &[8, 5], &[2, 3], &[8, 3, 2, 3]][broken];
        Self { color: hue(index), width: if dash.is_empty() { 2.6 } else { 1.8 }, dash }
    }

    /// The dash pattern as SVG writes it, in multiples of `unit` pixels.
    pub(super) fn dasharray(&self, unit: f64) -> Option<String> {
        let lengths: Vec<String> =
            self.dash.iter().map(|&length| (f64::from(length) * unit).to_string()).collect();
        (!lengths.is_empty()).then(|| lengths.join(" "))
    }
}

/// From 0 at the first joint to 1.2 px at the last.
fn thinning(joint: usize, joints: usize) -> f64 {
    1.2 * joint as f64 / (joints.max(2) - 1) as f64
}
