//! The paper's formula for the rate: products of extreme eigenvalues. A lower bound of the true rate, often a poor one.

use crate::laws::VcbcGains;
use crate::prove::engine::region::region;
use crate::prove::engine::structural::{Proposition, positions};
use crate::robot::Robot;

/// The rate of paper, corollaries on the three shaping functions, by its own formula, with its factor 2 corrected
/// (docs/errata.md, 1) [1/s]: min{β_q, λ_min(D + K_d) λ_min(M⁻¹)}, with β_q = λ_min(Π ∂φ)/λ_max(Π), or ½ min κ for `coupled-tanh`.
///
/// `largest_inertia` is λ_max of M_l over all configurations [kg m²].
pub fn paper_rate(robot: &Robot, gains: &VcbcGains, problem: &Proposition, largest_inertia: f64) -> f64 {
    let VcbcGains { link, motor, .. } = gains;
    let smallest = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);

    let kappa = [link, motor].map(|side| side.extra("kappa").cloned().unwrap_or_default()).concat();
    let own = problem.controller.phi.certified().paper_rate(&kappa);
    let beta_q = own.unwrap_or_else(|| {
        let metric: Vec<_> =
            problem.controller.link.metric.iter().chain(&problem.controller.motor.metric).collect();
        let bounds: Vec<_> = metric.iter().map(|number| number.bounds()).collect();
        let slowest = positions(&problem.controller, &region(&problem.region, &bounds).error);
        let products = slowest.iter().flat_map(|side| {
            let a = side.slopes(&vec![false; side.joints()]);
            (0..side.joints())
                .map(move |i| (side.metric(i) * side.slope(&a, i, i)).midpoint())
                .collect::<Vec<_>>()
        });
        smallest(&mut products.into_iter()) / largest(&[link.metric.clone(), motor.metric.clone()].concat())
    });
    let side = |plant: &[f64], injected: &[f64], inertia: f64| {
        smallest(&mut plant.iter().zip(injected).map(|(a, b)| a + b)) / inertia
    };
    let beta_l = side(&robot.link_damping, &link.damping, largest_inertia);
    let beta_m = side(&robot.motor_damping, &motor.damping, largest(&robot.motor_inertia));
    beta_q.min(beta_l).min(beta_m)
}
