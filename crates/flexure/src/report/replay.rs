//! A log over the simulation: four panels, a table, a CSV file.

use std::path::{Path, PathBuf};

use comfy_table::{Cell, Row};

use super::outputs::write_figure;
use crate::files::number::{NONE, duration, engineering};
use crate::files::{WriteError, create_folder};
use crate::replay::{JointResiduals, Replay, Residual};
use crate::report::draw::curve::Curve;
use crate::report::draw::panel::{Panel, Scale, View, span};
use crate::report::draw::range::Range;
use crate::report::draw::scene::Scene;
use crate::report::draw::style::{INK, Stroke};
use crate::report::figures::run::{FigureOptions, buckets, four, over};
use crate::report::tables::summary::{headed, right};
use crate::simulate::{Trace, write_trace};
use crate::units;

/// Positions, deflections and torques of log, closed loop and prediction, and what the prediction misses.
pub fn replay_figure(replay: &Replay) -> Scene {
    let trace = &replay.trace;
    let t = trace.column("t").unwrap_or_default();
    let joints = replay.joints.len();
    let side = if trace.joints("q_l").is_empty() { "q_m" } else { "q_l" };
    let logged = |name: &str| curves(trace, name, Stroke::link);
    let predicted = |name: &str| curves(trace, &format!("{name}_predicted"), Stroke::motor);
    let closed = |name: &str| curves(trace, &format!("{name}_loop"), Stroke::dotted);
    let window = detail(t, &trace.joints("u_m"));
    let panels = [
        Panel {
            title: if side == "q_l" {
                "(a) link positions qₗ, less their means in the log"
            } else {
                "(a) motor positions qₘ, less their means in the log"
            },
            quantity: "position",
            unit: units::ANGLE.raised,
            scale: Scale::Linear,
            window: None,
            limits: Vec::new(),
            curves: centred(over(over(logged(side), predicted(side)), closed(side)), trace, side),
            bounds: Vec::new(),
        },
        Panel {
            title: "(b) deflections qₘ − qₗ",
            quantity: "deflection",
            unit: units::ANGLE.raised,
            scale: Scale::Linear,
            window,
            limits: Vec::new(),
            curves: over(over(logged("deflection"), predicted("deflection")), closed("deflection")),
            bounds: Vec::new(),
        },
        Panel {
            title: "(c) motor torques uₘ",
            quantity: "torque",
            unit: units::TORQUE.raised,
            scale: Scale::Linear,
            window,
            limits: Vec::new(),
            curves: over(logged("u_m"), closed("u_m")),
            bounds: Vec::new(),
        },
        Panel {
            title: if side == "q_l" {
                "(d) prediction − log, link positions qₗ"
            } else {
                "(d) prediction − log, motor positions qₘ"
            },
            quantity: "|prediction − log|",
            unit: units::ANGLE.raised,
            scale: Scale::Decades,
            window: None,
            limits: Vec::new(),
            curves: residuals(trace, &format!("{side}_residual"), Stroke::link),
            bounds: Vec::new(),
        },
    ];
    let options = FigureOptions {
        title: format!("{} against {}", replay.scenario, file_name(&replay.log)),
        subtitle: format!(
            "log, closed loop of the scenario, and the robot under the logged torque predicted {} ahead at most",
            duration(replay.horizon)
        ),
        ..FigureOptions::default()
    };
    let view = View {
        t: span(t),
        diverged: divergence(t, &panels),
        thinned: None,
        buckets: buckets(&panels),
        happenings: Vec::new(),
    };
    four(&view, &panels, &options, &legend(&replay.joints, joints))
}

/// The curves of log, prediction and closed loop, joint by joint each, less the means of the signal `side` in the log: joints that stand
/// far from each other would look still.
fn centred(mut curves: Vec<Curve>, trace: &Trace, side: &str) -> Vec<Curve> {
    let logged = trace.joints(side);
    let means: Vec<f64> = logged.iter().map(|q| q.iter().sum::<f64>() / q.len() as f64).collect();
    for (curve, mean) in curves.iter_mut().zip(means.iter().cycle()) {
        for value in &mut curve.values {
            *value -= mean;
        }
    }
    curves
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

/// The last instant of the curve that ends first, if one ends before the recording does.
fn divergence(t: &[f64], panels: &[Panel]) -> Option<f64> {
    let curves = || panels.iter().flat_map(|panel| &panel.curves);
    let shortest = curves().min_by_key(|curve| curve.t.len())?;
    (shortest.t.len() < t.len()).then(|| shortest.t.last().copied().unwrap_or(0.0))
}

/// The last part of a path.
fn file_name(path: &str) -> &str {
    Path::new(path).file_name().and_then(|name| name.to_str()).unwrap_or(path)
}

/// The signals `prefix` where they are numbers: a prediction that broke off goes on with the next window.
fn residuals(trace: &Trace, prefix: &str, stroke: impl Fn(usize, usize) -> Stroke) -> Vec<Curve> {
    let t = trace.column("t").unwrap_or_default();
    let signals = trace.joints(prefix);
    let curve = |(joint, values): (usize, &&[f64])| {
        let (t, values): (Vec<f64>, Vec<f64>) =
            t.iter().zip(values.iter()).filter(|(_, value)| value.is_finite()).unzip();
        Curve::new(&t, &values, stroke(joint, signals.len()))
    };
    signals.iter().enumerate().map(curve).collect()
}

/// Times that a signal may pass its mean and still be legible whole, and as often it passes it in a detail, about.
const LEGIBLE: usize = 60;
const DETAIL: f64 = 24.0;

/// Where to look closer: around the largest of `signals` over the times `t`; none where the whole is legible.
fn detail(t: &[f64], signals: &[&[f64]]) -> Option<Range> {
    let passes = |values: &&[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.windows(2).filter(|pair| (pair[0] < mean) != (pair[1] < mean)).count()
    };
    let most = signals.iter().map(passes).max().filter(|most| *most > LEGIBLE)?;
    let samples = signals.iter().flat_map(|values| t.iter().zip(values.iter()));
    let (peak, _) = samples.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let whole = span(t);
    // 1, 2 or 5 times a power of ten, in s.
    let about = whole.span() * DETAIL / most as f64;
    let decade = 10f64.powf(about.log10().floor());
    let width = decade * [5.0, 2.0].into_iter().find(|k| k * decade <= about).unwrap_or(1.0);
    let begin = (peak - 0.5 * width).clamp(whole.low, whole.high - width);
    let low = 0.1 * width * (10.0 * begin / width).floor();
    Some(Range { low, high: low + width })
}

/// Joints with what the prediction misses of them, then line styles.
fn legend(found: &[JointResiduals], joints: usize) -> Vec<(String, Stroke)> {
    let joint = |(i, joint): (usize, &JointResiduals)| {
        let residual = joint.predicted_q_l.or(joint.predicted_q_m);
        let rms = residual
            .map_or(String::new(), |residual| format!(": rms in (d) {} rad", engineering(residual.rms)));
        (format!("{}{rms}", joint.name), Stroke::swatch(i, joints))
    };
    let side = |name: &str, stroke: Stroke| (name.to_owned(), Stroke { color: INK, ..stroke });
    let styles = [
        side("log", Stroke::link(0, 1)),
        side("prediction", Stroke::motor(0, 1)),
        side("closed loop", Stroke::dotted(0, 1)),
    ];
    found.iter().enumerate().map(joint).chain(styles).collect()
}

/// A column: three lines of heading, the residual that stands in it.
type Column = (&'static str, fn(&JointResiduals) -> Option<Residual>);

const COLUMNS: [Column; 7] = [
    ("predicted\nq_l\n[rad]", |joint| joint.predicted_q_l),
    ("predicted\nq_m\n[rad]", |joint| joint.predicted_q_m),
    ("predicted\nq_m − q_l\n[rad]", |joint| joint.predicted_deflection),
    ("loop\nq_l\n[rad]", |joint| joint.loop_q_l),
    ("loop\nq_m\n[rad]", |joint| joint.loop_q_m),
    ("loop\nq_m − q_l\n[rad]", |joint| joint.loop_deflection),
    ("loop\nu_m\n[N m]", |joint| joint.loop_u_m),
];

/// One row a joint: root mean square of simulation minus log, with its part of what the logged signal moves; at most 100 columns
/// wide.
pub fn replay_table(replay: &Replay) -> String {
    let columns: Vec<Column> =
        COLUMNS.into_iter().filter(|(_, of)| replay.joints.iter().any(|joint| of(joint).is_some())).collect();
    let mut table = headed(["joint"].into_iter().chain(columns.iter().map(|(title, _)| *title)));
    for joint in &replay.joints {
        let cell = |residual: Option<Residual>| {
            right(residual.map_or(NONE.to_owned(), |Residual { rms, signal, .. }| {
                let share = 100.0 * rms / signal;
                let share =
                    if share.is_finite() { format!("\n{} %", engineering(share)) } else { String::new() };
                format!("{}{share}", engineering(rms))
            }))
        };
        let numbers = columns.iter().map(|(_, of)| cell(of(joint)));
        table.add_row(Row::from(std::iter::once(Cell::new(&joint.name)).chain(numbers).collect::<Vec<_>>()));
    }
    table.to_string()
}

/// Writes `NAME.replay.csv` and the figure into `folder`, which is created if missing; returns the paths.
///
/// # Errors
/// If a file cannot be written; none is ever half written.
pub fn write_replay(folder: &Path, replay: &Replay) -> Result<Vec<PathBuf>, WriteError> {
    create_folder(folder)?;
    let name = format!("{}.replay", replay.scenario);
    let table = folder.join(format!("{name}.csv"));
    write_trace(&table, &replay.trace)?;
    let [svg, png] = write_figure(folder, &name, &replay_figure(replay))?;
    Ok(vec![table, svg, png])
}

#[cfg(test)]
mod tests {
    use super::detail;

    #[test]
    fn what_swings_often_is_shown_in_detail() {
        let t: Vec<f64> = (0..20_001).map(|k| 1e-3 * f64::from(k)).collect();
        let swing = |hertz: f64| t.iter().map(|t| (1.0 + 0.1 * t) * (hertz * t).sin()).collect::<Vec<_>>();
        let (slow, fast) = (swing(3.0), swing(60.0));
        assert!(detail(&t, &[&slow]).is_none() && detail(&t, &[]).is_none() && detail(&[], &[]).is_none());
        let window = detail(&t, &[&slow, &fast]).expect("a detail");
        assert!(
            (window.span() - 1.0).abs() < 1e-9 && window.low >= 18.5 && window.high <= 20.0 + 1e-9,
            "{window:?}"
        );
    }
}
