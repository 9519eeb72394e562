//! PD control of the motors with the gravity of the goal.

use super::{ControlLaw, MotorPd, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// u = −K_P (θ − θ_0) − K_D (θ̇ − θ̇_0) + g(q_0) with θ_0 = q_0 + K⁻¹ g(q_0). Tomei, *A simple PD controller for robots with
/// elastic joints*, IEEE Trans. Automatic Control 36, 1991.
///
/// A law of regulation: on tracking tasks q_0 is the reference as it passes, θ̇_0 the rate of θ_0.
#[derive(Clone, Copy, Debug)]
pub struct Pd<C, const N: usize> {
    /// K_P and K_D, the feedback of motor positions and velocities.
    pub motor: MotorPd<C, N>,
}

impl<C: Scalar, const N: usize> Pd<C, N> {
    /// What the slope of gravity must stay below, joint by joint [N m/rad]: the smaller eigenvalue of
    /// [[k, −k], [−k, k + k_P]]. The goal is globally asymptotically stable if the smallest of them exceeds the Lipschitz
    /// constant of g: the matrix of the whole robot is diagonal by blocks, one per joint. Tomei 1991, eq. 10.
    #[inline]
    pub fn gravity_slope_limit<L>(&self, robot: &Fjr<C, L, N>) -> Vector<C, N> {
        Vector::from_fn(|i| {
            let (k, half) = (robot.stiffness[i], self.motor.stiffness[i] * C::from_ratio(1, 2));
            // Product of the eigenvalues over the larger one: nothing cancels.
            let larger = k + half + (k.square() + half.square()).sqrt();
            k * self.motor.stiffness[i] / larger
        })
    }
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for Pd<C, N> {
    const READS: Signals = Signals::MOTORS;

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let q_0 = q_ld.map(|x| x.truncate::<2>());
        let gravity = robot.links.gravity_torque(&q_0);
        let theta_0 = q_0 + robot.stiffness.map(C::recip).diag_mul(&gravity);
        let [theta_0, rate_0] = theta_0.derivatives();
        let feedback = self.motor.feedback(&(x.q_m - theta_0), &(x.v_m - rate_0));
        feedback + gravity.map(|g| g.coefficient(0))
    }
}
