//! One joint of a tree and the coordinate changes across it.

use super::JointKind;
use crate::linalg::Matrix;
use crate::scalar::{Over, Scalar};
use crate::spatial::{Carried, RigidInertia, Rotation, Twist, Vec3, Wrench};

/// A joint about or along the z axis of its frame, and the body it carries.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint<C> {
    /// Index of the parent; `usize::MAX`, which is no index, for the base.
    pub parent: usize,
    pub kind: JointKind,
    /// Joint frame at q = 0 in the parent's frame.
    pub rotation: Rotation<C>,
    pub translation: Vec3<C>,
    pub inertia: RigidInertia<C>,
}

impl<C: Scalar> Joint<C> {
    /// What fills a tree up to its capacity: recursions do not visit it.
    pub(super) fn phantom() -> Self {
        let (zero, one) = (C::ZERO, C::ONE);
        Self {
            parent: usize::MAX,
            kind: JointKind::Prismatic,
            rotation: Rotation::from_matrix(&Matrix::identity()),
            translation: Vec3::ZERO,
            inertia: RigidInertia::new(one, [zero; 3], [zero; 6]),
        }
    }

    pub(super) fn map<D: Scalar>(&self, f: impl Fn(C) -> D) -> Joint<D> {
        Joint {
            parent: self.parent,
            kind: self.kind,
            rotation: self.rotation.map(&f),
            translation: self.translation.map(&f),
            inertia: self.inertia.map(&f),
        }
    }

    /// The joint at position `q`.
    #[inline]
    pub(super) fn at<T: Over<C>>(&self, q: T) -> Pose<T> {
        match self.kind {
            JointKind::Revolute => {
                let (sin, cos) = q.sin_cos();
                Pose::Turned { sin, cos }
            }
            JointKind::Prismatic => Pose::Slid(q),
        }
    }

    #[inline]
    pub(super) fn is_prismatic(&self) -> bool {
        self.kind == JointKind::Prismatic
    }

    /// A twist from parent to child coordinates.
    #[inline]
    pub(super) fn twist_to_child<T: Over<C>>(&self, pose: &Pose<T>, m: &Twist<T>) -> Twist<T> {
        let angular = self.unrotate(pose, m.angular);
        let linear = self.unrotate(pose, m.linear + m.angular.cross_constant(&self.translation));
        match *pose {
            Pose::Turned { .. } => Twist { angular, linear },
            // v + ω × e_z q
            Pose::Slid(q) => Twist {
                angular,
                linear: Vec3::new(linear.x + angular.y * q, linear.y - angular.x * q, linear.z),
            },
        }
    }

    /// A wrench from child to parent coordinates.
    #[inline]
    pub(super) fn wrench_to_parent<T: Over<C>>(&self, pose: &Pose<T>, f: &Wrench<T>) -> Wrench<T> {
        let (moment, linear) = match *pose {
            Pose::Turned { sin, cos } => (turn(f.moment, sin, cos), turn(f.linear, sin, cos)),
            // n + e_z q × f
            Pose::Slid(q) => {
                let (n, f) = (f.moment, f.linear);
                (Vec3::new(n.x - q * f.y, n.y + q * f.x, n.z), f)
            }
        };
        let linear = self.rotation.rotate(linear);
        Wrench { moment: self.rotation.rotate(moment) - linear.cross_constant(&self.translation), linear }
    }

    /// A free vector from child to parent axes.
    #[inline]
    pub(super) fn rotate<T: Over<C>>(&self, pose: &Pose<T>, v: Vec3<T>) -> Vec3<T> {
        self.rotation.rotate(match *pose {
            Pose::Turned { sin, cos } => turn(v, sin, cos),
            Pose::Slid(_) => v,
        })
    }

    /// A free vector from parent to child axes.
    #[inline]
    pub(super) fn unrotate<T: Over<C>>(&self, pose: &Pose<T>, v: Vec3<T>) -> Vec3<T> {
        let v = self.rotation.unrotate(v);
        match *pose {
            Pose::Turned { sin, cos } => unturn(v, sin, cos),
            Pose::Slid(_) => v,
        }
    }

    /// Origin of the child frame in the parent frame.
    #[inline]
    pub(super) fn origin<T: Over<C>>(&self, pose: &Pose<T>) -> Vec3<T> {
        let fixed = self.translation.map(T::constant);
        match *pose {
            Pose::Turned { .. } => fixed,
            Pose::Slid(q) => fixed + self.rotation.rotate(Vec3::new(T::ZERO, T::ZERO, q)),
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

    /// The motion of the child in its own axes, from that of the parent and what the joint adds: velocity, velocity of the reference,
    /// acceleration of the reference.
    #[inline]
    pub(super) fn carried<T: Over<C>>(
        &self,
        pose: &Pose<T>,
        parent: &Carried<T>,
        [v, v_r, a_r]: [T; 3],
    ) -> Carried<T> {
        let linear = self.unrotate(pose, parent.at(&self.translation));
        let [spin, spin_r, spin_rate] =
            [parent.spin, parent.spin_r, parent.spin_rate].map(|x| self.unrotate(pose, x));
        match *pose {
            Pose::Turned { .. } => Carried {
                spin: Vec3 { z: spin.z + v, ..spin },
                spin_r: Vec3 { z: spin_r.z + v_r, ..spin_r },
                // + z a_r + ω × z v_r
                spin_rate: Vec3::new(
                    spin_rate.x + spin.y * v_r,
                    spin_rate.y - spin.x * v_r,
                    spin_rate.z + a_r,
                ),
                linear,
            },
            Pose::Slid(q) => {
                // + α × z q + ω_r × (ω × z q) + z a_r + ω × z v_r + ω_r × z v
                let across = spin_r.cross(Vec3::new(spin.y * q, -(spin.x * q), T::ZERO));
                let linear = Vec3::new(
                    linear.x + spin_rate.y * q + across.x + spin.y * v_r + spin_r.y * v,
                    linear.y - spin_rate.x * q + across.y - spin.x * v_r - spin_r.x * v,
                    linear.z + across.z + a_r,
                );
                Carried { spin, spin_r, spin_rate, linear }
            }
        }
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

/// A joint's displacement, with what a rotation needs computed once.
#[derive(Clone, Copy, Debug)]
pub(super) enum Pose<T> {
    Turned { sin: T, cos: T },
    Slid(T),
}

/// Rotation about z.
#[inline]
fn turn<T: Scalar>(v: Vec3<T>, sin: T, cos: T) -> Vec3<T> {
    Vec3 { x: cos * v.x - sin * v.y, y: sin * v.x + cos * v.y, z: v.z }
}

/// Rotation about z, backwards.
#[inline]
fn unturn<T: Scalar>(v: Vec3<T>, sin: T, cos: T) -> Vec3<T> {
    Vec3 { x: cos * v.x + sin * v.y, y: cos * v.y - sin * v.x, z: v.z }
}
