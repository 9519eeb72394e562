//! From samples to the path of an SVG: decimated, cut at the frame, written short.

use std::fmt::Write as _;

use crate::report::decimate::{decimate, envelope};
use crate::report::range::Range;
use crate::report::style::Stroke;

/// One line of a panel, in the units of its axes.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    pub t: Vec<f64>,
    pub values: Vec<f64>,
    pub stroke: Stroke,
}

impl Curve {
    /// The samples up to the first one that is not a number: what a diverged run still has to show.
    pub(super) fn new(t: &[f64], values: &[f64], stroke: Stroke) -> Self {
        let finite = t.iter().zip(values).take_while(|(t, value)| t.is_finite() && value.is_finite()).count();
        Self { t: t[..finite].to_vec(), values: values[..finite].to_vec(), stroke }
    }

    /// The exponents of ten of the largest absolute value in each bucket: what a logarithmic axis shows.
    pub(super) fn exponents(&self, buckets: usize) -> Self {
        let exponents: Vec<f64> =
            self.values.iter().map(|value| value.abs().max(f64::MIN_POSITIVE).log10()).collect();
        let (t, values) = envelope(&self.t, &exponents, buckets).into_iter().unzip();
        Self { t, values, stroke: self.stroke.clone() }
    }

    /// The part within a window of time, with one sample more on either side.
    pub(super) fn within(&self, window: Range) -> Self {
        let start = self.t.partition_point(|&t| t < window.low).saturating_sub(1);
        let end = (self.t.partition_point(|&t| t <= window.high) + 1).min(self.t.len());
        Self {
            t: self.t[start..end].to_vec(),
            values: self.values[start..end].to_vec(),
            stroke: self.stroke.clone(),
        }
    }

    /// The curve on another unit of time, `scale` to the second.
    pub(super) fn stretched(mut self, scale: f64) -> Self {
        self.t.iter_mut().for_each(|t| *t *= scale);
        self
    }

    /// The `d` of a path in tenths of a pixel, in a frame of `width` by `height` pixels whose axes are `x` and `y`.
    pub(super) fn path(&self, x: Range, y: Range, width: f64, height: f64, buckets: usize) -> String {
        // A diverging run reaches 1e300: far outside is far enough, and finite.
        let far = 1e6 * height;
        let points: Vec<(f64, f64)> = decimate(&self.t, &self.values, buckets)
            .into_iter()
            .map(|(t, value)| {
                let right = 10.0 * width * (t - x.low) / x.span();
                let down = 10.0 * height * (y.high - value) / y.span();
                (right.clamp(-far, far), down.clamp(-far, far))
            })
            .collect();
        let mut pen = Pen::default();
        for pair in points.windows(2) {
            let whole = Some((pair[0], pair[1]));
            let inside = whole
                .and_then(|s| cut(s, 10.0 * height))
                .map(swap)
                .and_then(|s| cut(s, 10.0 * width))
                .map(swap);
            if let Some((from, to)) = inside {
                pen.line(from, to);
            }
        }
        pen.path
    }
}

type Segment = ((f64, f64), (f64, f64));

/// The part of a segment whose second coordinate lies in `0..=high`.
fn cut((from, to): Segment, high: f64) -> Option<Segment> {
    let rise = to.1 - from.1;
    let (mut start, mut end) = (0.0f64, 1.0f64);
    if rise == 0.0 {
        return (0.0..=high).contains(&from.1).then_some((from, to));
    }
    let (enter, leave) = ((0.0 - from.1) / rise, (high - from.1) / rise);
    start = start.max(enter.min(leave));
    end = end.min(enter.max(leave));
    let at = |s: f64| (from.0 + s * (to.0 - from.0), from.1 + s * rise);
    (start <= end).then(|| (at(start), at(end)))
}

fn swap((from, to): Segment) -> Segment {
    ((from.1, from.0), (to.1, to.0))
}

/// Writes relative, whole steps: their sum is exact, so nothing drifts.
#[derive(Default)]
struct Pen {
    path: String,
    at: Option<(i64, i64)>,
}

impl Pen {
    fn line(&mut self, from: (f64, f64), to: (f64, f64)) {
        let (from, to) = (whole(from), whole(to));
        if self.at != Some(from) {
            let _ = write!(self.path, "M{} {}", from.0, from.1);
        } else if from == to {
            return;
        }
        let (right, down) = (to.0 - from.0, to.1 - from.1);
        // A minus sign separates numbers as well as a space does.
        let _ =
            if down < 0 { write!(self.path, "l{right}{down}") } else { write!(self.path, "l{right} {down}") };
        self.at = Some(to);
    }
}

#[expect(clippy::cast_possible_truncation, reason = "cut to the frame: a few thousand at most")]
fn whole((x, y): (f64, f64)) -> (i64, i64) {
    (x.round() as i64, y.round() as i64)
}

#[cfg(test)]
mod tests {
    use super::{Curve, Range, cut};
    use crate::report::style::Stroke;

    const UNIT: Range = Range { low: 0.0, high: 1.0 };

    fn path(values: &[f64]) -> String {
        let t: Vec<f64> = (0..values.len()).map(|k| k as f64 / (values.len() - 1) as f64).collect();
        Curve::new(&t, values, Stroke::reference()).path(UNIT, UNIT, 10.0, 10.0, 100)
    }

    #[test]
    fn a_cut_segment_stays_on_its_line() {
        assert_eq!(cut(((0.0, -10.0), (4.0, 10.0)), 5.0), Some(((2.0, 0.0), (3.0, 5.0))));
        assert!(cut(((0.0, 6.0), (1.0, 9.0)), 5.0).is_none());
    }

    #[test]
    fn leaving_and_coming_back_starts_a_new_line() {
        assert_eq!(path(&[0.0, 1.0]), "M0 100l100-100");
        assert_eq!(path(&[0.0, 2.0, 0.0]).matches('M').count(), 2);
        assert_eq!(path(&[5.0, 6.0]), "");
    }

    #[test]
    fn divergence_is_cut_not_written() {
        assert_eq!(path(&[0.0, f64::NAN, 1.0]), "");
        let steep = path(&[0.0, 0.5, 1e300]);
        assert!(
            !steep.contains("NaN") && !steep.contains("inf") && steep.starts_with("M0 100l50-50"),
            "{steep}"
        );
    }
}
