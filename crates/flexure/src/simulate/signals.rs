//! What can be read of a loop at an instant: the columns of its trace.

use flexure_core::control::Command;
use flexure_core::model::{Fjr, Links, Motion};

use crate::robot::MovingJoint;
use crate::simulate::controller::{Action, Said};
use crate::simulate::interface::Signal;
use crate::simulate::simulation::Instant;
use crate::units::{self, Unit};

/// What there is beside the motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns {
    /// Errors, link torque and rate of the v-CBC law.
    pub(crate) errors: bool,
    /// What the law sees, what it commands, what the guard says.
    pub(crate) devices: bool,
    /// What its guard does, and why.
    pub(crate) guard: bool,
}

/// Name and unit of a signal; vectors have one number per joint.
type Kind = (&'static str, Unit);

/// The columns of every trace, with units; vector signals have one column per joint.
const MOTION: [Kind; 7] = [
    ("q_l", units::ANGLE),
    ("q_m", units::ANGLE),
    ("dq_l", units::SPEED),
    ("dq_m", units::SPEED),
    ("q_ld", units::ANGLE),
    ("e_l", units::ANGLE),
    ("u_m", units::TORQUE),
];
/// Those of the v-CBC law.
const ERRORS: [Kind; 4] = [
    ("e_m", units::ANGLE),
    ("sigma_l", units::MOMENTUM),
    ("sigma_m", units::MOMENTUM),
    ("u_l", units::TORQUE),
];
/// Those of loops with devices: what a log of the robot would hold, and what the controller makes of it.
const DEVICES: [Kind; 9] = [
    ("q_l_measured", units::ANGLE),
    ("q_m_measured", units::ANGLE),
    ("u_m_measured", units::TORQUE),
    ("q_l_seen", units::ANGLE),
    ("q_m_seen", units::ANGLE),
    ("dq_l_seen", units::SPEED),
    ("dq_m_seen", units::SPEED),
    ("u_command", units::TORQUE),
    ("disturbance_m", units::TORQUE),
];
const ENERGY: [Kind; 4] = [
    ("hamiltonian", units::ENERGY),
    ("supplied", units::ENERGY),
    ("dissipated", units::ENERGY),
    ("energy_residual", units::ENERGY),
];
const RATE: Kind = ("rate", units::RATE);
/// 1 or 0: whether a certificate can hold, and whether the guard has stopped the robot.
const STATUS: [Kind; 2] = [("certificate", units::NONE), ("stopped", units::NONE)];
/// Codes: who decides the torque, and the first thing that is wrong.
const GUARD: [Kind; 2] = [("phase", units::NONE), ("fault", units::NONE)];

impl Columns {
    /// Name and unit of each column for a robot of these joints.
    pub(crate) fn signals(self, joints: &[MovingJoint]) -> Vec<Signal> {
        let signal = |name: String, unit: Unit| Signal { name, unit: unit.plain };
        let per_joint = |&(name, unit): &Kind| {
            let of_joint =
                |(k, joint): (usize, &MovingJoint)| signal(format!("{name}{k}"), unit.of(joint.kind));
            (1..).zip(joints).map(of_joint).collect::<Vec<_>>()
        };
        let scalar = |&(name, unit): &Kind| vec![signal(name.to_owned(), unit)];
        let (errors, devices) = (usize::from(self.errors), usize::from(self.devices));
        let vectors = MOTION.iter().chain(&ERRORS[..ERRORS.len() * errors]);
        let vectors = vectors.chain(&DEVICES[..DEVICES.len() * devices]).flat_map(per_joint);
        let scalars =
            ENERGY.iter().chain([RATE].iter().take(errors)).chain(&STATUS[..STATUS.len() * devices]);
        let scalars = scalars.chain(&GUARD[..GUARD.len() * usize::from(self.guard)]);
        scalar(&("t", units::TIME)).into_iter().chain(vectors).chain(scalars.flat_map(scalar)).collect()
    }

    /// Writes a number per column to `values`; `errors` are those of the v-CBC law at the true motion with its contraction rate
    /// there, if it is one.
    pub(crate) fn read<L: Links<f64, N>, const N: usize>(
        self,
        robot: &Fjr<f64, L, N>,
        instant: &Instant<'_, N>,
        errors: Option<&(Command<f64, N>, f64)>,
        values: &mut [f64],
    ) {
        let Instant { t, motion, action, energy, residual, ledger } = *instant;
        let n = robot.links.joints();
        let mut slots = values.iter_mut();
        let mut push = |numbers: &mut dyn Iterator<Item = f64>| {
            // The numbers first: a slot that is taken is filled.
            for (x, slot) in numbers.zip(slots.by_ref()) {
                *slot = x;
            }
        };
        let q_ld = action.reference.map(|jet| jet.coefficient(0));
        let Motion { q_l, q_m, v_l, v_m } = motion;
        push(&mut [t].into_iter());
        for v in [q_l, q_m, v_l, v_m, &q_ld, &(*q_l - q_ld), &action.applied.last()] {
            push(&mut v.iter().take(n));
        }
        if let Some((command, _)) = errors {
            let sigma = robot.state(&Motion { v_l: command.s_l, v_m: command.s_m, ..*motion });
            for v in [&command.e_m, &sigma.p_l, &sigma.p_m, &command.u_l] {
                push(&mut v.iter().take(n));
            }
        }
        if self.devices {
            let Action { measured, seen, reported, .. } = action;
            for v in [&measured.q_l, &measured.q_m, reported] {
                push(&mut v.iter().take(n));
            }
            for v in [&seen.q_l, &seen.q_m, &seen.v_l, &seen.v_m, &action.u_m, &action.disturbance] {
                push(&mut v.iter().take(n));
            }
        }
        push(&mut [energy, ledger.supplied, ledger.dissipated, residual].into_iter());
        push(&mut errors.iter().map(|(_, rate)| *rate));
        if self.devices {
            let flag = |holds: bool| f64::from(u8::from(holds));
            push(&mut [flag(action.certificate), flag(action.stopped)].into_iter());
        }
        if self.guard {
            // While the computer stands still nobody says anything.
            let said = action.guard.map_or([f64::NAN; 2], |Said { phase, fault }| {
                [phase.code(), fault.map_or(0, |(fault, _)| fault.code())].map(f64::from)
            });
            push(&mut said.into_iter());
        }
    }
}
