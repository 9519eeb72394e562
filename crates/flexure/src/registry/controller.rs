//! The controllers by name.

use flexure_core::control::{Command, Input, LinkGains, Metric, MotorGains, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::Jet;

use super::robot::vector;
use super::{AnyShaping, Entry};
use crate::io::{Controller, Phi, SideGains};

/// The registered controllers.
pub const CONTROLLERS: &[Entry] = &[Entry {
    name: "vcbc",
    summary: "virtual-contraction law of flexible-joint robots: (φ, Π, K_d) per side",
}];

/// A law over the registered shaping functions.
pub type Law<const N: usize> = Vcbc<f64, AnyShaping<N>, AnyShaping<N>, N>;

/// The law that a scenario's controller describes.
pub fn law<const N: usize>(controller: &Controller) -> Law<N> {
    let Controller::Vcbc { phi, link, motor } = controller;
    let base = vector(&link.metric);
    let metric = match &link.metric_hardening {
        Some(hardening) => Metric::Hardening { base, hardening: vector(hardening) },
        None => Metric::Constant(base),
    };
    Vcbc {
        link: LinkGains { metric, shaping: shaping(*phi, link), damping: vector(&link.damping) },
        motor: MotorGains {
            metric: vector(&motor.metric),
            shaping: shaping(*phi, motor),
            damping: vector(&motor.damping),
        },
    }
}

/// What `law` commands the robot at `x` to do, following `q_ld`, the reference in rad to order 4. Compiled once per
/// robot: it is much code, wanted in many places.
#[inline(never)]
pub fn command<L: Links<f64, N>, const N: usize>(
    law: &Law<N>,
    robot: &Fjr<f64, L, N>,
    x: &Motion<f64, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
) -> Command<f64, N> {
    law.command(robot, x, q_ld, &Input::ZERO)
}

fn shaping<const N: usize>(phi: Phi, gains: &SideGains) -> AnyShaping<N> {
    AnyShaping::new(phi.name(), vector(&gains.shaping), gains.kappa.as_deref().map(vector))
        .expect("the reader takes registered names only, and asks for kappa where it is needed")
}
