//! The closed loop of v-CBC as two differentially passive systems in feedback: links and motors (corollary feedback-interconnection).

use flexure_core::contraction::{
    Both, ControlSystem, ErrorLoop, Interconnection, MatrixField, passivity_matrices,
};
use flexure_core::control::{LinkGains, Shaping};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Links, Motion};
use flexure_core::scalar::{Over, Piecewise};

use crate::common::{Numbers, flexible, gains, planar, tanh};

/// One side in errors (q̃, σ), with the input (v̄_r, ω̄) and the output (Π q̃, M⁻¹ σ): the paper's eq. variational-link-dynamics1 and
/// variational-motor-dynamics, with M and E those of one instant.
struct Side<P> {
    metric: Vector<f64, 2>,
    shaping: P,
    mass: Matrix<f64, 2, 2>,
    /// E + D + K_d.
    damping: Matrix<f64, 2, 2>,
}

impl<P: Shaping<f64, 2>> ControlSystem<f64, 4, 4> for Side<P> {
    fn drift<T: Over<f64> + Piecewise>(&self, x: &Vector<T, 4>, t: T) -> Vector<T, 4> {
        let y = self.output(x, t);
        let (phi, s) = (self.shaping.eval(&Vector([x[0], x[1]])), Vector([y[2], y[3]]));
        let lost = self.damping.map(T::constant) * s;
        Vector([s[0] - phi[0], s[1] - phi[1], -y[0] - lost[0], -y[1] - lost[1]])
    }
    fn port<T: Over<f64> + Piecewise>(&self, _: &Vector<T, 4>, _: T) -> Matrix<T, 4, 4> {
        Matrix::identity()
    }
    fn output<T: Over<f64> + Piecewise>(&self, x: &Vector<T, 4>, t: T) -> Vector<T, 4> {
        MatrixField::<f64, 4>::at(self, x, t) * *x
    }
}

impl<P> MatrixField<f64, 4> for Side<P> {
    fn at<T: Over<f64> + Piecewise>(&self, _: &Vector<T, 4>, _: T) -> Matrix<T, 4, 4> {
        let inverse = Matrix([[1.0, 0.0], [0.0, 1.0]].map(|e| self.mass.ldl().solve(&Vector(e)).0));
        Matrix::from_fn(|i, j| match (i < 2, j < 2) {
            (true, true) if i == j => T::constant(self.metric[i]),
            (false, false) => T::constant(inverse[(i - 2, j - 2)]),
            _ => T::ZERO,
        })
    }
}

/// Each side is differentially passive; coupled by K Π_m⁻¹ and −Π_m⁻¹ Kᵀ they are the closed loop, and its storage is the sum of theirs.
#[test]
fn links_and_motors_in_feedback_are_the_closed_loop() {
    let r = &mut Numbers(1);
    for _ in 0..10 {
        let (robot, law) = (flexible(planar(), r), gains(tanh, false, r));
        // At rest, so that M is constant and E = 0: rates of M are in the test of the whole, flexible_joints.
        let motion = Motion::at_rest(r.vector(1.5));
        let LinkGains { metric, shaping, damping } = law.link;
        let diagonal = |d: Vector<f64, 2>| Matrix::diagonal(&d);
        let links = Side {
            metric: metric.at(&Vector([0.0; 2])),
            shaping,
            mass: robot.links.mass_matrix(&motion.q_l),
            damping: diagonal(robot.link_damping + damping),
        };
        let motors = Side {
            metric: law.motor.metric,
            shaping: law.motor.shaping,
            mass: diagonal(robot.motor_inertia),
            damping: diagonal(robot.motor_damping + law.motor.damping),
        };
        let coupling =
            Matrix::from_fn(|i, j| if i == j + 2 { -robot.stiffness[j] / law.motor.metric[j] } else { 0.0 });
        let whole: Interconnection<_, _, f64, 4, 4, 4> =
            Interconnection { first: &links, second: &motors, coupling };

        let e: Vector<f64, 8> = r.vector(1.0);
        // (q̃_l, σ_l, q̃_m, σ_m) from (q̃_l, q̃_m, σ_l, σ_m), and back: the middle parts change places.
        let order = [0, 1, 4, 5, 2, 3, 6, 7];
        let swapped = |x: &Vector<f64, 8>| Vector::<f64, 8>::from_fn(|i| x[order[i]]);
        let errors = ErrorLoop { robot: &robot, law: &law, motion };
        let omega: Vector<f64, 4> = r.vector(5.0);
        let expected = errors.rate_under(&e, &omega, 0.0);
        let input = Vector([0.0, 0.0, omega[0], omega[1], 0.0, 0.0, omega[2], omega[3]]);
        let found = ControlSystem::<f64, 8, 8>::rate_under(&whole, &swapped(&e), &input, 0.0);
        for (a, b) in swapped(&found).iter().zip(expected.iter()) {
            assert!((a - b).abs() < 1e-10 * b.abs().max(1.0), "{a} against {b}");
        }

        let sum: Both<_, _, 4, 4> = Both(&links, &motors);
        let metric = MatrixField::<f64, 8>::at(&sum, &swapped(&e), 0.0);
        let whole_metric: Matrix<f64, 8, 8> = errors.at(&e, 0.0);
        for i in 0..8 {
            for j in 0..8 {
                let (a, b) = (metric[(i, j)], whole_metric[(order[i], order[j])]);
                assert!((a - b).abs() < 1e-11 * b.abs().max(1.0), "{a} against {b}");
            }
        }
        let matrices = passivity_matrices::<f64, f64, 8, 8>(&whole, &sum, &swapped(&e), &input, 0.0);
        let parts = [(&links, 0), (&motors, 4)].map(|(side, start)| {
            let x = Vector::from_fn(|i| swapped(&e)[start + i]);
            passivity_matrices::<f64, f64, 4, 4>(side, side, &x, &Vector([0.0; 4]), 0.0).dissipation
        });
        for i in 0..8 {
            for j in 0..8 {
                assert!(matrices.mismatch[(i, j)].abs() < 1e-12);
                let part = if i / 4 == j / 4 { parts[i / 4][(i % 4, j % 4)] } else { 0.0 };
                // Of entries of K M⁻¹ and M⁻¹ D M⁻¹, up to 1e5.
                assert!((matrices.dissipation[(i, j)] - part).abs() < 1e-9 * part.abs().max(1e2));
            }
        }
    }
}
