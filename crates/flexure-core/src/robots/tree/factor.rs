//! The mass matrix of a tree, factorised: as a matrix where joints are few, in O(n) by articulated bodies where they are many.

use super::Tree;
use super::joint::Pose;
use crate::linalg::{Ldl, Vector};
use crate::model::MassFactor;
use crate::scalar::{Over, Scalar};
use crate::spatial::{ArticulatedInertia, Twist, Wrench};

/// Most joints whose mass matrix is factorised as a matrix: n³/6 products are fewer than n steps of 6 × 6 inertias up to here,
/// and wait less for each other (0.6 of the time for seven joints).
const DENSE: usize = 8;

/// The mass matrix of a tree, factorised by what is quicker for its number of joints.
#[derive(Clone, Copy, Debug)]
pub enum TreeFactor<'a, C, T, const N: usize> {
    /// Up to eight joints: composite rigid bodies, then L D Lᵀ.
    Dense(Dense<T, N>),
    /// Beyond: O(n).
    Articulated(Articulated<'a, C, T, N>),
}

/// The mass matrix as L D Lᵀ, and the position it was computed at.
#[derive(Clone, Copy, Debug)]
pub struct Dense<T, const N: usize> {
    poses: [Pose<T>; N],
    matrix: Ldl<T, N>,
}

/// Articulated-body factorisation of M(q): solving costs O(n).
///
/// Featherstone (2008), section 7.3, with the position-dependent half of the algorithm done once.
#[derive(Clone, Copy, Debug)]
pub struct Articulated<'a, C, T, const N: usize> {
    tree: &'a Tree<C, N>,
    poses: [Pose<T>; N],
    /// U_i = I_i S_i in child coordinates.
    along: [Wrench<T>; N],
    /// 1 / (S_iᵀ U_i).
    reciprocals: [T; N],
}

impl<C: Scalar, const N: usize> Tree<C, N> {
    #[inline]
    pub(super) fn factorised<T: Over<C>>(&self, q: &Vector<T, N>) -> TreeFactor<'_, C, T, N> {
        let poses = self.poses(q);
        if self.count <= DENSE {
            TreeFactor::Dense(Dense { matrix: self.composite(&poses).ldl(), poses })
        } else {
            TreeFactor::Articulated(self.articulated_bodies(poses))
        }
    }

    /// The mass matrix at q in articulated bodies, whatever the number of joints.
    #[inline]
    pub fn articulated<T: Over<C>>(&self, q: &Vector<T, N>) -> Articulated<'_, C, T, N> {
        self.articulated_bodies(self.poses(q))
    }

    #[inline]
    fn articulated_bodies<T: Over<C>>(&self, poses: [Pose<T>; N]) -> Articulated<'_, C, T, N> {
        // What each body feels of those that it carries.
        let mut felt = [ArticulatedInertia::<T>::ZERO; N];
        let mut along = [Wrench::ZERO; N];
        let mut reciprocals = [T::ZERO; N];
        for (i, (joint, pose)) in self.chain(&poses).rev() {
            let Some(carried) = felt.get(i) else { continue };
            let inertia = carried.plus(&ArticulatedInertia::of_body(&joint.inertia));
            let u = inertia.along_axis(joint.is_prismatic());
            let reciprocal = joint.project(&u).recip();
            if let Some(parent) = felt.get_mut(joint.parent) {
                *parent = parent.plus(&joint.felt(pose, &inertia, &u, reciprocal));
            }
            if let (Some(slot), Some(d)) = (along.get_mut(i), reciprocals.get_mut(i)) {
                (*slot, *d) = (u, reciprocal);
            }
        }
        Articulated { tree: self, poses, along, reciprocals }
    }
}

impl<C, T, const N: usize> TreeFactor<'_, C, T, N> {
    /// Where the joints are.
    #[inline]
    pub(super) fn poses(&self) -> &[Pose<T>; N] {
        match self {
            Self::Dense(factor) => &factor.poses,
            Self::Articulated(factor) => &factor.poses,
        }
    }
}

impl<C: Scalar, T: Over<C>, const N: usize> MassFactor<T, N> for TreeFactor<'_, C, T, N> {
    #[inline]
    fn solve(&self, b: &Vector<T, N>) -> Vector<T, N> {
        match self {
            Self::Dense(factor) => factor.matrix.solve(b),
            Self::Articulated(factor) => factor.solve(b),
        }
    }
}

impl<C: Scalar, T: Over<C>, const N: usize> MassFactor<T, N> for Articulated<'_, C, T, N> {
    #[inline]
    fn solve(&self, b: &Vector<T, N>) -> Vector<T, N> {
        // Backward: force that the joints further out pass on, and what is left for each joint.
        let mut passed = Vector([Wrench::ZERO; N]);
        let mut rest = *b;
        for (i, (joint, pose)) in self.tree.chain(&self.poses).rev() {
            let (Some(u), Some(&d)) = (self.along.get(i), self.reciprocals.get(i)) else { continue };
            let force: Wrench<T> = passed[i];
            rest[i] -= joint.project(&force);
            if let Some(parent) = passed.0.get_mut(joint.parent) {
                *parent += joint.wrench_to_parent(pose, &(force + u.scaled(rest[i] * d)));
            }
        }
        // Forward: accelerations.
        let mut acceleration = Vector([Twist::ZERO; N]);
        // Phantoms: unit inertia.
        let mut solution = *b;
        for (i, (joint, pose)) in self.tree.chain(&self.poses) {
            let (Some(u), Some(&d)) = (self.along.get(i), self.reciprocals.get(i)) else { continue };
            let carried = match acceleration.0.get(joint.parent) {
                Some(parent) => joint.twist_to_child(pose, parent),
                None => Twist::ZERO,
            };
            let inner = u.moment.dot(carried.angular) + u.linear.dot(carried.linear);
            solution[i] = (rest[i] - inner) * d;
            acceleration[i] = carried + joint.along_axis(solution[i]);
        }
        solution
    }
}
