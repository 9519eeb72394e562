//! Records a closed-loop run as a trace.

use flexure_core::control::Command;
use flexure_core::guard::{Certificate, Phase};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};

use crate::simulate::Instant;
use crate::simulate::trace::Trace;
use crate::units::{self, Unit};

/// Watches a run, instant by instant.
pub(crate) struct Recorder {
    trace: Trace,
    row: Vec<f64>,
    columns: Columns,
}

/// What is recorded beside the motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns {
    /// Errors, link torque and rate of the v-CBC law.
    pub(crate) errors: bool,
    /// What the law sees, what it commands, what the guard says.
    pub(crate) devices: bool,
}

type Signal = (&'static str, Unit);

/// The columns of every trace, with units; vector signals have one column per joint.
const MOTION: [Signal; 7] = [
    ("q_l", units::ANGLE),
    ("q_m", units::ANGLE),
    ("dq_l", units::SPEED),
    ("dq_m", units::SPEED),
    ("q_ld", units::ANGLE),
    ("e_l", units::ANGLE),
    ("u_m", units::TORQUE),
];
/// Those of the v-CBC law.
const ERRORS: [Signal; 4] = [
    ("e_m", units::ANGLE),
    ("sigma_l", units::MOMENTUM),
    ("sigma_m", units::MOMENTUM),
    ("u_l", units::TORQUE),
];
/// Those of loops with devices.
const DEVICES: [Signal; 6] = [
    ("q_l_seen", units::ANGLE),
    ("q_m_seen", units::ANGLE),
    ("dq_l_seen", units::SPEED),
    ("dq_m_seen", units::SPEED),
    ("u_command", units::TORQUE),
    ("disturbance_m", units::TORQUE),
];
const ENERGY: [Signal; 4] = [
    ("hamiltonian", units::ENERGY),
    ("supplied", units::ENERGY),
    ("dissipated", units::ENERGY),
    ("energy_residual", units::ENERGY),
];
const RATE: Signal = ("rate", units::RATE);
/// 1 or 0: whether a certificate can hold, and whether the guard has stopped the robot.
const STATUS: [Signal; 2] = [("certificate", units::NONE), ("stopped", units::NONE)];

impl Recorder {
    pub(crate) fn new(joints: usize, columns: Columns) -> Self {
        let per_joint = |(name, unit): Signal| {
            (1..=joints).map(move |k| (format!("{name}{k}"), unit.plain)).collect::<Vec<_>>()
        };
        let scalar = |(name, unit): Signal| vec![(name.to_owned(), unit.plain)];
        let (errors, devices) = (usize::from(columns.errors), usize::from(columns.devices));
        let vectors = MOTION.iter().chain(&ERRORS[..ERRORS.len() * errors]);
        let vectors =
            vectors.chain(&DEVICES[..DEVICES.len() * devices]).flat_map(|&signal| per_joint(signal));
        let scalars = ENERGY.iter().chain([RATE].iter().take(errors));
        let scalars = scalars.chain(&STATUS[..STATUS.len() * devices]).flat_map(|&signal| scalar(signal));
        let names = scalar(("t", units::TIME)).into_iter().chain(vectors).chain(scalars);
        let trace = Trace::new(names);
        Self { row: Vec::with_capacity(trace.columns().len()), trace, columns }
    }

    /// Adds a row; `errors` are those of the v-CBC law at the true motion and `rate` its contraction rate there, if it is one.
    pub(crate) fn record<L: Links<f64, N>, const N: usize>(
        &mut self,
        robot: &Fjr<f64, L, N>,
        instant: &Instant<'_, N>,
        errors: Option<(&Command<f64, N>, f64)>,
    ) {
        let Instant { t, motion, action, energy, residual, ledger } = *instant;
        let q_ld = action.reference.map(|jet| jet.coefficient(0));
        let Columns { devices, .. } = self.columns;
        let row = &mut self.row;
        row.clear();
        row.push(t);
        let mut push = |vectors: &[&Vector<f64, N>]| row.extend(vectors.iter().flat_map(|v| v.iter()));
        let Motion { q_l, q_m, v_l, v_m } = motion;
        push(&[q_l, q_m, v_l, v_m, &q_ld, &(*q_l - q_ld), &action.applied.last()]);
        if let Some((command, _)) = errors {
            let sigma = robot.state(&Motion { v_l: command.s_l, v_m: command.s_m, ..*motion });
            push(&[&command.e_m, &sigma.p_l, &sigma.p_m, &command.u_l]);
        }
        if devices {
            let seen = &action.seen;
            push(&[&seen.q_l, &seen.q_m, &seen.v_l, &seen.v_m, &action.u_m, &action.disturbance]);
        }
        row.extend([energy, ledger.supplied, ledger.dissipated, residual]);
        row.extend(errors.map(|(_, rate)| rate));
        if devices {
            let flag = |holds: bool| f64::from(u8::from(holds));
            let status = &action.status;
            row.push(flag(status.is_none_or(|status| status.certificate() == Certificate::Holds)));
            row.push(flag(status.is_some_and(|status| status.phase != Phase::Following)));
        }
        self.trace.push(&self.row);
    }

    pub(crate) fn finish(self) -> Trace {
        self.trace
    }
}
