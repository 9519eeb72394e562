//! The robot at rest: springs that carry gravity.

use super::{Fjr, Links};
use crate::linalg::Vector;
use crate::scalar::{Over, Scalar};

/// Passes of the fixed point behind [`Fjr::links_at_rest`]. Each shrinks the error by the ratio of the slope of gravity to
/// the stiffness, below 1/10 for drives of arms: sixteen leave nothing of it in double precision.
const PASSES: usize = 16;

impl<C: Scalar, L: Links<C, N>, const N: usize> Fjr<C, L, N> {
    /// Motor position q_m = q_l + K⁻¹ g(q_l) in rad that holds the links at `q_l` in rad.
    #[inline]
    pub fn motors_at_rest<T: Over<C>>(&self, q_l: &Vector<T, N>) -> Vector<T, N> {
        *q_l + self.stiffness.map(C::recip).diag_mul(&self.links.gravity_torque(q_l))
    }

    /// Link position q̄ in rad at which the springs carry gravity while the motors are at `q_m` in rad: q_m = q̄ + K⁻¹ g(q̄),
    /// by a fixed point, which exists where the springs are stiffer than gravity: K exceeds the Lipschitz constant of g.
    /// Albu-Schäffer, Ott and Hirzinger, *A unified passivity-based control framework for position, torque and impedance
    /// control of flexible joint robots*, Int. J. Robotics Research 26, 2007, section 4.1.
    #[inline]
    pub fn links_at_rest<T: Over<C>>(&self, q_m: &Vector<T, N>) -> Vector<T, N> {
        let compliance = self.stiffness.map(C::recip);
        let mut q_l = *q_m;
        for _ in 0..PASSES {
            q_l = *q_m - compliance.diag_mul(&self.links.gravity_torque(&q_l));
        }
        q_l
    }
}
