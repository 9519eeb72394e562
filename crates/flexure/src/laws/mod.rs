//! Control laws: their gains in files, gains to start from, and the laws of the core by name.
//!
//! A law is a file here, which says what `[controller]` has for it, and a line in the list below; its equations are those of
//! [`flexure_core::control`].

mod backstepping;
mod cascade;
pub(crate) mod document;
mod drive;
mod esp;
mod feedback_linearization;
mod feedforward_pd;
mod gain;
mod gravity_cancellation;
mod integral_manifold;
mod passivity;
mod pd;
mod pd_online_gravity;
mod rates;
mod registry;
mod rigid_vcbc;
mod shaping;
mod side;
mod singular_perturbation;
mod starting;
mod torque_feedback;
mod vcbc;

use flexure_core::control::ControlLaw;
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::{Jet, Over, Scalar};

use crate::files::Entry;
use gain::{GainSet, ReadGains};
use registry::{LawKind, Maker, constants, laws};

pub use drive::Drive;
pub use gain::Gain;
pub use rates::BlockRates;
pub use shaping::{AnyShaping, Extra, Phi, SHAPING};
pub use side::SideGains;
pub(crate) use starting::drives;
pub use vcbc::{Law, VcbcGains, command, law, law_over};

// One line a law, in the order in which lists show them.
laws! {
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
}

/// What `law` asks of the motors of the robot at `x` [N m], following `q_ld`, the reference in rad to order 4. Compiled
/// once per robot, as [`command`] is.
#[inline(never)]
pub fn torque<L: Links<f64, N>, const N: usize>(
    law: &AnyLaw<f64, N>,
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
) -> Vector<f64, N> {
    if let AnyLaw::Vcbc(law) = law {
        // The code that `command` is anyway.
        return command(law, robot, x, q_ld).u_m;
    }
    law.torque(robot, x, q_ld)
}
