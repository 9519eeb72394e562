//! The theory on systems of one's own: what the functions say against solutions, closed forms and each other.

mod flexible_joints;
mod passivity;
mod solutions;
mod systems;

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
