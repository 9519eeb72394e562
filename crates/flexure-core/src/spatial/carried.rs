//! What a body carries along the Newton–Euler recursion.

use super::Vec3;
use crate::scalar::{Over, Scalar};

/// The motion of a body and that of a reference beside it, at one posture: in axes of the body, rates taken in inertial space.
///
/// The acceleration is bilinear in both velocities, as J̇(q, v) v_r is: that of the reference itself where they are equal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carried<S> {
    /// ω: angular velocity [rad/s].
    pub spin: Vec3<S>,
    /// ω_r: angular velocity of the reference [rad/s].
    pub spin_r: Vec3<S>,
    /// α: rate of `spin_r` [rad/s²].
    pub spin_rate: Vec3<S>,
    /// a: acceleration of the frame's origin [m/s²].
    pub linear: Vec3<S>,
}

impl<S: Scalar> Carried<S> {
    /// Acceleration of the point of the body at `x` [m/s²]: a + α × x + ω_r × (ω × x).
    #[inline]
    pub fn at<C: Copy>(&self, x: &Vec3<C>) -> Vec3<S>
    where
        S: Over<C>,
    {
        self.linear + self.spin_rate.cross_constant(x) + self.spin_r.cross(self.spin.cross_constant(x))
    }
}
