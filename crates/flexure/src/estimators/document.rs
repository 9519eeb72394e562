//! `[estimator]` and `[disturbance_observer]`: what the controller makes of its sensors.

use crate::files::field::{Field, Joints};
use crate::files::quantity;
use crate::files::table::Table;

/// Where the motion that the law sees comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Estimator {
    /// A model of the robot, corrected by encoders: kind `observer`.
    Observer {
        /// Encoders whose readings correct it.
        encoders: Encoders,
        /// How fast its errors decay > 0, per joint [rad/s].
        bandwidth: Vec<f64>,
    },
}

/// Encoders that an observer uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoders {
    /// Encoders on links and motors.
    Both,
    /// Encoders on the motors; link positions are estimated.
    Motor,
}

/// Estimates the torque that the model does not explain.
#[derive(Clone, Debug, PartialEq)]
pub struct DisturbanceObserver {
    /// How fast it follows > 0, per joint [rad/s].
    pub bandwidth: Vec<f64>,
    /// Whether the law is helped by its estimate, or it is only recorded.
    pub compensate: bool,
}

/// Reads `[estimator]`.
#[expect(clippy::option_option, reason = "bad, absent and good are three cases")]
pub(crate) fn read(root: &Table<'_>, joints: &Joints) -> Option<Option<Estimator>> {
    root.optional("estimator", |field| {
        let table = field.table(&["kind", "encoders", "bandwidth"])?;
        table.choice("kind", &[("observer", ())])?;
        let encoders = table.optional("encoders", |field| {
            field.choice(&[("both", Encoders::Both), ("motor", Encoders::Motor)])
        });
        let bandwidth = table.per_joint("bandwidth", joints, &quantity::BANDWIDTH);
        Some(Estimator::Observer { encoders: encoders?.unwrap_or(Encoders::Both), bandwidth: bandwidth? })
    })
}

/// Reads `[disturbance_observer]`.
#[expect(clippy::option_option, reason = "bad, absent and good are three cases")]
pub(crate) fn read_disturbance_observer(
    root: &Table<'_>,
    joints: &Joints,
) -> Option<Option<DisturbanceObserver>> {
    root.optional("disturbance_observer", |field| {
        let table = field.table(&["bandwidth", "compensate"])?;
        let bandwidth = table.per_joint("bandwidth", joints, &quantity::BANDWIDTH);
        let compensate = table.optional("compensate", Field::boolean);
        Some(DisturbanceObserver { bandwidth: bandwidth?, compensate: compensate?.unwrap_or(true) })
    })
}
