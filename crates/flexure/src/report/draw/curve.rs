//! From samples to points of a figure: decimated, cut at the frame, to tenths of a pixel.

use super::axes::Axes;
use super::chatter::{Shown, shown};
use super::decimate::envelope;
use super::range::Range;
use super::scene::Point;
use super::style::Stroke;

/// One line of a panel, in the units of its axes.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    pub t: Vec<f64>,
    pub values: Vec<f64>,
    pub stroke: Stroke,
}

impl Curve {
    /// The samples up to the first one that is not a number: what a diverged run still has to show.
    pub(crate) fn new(t: &[f64], values: &[f64], stroke: Stroke) -> Self {
        let finite = t.iter().zip(values).take_while(|(t, value)| t.is_finite() && value.is_finite()).count();
        Self { t: t[..finite].to_vec(), values: values[..finite].to_vec(), stroke }
    }

    /// The exponents of ten of the largest absolute value in each bucket: what a logarithmic axis shows.
    pub(crate) fn exponents(&self, buckets: usize) -> Self {
        let exponents: Vec<f64> =
            self.values.iter().map(|value| value.abs().max(f64::MIN_POSITIVE).log10()).collect();
        let (t, values) = envelope(&self.t, &exponents, buckets).into_iter().unzip();
        Self { t, values, stroke: self.stroke }
    }

    /// The part within a window of time, with one sample more on either side.
    pub(crate) fn within(&self, window: Range) -> Self {
        let start = self.t.partition_point(|&t| t < window.low).saturating_sub(1);
        let end = (self.t.partition_point(|&t| t <= window.high) + 1).min(self.t.len());
        Self { t: self.t[start..end].to_vec(), values: self.values[start..end].to_vec(), stroke: self.stroke }
    }

    /// The curve on another unit of time, `scale` to the second.
    pub(crate) fn stretched(mut self, scale: f64) -> Self {
        self.t.iter_mut().for_each(|t| *t *= scale);
        self
    }

    /// What to draw in a frame [px]: lines, and shapes of bands.
    pub(crate) fn drawn(&self, axes: &Axes, buckets: usize) -> (Vec<Vec<Point>>, Vec<Vec<Point>>) {
        let Shown { line, bands } = shown(&self.t, &self.values, buckets);
        let [left, top, width, height] = axes.frame;
        let inside = |t: f64, value: f64| {
            let [x, y] = axes.place(t, value);
            [tenths(x.clamp(left, left + width)), tenths(y.clamp(top, top + height))]
        };
        let shape = |band: &Vec<(f64, f64, f64)>| {
            let above = band.iter().map(|&(t, _, high)| inside(t, high));
            let below = band.iter().rev().map(|&(t, low, _)| inside(t, low));
            above.chain(below).collect()
        };
        (pieces(&line, axes), bands.iter().map(shape).collect())
    }

    /// Whether some of it is drawn as a band.
    pub(crate) fn swings(&self, buckets: usize) -> bool {
        !shown(&self.t, &self.values, buckets).bands.is_empty()
    }
}

/// The lines through `points` that lie in a frame [px].
fn pieces(points: &[(f64, f64)], axes: &Axes) -> Vec<Vec<Point>> {
    let [left, top, width, height] = axes.frame;
    // A diverging run reaches 1e300: far outside is far enough, and finite.
    let far = 1e5 * height;
    let points: Vec<Point> = points
        .iter()
        .map(|&(t, value)| {
            let [x, y] = axes.place(t, value);
            [(x - left).clamp(-far, far), (y - top).clamp(-far, far)]
        })
        .collect();
    let mut pen = Pen::default();
    for pair in points.windows(2) {
        let inside = cut([pair[0], pair[1]], height).map(swap).and_then(|s| cut(s, width)).map(swap);
        if let Some(ends) = inside {
            let [from, to] = ends.map(|[x, y]| [tenths(left + x), tenths(top + y)]);
            pen.line(from, to);
        }
    }
    pen.pieces
}

type Segment = [Point; 2];

/// The part of a segment whose second coordinate lies in `0..=high`.
fn cut([from, to]: Segment, high: f64) -> Option<Segment> {
    let rise = to[1] - from[1];
    let (mut start, mut end) = (0.0f64, 1.0f64);
    if rise == 0.0 {
        return (0.0..=high).contains(&from[1]).then_some([from, to]);
    }
    let (enter, leave) = ((0.0 - from[1]) / rise, (high - from[1]) / rise);
    start = start.max(enter.min(leave));
    end = end.min(enter.max(leave));
    let at = |s: f64| [from[0] + s * (to[0] - from[0]), from[1] + s * rise];
    (start <= end).then(|| [at(start), at(end)])
}

fn swap(ends: Segment) -> Segment {
    ends.map(|[x, y]| [y, x])
}

/// To tenths: finer than any screen, and lines that go on do so exactly.
fn tenths(pixels: f64) -> f64 {
    (10.0 * pixels).round() / 10.0
}

/// Joins lines that start where the one before ends.
#[derive(Default)]
struct Pen {
    pieces: Vec<Vec<Point>>,
}

impl Pen {
    fn line(&mut self, from: Point, to: Point) {
        match self.pieces.last_mut() {
            Some(piece) if piece.last() == Some(&from) => {
                if piece.last() != Some(&to) {
                    piece.push(to);
                }
            }
            _ => self.pieces.push(vec![from, to]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Curve, Point, Range, cut};
    use crate::report::draw::axes::{Axes, Axis};
    use crate::report::draw::style::Stroke;

    /// In a frame of 10 px at (20, 30) whose axes go from 0 to 1.
    fn pieces(values: &[f64]) -> Vec<Vec<Point>> {
        let axis = || Axis { range: Range { low: 0.0, high: 1.0 }, ticks: Vec::new(), label: "" };
        let axes = Axes { frame: [20.0, 30.0, 10.0, 10.0], left: 0.0, x: axis(), y: axis() };
        let t: Vec<f64> = (0..values.len()).map(|k| k as f64 / (values.len() - 1) as f64).collect();
        Curve::new(&t, values, Stroke::reference()).drawn(&axes, 100).0
    }

    #[test]
    fn a_cut_segment_stays_on_its_line() {
        assert_eq!(cut([[0.0, -10.0], [4.0, 10.0]], 5.0), Some([[2.0, 0.0], [3.0, 5.0]]));
        assert!(cut([[0.0, 6.0], [1.0, 9.0]], 5.0).is_none());
    }

    #[test]
    fn leaving_and_coming_back_starts_a_new_line() {
        assert_eq!(pieces(&[0.0, 1.0]), [[[20.0, 40.0], [30.0, 30.0]]]);
        assert_eq!(pieces(&[0.0, 2.0, 0.0]).len(), 2);
        assert_eq!(pieces(&[0.0, 0.5, 0.0]), [[[20.0, 40.0], [25.0, 35.0], [30.0, 40.0]]]);
        assert!(pieces(&[5.0, 6.0]).is_empty());
    }

    #[test]
    fn divergence_is_cut_not_drawn() {
        assert!(pieces(&[0.0, f64::NAN, 1.0]).is_empty());
        let steep = pieces(&[0.0, 0.5, 1e300]);
        assert_eq!(steep[0][..2], [[20.0, 40.0], [25.0, 35.0]]);
        let inside = |&[x, y]: &Point| (20.0..=30.0).contains(&x) && (30.0..=40.0).contains(&y);
        assert!(steep.iter().flatten().all(inside), "{steep:?}");
    }
}
