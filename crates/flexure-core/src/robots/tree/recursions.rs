//! Mass matrix, inverse dynamics and potential energy of a tree.

use super::joint::Pose;
use super::{Tree, TreeFactor};
use crate::linalg::{Matrix, Vector};
use crate::model::Links;
use crate::scalar::{Over, Scalar};
use crate::spatial::{Carried, Vec3, Wrench};

impl<C: Scalar, const N: usize> Tree<C, N> {
    /// Where the joints are; phantoms slide, which takes no sines.
    #[inline]
    pub(super) fn poses<T: Over<C>>(&self, q: &Vector<T, N>) -> [Pose<T>; N] {
        let mut positions = q.iter();
        self.joints.each_ref().map(|joint| joint.at(positions.next().unwrap_or(T::ZERO)))
    }

    /// The modified Newton–Euler pass: M(q) a_r + C(q, v) v_r plus the torque that holds the tree against a base
    /// accelerating with `base` [m/s²].
    ///
    /// C is the Christoffel matrix. It is that of point masses, Jᵀ m J̇ with the derivative J̇ along v (Γ_kij = Σ m ∂_k x · ∂_ij x), so
    /// nothing has to be made symmetric: a body carries two angular velocities, ω of v and ω_r of v_r, the rate α of ω_r, and the acceleration a of
    /// its origin. A point x of it has the acceleration a + α × x + ω_r × (ω × x), and with the mass m, the first moment h, the
    /// rotational inertia I and the second moment Σ = ½ tr(I) 1 − I of the body that sums up to
    ///
    /// f = m a + α × h + ω_r × (ω × h),  n = I α + (Σ ω_r) × ω + h × a.
    #[inline]
    fn newton_euler<T: Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
        base: Vec3<T>,
    ) -> Vector<T, N> {
        let poses = self.poses(q);
        let ground = Carried { spin: Vec3::ZERO, spin_r: Vec3::ZERO, spin_rate: Vec3::ZERO, linear: base };
        let mut bodies = Vector([ground; N]);
        let mut force = Vector([Wrench::ZERO; N]);
        for (i, (joint, pose)) in self.chain(&poses) {
            let carrier = bodies.0.get(joint.parent).unwrap_or(&ground);
            let body = joint.carried(pose, carrier, [v[i], v_r[i], a_r[i]]);
            force[i] = joint.inertia.wrench(&body);
            bodies[i] = body;
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

    #[inline]
    fn joints(&self) -> usize {
        self.count
    }

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
        self.factorised(q)
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
