//! The feedback of motor position and velocity that most laws end with.

use crate::linalg::Vector;
use crate::scalar::{Over, Scalar};

/// −K_P e − K_D ė on the motors.
#[derive(Clone, Copy, Debug)]
pub struct MotorPd<C, const N: usize> {
    /// The diagonal of K_P [N m/rad].
    pub stiffness: Vector<C, N>,
    /// The diagonal of K_D [N m s/rad].
    pub damping: Vector<C, N>,
}

impl<C: Scalar, const N: usize> MotorPd<C, N> {
    /// Torque [N m] against a position error in rad and its rate [rad/s].
    #[inline]
    pub fn feedback<T: Over<C>>(&self, error: &Vector<T, N>, rate: &Vector<T, N>) -> Vector<T, N> {
        -(self.stiffness.diag_mul(error) + self.damping.diag_mul(rate))
    }
}
