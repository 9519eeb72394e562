//! Twists and wrenches: spatial motion and force vectors.

use core::ops::{Add, AddAssign};

use super::Vec3;
use crate::scalar::Scalar;

/// A spatial velocity [rad/s, m/s] or acceleration [rad/s², m/s²] of a body, in Plücker coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<S> {
    /// Angular velocity [rad/s] or acceleration [rad/s²].
    pub angular: Vec3<S>,
    /// Velocity [m/s] or spatial acceleration [m/s²] of the body's point at the frame's origin.
    pub linear: Vec3<S>,
}

/// A spatial force [N m, N] or momentum [kg m²/s, kg m/s], in Plücker coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench<S> {
    /// Moment [N m] or angular momentum [kg m²/s] about the frame's origin.
    pub moment: Vec3<S>,
    /// Force in N or linear momentum [kg m/s].
    pub linear: Vec3<S>,
}

impl<S: Scalar> Twist<S> {
    /// At rest.
    pub const ZERO: Self = Self { angular: Vec3::ZERO, linear: Vec3::ZERO };
}

impl<S: Scalar> Wrench<S> {
    /// No force.
    pub const ZERO: Self = Self { moment: Vec3::ZERO, linear: Vec3::ZERO };

    /// `self · s`.
    #[inline]
    pub fn scaled(&self, s: S) -> Self {
        Self { moment: self.moment.scaled(s), linear: self.linear.scaled(s) }
    }
}

impl<S: Scalar> Add for Twist<S> {
    type Output = Self;
    #[inline]
    fn add(self, b: Self) -> Self {
        Self { angular: self.angular + b.angular, linear: self.linear + b.linear }
    }
}

impl<S: Scalar> Add for Wrench<S> {
    type Output = Self;
    #[inline]
    fn add(self, b: Self) -> Self {
        Self { moment: self.moment + b.moment, linear: self.linear + b.linear }
    }
}

impl<S: Scalar> AddAssign for Wrench<S> {
    #[inline]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
