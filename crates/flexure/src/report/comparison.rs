//! Several runs in one axis: how fast each error decays.

use super::axes::{Axes, Labels};
use super::curve::Curve;
use super::figure::{buckets, span};
use super::range::{Range, decades};
use super::sheet::{MARGIN, Sheet};
use super::style::Stroke;
use crate::trace::Trace;

const WIDTH: f64 = 1200.0;
const HEIGHT: f64 = 470.0;

/// The largest |e_l| over the joints, on a logarithmic axis over time, one line per `(name, trace)`, as SVG.
pub fn comparison(traces: &[(&str, &Trace)]) -> String {
    let errors: Vec<Curve> =
        traces.iter().enumerate().map(|(run, (_, trace))| largest_error(trace, Stroke::run(run))).collect();
    let legend: Vec<(String, Stroke)> =
        traces.iter().enumerate().map(|(run, (name, _))| ((*name).to_owned(), Stroke::run(run))).collect();
    let y = decades(errors.iter().flat_map(|curve| curve.values.iter().copied()));
    let x = traces
        .iter()
        .map(|(_, trace)| span(trace.column("t").unwrap_or_default()))
        .reduce(|a, b| Range { low: a.low.min(b.low), high: a.high.max(b.high) })
        .unwrap_or(Range { low: 0.0, high: 1.0 });
    let curves: Vec<Curve> = errors.into_iter().map(Curve::exponents).collect();

    let mut sheet = Sheet::new(WIDTH, HEIGHT, "Largest link position error, run by run", "");
    let top = 60.0 + sheet.legend(60.0, &legend);
    sheet.scene.height = top + HEIGHT - 82.0;
    let axes = Axes {
        place: [MARGIN / 2.0, top - 6.0, WIDTH - MARGIN, HEIGHT - 82.0],
        x,
        y,
        x_label: "time [s]",
        y_label: "max |e_l| [rad]",
        y_labels: Labels::Decades,
        left: 76.0,
    };
    axes.draw(&mut sheet, &curves, None, buckets(traces.len()));
    sheet.finish()
}

/// The largest absolute link error over the joints; not a number from where a joint has none.
fn largest_error(trace: &Trace, stroke: Stroke) -> Curve {
    let joints = trace.joints("e_l");
    let largest = |sample: usize| {
        joints
            .iter()
            .map(|values| values[sample].abs())
            .fold(0.0, |a, b| if b.is_nan() || b > a { b } else { a })
    };
    let values: Vec<f64> = (0..trace.len()).map(largest).collect();
    Curve::new(trace.column("t").unwrap_or_default(), &values, stroke)
}
