//! Prolonged systems, and incremental stability of solutions.

use flexure_core::contraction::{
    ClosedLoop, ControlSystem, Dynamics, Feedback, Prolonged, generalised_jacobian, measure_2, runge_kutta,
};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::{Dual, Over, Piecewise, Scalar};

use super::systems::{Dominant, Driven};
use super::{norm, solution};
use crate::common::{Numbers, close, moving, rate};

const DRIVEN: Driven = Driven { stiffness: 2.0, damping: 0.7 };

/// γ = −(1 + x_2) sin x_1.
struct Swing;

impl<C: Scalar> Feedback<C, 2, 1> for Swing {
    fn input<T: Over<C> + Piecewise>(&self, x: &Vector<T, 2>, _: T) -> Vector<T, 1> {
        Vector([-(T::ONE + x[1]) * x[0].sin()])
    }
}

/// The prolonged control system is the limit of differences of two inputs and states; its affine form has the terms of the paper.
#[test]
fn prolonged_systems_are_limits_of_differences() {
    let mut r = Numbers(1);
    for _ in 0..20 {
        let (x, dx): (Vector<f64, 2>, Vector<f64, 2>) = (r.vector(2.0), r.vector(1.0));
        let (u, du): (Vector<f64, 1>, Vector<f64, 1>) = (r.vector(2.0), r.vector(1.0));
        let t = r.next();
        let prolonged: Prolonged<_, 2, 1> = Prolonged(&DRIVEN);
        let (state, input) = (Vector([x[0], x[1], dx[0], dx[1]]), Vector([u[0], du[0]]));
        let found = ControlSystem::<f64, 4, 2>::rate_under(&prolonged, &state, &input, t);
        let output = ControlSystem::<f64, 4, 2>::output(&prolonged, &state, t);

        let at = |h: f64| {
            let (x, u) = (x + dx.scaled(h), u + du.scaled(h));
            let rate = ControlSystem::<f64, 2, 1>::rate_under(&DRIVEN, &x, &u, t);
            (rate, ControlSystem::<f64, 2, 1>::output(&DRIVEN, &x, t))
        };
        // Central differences: h² of the third derivatives and the rounding of values over h.
        let h = 1e-5;
        let ((ahead, y_ahead), (behind, y_behind)) = (at(h), at(-h));
        let difference = (ahead - behind).scaled(0.5 / h);
        close(&Vector([found[2], found[3]]), &difference, 1e-8);
        close(&Vector([output[1]]), &(y_ahead - y_behind).scaled(0.5 / h), 1e-8);
        assert_eq!(Vector([found[0], found[1]]), at(0.0).0);
        assert_eq!(Vector([output[0]]), at(0.0).1);

        // δẋ = A δx + B δu, δy = C δx.
        let linearised = ControlSystem::<f64, 2, 1>::linearised(&DRIVEN, &x, &u, t);
        close(&Vector([found[2], found[3]]), &(linearised.state * dx + linearised.port * du), 1e-14);
        close(&Vector([output[1]]), &(linearised.output * dx), 1e-14);
    }
}

/// The solution of the prolonged system is the derivative of solutions by their start: the step on dual numbers is the step of the
/// prolonged system, and both are the limit of differences of two solutions.
#[test]
fn variations_are_derivatives_of_solutions() {
    let closed: ClosedLoop<_, _, 1> = ClosedLoop { system: &DRIVEN, feedback: Swing };
    let (x, dx) = (Vector([0.8, -0.3]), Vector([0.6, 1.1]));
    let prolonged: Prolonged<_, 2, 0> = Prolonged(&closed);
    let (h, steps) = (0.01, 300);
    let end = solution::<4>(&prolonged, Vector([x[0], x[1], dx[0], dx[1]]), h, steps);

    let dual = (0..steps).fold(moving(&x, &dx), |x, k| {
        runge_kutta::<f64, _, 2>(&closed, &x, Dual::constant(k as f64 * h), Dual::constant(h))
    });
    // The same operations in another order, 300 steps long.
    close(&Vector([end[2], end[3]]), &rate(&dual), 1e-13);
    close(&Vector([end[0], end[1]]), &dual.map(|x| x.value), 1e-13);

    let far = 1e-5;
    let [ahead, behind] = [far, -far].map(|s| solution::<2>(&closed, x + dx.scaled(s), h, steps));
    close(&Vector([end[2], end[3]]), &(ahead - behind).scaled(0.5 / far), 1e-8);

    let jacobian = Dynamics::<f64, 2>::jacobian(&closed, &x, 0.4);
    close(&(jacobian * dx), &Dynamics::<f64, 2>::variation(&closed, &x, &dx, 0.4), 1e-14);
}

/// Incremental exponential stability, twice: by two solutions and by the variational one. The bound is a matrix measure: ∂F has the diagonal
/// (−2, −3) and entries of at most 1 beside it, so μ_2 ≤ −½(5 − √5) everywhere.
#[test]
fn two_solutions_approach_at_the_measured_rate() {
    let rate = 0.5 * (5.0 - 5.0_f64.sqrt());
    let mut r = Numbers(2);
    for _ in 0..20 {
        let (one, other): (Vector<f64, 2>, Vector<f64, 2>) = (r.vector(4.0), r.vector(4.0));
        let jacobian = generalised_jacobian::<f64, f64, 2>(&Dominant, &Matrix::identity(), &one, 0.0);
        assert!(measure_2(&jacobian) <= -rate + 1e-12);

        let (h, steps) = (0.01, 200);
        let start = norm(&(one - other));
        let apart = solution(&Dominant, one, h, steps) - solution(&Dominant, other, h, steps);
        // The bound holds for the exact solution; that of Runge–Kutta differs by 1e-9 of it.
        let bound = (-rate * h * steps as f64).exp() * (1.0 + 1e-8);
        assert!(norm(&apart) <= bound * start, "{} over {}", norm(&apart), bound * start);

        let dx = one - other;
        let end =
            solution::<4>(&Prolonged::<_, 2, 0>(&Dominant), Vector([one[0], one[1], dx[0], dx[1]]), h, steps);
        assert!(norm(&Vector([end[2], end[3]])) <= bound * start);
    }
}

/// Without damping the driven pendulum is incrementally stable nowhere: two solutions that start side by side part.
#[test]
fn what_does_not_contract_is_seen() {
    let loose = Driven { stiffness: 2.0, damping: 0.0 };
    let closed: ClosedLoop<_, _, 1> = ClosedLoop { system: &loose, feedback: Vector([0.0]) };
    let (one, other) = (Vector([3.0, 0.0]), Vector([3.001, 0.0]));
    let apart = solution::<2>(&closed, one, 0.01, 500) - solution::<2>(&closed, other, 0.01, 500);
    assert!(norm(&apart) > 5.0 * norm(&(one - other)), "{apart:?}");
    let jacobian = generalised_jacobian::<f64, f64, 2>(&closed, &Matrix::identity(), &one, 0.0);
    assert!(measure_2(&jacobian) > 0.0);
}
