//! A log over the simulation: four panels, a table, a CSV file.

use std::path::{Path, PathBuf};

use comfy_table::{Cell, Row};

use super::curve::Curve;
use super::figure::{FigureOptions, curves, four, over};
use super::outputs::write_figure;
use super::panel::{Panel, Scale};
use super::scene::Scene;
use super::style::{INK, Stroke};
use super::table::{headed, right};
use crate::files::number::{NONE, duration, engineering};
use crate::files::{WriteError, create_folder};
use crate::replay::{JointResiduals, Replay, Residual};
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
    let closed = |name: &str| curves(trace, &format!("{name}_loop"), |_, _| Stroke::reference());
    let panels = [
        Panel {
            title: if side == "q_l" { "(a) link positions qₗ" } else { "(a) motor positions qₘ" },
            quantity: "position",
            unit: units::ANGLE.raised,
            scale: Scale::Linear,
            curves: over(over(logged(side), predicted(side)), closed(side)),
        },
        Panel {
            title: "(b) deflections qₘ − qₗ",
            quantity: "deflection",
            unit: units::ANGLE.raised,
            scale: Scale::Linear,
            curves: over(over(logged("deflection"), predicted("deflection")), closed("deflection")),
        },
        Panel {
            title: "(c) motor torques uₘ",
            quantity: "torque",
            unit: units::TORQUE.raised,
            scale: Scale::Linear,
            curves: over(logged("u_m"), closed("u_m")),
        },
        Panel {
            title: "(d) what the prediction misses, links and motors",
            quantity: "|prediction − log|",
            unit: units::ANGLE.raised,
            scale: Scale::Decades,
            curves: over(
                residuals(trace, "q_m_residual", Stroke::motor),
                residuals(trace, "q_l_residual", Stroke::link),
            ),
        },
    ];
    let options = FigureOptions {
        title: format!("{} against {}", replay.scenario, file_name(&replay.log)),
        subtitle: format!(
            "log, closed loop of the scenario, and the robot under the logged torque predicted {} ahead at most",
            duration(replay.horizon)
        ),
    };
    four(t, &panels, &options, &legend(&replay.joints, joints))
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

/// Joints with what the prediction misses of them, then line styles.
fn legend(found: &[JointResiduals], joints: usize) -> Vec<(String, Stroke)> {
    let joint = |(i, joint): (usize, &JointResiduals)| {
        let residual = joint.predicted_q_l.or(joint.predicted_q_m);
        let rms =
            residual.map_or(String::new(), |residual| format!(": {} rad rms", engineering(residual.rms)));
        (format!("{}{rms}", joint.name), Stroke::swatch(i, joints))
    };
    let side = |name: &str, stroke: Stroke| (name.to_owned(), Stroke { color: INK, ..stroke });
    let styles = [
        side("log; in (d) links", Stroke::link(0, 1)),
        side("prediction; in (d) motors", Stroke::motor(0, 1)),
        side("closed loop", Stroke::reference()),
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
