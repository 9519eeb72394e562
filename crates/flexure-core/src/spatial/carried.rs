//! What a body carries along the Newton–Euler recursion.

use super::{RigidInertia, Sym3, Twist, Vec3};
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
    /// Rows of A, by which the acceleration of a point x differs from that of the origin [1/s²]: A x = α × x + ω_r × (ω × x), so that
    /// A = [α]× + ω ω_rᵀ − (ω·ω_r) 1.
    pub spread: [Vec3<S>; 3],
    /// a: acceleration of the frame's origin [m/s²].
    pub linear: Vec3<S>,
}

impl<S: Scalar> Carried<S> {
    /// What does not turn, with the acceleration `linear` [m/s²].
    #[inline]
    pub fn straight(linear: Vec3<S>) -> Self {
        let zero = Vec3::ZERO;
        Self { spin: zero, spin_r: zero, spin_rate: zero, spread: [zero; 3], linear }
    }

    /// A of a body and a reference that turn like this.
    #[inline]
    pub fn spread(spin: Vec3<S>, spin_r: Vec3<S>, spin_rate: Vec3<S>) -> [Vec3<S>; 3] {
        let (w, r, rate) = (spin, spin_r, spin_rate);
        let (xx, yy, zz) = (w.x * r.x, w.y * r.y, w.z * r.z);
        [
            Vec3::new(-yy - zz, w.x * r.y - rate.z, w.x * r.z + rate.y),
            Vec3::new(w.y * r.x + rate.z, -xx - zz, w.y * r.z - rate.x),
            Vec3::new(w.z * r.x - rate.y, w.z * r.y + rate.x, -xx - yy),
        ]
    }

    /// A of a body that turns like this: fewer products where the reference is the motion itself.
    #[inline]
    pub fn own_spread(spin: Vec3<S>, spin_rate: Vec3<S>) -> [Vec3<S>; 3] {
        let (w, rate) = (spin, spin_rate);
        let (xx, yy, zz) = (w.x.square(), w.y.square(), w.z.square());
        let (xy, xz, yz) = (w.x * w.y, w.x * w.z, w.y * w.z);
        [
            Vec3::new(-yy - zz, xy - rate.z, xz + rate.y),
            Vec3::new(xy + rate.z, -xx - zz, yz - rate.x),
            Vec3::new(xz - rate.y, yz + rate.x, -xx - yy),
        ]
    }

    /// How the power of what moves a body like this grows with each number of the body, if it gives way with the twist `s`: points have the
    /// velocity v + Ω x, Ω = [ω]×, so that P = ∫ (a + A x)·(v + Ω x) dm = m a·v + h·(Aᵀ v + a × ω) + Σ : Aᵀ Ω.
    #[inline]
    pub fn power(&self, s: &Twist<S>) -> RigidInertia<S> {
        let (a, w, v) = (self.linear, s.angular, s.linear);
        let [x, y, z] = self.spread;
        // Columns of Aᵀ Ω = Σ_rows A_k Ω_kᵀ, with the rows (0, −ω_z, ω_y), (ω_z, 0, −ω_x), (−ω_y, ω_x, 0) of Ω.
        let first = y.scaled(w.z) - z.scaled(w.y);
        let second = z.scaled(w.x) - x.scaled(w.z);
        let third = x.scaled(w.y) - y.scaled(w.x);
        RigidInertia {
            mass: a.dot(v),
            first_moment: x.scaled(v.x) + y.scaled(v.y) + z.scaled(v.z) + a.cross(w),
            second_moment: Sym3 {
                xx: first.x,
                xy: first.y + second.x,
                xz: first.z + third.x,
                yy: second.y,
                yz: second.z + third.y,
                zz: third.z,
            },
        }
    }

    /// Acceleration of the point of the body at `x` [m/s²]: a + A x.
    #[inline]
    pub fn at<C: Copy>(&self, x: &Vec3<C>) -> Vec3<S>
    where
        S: Over<C>,
    {
        let [rx, ry, rz] = self.spread;
        self.linear + Vec3 { x: rx.dot_constant(x), y: ry.dot_constant(x), z: rz.dot_constant(x) }
    }
}
