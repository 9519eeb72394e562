//! Vectors of three-space, and rotations by a constant matrix.

use core::ops::{Add, AddAssign, Neg, Sub};

use crate::linalg::Matrix;
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
    #[inline]
    pub const fn new(x: S, y: S, z: S) -> Self {
        Self { x, y, z }
    }

    /// The vector of an array.
    #[inline]
    pub fn from_array([x, y, z]: [S; 3]) -> Self {
        Self { x, y, z }
    }

    /// Every component through `f`.
    #[inline]
    pub fn map<T>(self, f: impl Fn(S) -> T) -> Vec3<T> {
        Vec3 { x: f(self.x), y: f(self.y), z: f(self.z) }
    }

    /// Inner product.
    #[inline]
    pub fn dot(self, b: Self) -> S {
        self.x * b.x + self.y * b.y + self.z * b.z
    }

    /// `self × b`.
    #[inline]
    pub fn cross(self, b: Self) -> Self {
        Self {
            x: self.y * b.z - self.z * b.y,
            y: self.z * b.x - self.x * b.z,
            z: self.x * b.y - self.y * b.x,
        }
    }

    /// `self · s`.
    #[inline]
    pub fn scaled(self, s: S) -> Self {
        self.map(|x| x * s)
    }

    /// `self × b` for a constant `b`.
    #[inline]
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

    /// Inner product with a constant vector.
    #[inline]
    pub fn dot_constant<C: Copy>(self, b: &Vec3<C>) -> S
    where
        S: Over<C>,
    {
        self.x.scale(b.x) + self.y.scale(b.y) + self.z.scale(b.z)
    }
}

impl<S: Scalar> Add for Vec3<S> {
    type Output = Self;
    #[inline]
    fn add(self, b: Self) -> Self {
        Self { x: self.x + b.x, y: self.y + b.y, z: self.z + b.z }
    }
}

impl<S: Scalar> Sub for Vec3<S> {
    type Output = Self;
    #[inline]
    fn sub(self, b: Self) -> Self {
        Self { x: self.x - b.x, y: self.y - b.y, z: self.z - b.z }
    }
}

impl<S: Scalar> Neg for Vec3<S> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z }
    }
}

impl<S: Scalar> AddAssign for Vec3<S> {
    #[inline]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

/// A constant rotation matrix, by columns: `R = [x y z]`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rotation<C> {
    x: Vec3<C>,
    y: Vec3<C>,
    z: Vec3<C>,
}

impl<C: Scalar> Rotation<C> {
    pub(crate) fn from_matrix(m: &Matrix<C, 3, 3>) -> Self {
        Self {
            x: Vec3::from_array(m.column(0).0),
            y: Vec3::from_array(m.column(1).0),
            z: Vec3::from_array(m.column(2).0),
        }
    }

    pub(crate) fn map<D: Scalar>(&self, f: impl Fn(C) -> D) -> Rotation<D> {
        Rotation { x: self.x.map(&f), y: self.y.map(&f), z: self.z.map(&f) }
    }

    /// `R v`.
    #[inline]
    pub(crate) fn rotate<T: Over<C>>(&self, v: Vec3<T>) -> Vec3<T> {
        Vec3 {
            x: v.x.scale(self.x.x) + v.y.scale(self.y.x) + v.z.scale(self.z.x),
            y: v.x.scale(self.x.y) + v.y.scale(self.y.y) + v.z.scale(self.z.y),
            z: v.x.scale(self.x.z) + v.y.scale(self.y.z) + v.z.scale(self.z.z),
        }
    }

    /// `Rᵀ v`.
    #[inline]
    pub(crate) fn unrotate<T: Over<C>>(&self, v: Vec3<T>) -> Vec3<T> {
        Vec3 { x: v.dot_constant(&self.x), y: v.dot_constant(&self.y), z: v.dot_constant(&self.z) }
    }
}
