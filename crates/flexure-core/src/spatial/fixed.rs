//! Constant rotations.

use super::{Sym3, Vec3};
use crate::linalg::Matrix;
use crate::scalar::{Over, Scalar};

/// A constant rotation: about x where frames are chosen so, after Denavit and Hartenberg, which takes six products and sums instead of
/// fifteen.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Fixed<C> {
    AboutX { sin: C, cos: C },
    General(Rotation<C>),
}

impl<C: Scalar> Fixed<C> {
    pub(crate) fn map<D: Scalar>(&self, f: impl Fn(C) -> D) -> Fixed<D> {
        match self {
            Self::AboutX { sin, cos } => Fixed::AboutX { sin: f(*sin), cos: f(*cos) },
            Self::General(rotation) => Fixed::General(rotation.map(f)),
        }
    }

    /// `R e_z`.
    pub(crate) fn axis(&self) -> Vec3<C> {
        match *self {
            Self::AboutX { sin, cos } => Vec3::new(C::ZERO, -sin, cos),
            Self::General(rotation) => rotation.z,
        }
    }

    /// `R v`.
    #[inline(always)]
    pub(crate) fn rotate<T: Over<C>>(&self, v: Vec3<T>) -> Vec3<T> {
        match self {
            Self::AboutX { sin, cos } => {
                Vec3 { x: v.x, y: v.y.scale(*cos) - v.z.scale(*sin), z: v.y.scale(*sin) + v.z.scale(*cos) }
            }
            Self::General(rotation) => rotation.rotate(v),
        }
    }

    /// `Rᵀ v`.
    #[inline(always)]
    pub(crate) fn unrotate<T: Over<C>>(&self, v: Vec3<T>) -> Vec3<T> {
        match self {
            Self::AboutX { sin, cos } => {
                Vec3 { x: v.x, y: v.y.scale(*cos) + v.z.scale(*sin), z: v.z.scale(*cos) - v.y.scale(*sin) }
            }
            Self::General(rotation) => rotation.unrotate(v),
        }
    }

    /// `R A Rᵀ`.
    #[inline(always)]
    pub(crate) fn congruence<T: Over<C>>(&self, a: &Sym3<T>) -> Sym3<T> {
        match self {
            Self::AboutX { sin, cos } => a.tilted(*sin, *cos),
            Self::General(rotation) => {
                // The rows of A Rᵀ; of R (A Rᵀ) the upper triangle.
                let [x, y, z] = a.rows().map(|row| rotation.rotate(row));
                let first = rotation.rotate(Vec3::new(x.x, y.x, z.x));
                let second = rotation.rotate(Vec3::new(x.y, y.y, z.y));
                let third = rotation.rotate(Vec3::new(x.z, y.z, z.z));
                Sym3 { xx: first.x, xy: second.x, xz: third.x, yy: second.y, yz: third.y, zz: third.z }
            }
        }
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

    fn map<D: Scalar>(&self, f: impl Fn(C) -> D) -> Rotation<D> {
        Rotation { x: self.x.map(&f), y: self.y.map(&f), z: self.z.map(&f) }
    }

    /// `R v`.
    #[inline(always)]
    fn rotate<T: Over<C>>(&self, v: Vec3<T>) -> Vec3<T> {
        Vec3 {
            x: v.x.scale(self.x.x) + v.y.scale(self.y.x) + v.z.scale(self.z.x),
            y: v.x.scale(self.x.y) + v.y.scale(self.y.y) + v.z.scale(self.z.y),
            z: v.x.scale(self.x.z) + v.y.scale(self.y.z) + v.z.scale(self.z.z),
        }
    }

    /// `Rᵀ v`.
    #[inline(always)]
    fn unrotate<T: Over<C>>(&self, v: Vec3<T>) -> Vec3<T> {
        Vec3 { x: v.dot_constant(&self.x), y: v.dot_constant(&self.y), z: v.dot_constant(&self.z) }
    }
}
