//! Vectors of three-space.

use core::ops::{Add, AddAssign, Neg, Sub};

use crate::scalar::{Over, Scalar};

/// A vector of three-space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vec3<S> {
    /// First component.
    pub x: S,
    /// Second component.
    pub y: S,
    /// Third component.
    pub z: S,
}

impl<S: Scalar> Vec3<S> {
    /// The zero vector.
    pub const ZERO: Self = Self { x: S::ZERO, y: S::ZERO, z: S::ZERO };

    /// The vector `(x, y, z)`.
    #[inline(always)]
    pub const fn new(x: S, y: S, z: S) -> Self {
        Self { x, y, z }
    }

    /// The vector of an array.
    #[inline(always)]
    pub fn from_array([x, y, z]: [S; 3]) -> Self {
        Self { x, y, z }
    }

    /// Every component through `f`.
    #[inline(always)]
    pub fn map<T>(self, f: impl Fn(S) -> T) -> Vec3<T> {
        Vec3 { x: f(self.x), y: f(self.y), z: f(self.z) }
    }

    /// Inner product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> S {
        self.x * b.x + self.y * b.y + self.z * b.z
    }

    /// `self × b`.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        Self {
            x: self.y * b.z - self.z * b.y,
            y: self.z * b.x - self.x * b.z,
            z: self.x * b.y - self.y * b.x,
        }
    }

    /// `self · s`.
    #[inline(always)]
    pub fn scaled(self, s: S) -> Self {
        self.map(|x| x * s)
    }

    /// `self × b` for a constant `b`.
    #[inline(always)]
    pub fn cross_constant<C: Copy>(self, b: &Vec3<C>) -> Self
    where
        S: Over<C>,
    {
        Self {
            x: self.y.scale(b.z) - self.z.scale(b.y),
            y: self.z.scale(b.x) - self.x.scale(b.z),
            z: self.x.scale(b.y) - self.y.scale(b.x),
        }
    }

    /// `b × self` for a constant `b`.
    #[inline(always)]
    pub(crate) fn crossed_by_constant<C: Copy>(self, b: &Vec3<C>) -> Self
    where
        S: Over<C>,
    {
        Self {
            x: self.z.scale(b.y) - self.y.scale(b.z),
            y: self.x.scale(b.z) - self.z.scale(b.x),
            z: self.y.scale(b.x) - self.x.scale(b.y),
        }
    }

    /// The vector turned about z.
    #[inline(always)]
    pub(crate) fn turned(self, sin: S, cos: S) -> Self {
        Self { x: cos * self.x - sin * self.y, y: sin * self.x + cos * self.y, z: self.z }
    }

    /// The vector turned about z, backwards.
    #[inline(always)]
    pub(crate) fn unturned(self, sin: S, cos: S) -> Self {
        Self { x: cos * self.x + sin * self.y, y: cos * self.y - sin * self.x, z: self.z }
    }

    /// Inner product with a constant vector.
    #[inline(always)]
    pub fn dot_constant<C: Copy>(self, b: &Vec3<C>) -> S
    where
        S: Over<C>,
    {
        self.x.scale(b.x) + self.y.scale(b.y) + self.z.scale(b.z)
    }
}

impl<S: Scalar> Add for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { x: self.x + b.x, y: self.y + b.y, z: self.z + b.z }
    }
}

impl<S: Scalar> Sub for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self { x: self.x - b.x, y: self.y - b.y, z: self.z - b.z }
    }
}

impl<S: Scalar> Neg for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z }
    }
}

impl<S: Scalar> AddAssign for Vec3<S> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
