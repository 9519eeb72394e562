//! Symmetric 3 × 3 matrices.

use super::Vec3;
use crate::scalar::{Over, Scalar};

/// A symmetric 3 × 3 matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sym3<S> {
    pub xx: S,
    pub xy: S,
    pub xz: S,
    pub yy: S,
    pub yz: S,
    pub zz: S,
}

impl<S: Scalar> Sym3<S> {
    /// The zero matrix.
    pub(crate) const ZERO: Self =
        Self { xx: S::ZERO, xy: S::ZERO, xz: S::ZERO, yy: S::ZERO, yz: S::ZERO, zz: S::ZERO };

    #[inline]
    pub(crate) fn map<T>(&self, f: impl Fn(S) -> T) -> Sym3<T> {
        Sym3 {
            xx: f(self.xx),
            xy: f(self.xy),
            xz: f(self.xz),
            yy: f(self.yy),
            yz: f(self.yz),
            zz: f(self.zz),
        }
    }

    #[inline]
    pub(crate) fn zip(&self, b: &Self, f: impl Fn(S, S) -> S) -> Self {
        Self {
            xx: f(self.xx, b.xx),
            xy: f(self.xy, b.xy),
            xz: f(self.xz, b.xz),
            yy: f(self.yy, b.yy),
            yz: f(self.yz, b.yz),
            zz: f(self.zz, b.zz),
        }
    }

    #[inline]
    pub(crate) fn plus(&self, b: &Self) -> Self {
        self.zip(b, |x, y| x + y)
    }

    #[inline]
    pub(crate) fn mul(&self, v: Vec3<S>) -> Vec3<S> {
        let [x, y, z] = self.rows();
        Vec3 { x: x.dot(v), y: y.dot(v), z: z.dot(v) }
    }

    /// The rows as vectors.
    #[inline]
    pub(crate) fn rows(&self) -> [Vec3<S>; 3] {
        [
            Vec3::new(self.xx, self.xy, self.xz),
            Vec3::new(self.xy, self.yy, self.yz),
            Vec3::new(self.xz, self.yz, self.zz),
        ]
    }

    /// `R A Rᵀ` with the rotation R about z. With w = s (xx − yy) + 2 c xy the block of x and y becomes xx − s w, c w − xy, yy + s w.
    #[inline]
    pub(crate) fn turned(&self, sin: S, cos: S) -> Self {
        let w = sin * (self.xx - self.yy) + cos * (self.xy + self.xy);
        let moved = sin * w;
        Self {
            xx: self.xx - moved,
            xy: cos * w - self.xy,
            xz: cos * self.xz - sin * self.yz,
            yy: self.yy + moved,
            yz: sin * self.xz + cos * self.yz,
            zz: self.zz,
        }
    }

    /// `R A Rᵀ` with a constant rotation R about x.
    #[inline]
    pub(crate) fn tilted<C: Copy>(&self, sin: C, cos: C) -> Self
    where
        S: Over<C>,
    {
        let w = (self.yy - self.zz).scale(sin) + (self.yz + self.yz).scale(cos);
        let moved = w.scale(sin);
        Self {
            xx: self.xx,
            xy: self.xy.scale(cos) - self.xz.scale(sin),
            xz: self.xy.scale(sin) + self.xz.scale(cos),
            yy: self.yy - moved,
            yz: w.scale(cos) - self.yz,
            zz: self.zz + moved,
        }
    }
}
