//! Mass matrix, inverse dynamics and potential energy of a tree.

use super::joint::Pose;
use super::{Tree, TreeFactor};
use crate::linalg::{Matrix, Vector};
use crate::model::Links;
use crate::scalar::{Over, Scalar};
use crate::spatial::{Twist, Vec3, Wrench};

impl<C: Scalar, const N: usize> Tree<C, N> {
    /// Where the real joints are.
    #[inline]
    pub(super) fn poses<T: Over<C>>(&self, q: &Vector<T, N>) -> [Pose<T>; N] {
        let mut poses = [Pose::Slid(T::ZERO); N];
        for ((pose, joint), q) in poses.iter_mut().zip(&self.joints).zip(q.iter()).take(self.count) {
            *pose = joint.at(q);
        }
        poses
    }

    /// The modified Newton–Euler pass: M(q) a_r + C(q, v) v_r plus the torque that holds the tree against a base
    /// accelerating with `base` [m/s²].
    ///
    /// The body force I a_r + ½ (v ×* I v_r − I (v × v_r) + v_r ×* I v) splits the velocity products so that the
    /// Coriolis matrix is the Christoffel one.
    #[inline]
    fn newton_euler<T: Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
        base: Vec3<T>,
    ) -> Vector<T, N> {
        let base = Twist { angular: Vec3::ZERO, linear: base };
        let poses = self.poses(q);
        let half = T::from_f64(0.5);
        let mut velocity = Vector([Twist::ZERO; N]);
        let mut reference = Vector([Twist::ZERO; N]);
        let mut acceleration = Vector([Twist::ZERO; N]);
        let mut force = Vector([Wrench::ZERO; N]);
        for (i, (joint, pose)) in self.chain(&poses) {
            let carried = |bodies: &Vector<Twist<T>, N>, base: &Twist<T>| {
                joint.twist_to_child(pose, bodies.0.get(joint.parent).unwrap_or(base))
            };
            let v_i = match velocity.0.get(joint.parent) {
                Some(parent) => joint.twist_to_child(pose, parent) + joint.along_axis(v[i]),
                None => joint.along_axis(v[i]),
            };
            let v_ri = match reference.0.get(joint.parent) {
                Some(parent) => joint.twist_to_child(pose, parent) + joint.along_axis(v_r[i]),
                None => joint.along_axis(v_r[i]),
            };
            let a_ri =
                carried(&acceleration, &base) + joint.along_axis(a_r[i]) + joint.cross_axis(&v_i, v_r[i]);
            let inertia = &joint.inertia;
            let split = a_ri - v_i.cross(&v_ri).scaled(half);
            let products =
                v_i.cross_wrench(&inertia.momentum(&v_ri)) + v_ri.cross_wrench(&inertia.momentum(&v_i));
            force[i] = inertia.momentum(&split) + products.scaled(half);
            (velocity[i], reference[i], acceleration[i]) = (v_i, v_ri, a_ri);
        }
        // Phantoms: unit inertia.
        let mut torque = *a_r;
        for (i, (joint, pose)) in self.chain(&poses).rev() {
            torque[i] = joint.project(&force[i]);
            let passed = force[i];
            if let Some(parent) = force.0.get_mut(joint.parent) {
                *parent += joint.wrench_to_parent(pose, &passed);
            }
        }
        torque
    }
}

impl<C: Scalar, const N: usize> Links<C, N> for Tree<C, N> {
    type Factor<'a, T: Over<C>>
        = TreeFactor<'a, C, T, N>
    where
        C: 'a;

    /// Composite rigid bodies.
    #[inline]
    fn mass_matrix<T: Over<C>>(&self, q: &Vector<T, N>) -> Matrix<T, N, N> {
        let poses = self.poses(q);
        let mut composite = Vector(self.joints.each_ref().map(|joint| joint.inertia.map(T::constant)));
        let mut mass = Matrix::identity();
        for (i, (joint, pose)) in self.chain(&poses).rev() {
            let body = composite[i];
            if let Some(parent) = composite.0.get_mut(joint.parent) {
                *parent = parent.plus(&body.moved(|v| joint.rotate(pose, v), joint.origin(pose)));
            }
            // Force that moves the composite body along its joint, felt at every joint towards the base.
            let mut force = body.axis_momentum(joint.is_prismatic());
            mass[(i, i)] = joint.project(&force);
            let mut carrier = (joint, pose);
            let mut next = carrier.0.parent;
            while let (Some(parent), Some(parent_pose)) = (self.joints.get(next), poses.get(next)) {
                force = carrier.0.wrench_to_parent(carrier.1, &force);
                mass[(i, next)] = parent.project(&force);
                mass[(next, i)] = mass[(i, next)];
                carrier = (parent, parent_pose);
                next = parent.parent;
            }
        }
        mass
    }

    /// Minus weight times height, from composite first moments of mass.
    #[inline]
    fn potential_energy<T: Over<C>>(&self, q: &Vector<T, N>) -> T {
        let poses = self.poses(q);
        let mut mass = Vector(self.joints.each_ref().map(|joint| joint.inertia.mass));
        let mut moment =
            Vector(self.joints.each_ref().map(|joint| joint.inertia.first_moment.map(T::constant)));
        let mut total = Vec3::ZERO;
        for (i, (joint, pose)) in self.chain(&poses).rev() {
            let h = joint.rotate(pose, moment[i]) + joint.origin(pose).map(|x| x.scale(mass[i]));
            let m = mass[i];
            match (moment.0.get_mut(joint.parent), mass.0.get_mut(joint.parent)) {
                (Some(parent_moment), Some(parent_mass)) => {
                    *parent_moment += h;
                    *parent_mass += m;
                }
                _ => total += h,
            }
        }
        -total.dot_constant(&self.gravity)
    }

    /// Angular velocities from the base outwards.
    #[inline]
    fn carrier_rates<T: Over<C>>(&self, q: &Vector<T, N>, v: &Vector<T, N>) -> Vector<T, N> {
        let poses = self.poses(q);
        let mut angular = Vector([Vec3::ZERO; N]);
        let mut rates = Vector::ZERO;
        for (i, (joint, pose)) in self.chain(&poses) {
            let carrier = angular.0.get(joint.parent).map_or(Vec3::ZERO, |&w| joint.unrotate(pose, w));
            rates[i] = carrier.z;
            angular[i] = carrier + joint.along_axis(v[i]).angular;
        }
        rates
    }

    #[inline]
    fn factor<T: Over<C>>(&self, q: &Vector<T, N>) -> TreeFactor<'_, C, T, N> {
        self.articulate(q)
    }

    #[inline]
    fn gravity_torque<T: Over<C>>(&self, q: &Vector<T, N>) -> Vector<T, N> {
        let rest = Vector::ZERO;
        self.inverse_dynamics(q, &rest, &rest, &rest)
    }

    #[inline]
    fn inertial_torque<T: Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
    ) -> Vector<T, N> {
        self.newton_euler(q, v, v_r, a_r, Vec3::ZERO)
    }

    #[inline]
    fn inverse_dynamics<T: Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
    ) -> Vector<T, N> {
        self.newton_euler(q, v, v_r, a_r, -self.gravity.map(T::constant))
    }

    #[inline]
    fn mass_mul<T: Over<C>>(&self, q: &Vector<T, N>, a: &Vector<T, N>) -> Vector<T, N> {
        let rest = Vector::ZERO;
        self.inertial_torque(q, &rest, &rest, a)
    }
}
