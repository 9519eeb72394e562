//! What falls exponentially: on an axis of decades a straight line. What stays where it is falls at 0 1/s.

use super::curve::Curve;
use super::range::Range;
use super::style::Stroke;

/// A bound of absolute values, start · e^(−rate (t − from)) from `from` on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Falling {
    /// In the unit of the axis.
    pub start: f64,
    /// Not before the beginning of the time axis, in its unit.
    pub from: f64,
    /// ≥ 0 [1/s].
    pub rate: f64,
    pub stroke: Stroke,
}

impl Falling {
    /// An axis of exponents of ten on which the beginning is seen.
    pub(crate) fn seen_on(self, axis: Range) -> Range {
        Range { high: axis.high.max(self.start.log10() + 0.2), ..axis }
    }

    /// The line in a frame with these axes.
    pub(crate) fn line(self, t: Range, axis: Range) -> Curve {
        let slope = self.rate / std::f64::consts::LN_10;
        let top = self.start.log10();
        // A little below the frame, which cuts it: far below nothing could be placed.
        let end = ((top - axis.low + axis.span()) / slope).min(t.high - self.from);
        Curve {
            t: vec![self.from, self.from + end],
            values: vec![top, top - slope * end],
            stroke: self.stroke,
        }
    }
}
