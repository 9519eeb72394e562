//! Several runs in one axis: how fast each error decays.

use crate::files::number::{duration, significant};
use crate::report::Sketch;
use crate::report::draw::axes::Axis;
use crate::report::draw::curve::Curve;
use crate::report::draw::panel::{LEFT, TIME, buckets, over_time};
use crate::report::draw::range::{Range, decades};
use crate::report::draw::scene::Scene;
use crate::report::draw::sheet::{MARGIN, line_legend, page};
use crate::report::draw::style::Stroke;
use crate::report::draw::ticks;

const WIDTH: f64 = 1200.0;
const HEIGHT: f64 = 400.0;
const TITLE: &str = "Largest link position error of each run";

/// The largest |e_l| over the joints, on a logarithmic axis over time, one line per `(name, run)`.
///
/// Where every run reaches its floor early, the axis shows the decay alone, and says what was left out.
pub fn comparison(runs: &[(&str, &Sketch)]) -> Scene {
    let errors: Vec<Curve> =
        runs.iter().enumerate().map(|(k, (_, run))| run.largest_error(Stroke::run(k))).collect();
    let legend: Vec<(String, Stroke)> =
        runs.iter().enumerate().map(|(k, (name, _))| ((*name).to_owned(), Stroke::run(k))).collect();
    let whole = runs
        .iter()
        .map(|(_, run)| run.span())
        .reduce(|a, b| Range { low: a.low.min(b.low), high: a.high.max(b.high) })
        .unwrap_or(Range { low: 0.0, high: 1.0 });
    let x = decay(&errors, whole).unwrap_or(whole);
    let shown: Vec<Curve> = errors.iter().map(|curve| curve.within(x)).collect();
    let buckets = buckets(runs.len());
    let mut curves: Vec<Curve> = shown.iter().map(|curve| curve.exponents(buckets)).collect();
    // Runs that coincide both show: broken lines lie on top of solid ones.
    curves.sort_by_key(|curve| !curve.stroke.dash.is_empty());
    let y = decades(&curves);

    let subtitle = if x == whole { String::new() } else { left_out(&errors, x, whole) };
    let (mut scene, top) = page(WIDTH, TITLE, &subtitle);
    let top = top + line_legend(&mut scene, top, &legend) - 6.0;
    scene.height = top + HEIGHT + 6.0;
    let y = Axis { range: y, ticks: ticks::decades(y), label: "max |eₗ| [rad]" };
    let axes = over_time([MARGIN / 2.0, top, WIDTH - MARGIN, HEIGHT], LEFT, x, TIME, y);
    axes.draw(&mut scene);
    for curve in &curves {
        axes.curve(&mut scene, curve, buckets);
    }
    scene
}

/// One and a half times the time in which every run comes down to three times what it does in its second half, if that is short and
/// nothing worth seeing follows.
fn decay(errors: &[Curve], whole: Range) -> Option<Range> {
    let settled = |curve: &Curve| {
        let floor = largest(&curve.values[curve.values.len() / 2..]);
        let last = curve.values.iter().rposition(|&value| value > 3.0 * floor);
        last.map_or(whole.low, |sample| curve.t[sample])
    };
    let slowest = errors.iter().map(settled).fold(whole.low, f64::max);
    let high = whole.low + 1.5 * (slowest - whole.low);
    let nothing_follows =
        after(errors, high) < 1e-2 * errors.iter().map(|curve| largest(&curve.values)).fold(0.0, f64::max);
    (high > whole.low && high < whole.low + 0.5 * whole.span() && nothing_follows)
        .then_some(Range { high, ..whole })
}

fn left_out(errors: &[Curve], x: Range, whole: Range) -> String {
    let rest = significant(after(errors, x.high), 2);
    format!(
        "first {} of {}; after that every error stays within {rest} rad",
        duration(x.span()),
        duration(whole.span())
    )
}

/// The largest value of any curve later than `t`.
fn after(errors: &[Curve], t: f64) -> f64 {
    errors
        .iter()
        .map(|curve| largest(&curve.values[curve.t.partition_point(|&at| at <= t)..]))
        .fold(0.0, f64::max)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}
