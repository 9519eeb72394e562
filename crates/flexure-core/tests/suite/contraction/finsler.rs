//! Finsler functions with corners as Lyapunov functions of prolonged systems.

use flexure_core::contraction::{Finsler, MatrixField, Norm, Prolonged, generalised_jacobian, runge_kutta};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::{Over, Piecewise, Scalar};

use super::solution;
use super::systems::Dominant;
use crate::common::Numbers;

/// A weight that depends on state and time, regular everywhere.
struct Bent;

impl<C: Scalar> MatrixField<C, 2> for Bent {
    fn at<T: Over<C> + Piecewise>(&self, x: &Vector<T, 2>, t: T) -> Matrix<T, 2, 2> {
        let two = T::from_f64(2.0);
        Matrix([[two + x[1].sin(), T::from_f64(0.3)], [T::ZERO, two + t.cos() * x[0].tanh()]])
    }
}

const NORMS: [Norm; 2] = [Norm::One, Norm::Infinity];

#[test]
fn norms_and_their_upper_rates_are_those_of_lines() {
    let mut r = Numbers(1);
    // Corners too: entries that are 0, entries of equal size.
    let corners = [[0.0, 0.0, 0.0], [1.0, -1.0, 0.0], [0.0, 2.0, 2.0], [-3.0, 0.0, 1.0]];
    for k in 0..40 {
        let z = corners.get(k).map_or_else(|| r.vector::<3>(2.0), |z| Vector(*z));
        let rate: Vector<f64, 3> = r.vector(2.0);
        let sizes = |z: &Vector<f64, 3>| {
            [z.iter().map(f64::abs).sum(), z.iter().fold(0.0, |m: f64, x| m.max(x.abs()))]
        };
        for (norm, size) in NORMS.into_iter().zip([0, 1]) {
            assert_eq!(Vector([norm.of(&z)]), Vector([sizes(&z)[size]]));
            // Both are linear up to the next corner: rounding over h is what is left.
            let h = 1e-6;
            let ahead = (sizes(&(z + rate.scaled(h)))[size] - sizes(&z)[size]) / h;
            let found = norm.upper_rate(&z, &rate);
            assert!((found - ahead).abs() < 1e-8, "{z:?} {rate:?}: {found} against {ahead}");
        }
    }
}

/// D⁺V ≤ μ(J̄) V at every state and variation, for weights that move, and equality for some variation.
#[test]
fn the_measure_bounds_the_upper_rate() {
    let mut r = Numbers(2);
    for norm in NORMS {
        let finsler = Finsler { weight: Bent, norm };
        for _ in 0..30 {
            let (x, t): (Vector<f64, 2>, f64) = (r.vector(3.0), 3.0 * r.next());
            let jacobian = generalised_jacobian::<f64, f64, 2>(&Dominant, &Bent, &x, t);
            let mu = norm.measure(&jacobian);
            // Corners of the unit balls, where the bound is attained: unit vectors for 1, vectors of signs for ∞.
            let extreme = match norm {
                Norm::One => [[1.0, 0.0], [0.0, 1.0]],
                Norm::Infinity => [[1.0, 1.0], [1.0, -1.0]],
            };
            let rates = extreme.map(|z| norm.upper_rate(&Vector(z), &(jacobian * Vector(z))));
            let largest = rates[0].max(rates[1]);
            assert!((largest - mu).abs() < 1e-13 * mu.abs().max(1.0), "{largest} against {mu}");
            let delta = r.vector(1.0);
            let value = finsler.value::<f64, f64, 2>(&x, &delta, t);
            let rate = finsler.upper_rate::<f64, f64, 2>(&Dominant, &x, &delta, t);
            assert!(rate <= mu * value + 1e-12 * value);
        }
    }
}

/// The diagonally dominant system has μ_1 ≤ −1 and μ_∞ ≤ −1 everywhere. So V decays at the rate 1 along its prolonged solutions, although it
/// has corners, and so does the distance of two solutions.
#[test]
fn finsler_functions_decay_along_solutions() {
    let mut r = Numbers(3);
    for norm in NORMS {
        let finsler = Finsler { weight: Matrix::<f64, 2, 2>::identity(), norm };
        let prolonged: Prolonged<_, 2, 0> = Prolonged(&Dominant);
        for _ in 0..10 {
            let (x, delta): (Vector<f64, 2>, Vector<f64, 2>) = (r.vector(3.0), r.vector(1.0));
            let value = |state: &Vector<f64, 4>, t| {
                finsler.value(&Vector([state[0], state[1]]), &Vector([state[2], state[3]]), t)
            };
            let mut state = Vector([x[0], x[1], delta[0], delta[1]]);
            let h = 0.01;
            for k in 0..300 {
                let t = f64::from(k) * h;
                let next = runge_kutta::<f64, f64, 4>(&prolonged, &state, t, h);
                // The step of Runge–Kutta is exact to 1e-9.
                assert!(value(&next, t + h) <= value(&state, t) * (-h).exp() * (1.0 + 1e-8));
                state = next;
            }
            let other = x + delta;
            let ends = [x, other].map(|x| solution(&Dominant, x, h, 300));
            let [start, end] = [[x, other], ends].map(|[a, b]| finsler.length::<f64, f64, 2>(&a, &b, 0.0, 1));
            assert!(end <= start * (-3.0_f64).exp() * (1.0 + 1e-8));
        }
    }
}

/// A line is as long as its end is far in a constant weight, and the sum of its pieces in one that bends.
#[test]
fn lengths_are_distances() {
    let (from, to) = (Vector([0.5, -1.0]), Vector([2.0, 1.0]));
    let weight = Matrix([[2.0, 0.3], [0.0, 1.5]]);
    for norm in NORMS {
        let flat = Finsler { weight, norm };
        let length = flat.length::<f64, f64, 2>(&from, &to, 0.0, 7);
        assert!((length - norm.of(&(weight * (to - from)))).abs() < 1e-14);
    }
    // Θ = diag(2 + sin x_2, …): for the 1-norm along x_2 at x_1 = 0 the second entry alone, 2 + cos t tanh 0 = 2, and 0.3.
    let bent = Finsler { weight: Bent, norm: Norm::One };
    let upright = bent.length::<f64, f64, 2>(&Vector([0.0, -1.0]), &Vector([0.0, 1.0]), 0.0, 10);
    assert!((upright - 2.0 * 2.3).abs() < 1e-14);
    // Along x_1 from 0 to 1 at x_2 = 0: 2 per unit whatever x_1; along x_2 and x_1 alike the midpoint rule converges with h².
    let slanted = |pieces| bent.length::<f64, f64, 2>(&Vector([0.0; 2]), &Vector([1.0; 2]), 0.0, pieces);
    // ∫ (2 + sin s + 0.3) + (2 + tanh s) ds from 0 to 1.
    let exact = 4.3 + (1.0 - 1.0_f64.cos()) + 1.0_f64.cosh().ln();
    let [coarse, fine] = [20, 40].map(|pieces| slanted(pieces) - exact);
    assert!(coarse.abs() < 1e-3 && (coarse / fine - 4.0).abs() < 0.05, "{coarse} and {fine}");
}
