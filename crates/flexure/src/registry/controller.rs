//! The controllers by name.

use flexure_core::control::{Command, Input, LinkGains, Metric, MotorGains, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::{Jet, Scalar};

use super::robot::vector;
use super::{AnyShaping, Entry};
use crate::io::{Controller, Phi, SideGains};

/// The registered controllers.
pub const CONTROLLERS: &[Entry] = &[Entry {
    name: "vcbc",
    summary: "virtual-contraction law of flexible-joint robots: (φ, Π, K_d) per side",
}];

/// A law over the registered shaping functions, with gains of type `C`.
pub type Law<C, const N: usize> = Vcbc<C, AnyShaping<C, N>, AnyShaping<C, N>, N>;

/// The law that a scenario's controller describes.
pub fn law<const N: usize>(controller: &Controller) -> Law<f64, N> {
    law_over(controller, |x| x)
}

/// The law that a scenario's controller describes, with every gain through `number`: [`io::Scenario::bounds`] for the law
/// over intervals that encloses what the decimals in the file say.
///
/// [`io::Scenario::bounds`]: crate::io::Scenario::bounds
pub fn law_over<C: Scalar, const N: usize>(controller: &Controller, number: impl Fn(f64) -> C) -> Law<C, N> {
    let Controller::Vcbc { phi, link, motor } = controller;
    let gains = |values: &[f64]| vector(values).map(&number);
    let base = gains(&link.metric);
    let metric = match &link.metric_hardening {
        Some(hardening) => Metric::Hardening { base, hardening: gains(hardening) },
        None => Metric::Constant(base),
    };
    let shaping = |side: &SideGains| shaping(*phi, gains(&side.shaping), side.kappa.as_deref().map(gains));
    Vcbc {
        link: LinkGains { metric, shaping: shaping(link), damping: gains(&link.damping) },
        motor: MotorGains {
            metric: gains(&motor.metric),
            shaping: shaping(motor),
            damping: gains(&motor.damping),
        },
    }
}

/// What `law` commands the robot at `x` to do, following `q_ld`, the reference in rad to order 4. Compiled once per
/// robot: it is much code, wanted in many places.
#[inline(never)]
pub fn command<L: Links<f64, N>, const N: usize>(
    law: &Law<f64, N>,
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
) -> Command<f64, N> {
    law.command(robot, x, q_ld, &Input::ZERO)
}

fn shaping<C: Scalar, const N: usize>(
    phi: Phi,
    gain: Vector<C, N>,
    kappa: Option<Vector<C, N>>,
) -> AnyShaping<C, N> {
    AnyShaping::new(phi.name(), gain, kappa)
        .expect("the reader takes registered names only, and asks for kappa where it is needed")
}
