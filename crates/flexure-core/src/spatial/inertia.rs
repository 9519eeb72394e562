//! Rigid-body and articulated-body inertias.

use super::{Carried, Twist, Vec3, Wrench};
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
    fn zip(&self, b: &Self, f: impl Fn(S, S) -> S) -> Self {
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
    fn mul(&self, v: Vec3<S>) -> Vec3<S> {
        Vec3 {
            x: self.xx * v.x + self.xy * v.y + self.xz * v.z,
            y: self.xy * v.x + self.yy * v.y + self.yz * v.z,
            z: self.xz * v.x + self.yz * v.y + self.zz * v.z,
        }
    }

    #[inline]
    fn mul_lifted<T: Over<S>>(&self, v: Vec3<T>) -> Vec3<T> {
        Vec3 {
            x: v.x.scale(self.xx) + v.y.scale(self.xy) + v.z.scale(self.xz),
            y: v.x.scale(self.xy) + v.y.scale(self.yy) + v.z.scale(self.yz),
            z: v.x.scale(self.xz) + v.y.scale(self.yz) + v.z.scale(self.zz),
        }
    }

    /// The rows as vectors.
    #[inline]
    fn rows(&self) -> [Vec3<S>; 3] {
        [
            Vec3::new(self.xx, self.xy, self.xz),
            Vec3::new(self.xy, self.yy, self.yz),
            Vec3::new(self.xz, self.yz, self.zz),
        ]
    }

    /// The upper triangle of the matrix with these rows, which is symmetric in exact arithmetic.
    #[inline]
    fn from_rows([x, y, z]: [Vec3<S>; 3]) -> Self {
        Self { xx: x.x, xy: x.y, xz: x.z, yy: y.y, yz: y.z, zz: z.z }
    }
}

/// The inertia of a rigid body in its link frame: mass, first moment of mass and rotational inertia about the
/// frame's origin.
#[derive(Clone, Copy, Debug)]
pub struct RigidInertia<C> {
    pub(crate) mass: C,
    pub(crate) first_moment: Vec3<C>,
    pub(crate) rotational: Sym3<C>,
}

impl<C: Scalar> RigidInertia<C> {
    /// From the mass in kg, the centre of mass in m and the rotational inertia about it [kg m²], given as
    /// `(xx, xy, xz, yy, yz, zz)` in the axes of the link frame. Parallel-axis theorem.
    pub fn new(mass: C, com: [C; 3], [xx, xy, xz, yy, yz, zz]: [C; 6]) -> Self {
        let c = Vec3::from_array(com);
        let h = c.scaled(mass);
        let rotational = Sym3 {
            xx: xx + h.y * c.y + h.z * c.z,
            xy: xy - h.x * c.y,
            xz: xz - h.x * c.z,
            yy: yy + h.x * c.x + h.z * c.z,
            yz: yz - h.y * c.z,
            zz: zz + h.x * c.x + h.y * c.y,
        };
        Self { mass, first_moment: h, rotational }
    }

    pub(crate) fn map<D>(&self, f: impl Fn(C) -> D) -> RigidInertia<D> {
        RigidInertia {
            mass: f(self.mass),
            first_moment: self.first_moment.map(&f),
            rotational: self.rotational.map(&f),
        }
    }

    /// ∫ r rᵀ dm about the frame's origin: ½ tr(I) 1 − I [kg m²].
    #[inline]
    fn second_moment(&self) -> Sym3<C> {
        let r = &self.rotational;
        let half = C::from_ratio(1, 2) * (r.xx + r.yy + r.zz);
        Sym3 { xx: half - r.xx, xy: -r.xy, xz: -r.xz, yy: half - r.yy, yz: -r.yz, zz: half - r.zz }
    }

    /// What moves the body like this.
    #[inline]
    pub(crate) fn wrench<T: Over<C>>(&self, body: &Carried<T>) -> Wrench<T> {
        let h = &self.first_moment;
        let (spin, spin_r, spin_rate) = (body.spin, body.spin_r, body.spin_rate);
        Wrench {
            moment: self.rotational.mul_lifted(spin_rate)
                + self.second_moment().mul_lifted(spin_r).cross(spin)
                - body.linear.cross_constant(h),
            linear: body.linear.map(|x| x.scale(self.mass))
                + spin_rate.cross_constant(h)
                + spin_r.cross(spin.cross_constant(h)),
        }
    }

    /// Sum of two inertias in the same frame.
    #[inline]
    pub(crate) fn plus(&self, b: &Self) -> Self {
        Self {
            mass: self.mass + b.mass,
            first_moment: self.first_moment + b.first_moment,
            rotational: self.rotational.zip(&b.rotational, |x, y| x + y),
        }
    }

    /// The same body in a frame whose axes are `rotate(·)` away and whose origin lies at `−p`: the body's
    /// coordinates go through `x ↦ R x + p`.
    #[inline]
    pub(crate) fn moved(&self, rotate: impl Fn(Vec3<C>) -> Vec3<C>, p: Vec3<C>) -> Self {
        let h = rotate(self.first_moment);
        let shifted = h + p.scaled(self.mass);
        let rotational = congruence(self.rotational.rows(), &rotate);
        // I + 2 (h·p) 1 − h pᵀ − p hᵀ + m (p·p 1 − p pᵀ), with h + m p = shifted.
        let diagonal = h.dot(p) + shifted.dot(p);
        let rotational = Sym3 {
            xx: rotational.xx + diagonal - h.x * p.x - p.x * shifted.x,
            xy: rotational.xy - h.x * p.y - p.x * shifted.y,
            xz: rotational.xz - h.x * p.z - p.x * shifted.z,
            yy: rotational.yy + diagonal - h.y * p.y - p.y * shifted.y,
            yz: rotational.yz - h.y * p.z - p.y * shifted.z,
            zz: rotational.zz + diagonal - h.z * p.z - p.z * shifted.z,
        };
        Self { mass: self.mass, first_moment: shifted, rotational }
    }

    /// Spatial momentum for a unit velocity along the joint axis z: revolute or prismatic.
    #[inline]
    pub(crate) fn axis_momentum(&self, prismatic: bool) -> Wrench<C> {
        let (h, r) = (self.first_moment, &self.rotational);
        if prismatic {
            Wrench { moment: Vec3::new(h.y, -h.x, C::ZERO), linear: Vec3::new(C::ZERO, C::ZERO, self.mass) }
        } else {
            Wrench { moment: Vec3::new(r.xz, r.yz, r.zz), linear: Vec3::new(-h.y, h.x, C::ZERO) }
        }
    }
}

/// `R A Rᵀ` for a symmetric `A` given by its rows, with `R` as a function.
#[inline]
fn congruence<C: Scalar>(rows: [Vec3<C>; 3], rotate: impl Fn(Vec3<C>) -> Vec3<C>) -> Sym3<C> {
    Sym3::from_rows(rotate_matrix(rows, rotate))
}

/// The rows of `R A Rᵀ` for any `A` given by its rows.
#[inline]
fn rotate_matrix<C: Scalar>(rows: [Vec3<C>; 3], rotate: impl Fn(Vec3<C>) -> Vec3<C>) -> [Vec3<C>; 3] {
    transpose(transpose(rows.map(&rotate)).map(&rotate))
}

#[inline]
fn transpose<C: Copy>([a, b, c]: [Vec3<C>; 3]) -> [Vec3<C>; 3] {
    [Vec3 { x: a.x, y: b.x, z: c.x }, Vec3 { x: a.y, y: b.y, z: c.y }, Vec3 { x: a.z, y: b.z, z: c.z }]
}

/// An articulated-body inertia `[[A, B], [Bᵀ, D]]`: moment = A ω + B v, force = Bᵀ ω + D v.
///
/// Featherstone (2008), section 7.1.
#[derive(Clone, Copy, Debug)]
pub struct ArticulatedInertia<S> {
    angular: Sym3<S>,
    /// Rows of B.
    coupling: [Vec3<S>; 3],
    linear: Sym3<S>,
}

impl<S: Scalar> ArticulatedInertia<S> {
    /// The articulated inertia of a single rigid body.
    #[inline]
    pub(crate) fn of_body<C: Scalar>(body: &RigidInertia<C>) -> Self
    where
        S: Over<C>,
    {
        let h = body.first_moment.map(S::constant);
        let m = S::constant(body.mass);
        let zero = S::ZERO;
        Self {
            angular: body.rotational.map(S::constant),
            // [h]×
            coupling: [Vec3::new(zero, -h.z, h.y), Vec3::new(h.z, zero, -h.x), Vec3::new(-h.y, h.x, zero)],
            linear: Sym3 { xx: m, xy: zero, xz: zero, yy: m, yz: zero, zz: m },
        }
    }

    #[inline]
    pub(crate) fn plus(&self, b: &Self) -> Self {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.coupling, b.coupling);
        Self {
            angular: self.angular.zip(&b.angular, |x, y| x + y),
            coupling: [a0 + b0, a1 + b1, a2 + b2],
            linear: self.linear.zip(&b.linear, |x, y| x + y),
        }
    }

    /// `I S` for the unit joint axis z: revolute or prismatic.
    #[inline]
    pub(crate) fn along_axis(&self, prismatic: bool) -> Wrench<S> {
        let [b0, b1, b2] = self.coupling;
        if prismatic {
            let d = &self.linear;
            Wrench { moment: Vec3::new(b0.z, b1.z, b2.z), linear: Vec3::new(d.xz, d.yz, d.zz) }
        } else {
            let a = &self.angular;
            Wrench { moment: Vec3::new(a.xz, a.yz, a.zz), linear: b2 }
        }
    }

    /// `I − U Uᵀ / d`: what the rest of the tree feels of a joint that is free to move.
    #[inline]
    pub(crate) fn without_axis(&self, u: &Wrench<S>, reciprocal: S) -> Self {
        let (n, f) = (u.moment, u.linear);
        let (nd, fd) = (n.scaled(reciprocal), f.scaled(reciprocal));
        let outer = |a: Vec3<S>, b: Vec3<S>| Sym3 {
            xx: a.x * b.x,
            xy: a.x * b.y,
            xz: a.x * b.z,
            yy: a.y * b.y,
            yz: a.y * b.z,
            zz: a.z * b.z,
        };
        let [b0, b1, b2] = self.coupling;
        Self {
            angular: self.angular.zip(&outer(n, nd), |x, y| x - y),
            coupling: [b0 - fd.scaled(n.x), b1 - fd.scaled(n.y), b2 - fd.scaled(n.z)],
            linear: self.linear.zip(&outer(f, fd), |x, y| x - y),
        }
    }

    /// The same inertia in coordinates `x ↦ R x + p`.
    #[inline]
    pub(crate) fn moved(&self, rotate: impl Fn(Vec3<S>) -> Vec3<S>, p: Vec3<S>) -> Self {
        let angular = rotate_matrix(self.angular.rows(), &rotate);
        let [b0, b1, b2] = rotate_matrix(self.coupling, &rotate);
        let linear = congruence(self.linear.rows(), &rotate);
        // With P = [p]×: B' = B + P D,  A' = A + P Bᵀ + (P Bᵀ)ᵀ + P D Pᵀ = A + P Bᵀ + B' Pᵀ.
        let [c0, c1, c2] = transpose(linear.rows().map(|row| p.cross(row)));
        let coupling = [b0 + c0, b1 + c1, b2 + c2];
        let [d0, d1, d2] = transpose([b0, b1, b2].map(|row| p.cross(row)));
        let [e0, e1, e2] = coupling.map(|row| p.cross(row));
        let [a0, a1, a2] = angular;
        Self { angular: Sym3::from_rows([a0 + d0 + e0, a1 + d1 + e1, a2 + d2 + e2]), coupling, linear }
    }

    /// `I v`.
    #[inline]
    pub fn mul(&self, v: &Twist<S>) -> Wrench<S> {
        let [b0, b1, b2] = self.coupling;
        let [t0, t1, t2] = transpose(self.coupling);
        let w = v.angular;
        Wrench {
            moment: self.angular.mul(w) + Vec3::new(b0.dot(v.linear), b1.dot(v.linear), b2.dot(v.linear)),
            linear: Vec3::new(t0.dot(w), t1.dot(w), t2.dot(w)) + self.linear.mul(v.linear),
        }
    }
}
