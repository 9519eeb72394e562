//! The theory on systems of one's own: what the functions say against solutions, closed forms and each other.

#[cfg(feature = "interval")]
mod circuit;
mod finsler;
mod flexible_joints;
mod full_matrices;
#[cfg(feature = "interval")]
mod measures;
mod passivity;
mod port_hamiltonian;
#[cfg(feature = "interval")]
mod rigid_arm;
mod sides;
mod solutions;
#[cfg(feature = "interval")]
mod stretched;
mod systems;

use flexure_core::contraction::{Dynamics, runge_kutta};
use flexure_core::linalg::{Matrix, Vector};

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

/// Up to a tolerance relative to the largest entry.
fn matrices_are_close<const R: usize, const K: usize>(
    a: &Matrix<f64, R, K>,
    b: &Matrix<f64, R, K>,
    tolerance: f64,
) {
    let scale = b.0.as_flattened().iter().fold(1.0, |m: f64, x| m.max(x.abs()));
    for (x, y) in a.0.as_flattened().iter().zip(b.0.as_flattened()) {
        assert!((x - y).abs() <= tolerance * scale, "{x} against {y} of {scale}");
    }
}
