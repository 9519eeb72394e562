//! One joint of a tree and the coordinate changes across it.
#![expect(
    clippy::inline_always,
    reason = "measured: inverse dynamics and articulated bodies take 0.9 of the time"
)]

use super::JointKind;
use crate::linalg::Matrix;
use crate::scalar::{Jet, Over, Scalar};
use crate::spatial::{ArticulatedInertia, Carried, Fixed, RigidInertia, Rotation, Twist, Vec3, Wrench};

/// A joint about or along the z axis of its frame, and the body it carries.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint<C> {
    /// Index of the parent; `usize::MAX`, which is no index, for the base.
    pub parent: usize,
    pub kind: JointKind,
    /// Joint frame at q = 0 in the parent's frame: turned by `rotation` after a turn about z with the sine and cosine `phase`.
    pub rotation: Fixed<C>,
    pub phase: [C; 2],
    pub translation: Vec3<C>,
    /// Of the body of a revolute joint: less the mass on the axis, which the parent has.
    pub inertia: RigidInertia<C>,
}

impl<C: Scalar> Joint<C> {
    /// What fills a tree up to its capacity: recursions do not visit it.
    pub(super) fn phantom() -> Self {
        let (zero, one) = (C::ZERO, C::ONE);
        Self {
            parent: usize::MAX,
            kind: JointKind::Prismatic,
            rotation: Fixed::General(Rotation::from_matrix(&Matrix::identity())),
            phase: [zero, one],
            translation: Vec3::ZERO,
            inertia: RigidInertia::new(one, [zero; 3], [zero; 6]),
        }
    }

    pub(super) fn map<D: Scalar>(&self, f: impl Fn(C) -> D) -> Joint<D> {
        Joint {
            parent: self.parent,
            kind: self.kind,
            rotation: self.rotation.map(&f),
            phase: self.phase.map(&f),
            translation: self.translation.map(&f),
            inertia: self.inertia.map(&f),
        }
    }

    /// The joint at position `q`.
    #[inline]
    pub(super) fn at<T: Over<C>>(&self, q: T) -> Pose<T> {
        let [sin_0, cos_0] = self.phase;
        match self.kind {
            JointKind::Revolute => {
                let (sin, cos) = q.sin_cos();
                Pose {
                    sin: sin.scale(cos_0) + cos.scale(sin_0),
                    cos: cos.scale(cos_0) - sin.scale(sin_0),
                    slide: T::ZERO,
                }
            }
            JointKind::Prismatic => Pose { sin: T::constant(sin_0), cos: T::constant(cos_0), slide: q },
        }
    }

    /// The joint along the series `q`, which starts where `pose` is: no sine is taken.
    #[inline]
    pub(super) fn along<T: Over<C>, const K: usize>(&self, pose: &Pose<T>, q: Jet<T, K>) -> Pose<Jet<T, K>> {
        match self.kind {
            JointKind::Revolute => {
                let (sin, cos) = q.sin_cos_from(pose.sin, pose.cos);
                Pose { sin, cos, slide: Jet::ZERO }
            }
            JointKind::Prismatic => Pose { sin: Jet::value(pose.sin), cos: Jet::value(pose.cos), slide: q },
        }
    }

    #[inline]
    pub(super) fn is_prismatic(&self) -> bool {
        self.kind == JointKind::Prismatic
    }

    /// A twist from parent to child coordinates.
    #[inline(always)]
    pub(super) fn twist_to_child<T: Over<C>>(&self, pose: &Pose<T>, m: &Twist<T>) -> Twist<T> {
        let angular = self.unrotate(pose, m.angular);
        let linear = self.unrotate(pose, m.linear + m.angular.cross_constant(&self.translation));
        match self.kind {
            JointKind::Revolute => Twist { angular, linear },
            // v + ω × e_z q
            JointKind::Prismatic => {
                let q = pose.slide;
                let linear = Vec3::new(linear.x + angular.y * q, linear.y - angular.x * q, linear.z);
                Twist { angular, linear }
            }
        }
    }

    /// A wrench from child to parent coordinates.
    #[inline(always)]
    pub(super) fn wrench_to_parent<T: Over<C>>(&self, pose: &Pose<T>, f: &Wrench<T>) -> Wrench<T> {
        let (n, f) = (f.moment, f.linear);
        let n = match self.kind {
            JointKind::Revolute => n,
            // n + e_z q × f
            JointKind::Prismatic => Vec3::new(n.x - pose.slide * f.y, n.y + pose.slide * f.x, n.z),
        };
        let linear = self.rotate(pose, f);
        Wrench { moment: self.rotate(pose, n) + linear.crossed_by_constant(&self.translation), linear }
    }

    /// A free vector from child to parent axes.
    #[inline(always)]
    pub(super) fn rotate<T: Over<C>>(&self, pose: &Pose<T>, v: Vec3<T>) -> Vec3<T> {
        self.rotation.rotate(v.turned(pose.sin, pose.cos))
    }

    /// A free vector from parent to child axes.
    #[inline(always)]
    pub(super) fn unrotate<T: Over<C>>(&self, pose: &Pose<T>, v: Vec3<T>) -> Vec3<T> {
        self.rotation.unrotate(v).unturned(pose.sin, pose.cos)
    }

    /// Origin of the child frame in the parent frame.
    #[inline]
    pub(super) fn origin<T: Over<C>>(&self, pose: &Pose<T>) -> Vec3<T> {
        let fixed = self.translation.map(T::constant);
        match self.kind {
            JointKind::Revolute => fixed,
            JointKind::Prismatic => fixed + self.rotation.rotate(Vec3::new(T::ZERO, T::ZERO, pose.slide)),
        }
    }

    /// A body of child coordinates in parent coordinates.
    #[inline]
    pub(super) fn body_to_parent<T: Over<C>>(
        &self,
        pose: &Pose<T>,
        body: &RigidInertia<C, T>,
    ) -> RigidInertia<C, T> {
        let body = match self.kind {
            JointKind::Revolute => *body,
            JointKind::Prismatic => body.slid(pose.slide),
        };
        body.turned(pose.sin, pose.cos).placed(&self.rotation, &self.translation)
    }

    /// What the parent feels of an articulated body, in its coordinates, if the joint is free to move; `u` is I S, `reciprocal` 1 / (Sᵀ I S).
    #[inline]
    pub(super) fn felt<T: Over<C>>(
        &self,
        pose: &Pose<T>,
        body: &ArticulatedInertia<T>,
        u: &Wrench<T>,
        reciprocal: T,
    ) -> ArticulatedInertia<T> {
        let (sin, cos) = (pose.sin, pose.cos);
        match self.kind {
            JointKind::Revolute => {
                body.freed(u, reciprocal).turned(sin, cos).placed(&self.rotation, &self.translation)
            }
            JointKind::Prismatic => {
                let slid = body.without_axis(u, reciprocal).slid(pose.slide);
                slid.turned(sin, cos).placed(&self.rotation, &self.translation)
            }
        }
    }

    /// `S q̇`: the joint's own twist in child coordinates.
    #[inline]
    pub(super) fn along_axis<T: Scalar>(&self, rate: T) -> Twist<T> {
        let axis = Vec3::new(T::ZERO, T::ZERO, rate);
        match self.kind {
            JointKind::Revolute => Twist { angular: axis, linear: Vec3::ZERO },
            JointKind::Prismatic => Twist { angular: Vec3::ZERO, linear: axis },
        }
    }

    /// Writes to `child` its motion in its own axes, from that of the parent and what the joint adds: velocity, velocity of the reference,
    /// acceleration of the reference. `OWN`: the reference is the motion itself.
    #[inline]
    pub(super) fn carry<T: Over<C>, const OWN: bool>(
        &self,
        pose: &Pose<T>,
        parent: &Carried<T>,
        [v, v_r, a_r]: [T; 3],
        child: &mut Carried<T>,
    ) {
        let Carried { spin, spin_r, spin_rate, spread, linear } = child;
        *linear = self.unrotate(pose, parent.at(&self.translation));
        *spin = self.unrotate(pose, parent.spin);
        *spin_r = if OWN { *spin } else { self.unrotate(pose, parent.spin_r) };
        *spin_rate = self.unrotate(pose, parent.spin_rate);
        if self.kind == JointKind::Revolute {
            // + z a_r + ω × z v_r
            *spin_rate = Vec3::new(spin_rate.x + spin.y * v_r, spin_rate.y - spin.x * v_r, spin_rate.z + a_r);
            spin.z += v;
            spin_r.z += v_r;
        }
        *spread = if OWN {
            Carried::own_spread(*spin, *spin_rate)
        } else {
            Carried::spread(*spin, *spin_r, *spin_rate)
        };
        if self.kind == JointKind::Prismatic {
            // + A z q + z a_r + ω × z v_r + ω_r × z v
            let (q, [x, y, z]) = (pose.slide, &*spread);
            linear.x = linear.x + x.z * q + spin.y * v_r + spin_r.y * v;
            linear.y = linear.y + y.z * q - spin.x * v_r - spin_r.x * v;
            linear.z = linear.z + z.z * q + a_r;
        }
    }

    /// What moves the body like this.
    #[inline]
    pub(super) fn wrench<T: Over<C>>(&self, body: &Carried<T>) -> Wrench<T> {
        self.wrench_on(&self.inertia, body, T::scale)
    }

    /// What moves a `load` in place of the body; `times` multiplies by a number of it.
    #[inline(always)]
    pub(super) fn wrench_on<T: Scalar, P: Scalar>(
        &self,
        load: &RigidInertia<P>,
        body: &Carried<T>,
        times: impl Fn(T, P) -> T + Copy,
    ) -> Wrench<T> {
        match self.kind {
            JointKind::Revolute => load.about_axis(body, times),
            JointKind::Prismatic => load.wrench(body, times),
        }
    }

    /// How the power of what moves the body grows with each number of it, if it gives way with the twist `s`: 0 for what the parent has.
    #[inline]
    pub(super) fn power<T: Scalar>(&self, body: &Carried<T>, s: &Twist<T>) -> RigidInertia<T> {
        let mut power = body.power(s);
        if !self.is_prismatic() {
            power.split_axis();
        }
        power
    }

    /// `Sᵀ f`: the torque [N m] or force in N at the joint.
    #[inline]
    pub(super) fn project<T: Scalar>(&self, f: &Wrench<T>) -> T {
        match self.kind {
            JointKind::Revolute => f.moment.z,
            JointKind::Prismatic => f.linear.z,
        }
    }
}

/// A joint's displacement: the turn about z, constant if it slides, and how far it slides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose<T> {
    sin: T,
    cos: T,
    slide: T,
}

impl<T: Scalar> Pose<T> {
    /// The pose as a series that stands still.
    #[inline]
    pub(super) fn still<const K: usize>(&self) -> Pose<Jet<T, K>> {
        Pose { sin: Jet::value(self.sin), cos: Jet::value(self.cos), slide: Jet::value(self.slide) }
    }
}
