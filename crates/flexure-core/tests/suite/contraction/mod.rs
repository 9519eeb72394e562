//! The theory on systems of one's own: what the functions say against solutions, closed forms and each other.

mod finsler;
mod flexible_joints;
mod full_matrices;
#[cfg(feature = "interval")]
mod measures;
mod passivity;
mod port_hamiltonian;
mod sides;
mod solutions;
mod systems;
#[cfg(feature = "interval")]
mod virtual_systems;

use flexure_core::contraction::{Dynamics, runge_kutta};
use flexure_core::linalg::Vector;

/// The state after `steps` steps of `h`.
fn solution<const N: usize>(
    system: &impl Dynamics<f64, N>,
    x: Vector<f64, N>,
    h: f64,
    steps: usize,
) -> Vector<f64, N> {
    (0..steps).fold(x, |x, k| runge_kutta(system, &x, k as f64 * h, h))
}

fn norm<const N: usize>(x: &Vector<f64, N>) -> f64 {
    x.dot(x).sqrt()
}
