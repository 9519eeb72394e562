//! Control laws: their gains in files, gains to start from, and the laws of the core by name.
//!
//! A law is a file here, which says what `[controller]` has for it, and a line in the list below; its equations are those of
//! [`flexure_core::control`].

mod adaptation;
mod adaptive_command_filtered_backstepping;
mod adaptive_vcbc;
mod backstepping;
mod cascade;
mod command_filtered_backstepping;
mod composite_ph;
mod control_by_interconnection;
mod disturbance_rejecting;
mod disturbance_rejecting_vcbc;
pub(crate) mod document;
mod drive;
mod esp;
mod feedback_linearization;
mod feedforward_pd;
mod gain;
mod gravity_cancellation;
mod h_infinity;
mod ida_pbc;
mod immersion_invariance;
mod integral_manifold;
mod link_impedance;
mod link_position_feedback;
mod loria_ortega;
mod lqr;
mod motor_observer_pd;
mod motor_position_pd;
mod motor_position_pd_capped;
mod mpc;
mod optimal;
mod passivity;
mod pd;
mod pd_online_gravity;
mod pid;
mod position_feedback;
mod rates;
mod registry;
mod rigid_vcbc;
mod sea_cascade;
mod shaping;
mod side;
mod singular_perturbation;
mod sliding_mode;
mod starting;
mod torque_feedback;
mod vcbc;

use flexure_core::control::{self, Applied, ControlLaw as _, DynamicLaw as _, Seen};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::{Jet, Over, Piecewise, Scalar};

use crate::files::{Entry, Problems};
use crate::robot::Robot;
use gain::{GainSet, ReadGains};
use std::marker::PhantomData;

use registry::{Doubt, LawKind, Maker, all, constants, first, laws, reads};

pub use drive::Drive;
pub use gain::Gain;
pub use rates::BlockRates;
pub use registry::{About, Claim, LawMemory, PARTS};
pub use shaping::{AnyShaping, Extra, Phi, SHAPING};
pub use side::SideGains;
pub(crate) use starting::drives;
pub use vcbc::{Law, VcbcGains, command, law, law_over};

// One line a law, in the order in which lists show them.
laws! {
    static:
        vcbc::Vcbc,
        pd::Pd,
        pd_online_gravity::PdOnlineGravity,
        rigid_vcbc::RigidVcbc,
        feedback_linearization::FeedbackLinearization,
        feedforward_pd::FeedforwardPd,
        integral_manifold::IntegralManifold,
        passivity::Passivity,
        torque_feedback::TorqueFeedback,
        singular_perturbation::SingularPerturbation,
        gravity_cancellation::GravityCancellation,
        backstepping::Backstepping,
        cascade::Cascade,
        esp::Esp,
        immersion_invariance::ImmersionInvariance,
        ida_pbc::IdaPbc,
        link_impedance::LinkImpedance,
        composite_ph::CompositePh,
        sliding_mode::SlidingMode,
        lqr::Lqr,
        h_infinity::HInfinity,
        mpc::Mpc;
    dynamic:
        position_feedback::PositionFeedback,
        link_position_feedback::LinkPositionFeedback,
        motor_position_pd::MotorPositionPd,
        motor_position_pd_capped::MotorPositionPdCapped,
        motor_observer_pd::MotorObserverPd,
        control_by_interconnection::ControlByInterconnection,
        loria_ortega::LoriaOrtega,
        disturbance_rejecting::DisturbanceRejecting,
        disturbance_rejecting_vcbc::DisturbanceRejectingVcbc,
        sea_cascade::SeaCascade,
        pid::Pid,
        command_filtered_backstepping::CommandFilteredBackstepping,
        adaptive_command_filtered_backstepping::AdaptiveCommandFilteredBackstepping,
        adaptive_vcbc::AdaptiveVcbc;
}

/// The registered name of v-CBC.
pub(crate) const VCBC: &str = <vcbc::Vcbc as LawKind>::NAME;

/// What is known of the kind of law `kind`; none for names that are not registered.
pub fn about(kind: &str) -> Option<About> {
    ABOUT.iter().find(|(name, _)| *name == kind).map(|(_, about)| *about)
}

/// The memory of `law` in a loop that starts with the robot at `x`: [`AnyLaw::start`], compiled once per robot.
#[inline(never)]
pub(crate) fn start<L: Links<f64, N>, const N: usize>(
    law: &AnyLaw<f64, N>,
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
) -> LawMemory<f64, N> {
    law.start(robot, x, q_ld)
}

/// The memory of `law` a `period` in s after it was `z`: [`AnyLaw::advanced`], compiled once per robot.
#[inline(never)]
pub(crate) fn advanced<L: Links<f64, N>, const N: usize>(
    law: &AnyLaw<f64, N>,
    robot: &Fjr<f64, L, N>,
    seen: [&Seen<f64, N>; 2],
    z: &LawMemory<f64, N>,
    applied: &Applied<f64, N>,
    period: f64,
) -> LawMemory<f64, N> {
    law.advanced(robot, seen, z, applied, period)
}

/// What `law` asks of the motors of the robot at `x` [N m], following `q_ld`, the reference in rad to order 4, with the memory `z`. Compiled
/// once per robot, as [`command`] is.
#[inline(never)]
pub fn torque<L: Links<f64, N>, const N: usize>(
    law: &AnyLaw<f64, N>,
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
    z: &LawMemory<f64, N>,
) -> Vector<f64, N> {
    if let AnyLaw::Vcbc(law) = law {
        // The code that `command` is anyway.
        return command(law, robot, x, q_ld).u_m;
    }
    law.torque(robot, x, q_ld, z)
}
