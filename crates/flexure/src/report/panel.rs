//! One panel: a heading, a line that says what is shown and what is not, and its axes.

use crate::files::number::{duration, short, significant};
use crate::report::axes::{Axes, Labels};
use crate::report::curve::Curve;
use crate::report::decimate::bucket_size;
use crate::report::range::{Linear, Range, decades};
use crate::report::sheet::Sheet;
use crate::report::style::{INK, MUTED};

/// Height of a panel with its heading [px].
pub(super) const HEIGHT: f64 = HEADING + AXES;
const HEADING: f64 = 46.0;
const AXES: f64 = 330.0;
/// Room for the numbers on the left [px].
const LEFT: f64 = 76.0;
/// Width of the frame that shows a short excursion [px].
const STRIP: f64 = 214.0;
/// An excursion longer than this part of the run gets no frame of its own.
const SHORT: f64 = 0.2;

/// What all panels share.
pub(super) struct View {
    pub t: Range,
    /// The last finite instant of a run that did not stay finite.
    pub diverged: Option<f64>,
    pub buckets: usize,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Scale {
    Linear,
    /// Absolute values, logarithmic.
    Decades,
}

pub(super) struct Panel {
    pub title: &'static str,
    pub quantity: &'static str,
    pub unit: &'static str,
    pub scale: Scale,
    pub curves: Vec<Curve>,
}

/// Runs of samples that are drawn as two points each: fine for few signals, coarser for many, so that files stay small.
pub(super) fn buckets(signals: usize) -> usize {
    (18_000 / signals.max(1)).clamp(60, 500)
}

/// The time axis of a recording.
pub(super) fn span(t: &[f64]) -> Range {
    let finite = || t.iter().copied().filter(|t| t.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    if low < high { Range { low, high } } else { Range { low: 0.0, high: 1.0 } }
}

impl Panel {
    /// Draws the panel with its upper left corner at `(x, y)`.
    pub(super) fn draw(&self, sheet: &mut Sheet, (x, y): (f64, f64), width: f64, view: &View) {
        sheet.text((x + 14.0, y + 20.0), self.title, 15, INK, true);
        let place = [x, y + HEADING, width, AXES];
        let note = match self.scale {
            Scale::Linear => self.linear(sheet, place, view),
            Scale::Decades => Some(self.decades(sheet, place, view)),
        };
        let end = view.diverged.map(|t| format!("not finite after {}", duration(t)));
        let note = [end, note].into_iter().flatten().collect::<Vec<_>>().join("; ");
        sheet.text((x + 14.0, y + 39.0), &note, 12, MUTED, false);
    }

    fn decades(&self, sheet: &mut Sheet, place: [f64; 4], view: &View) -> String {
        let curves: Vec<Curve> = self.curves.iter().map(|curve| curve.exponents(view.buckets)).collect();
        let range = decades(&curves);
        let label = self.label();
        let axes = Axes { y_labels: Labels::Decades, ..axes(place, view.t, range, &label) };
        axes.draw(sheet, &curves, view.diverged, view.buckets);
        let samples = self.curves.iter().map(|curve| curve.t.len()).max().unwrap_or(0);
        match bucket_size(samples, view.buckets) {
            1 => "absolute values".to_owned(),
            size => format!("largest absolute value in each {}", duration(size as f64 * self.step())),
        }
    }

    /// Draws a linear axis, with a second frame for a short excursion. Returns what the frame cuts.
    fn linear(&self, sheet: &mut Sheet, place: [f64; 4], view: &View) -> Option<String> {
        let range = if view.diverged.is_some() { Linear::of_diverged } else { Linear::of };
        let Linear { range, clipped } = range(&mut self.values());
        let excursion = clipped.then(|| self.excursion(range));
        let short = |window: &Range| view.diverged.is_none() && window.span() <= SHORT * view.t.span();
        if let Some(window) = excursion.filter(short) {
            return Some(self.split(sheet, place, view, range, window));
        }
        axes(place, view.t, range, &self.label()).draw(sheet, &self.curves, view.diverged, view.buckets);
        clipped.then(|| format!("{} outside the frame", self.peak()))
    }

    /// The excursion on the left on its own scale, the whole run on the right. Returns what that cuts.
    fn split(&self, sheet: &mut Sheet, place: [f64; 4], view: &View, range: Range, window: Range) -> String {
        let [x, y, width, height] = place;
        let (scale, unit) = if window.high.abs() < 0.5 { (1e3, "ms") } else { (1.0, "s") };
        let zoomed: Vec<Curve> =
            self.curves.iter().map(|curve| curve.within(window).stretched(scale)).collect();
        let inside = Linear::whole(zoomed.iter().flat_map(|curve| curve.values.iter().copied()));
        let ticks = Range { low: scale * window.low, high: scale * window.high };
        let (label, time) = (self.label(), format!("time [{unit}]"));
        let left = Axes { x_label: &time, ..axes([x, y, STRIP, height], ticks, inside, &label) };
        left.draw(sheet, &zoomed, None, view.buckets / 2);
        let right = [x + STRIP, y, width - STRIP, height];
        let right = Axes { left: 60.0, ..axes(right, view.t, range, "") };
        right.draw(sheet, &self.curves, view.diverged, view.buckets);
        let [from, to] = [ticks.low, ticks.high].map(|t| short(t, 3));
        format!("left: {from} to {to} {unit}, {}; right: whole run, axis cut", self.peak())
    }

    fn label(&self) -> String {
        format!("{} [{}]", self.quantity, self.unit)
    }

    fn values(&self) -> impl Iterator<Item = f64> {
        self.samples().map(|(_, value)| value)
    }

    fn samples(&self) -> impl Iterator<Item = (f64, f64)> {
        self.curves.iter().flat_map(|curve| curve.t.iter().copied().zip(curve.values.iter().copied()))
    }

    /// The mean time between samples.
    fn step(&self) -> f64 {
        let t: &[f64] = self.curves.first().map_or(&[], |curve| &curve.t);
        span(t).span() / (t.len().max(2) - 1) as f64
    }

    /// The window of time that holds every sample outside `range`, with a little more on both sides.
    fn excursion(&self, range: Range) -> Range {
        let outside = self.samples().filter(|&(_, value)| !range.contains(value));
        let (first, last) =
            outside.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (t, _)| (low.min(t), high.max(t)));
        let t = span(self.curves.first().map_or(&[], |curve| &curve.t));
        let margin = (0.5 * (last - first)).max(4.0 * self.step());
        Range { low: (first - margin).max(t.low), high: (last + margin).min(t.high) }
    }

    /// The largest absolute value and when it was.
    fn peak(&self) -> String {
        let (t, value) = self.samples().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).unwrap_or_default();
        format!("peak {} {} at {}", significant(value.abs(), 4), self.unit, duration(t))
    }
}

fn axes(place: [f64; 4], x: Range, y: Range, y_label: &str) -> Axes<'_> {
    Axes { place, x, y, x_label: "time [s]", y_label, y_labels: Labels::Linear, left: LEFT }
}
