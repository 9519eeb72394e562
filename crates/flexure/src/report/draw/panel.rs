//! One panel: a heading, a line that says what is shown and what is not, and its axes.

use super::axes::{Axes, Axis, BOTTOM};
use super::curve::Curve;
use super::decimate::bucket_size;
use super::falling::Falling;
use super::marks::{Happening, shade};
use super::range::{Linear, Range, decades};
use super::scene::{Anchor, Point, Scene};
use super::style::{INK, MUTED, Stroke, bold, letters};
use super::ticks;
use crate::files::number::{duration, power_of_ten, short, significant};

/// Height of a panel with its heading [px].
pub(crate) const HEIGHT: f64 = HEADING + AXES;
const HEADING: f64 = 46.0;
const AXES: f64 = 330.0;
/// Room for the numbers on the left [px].
pub(crate) const LEFT: f64 = 76.0;
/// The label of axes in seconds.
pub(crate) const TIME: &str = "time [s]";
/// Width of the frame that shows a short excursion [px].
const STRIP: f64 = 214.0;
/// An excursion longer than this part of the run gets no frame of its own.
const SHORT: f64 = 0.2;

/// What all panels share.
pub(crate) struct View {
    pub t: Range,
    /// The last finite instant of a run that did not stay finite.
    pub diverged: Option<f64>,
    /// The time of which a run of samples was left its extremes, if it was \[s\].
    pub thinned: Option<f64>,
    pub buckets: usize,
    /// Spans that are shaded.
    pub happenings: Vec<Happening>,
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Scale {
    Linear,
    /// Absolute values, logarithmic.
    Decades,
}

/// A value that is not to be passed, and whose it is.
pub(crate) struct Limit {
    pub value: f64,
    pub of: String,
    pub stroke: Stroke,
}

pub(crate) struct Panel {
    pub title: &'static str,
    pub quantity: &'static str,
    pub unit: &'static str,
    pub scale: Scale,
    /// The part of the time that is shown, where all of it would be too dense; of linear axes.
    pub window: Option<Range>,
    /// Values that linear axes mark, where they are inside.
    pub limits: Vec<Limit>,
    pub curves: Vec<Curve>,
    /// Bounds of what is on an axis of decades.
    pub bounds: Vec<Falling>,
}

/// Runs of samples that are drawn as two points each: fine for few signals, coarser for many, so that files stay small.
pub(crate) fn buckets(signals: usize) -> usize {
    (18_000 / signals.max(1)).clamp(60, 500)
}

/// The time axis of a recording.
pub(crate) fn span(t: &[f64]) -> Range {
    let finite = || t.iter().copied().filter(|t| t.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    if low < high { Range { low, high } } else { Range { low: 0.0, high: 1.0 } }
}

impl Panel {
    /// Draws the panel with its upper left corner at `(x, y)`.
    pub(crate) fn draw(&self, scene: &mut Scene, [x, y]: Point, width: f64, view: &View) {
        scene.text([x + 14.0, y + 20.0], self.title, bold(15.0, INK), Anchor::Start);
        let place = [x, y + HEADING, width, AXES];
        let swings =
            self.scale == Scale::Linear && self.curves.iter().any(|curve| curve.swings(view.buckets));
        let bands = swings.then(|| "bands from the least to the largest value".to_owned());
        let note = match self.scale {
            Scale::Linear => self.linear(scene, place, view),
            Scale::Decades => Some(self.decades(scene, place, view)),
        };
        let end = view.diverged.map(|t| format!("not finite after {}", duration(t)));
        let note = [end, note, bands].into_iter().flatten().collect::<Vec<_>>().join("; ");
        if !note.is_empty() {
            scene.text([x + 14.0, y + 39.0], &note, letters(12.0, MUTED), Anchor::Start);
        }
    }

    fn decades(&self, scene: &mut Scene, place: [f64; 4], view: &View) -> String {
        let mut curves: Vec<Curve> = self.curves.iter().map(|curve| curve.exponents(view.buckets)).collect();
        let range = self.bounds.iter().fold(decades(&curves), |range, bound| bound.seen_on(range));
        curves.extend(self.bounds.iter().map(|bound| bound.line(view.t, range)));
        let label = format!("{} [{}]", self.quantity, self.unit);
        let y = Axis { range, ticks: ticks::decades(range), label: &label };
        draw(scene, &over_time(place, LEFT, view.t, TIME, y), &[], &curves, view);
        let samples = self.curves.iter().map(|curve| curve.t.len()).max().unwrap_or(0);
        match bucket_size(samples, view.buckets) {
            1 => "absolute values".to_owned(),
            size => format!("largest absolute value in each {}", duration(size as f64 * self.step())),
        }
    }

    /// Draws a linear axis, with a second frame for a short excursion. Returns what the frame cuts.
    fn linear(&self, scene: &mut Scene, place: [f64; 4], view: &View) -> Option<String> {
        if let Some(window) = self.window {
            return Some(self.detail(scene, place, view, window));
        }
        let range = if view.diverged.is_some() { Linear::of_diverged } else { Linear::of };
        let Linear { range, clipped } = range(&mut self.values());
        let excursion = clipped.then(|| self.excursion(range));
        let short = |window: &Range| view.diverged.is_none() && window.span() <= SHORT * view.t.span();
        if let Some(window) = excursion.filter(short) {
            return Some(self.split(scene, place, view, range, window));
        }
        let label = self.label(range);
        let axes = &over_time(place, LEFT, view.t, TIME, linear(range, &label));
        draw(scene, axes, &self.limits, &self.curves, view);
        clipped.then(|| format!("{} outside the frame", self.peak()))
    }

    /// Draws what is inside of `window` alone. Returns which part of the run that is.
    fn detail(&self, scene: &mut Scene, place: [f64; 4], view: &View, window: Range) -> String {
        let inside: Vec<Curve> = self.curves.iter().map(|curve| curve.within(window)).collect();
        let range = Linear::whole(inside.iter().flat_map(|curve| curve.values.iter().copied()));
        let label = self.label(range);
        let axes = over_time(place, LEFT, window, TIME, linear(range, &label));
        let view = View { t: window, diverged: None, happenings: Vec::new(), ..*view };
        draw(scene, &axes, &self.limits, &inside, &view);
        let [from, to, end] = [window.low, window.high, view.t.high].map(|t| short(t, 4));
        format!("detail: {from} to {to} s of {end} s")
    }

    /// The excursion on the left on its own scale, the whole run on the right. Returns what that cuts.
    fn split(&self, scene: &mut Scene, place: [f64; 4], view: &View, range: Range, window: Range) -> String {
        let [x, y, width, height] = place;
        let (scale, unit) = if window.high.abs() < 0.5 { (1e3, "ms") } else { (1.0, "s") };
        let zoomed: Vec<Curve> =
            self.curves.iter().map(|curve| curve.within(window).stretched(scale)).collect();
        let inside = Linear::whole(zoomed.iter().flat_map(|curve| curve.values.iter().copied()));
        let near = Range { low: scale * window.low, high: scale * window.high };
        let (label, time) = (self.label(inside), format!("time [{unit}]"));
        let left = over_time([x, y, STRIP, height], LEFT, near, &time, linear(inside, &label));
        let detail =
            View { t: near, diverged: None, buckets: view.buckets / 2, happenings: Vec::new(), ..*view };
        draw(scene, &left, &[], &zoomed, &detail);
        // The label on the left is of both frames, unless their numbers are in other units.
        let label =
            if ticks::power(range) == ticks::power(inside) { String::new() } else { self.label(range) };
        let right =
            over_time([x + STRIP, y, width - STRIP, height], 60.0, view.t, TIME, linear(range, &label));
        draw(scene, &right, &self.limits, &self.curves, view);
        let [from, to] = [near.low, near.high].map(|t| short(t, 3));
        let coarse =
            view.thinned.map(|t| format!("the extremes of each {}, ", duration(t))).unwrap_or_default();
        format!("left: {from} to {to} {unit}, {coarse}{}; right: whole run, axis cut", self.peak())
    }

    /// What a linear axis shows, and in which unit its numbers are.
    fn label(&self, range: Range) -> String {
        match ticks::power(range) {
            0 => format!("{} [{}]", self.quantity, self.unit),
            power => format!("{} [{} {}]", self.quantity, power_of_ten(power), self.unit),
        }
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

/// A frame in its place, left, top, width and height of everything with `left` px for labels, over time.
pub(crate) fn over_time<'a>(place: [f64; 4], left: f64, t: Range, label: &'a str, y: Axis<'a>) -> Axes<'a> {
    const TOP: f64 = 6.0;
    const RIGHT: f64 = 12.0;
    let [x, top, width, height] = place;
    let frame = [x + left, top + TOP, width - left - RIGHT, height - TOP - BOTTOM];
    let ticks = ticks::even(t, (frame[2] / 55.0).clamp(2.0, 10.0));
    Axes { frame, left, x: Axis { range: t, ticks, label }, y }
}

fn linear(range: Range, label: &str) -> Axis<'_> {
    Axis { range, ticks: ticks::even_by(range, 6.0, ticks::power(range)), label }
}

/// What happens, the frame, the limits inside it, the curves in their order, and a dotted line at the end of a run that did not stay finite.
fn draw(scene: &mut Scene, axes: &Axes, limits: &[Limit], curves: &[Curve], view: &View) {
    const END: Stroke = Stroke { color: MUTED, width: 1.2, dash: &[1.5, 3.0] };
    shade(scene, axes, &view.happenings);
    axes.draw(scene);
    let mut labels: Vec<(f64, String)> = Vec::new();
    for Limit { value, of, stroke } in limits.iter().filter(|limit| axes.y.range.contains(limit.value)) {
        axes.level(scene, *value, *stroke);
        let [_, y] = axes.place(axes.x.range.low, *value);
        match labels.iter_mut().find(|(other, _)| (other - y).abs() < 14.0) {
            Some((_, names)) => *names = format!("{names}, {of}"),
            None => labels.push((y, of.clone())),
        }
    }
    for (y, names) in labels {
        let [left, _, width, _] = axes.frame;
        let at = [left + width - 6.0, y - 4.0];
        scene.text(at, &format!("limit of {names}"), letters(12.0, MUTED), Anchor::End);
    }
    for curve in curves {
        axes.curve(scene, curve, view.buckets);
    }
    if let Some(t) = view.diverged {
        axes.mark(scene, t, END);
    }
}
