//! Contraction rates at a point: samples of what a certificate proves over a region.

use flexure_core::control::{Command, Shaping, Vcbc};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links};
use flexure_core::scalar::Dual;
use serde::Serialize;

use crate::linalg::{Leading, eigenvalues};

/// The contraction rate of each block of the closed loop at one state [1/s]: decay rates of √W, the length of the
/// error. The coupling between blocks cancels, so that the smallest of them is the rate of the whole.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BlockRates {
    /// λ_min of sym(Π_l ∂φ_l) − ½ Π̇_l relative to Π_l.
    pub phi_l: f64,
    /// λ_min of sym(Π_m ∂φ_m) relative to Π_m.
    pub phi_m: f64,
    /// λ_min of D_l + K_ld relative to M_l(q_l).
    pub sigma_l: f64,
    /// λ_min of D_m + K_md relative to M_m.
    pub sigma_m: f64,
}

impl BlockRates {
    /// At a state where the law gives `command` and the links are at `q_l` in rad.
    pub fn at<L, Pl, Pm, const N: usize>(
        robot: &Fjr<f64, L, N>,
        law: &Vcbc<f64, Pl, Pm, N>,
        q_l: &Vector<f64, N>,
        command: &Command<f64, N>,
    ) -> Self
    where
        L: Links<f64, N>,
        Pl: Shaping<f64, N>,
        Pm: Shaping<f64, N>,
    {
        let n = robot.links.joints();
        // ė_l = −φ_l + M_l⁻¹ σ_l carries Π_l along.
        let e_rate = command.s_l - law.link.shaping.eval(&command.e_l);
        let moving: Vector<Dual<f64, 1>, N> =
            Vector::from_fn(|i| Dual { value: command.e_l[i], gradient: [e_rate[i]] });
        let Pi_l = law.link.metric.at(&moving);
        let Pi_l_rate = Pi_l.map(|x| x.gradient[0]);
        let damping_l = robot.link_damping + law.link.damping;
        let damping_m = robot.motor_damping + law.motor.damping;
        Self {
            phi_l: shaping_rate(&law.link.shaping, &command.e_l, &Pi_l.map(|x| x.value), &Pi_l_rate, n),
            phi_m: shaping_rate(&law.motor.shaping, &command.e_m, &law.motor.metric, &Vector::ZERO, n),
            sigma_l: 1.0 / relative(&robot.links.mass_matrix(q_l), &damping_l, n).1,
            sigma_m: (0..n).fold(f64::INFINITY, |m, i| m.min(damping_m[i] / robot.motor_inertia[i])),
        }
    }

    /// The rate of the whole closed loop: the smallest of the blocks.
    pub fn overall(&self) -> f64 {
        self.phi_l.min(self.phi_m).min(self.sigma_l).min(self.sigma_m)
    }
}

/// λ_min of sym(Π ∂φ) − ½ Π̇ relative to Π, at the error `e` of the first `n` joints.
fn shaping_rate<const N: usize>(
    phi: &impl Shaping<f64, N>,
    e: &Vector<f64, N>,
    metric: &Vector<f64, N>,
    metric_rate: &Vector<f64, N>,
    n: usize,
) -> f64 {
    let slope = phi.slope(e);
    let symmetric = Matrix::from_fn(|i, j| {
        let own = if i == j { metric_rate[i] } else { 0.0 };
        0.5 * (metric[i] * slope[(i, j)] + metric[j] * slope[(j, i)] - own)
    });
    relative(&symmetric, metric, n).0
}

/// Smallest and largest eigenvalue of the leading `n` × `n` block of the symmetric `a` relative to the positive diagonal
/// `weight`.
fn relative<const N: usize>(a: &Matrix<f64, N, N>, weight: &Vector<f64, N>, n: usize) -> (f64, f64) {
    let root = weight.map(f64::sqrt);
    let mut scaled: Matrix<f64, N, N> = Matrix::from_fn(|i, j| a[(i, j)] / (root[i] * root[j]));
    eigenvalues(Leading::of(&mut scaled.0, n))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

#[cfg(test)]
mod tests {
    use super::{Matrix, Vector, relative};

    #[test]
    fn weights_scale_eigenvalues() {
        let (low, high) = relative(&Matrix([[4.0, 0.0], [0.0, 9.0]]), &Vector([2.0, 3.0]), 2);
        assert!((low - 2.0).abs() < 1e-15 && (high - 3.0).abs() < 1e-15);
    }
}
