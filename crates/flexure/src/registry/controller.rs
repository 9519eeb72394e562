//! The controllers by name.

use flexure_core::control::{LinkGains, Metric, MotorGains, Vcbc};

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

fn shaping<const N: usize>(phi: Phi, gains: &SideGains) -> AnyShaping<N> {
    AnyShaping::new(phi.name(), vector(&gains.shaping), gains.kappa.as_deref().map(vector))
        .expect("the reader takes registered names only, and asks for kappa where it is needed")
}
