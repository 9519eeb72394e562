//! The mass matrix of a tree, factorised in O(n) by articulated bodies.

use super::Tree;
use super::joint::Pose;
use crate::linalg::Vector;
use crate::model::MassFactor;
use crate::scalar::{Over, Scalar};
use crate::spatial::{ArticulatedInertia, Twist, Wrench};

/// Articulated-body factorisation of M(q): solving costs O(n).
///
/// Featherstone (2008), section 7.3, with the position-dependent half of the algorithm done once.
#[derive(Clone, Copy, Debug)]
pub struct TreeFactor<'a, C, T, const N: usize> {
    tree: &'a Tree<C, N>,
    poses: [Pose<T>; N],
    /// U_i = I_i S_i in child coordinates.
    along: [Wrench<T>; N],
    /// 1 / (S_iᵀ U_i).
    reciprocals: [T; N],
}

impl<C: Scalar, const N: usize> Tree<C, N> {
    #[inline]
    pub(super) fn articulate<T: Over<C>>(&self, q: &Vector<T, N>) -> TreeFactor<'_, C, T, N> {
        let mut articulated: [ArticulatedInertia<T>; N] =
            self.joints.each_ref().map(|joint| ArticulatedInertia::of_body(&joint.inertia));
        let poses = self.poses(q);
        let mut along = [Wrench::ZERO; N];
        let mut reciprocals = [T::ZERO; N];
        for (i, (joint, pose)) in self.chain(&poses).rev() {
            let Some(inertia) = articulated.get(i).copied() else { continue };
            let u = inertia.along_axis(joint.is_prismatic());
            let reciprocal = joint.project(&u).recip();
            if let Some(parent) = articulated.get_mut(joint.parent) {
                let felt = inertia.without_axis(&u, reciprocal);
                *parent = parent.plus(&felt.moved(|v| joint.rotate(pose, v), joint.origin(pose)));
            }
            if let (Some(slot), Some(d)) = (along.get_mut(i), reciprocals.get_mut(i)) {
                (*slot, *d) = (u, reciprocal);
            }
        }
        TreeFactor { tree: self, poses, along, reciprocals }
    }
}

impl<C: Scalar, T: Over<C>, const N: usize> MassFactor<T, N> for TreeFactor<'_, C, T, N> {
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
