//! Spatial motion and force vectors.

use core::ops::{Add, AddAssign, Sub};

use super::Vec3;
use crate::scalar::Scalar;

/// A spatial velocity or acceleration: angular part and linear part at the frame's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<S> {
    /// Angular part [rad/s].
    pub angular: Vec3<S>,
    /// Linear part at the frame's origin [m/s].
    pub linear: Vec3<S>,
}

/// A spatial force: moment about the frame's origin, and force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Force<S> {
    /// Moment about the frame's origin [N m].
    pub moment: Vec3<S>,
    /// Force in N.
    pub linear: Vec3<S>,
}

impl<S: Scalar> Motion<S> {
    /// No motion.
    pub const ZERO: Self = Self { angular: Vec3::ZERO, linear: Vec3::ZERO };

    /// `self × m`: the rate of a motion vector that is constant in a frame moving with `self`.
    #[inline]
    pub fn cross(&self, m: &Self) -> Self {
        Self {
            angular: self.angular.cross(m.angular),
            linear: self.angular.cross(m.linear) + self.linear.cross(m.angular),
        }
    }

    /// `self ×* f`: the rate of a force vector that is constant in a frame moving with `self`.
    #[inline]
    pub fn cross_force(&self, f: &Force<S>) -> Force<S> {
        Force {
            moment: self.angular.cross(f.moment) + self.linear.cross(f.linear),
            linear: self.angular.cross(f.linear),
        }
    }

    /// `self · s`.
    #[inline]
    pub fn scaled(&self, s: S) -> Self {
        Self { angular: self.angular.scaled(s), linear: self.linear.scaled(s) }
    }
}

impl<S: Scalar> Force<S> {
    /// No force.
    pub const ZERO: Self = Self { moment: Vec3::ZERO, linear: Vec3::ZERO };

    /// `self · s`.
    #[inline]
    pub fn scaled(&self, s: S) -> Self {
        Self { moment: self.moment.scaled(s), linear: self.linear.scaled(s) }
    }
}

impl<S: Scalar> Add for Motion<S> {
    type Output = Self;
    #[inline]
    fn add(self, b: Self) -> Self {
        Self { angular: self.angular + b.angular, linear: self.linear + b.linear }
    }
}

impl<S: Scalar> Sub for Motion<S> {
    type Output = Self;
    #[inline]
    fn sub(self, b: Self) -> Self {
        Self { angular: self.angular - b.angular, linear: self.linear - b.linear }
    }
}

impl<S: Scalar> Add for Force<S> {
    type Output = Self;
    #[inline]
    fn add(self, b: Self) -> Self {
        Self { moment: self.moment + b.moment, linear: self.linear + b.linear }
    }
}

impl<S: Scalar> AddAssign for Force<S> {
    #[inline]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
