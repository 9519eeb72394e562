//! The paper's four-panel figure of one closed-loop run.
//!
//! Positions and torques are on linear axes. Where a short excursion would flatten the rest (the first torque peak is
//! a hundred times what follows), the axis shows the bulk and a narrow frame beside it shows the excursion whole.
//! Errors and momentum errors are absolute values on a logarithmic axis: an exponential decay is a straight line.

use super::axes::{Axes, Labels};
use super::curve::Curve;
use super::number::{duration, significant};
use super::range::{Linear, Range, decades};
use super::sheet::{MARGIN, Sheet};
use super::style::{INK, MUTED, Stroke};
use crate::trace::Trace;

/// What is written above the panels.
#[derive(Clone, Debug, Default)]
pub struct FigureOptions {
    /// First line, bold.
    pub title: String,
    /// Second line; may be empty.
    pub subtitle: String,
}

const WIDTH: f64 = 1200.0;
/// Lines of a panel's heading.
const HEADING: f64 = 46.0;
const PANEL_WIDTH: f64 = (WIDTH - 2.0 * MARGIN) / 2.0;
const PANEL_HEIGHT: f64 = 330.0;
const LEFT: f64 = 76.0;

/// Positions, errors, momentum errors and torques of `trace` over time, as SVG.
///
/// A run that diverged is drawn up to its last finite sample, which is marked. Columns that are missing leave their
/// panel empty.
pub fn four_panel(trace: &Trace, options: &FigureOptions) -> String {
    let t = trace.column("t").unwrap_or_default();
    let joints = trace.joints("q_l").len().max(trace.joints("u_m").len());
    let dotted = |prefix| curves(trace, prefix, |_, _| Stroke::reference());
    let link = |prefix| curves(trace, prefix, Stroke::link);
    let motor = |prefix| curves(trace, prefix, Stroke::motor);

    let mut legend: Vec<(String, Stroke)> = (0..joints)
        .map(|joint| (format!("joint {}", joint + 1), Stroke { width: 4.0, ..Stroke::link(joint, joints) }))
        .collect();
    let side = |name: &str, stroke: Stroke| (name.to_owned(), Stroke { color: INK, ..stroke });
    legend.extend([
        side("link side", Stroke::link(0, 1)),
        side("motor side", Stroke::motor(0, 1)),
        side("reference", Stroke::reference()),
    ]);

    let mut positions = motor("q_m");
    positions.extend(link("q_l"));
    positions.extend(dotted("q_ld"));
    let panels = [
        Panel {
            title: "(a)  positions q_l, q_m and reference q_ld",
            y_label: "position [rad]",
            scale: Scale::Linear,
            curves: positions,
        },
        Panel {
            title: "(b)  position errors e_l, e_m",
            y_label: "|error| [rad]",
            scale: Scale::Decades,
            curves: over(motor("e_m"), link("e_l")),
        },
        Panel {
            title: "(c)  momentum errors σ_l, σ_m",
            y_label: "|momentum error| [kg m²/s]",
            scale: Scale::Decades,
            curves: over(motor("sigma_m"), link("sigma_l")),
        },
        Panel {
            title: "(d)  motor torques u_m",
            y_label: "torque [N m]",
            scale: Scale::Linear,
            curves: link("u_m"),
        },
    ];
    let signals: usize = panels.iter().map(|panel| panel.curves.len()).sum();

    let top = if options.subtitle.is_empty() { 62.0 } else { 82.0 };
    let height = top + 22.0 + 2.0 * (HEADING + PANEL_HEIGHT) + 8.0;
    let mut sheet = Sheet::new(WIDTH, height, &options.title, &options.subtitle);
    let top = top + sheet.legend(top, &legend);
    let view = View { t: span(t), diverged: divergence(t, &panels), buckets: buckets(signals) };
    for (index, panel) in panels.iter().enumerate() {
        let (row, column) = (index / 2, index % 2);
        let x = MARGIN / 2.0 + column as f64 * (PANEL_WIDTH + MARGIN / 2.0);
        let y = top + row as f64 * (HEADING + PANEL_HEIGHT);
        panel.draw(&mut sheet, (x, y), &view);
    }
    sheet.finish()
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

fn curves(trace: &Trace, prefix: &str, stroke: impl Fn(usize, usize) -> Stroke) -> Vec<Curve> {
    let t = trace.column("t").unwrap_or_default();
    let signals = trace.joints(prefix);
    signals
        .iter()
        .enumerate()
        .map(|(joint, values)| Curve::new(t, values, stroke(joint, signals.len())))
        .collect()
}

fn over(mut below: Vec<Curve>, above: Vec<Curve>) -> Vec<Curve> {
    below.extend(above);
    below
}

/// The last instant of the curve that ends first, if one ends before the recording does.
fn divergence(t: &[f64], panels: &[Panel]) -> Option<f64> {
    let curves = || panels.iter().flat_map(|panel| &panel.curves);
    let shortest = curves().min_by_key(|curve| curve.t.len())?;
    (shortest.t.len() < t.len()).then(|| shortest.t.last().copied().unwrap_or(0.0))
}

/// What all panels share.
struct View {
    t: Range,
    diverged: Option<f64>,
    buckets: usize,
}

#[derive(Clone, Copy, PartialEq)]
enum Scale {
    Linear,
    Decades,
}

struct Panel {
    title: &'static str,
    y_label: &'static str,
    scale: Scale,
    curves: Vec<Curve>,
}

impl Panel {
    fn draw(&self, sheet: &mut Sheet, (x, y): (f64, f64), view: &View) {
        sheet.text((x + 14.0, y + 20.0), self.title, 15, INK, true);
        let note = match self.scale {
            Scale::Linear => self.linear(sheet, (x, y + HEADING), view),
            Scale::Decades => self.decades(sheet, (x, y + HEADING), view),
        };
        let end = view.diverged.map(|t| format!("no finite value after {}", duration(t)));
        let note = [end, note].into_iter().flatten().collect::<Vec<_>>().join("  ·  ");
        sheet.text((x + 14.0, y + 39.0), &note, 12, MUTED, false);
    }

    fn decades(&self, sheet: &mut Sheet, (x, y): (f64, f64), view: &View) -> Option<String> {
        let y_range = decades(self.values());
        let exponents: Vec<Curve> = self.curves.iter().cloned().map(Curve::exponents).collect();
        let axes = Axes {
            y_labels: Labels::Decades,
            ..self.axes([x, y, PANEL_WIDTH, PANEL_HEIGHT], view.t, y_range)
        };
        axes.draw(sheet, &exponents, view.diverged, view.buckets);
        Some("absolute values, logarithmic; zero crossings leave the frame below".to_owned())
    }

    fn linear(&self, sheet: &mut Sheet, (x, y): (f64, f64), view: &View) -> Option<String> {
        let Linear { range, clipped } = Linear::of(self.values());
        let whole = [x, y, PANEL_WIDTH, PANEL_HEIGHT];
        if !clipped {
            self.axes(whole, view.t, range).draw(sheet, &self.curves, view.diverged, view.buckets);
            return None;
        }
        let peak = self.peak();
        let excursion = self.excursion(range);
        if excursion.span() > 0.2 * view.t.span() {
            self.axes(whole, view.t, range).draw(sheet, &self.curves, view.diverged, view.buckets);
            return Some(format!("frame cuts the excursions; {peak}"));
        }
        const STRIP: f64 = 210.0;
        let (scale, unit) = if excursion.high - view.t.low < 0.5 { (1e3, "ms") } else { (1.0, "s") };
        let strip: Vec<Curve> =
            self.curves.iter().map(|curve| stretched(&curve.within(excursion), scale)).collect();
        let inside = strip.iter().flat_map(|curve| curve.values.iter().copied());
        let x_range = Range { low: scale * excursion.low, high: scale * excursion.high };
        let x_label = format!("time [{unit}]");
        let zoom = Axes {
            x_label: &x_label,
            ..self.axes([x, y, STRIP, PANEL_HEIGHT], x_range, Linear::whole(inside))
        };
        let zoom = Axes { left: LEFT + 4.0, ..zoom };
        zoom.draw(sheet, &strip, None, view.buckets / 2);
        let rest = [x + STRIP, y, PANEL_WIDTH - STRIP, PANEL_HEIGHT];
        let rest = Axes { y_label: "", left: 52.0, ..self.axes(rest, view.t, range) };
        rest.draw(sheet, &self.curves, view.diverged, view.buckets);
        let [from, to] = [excursion.low, excursion.high].map(|t| significant(scale * t, 3));
        Some(format!("left: {from} to {to} {unit}, {peak}; right: whole run, cut there"))
    }

    fn axes(&self, place: [f64; 4], x: Range, y: Range) -> Axes<'static> {
        Axes { place, x, y, x_label: "time [s]", y_label: self.y_label, y_labels: Labels::Linear, left: LEFT }
    }

    fn values(&self) -> impl Iterator<Item = f64> {
        self.curves.iter().flat_map(|curve| curve.values.iter().copied())
    }

    /// The window of time that holds every sample outside `range`, with a little more on both sides.
    fn excursion(&self, range: Range) -> Range {
        let outside = self.curves.iter().flat_map(|curve| {
            curve.t.iter().zip(&curve.values).filter(|&(_, &value)| !range.contains(value)).map(|(&t, _)| t)
        });
        let (first, last) =
            outside.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| (low.min(t), high.max(t)));
        let t = span(self.curves.first().map_or(&[], |curve| &curve.t));
        let step = t.span() / self.curves.first().map_or(1, |curve| curve.t.len().max(2) - 1) as f64;
        let margin = (0.5 * (last - first)).max(4.0 * step);
        Range { low: (first - margin).max(t.low), high: (last + margin).min(t.high) }
    }

    /// Where the largest absolute value is.
    fn peak(&self) -> String {
        let unit = if self.y_label.contains("N m") { "N m" } else { "rad" };
        let samples =
            self.curves.iter().flat_map(|curve| curve.t.iter().copied().zip(curve.values.iter().copied()));
        let (t, value) = samples.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).unwrap_or_default();
        format!("peak {} {unit} at {}", significant(value.abs(), 4), duration(t))
    }
}

/// The curve on a finer unit of time.
fn stretched(curve: &Curve, scale: f64) -> Curve {
    Curve { t: curve.t.iter().map(|t| scale * t).collect(), ..curve.clone() }
}
