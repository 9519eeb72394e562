//! Rigid-body and articulated-body inertias.

use super::{Carried, Fixed, Sym3, Twist, Vec3, Wrench};
use crate::scalar::{Over, Scalar};

/// The inertia of a rigid body in its link frame: mass and the first and second moments of mass about the frame's
/// origin. The mass is a constant of type `C` even where the body has been moved by joints at positions of type `T`.
#[derive(Clone, Copy, Debug)]
pub struct RigidInertia<C, T = C> {
    pub(crate) mass: C,
    /// h = ∫ r dm [kg m].
    pub(crate) first_moment: Vec3<T>,
    /// Σ = ∫ r rᵀ dm [kg m²], a rotational inertia less: I = tr(Σ) 1 − Σ.
    pub(crate) second_moment: Sym3<T>,
}

impl<C: Scalar> RigidInertia<C> {
    /// From the mass in kg, the centre of mass in m and the rotational inertia about it [kg m²], given as
    /// `(xx, xy, xz, yy, yz, zz)` in the axes of the link frame.
    pub fn new(mass: C, com: [C; 3], [xx, xy, xz, yy, yz, zz]: [C; 6]) -> Self {
        let c = Vec3::from_array(com);
        let h = c.scaled(mass);
        let half = C::from_ratio(1, 2);
        // ½ tr(I) 1 − I about the centre of mass, + m c cᵀ.
        let second_moment = Sym3 {
            xx: half * (yy + zz - xx) + h.x * c.x,
            xy: h.x * c.y - xy,
            xz: h.x * c.z - xz,
            yy: half * (zz + xx - yy) + h.y * c.y,
            yz: h.y * c.z - yz,
            zz: half * (xx + yy - zz) + h.z * c.z,
        };
        Self { mass, first_moment: h, second_moment }
    }

    /// Takes off the body what may as well lie on the joint's axis z: its mass, h_z and Σ_zz, those of points of that axis. What is left
    /// is the same to every motor of a revolute joint if the axis has them, and needs fewer products
    /// ([`about_axis`](Self::about_axis)). Khalil and Dombre, *Modeling, identification and control of robots*, 2002, section 9.4.
    pub(crate) fn split_axis(&mut self) -> AxisMass<C> {
        let axis = AxisMass {
            mass: self.mass,
            first_moment: self.first_moment.z,
            second_moment: self.second_moment.zz,
        };
        self.mass = C::ZERO;
        self.first_moment.z = C::ZERO;
        self.second_moment.zz = C::ZERO;
        axis
    }

    /// Puts points that lie on a line onto the body: the line through `p` with the unit direction `e`.
    pub(crate) fn add_axis(&mut self, axis: &AxisMass<C>, p: Vec3<C>, e: Vec3<C>) {
        // x = p + e s: ∫ x xᵀ dm = m p pᵀ + h (p eᵀ + e pᵀ) + Σ e eᵀ = p uᵀ + e wᵀ with the two vectors below.
        let u = p.scaled(axis.mass) + e.scaled(axis.first_moment);
        let w = p.scaled(axis.first_moment) + e.scaled(axis.second_moment);
        self.mass += axis.mass;
        self.first_moment += u;
        let s = &mut self.second_moment;
        s.xx += p.x * u.x + e.x * w.x;
        s.xy += p.x * u.y + e.x * w.y;
        s.xz += p.x * u.z + e.x * w.z;
        s.yy += p.y * u.y + e.y * w.y;
        s.yz += p.y * u.z + e.y * w.z;
        s.zz += p.z * u.z + e.z * w.z;
    }

    pub(crate) fn map<D: Copy>(&self, f: impl Fn(C) -> D) -> RigidInertia<D> {
        RigidInertia {
            mass: f(self.mass),
            first_moment: self.first_moment.map(&f),
            second_moment: self.second_moment.map(&f),
        }
    }

    /// The body as one that joints move.
    #[inline]
    pub(crate) fn lift<T: Over<C>>(&self) -> RigidInertia<C, T> {
        RigidInertia {
            mass: self.mass,
            first_moment: self.first_moment.map(T::constant),
            second_moment: self.second_moment.map(T::constant),
        }
    }

    /// The ten numbers: mass, first moments x, y, z, second moments xx, xy, xz, yy, yz, zz.
    #[inline]
    pub(crate) fn numbers(&self) -> [C; 10] {
        let (Vec3 { x, y, z }, s) = (self.first_moment, &self.second_moment);
        [self.mass, x, y, z, s.xx, s.xy, s.xz, s.yy, s.yz, s.zz]
    }

    /// The body with these [`numbers`](Self::numbers).
    #[inline]
    pub(crate) fn from_numbers([mass, x, y, z, xx, xy, xz, yy, yz, zz]: [C; 10]) -> Self {
        let second_moment = Sym3 { xx, xy, xz, yy, yz, zz };
        Self { mass, first_moment: Vec3 { x, y, z }, second_moment }
    }

    /// What moves the body like this: with the accelerations a + A x of its points, f = m a + A h and n = h × a + ∫ x × A x dm,
    /// which is twice the axial vector of A Σ. `times` multiplies by a number of the body.
    #[inline(always)]
    pub(crate) fn wrench<T: Scalar>(&self, body: &Carried<T>, times: impl Fn(T, C) -> T + Copy) -> Wrench<T> {
        let (h, s, a) = (&self.first_moment, &self.second_moment, body.linear);
        let [x, y, z] = &body.spread;
        let reduced = self.about_axis(body, times);
        Wrench {
            moment: Vec3 {
                x: reduced.moment.x - times(y.z, s.zz) - times(a.y, h.z),
                y: reduced.moment.y + times(x.z, s.zz) + times(a.x, h.z),
                z: reduced.moment.z,
            },
            linear: Vec3 {
                x: reduced.linear.x + times(x.z, h.z) + times(a.x, self.mass),
                y: reduced.linear.y + times(y.z, h.z) + times(a.y, self.mass),
                z: reduced.linear.z + times(z.z, h.z) + times(a.z, self.mass),
            },
        }
    }

    /// [`wrench`](Self::wrench) of a body without mass, h_z and Σ_zz.
    #[inline(always)]
    pub(crate) fn about_axis<T: Scalar>(
        &self,
        body: &Carried<T>,
        times: impl Fn(T, C) -> T + Copy,
    ) -> Wrench<T> {
        let (h, s, a) = (&self.first_moment, &self.second_moment, body.linear);
        let [x, y, z] = &body.spread;
        Wrench {
            moment: Vec3 {
                x: times(z.x, s.xy) - times(y.x, s.xz)
                    + times(z.y, s.yy)
                    + times(z.z - y.y, s.yz)
                    + times(a.z, h.y),
                y: times(x.y, s.yz) - times(z.y, s.xy) - times(z.x, s.xx) + times(x.x - z.z, s.xz)
                    - times(a.z, h.x),
                z: times(y.z, s.xz) - times(x.z, s.yz) + times(y.x, s.xx) - times(x.y, s.yy)
                    + times(y.y - x.x, s.xy)
                    + times(a.y, h.x)
                    - times(a.x, h.y),
            },
            linear: Vec3 {
                x: times(x.x, h.x) + times(x.y, h.y),
                y: times(y.x, h.x) + times(y.y, h.y),
                z: times(z.x, h.x) + times(z.y, h.y),
            },
        }
    }
}

impl<C: Scalar, T: Over<C>> RigidInertia<C, T> {
    /// Sum of two inertias in the same frame.
    #[inline]
    pub(crate) fn plus(&self, b: &Self) -> Self {
        Self {
            mass: self.mass + b.mass,
            first_moment: self.first_moment + b.first_moment,
            second_moment: self.second_moment.plus(&b.second_moment),
        }
    }

    /// The body pushed along z by `q`.
    #[inline]
    pub(crate) fn slid(&self, q: T) -> Self {
        let (h, s) = (self.first_moment, &self.second_moment);
        let moved = h.z + q.scale(self.mass);
        Self {
            first_moment: Vec3 { z: moved, ..h },
            second_moment: Sym3 {
                xz: s.xz + q * h.x,
                yz: s.yz + q * h.y,
                zz: s.zz + q * (h.z + moved),
                ..*s
            },
            ..*self
        }
    }

    /// The body turned about z.
    #[inline]
    pub(crate) fn turned(&self, sin: T, cos: T) -> Self {
        Self {
            first_moment: self.first_moment.turned(sin, cos),
            second_moment: self.second_moment.turned(sin, cos),
            ..*self
        }
    }

    /// The body's points taken through `x ↦ R x + p`, both constant.
    #[inline]
    pub(crate) fn placed(&self, rotation: &Fixed<C>, p: &Vec3<C>) -> Self {
        let h = rotation.rotate(self.first_moment);
        let s = rotation.congruence(&self.second_moment);
        let moved = h + p.map(|x| T::constant(x * self.mass));
        // + h pᵀ + p (h + m p)ᵀ
        let second_moment = Sym3 {
            xx: s.xx + (h.x + moved.x).scale(p.x),
            xy: s.xy + h.x.scale(p.y) + moved.y.scale(p.x),
            xz: s.xz + h.x.scale(p.z) + moved.z.scale(p.x),
            yy: s.yy + (h.y + moved.y).scale(p.y),
            yz: s.yz + h.y.scale(p.z) + moved.z.scale(p.y),
            zz: s.zz + (h.z + moved.z).scale(p.z),
        };
        Self { mass: self.mass, first_moment: moved, second_moment }
    }

    /// Spatial momentum for a unit velocity along the joint axis z: revolute or prismatic.
    #[inline]
    pub(crate) fn axis_momentum(&self, prismatic: bool) -> Wrench<T> {
        let (h, s) = (self.first_moment, &self.second_moment);
        if prismatic {
            let along = Vec3::new(T::ZERO, T::ZERO, T::constant(self.mass));
            Wrench { moment: Vec3::new(h.y, -h.x, T::ZERO), linear: along }
        } else {
            Wrench { moment: Vec3::new(-s.xz, -s.yz, s.xx + s.yy), linear: Vec3::new(-h.y, h.x, T::ZERO) }
        }
    }
}

/// Points on a joint's axis z: mass, first and second moment about the frame's origin [kg, kg m, kg m²].
#[derive(Clone, Copy, Debug)]
pub(crate) struct AxisMass<C> {
    pub mass: C,
    pub first_moment: C,
    pub second_moment: C,
}

/// The rows of the transpose.
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
    /// No inertia.
    pub(crate) const ZERO: Self = Self { angular: Sym3::ZERO, coupling: [Vec3::ZERO; 3], linear: Sym3::ZERO };

    /// The articulated inertia of a single rigid body.
    #[inline]
    pub(crate) fn of_body<C: Scalar>(body: &RigidInertia<C>) -> Self
    where
        S: Over<C>,
    {
        let h = body.first_moment.map(S::constant);
        let m = S::constant(body.mass);
        let zero = S::ZERO;
        let s = &body.second_moment;
        let angular =
            Sym3 { xx: s.yy + s.zz, xy: -s.xy, xz: -s.xz, yy: s.zz + s.xx, yz: -s.yz, zz: s.xx + s.yy };
        Self {
            angular: angular.map(S::constant),
            // [h]×
            coupling: [Vec3::new(zero, -h.z, h.y), Vec3::new(h.z, zero, -h.x), Vec3::new(-h.y, h.x, zero)],
            linear: Sym3 { xx: m, xy: zero, xz: zero, yy: m, yz: zero, zz: m },
        }
    }

    #[inline]
    pub(crate) fn plus(&self, b: &Self) -> Self {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.coupling, b.coupling);
        Self {
            angular: self.angular.plus(&b.angular),
            coupling: [a0 + b0, a1 + b1, a2 + b2],
            linear: self.linear.plus(&b.linear),
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

    /// [`without_axis`](Self::without_axis) of a revolute joint, without what vanishes.
    #[inline]
    pub(crate) fn freed(&self, u: &Wrench<S>, reciprocal: S) -> Freed<S> {
        let (n, f) = (u.moment, u.linear);
        let (nd, fd) = (n.scaled(reciprocal), f.scaled(reciprocal));
        let ([b0, b1, _], a, d) = (self.coupling, &self.angular, &self.linear);
        Freed {
            xx: a.xx - n.x * nd.x,
            xy: a.xy - n.x * nd.y,
            yy: a.yy - n.y * nd.y,
            coupling: [b0 - fd.scaled(n.x), b1 - fd.scaled(n.y)],
            linear: Sym3 {
                xx: d.xx - f.x * fd.x,
                xy: d.xy - f.x * fd.y,
                xz: d.xz - f.x * fd.z,
                yy: d.yy - f.y * fd.y,
                yz: d.yz - f.y * fd.z,
                zz: d.zz - f.z * fd.z,
            },
        }
    }

    /// The inertia of what has been pushed along z by `q`.
    #[inline]
    pub(crate) fn slid(&self, q: S) -> Self {
        self.shifted(|v| Vec3 { x: -(q * v.y), y: q * v.x, z: S::ZERO })
    }

    /// The inertia of what has been turned about z.
    #[inline]
    pub(crate) fn turned(&self, sin: S, cos: S) -> Self {
        let turn = |v: Vec3<S>| v.turned(sin, cos);
        Self {
            angular: self.angular.turned(sin, cos),
            coupling: transpose(transpose(self.coupling.map(turn)).map(turn)),
            linear: self.linear.turned(sin, cos),
        }
    }

    /// The inertia of what has been taken through `x ↦ R x + p`, both constant.
    #[inline]
    pub(crate) fn placed<C: Scalar>(&self, rotation: &Fixed<C>, p: &Vec3<C>) -> Self
    where
        S: Over<C>,
    {
        let rotate = |v: Vec3<S>| rotation.rotate(v);
        let turned = Self {
            angular: rotation.congruence(&self.angular),
            coupling: transpose(transpose(self.coupling.map(rotate)).map(rotate)),
            linear: rotation.congruence(&self.linear),
        };
        turned.shifted(|v| v.crossed_by_constant(p))
    }

    /// The inertia of what has been shifted by p, given `cross(v)` = p × v.
    #[inline]
    fn shifted(&self, cross: impl Fn(Vec3<S>) -> Vec3<S>) -> Self {
        let [b0, b1, b2] = self.coupling;
        // With P = [p]×: B' = B + P D,  A' = A + P Bᵀ + (P Bᵀ)ᵀ + P D Pᵀ = A + P Bᵀ + B' Pᵀ.
        let [c0, c1, c2] = transpose(self.linear.rows().map(&cross));
        let coupling = [b0 + c0, b1 + c1, b2 + c2];
        let [d0, d1, d2] = [b0, b1, b2].map(&cross);
        let [e0, e1, e2] = coupling.map(&cross);
        let a = &self.angular;
        let angular = Sym3 {
            xx: a.xx + d0.x + e0.x,
            xy: a.xy + d1.x + e0.y,
            xz: a.xz + d2.x + e0.z,
            yy: a.yy + d1.y + e1.y,
            yz: a.yz + d2.y + e1.z,
            zz: a.zz + d2.z + e2.z,
        };
        Self { angular, coupling, linear: self.linear }
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

/// An articulated inertia that feels nothing about z: that of a revolute joint that is free to move. The third rows of A and B are zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Freed<S> {
    xx: S,
    xy: S,
    yy: S,
    coupling: [Vec3<S>; 2],
    linear: Sym3<S>,
}

impl<S: Scalar> Freed<S> {
    /// The inertia of what has been turned about z.
    #[inline]
    pub(crate) fn turned(&self, sin: S, cos: S) -> Self {
        let w = sin * (self.xx - self.yy) + cos * (self.xy + self.xy);
        let moved = sin * w;
        let [b0, b1] = self.coupling.map(|row| row.turned(sin, cos));
        Self {
            xx: self.xx - moved,
            xy: cos * w - self.xy,
            yy: self.yy + moved,
            coupling: [b0.scaled(cos) - b1.scaled(sin), b0.scaled(sin) + b1.scaled(cos)],
            linear: self.linear.turned(sin, cos),
        }
    }

    /// The inertia of what has been taken through `x ↦ R x + p`, both constant.
    #[inline]
    pub(crate) fn placed<C: Scalar>(&self, rotation: &Fixed<C>, p: &Vec3<C>) -> ArticulatedInertia<S>
    where
        S: Over<C>,
    {
        let [b0, b1] = self.coupling;
        let (xx, xy, yy, zero) = (self.xx, self.xy, self.yy, S::ZERO);
        let Fixed::AboutX { sin, cos } = *rotation else {
            let angular = Sym3 { xx, xy, xz: zero, yy, yz: zero, zz: zero };
            let all = ArticulatedInertia { angular, coupling: [b0, b1, Vec3::ZERO], linear: self.linear };
            return all.placed(rotation, p);
        };
        let [b0, b1] = [b0, b1].map(|row| rotation.rotate(row));
        let (y, z) = (yy.scale(cos), yy.scale(sin));
        let tilted = ArticulatedInertia {
            angular: Sym3 {
                xx,
                xy: xy.scale(cos),
                xz: xy.scale(sin),
                yy: y.scale(cos),
                yz: z.scale(cos),
                zz: z.scale(sin),
            },
            coupling: [b0, b1.map(|x| x.scale(cos)), b1.map(|x| x.scale(sin))],
            linear: self.linear.tilted(sin, cos),
        };
        tilted.shifted(|v| v.crossed_by_constant(p))
    }
}
