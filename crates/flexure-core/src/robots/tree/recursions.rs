//! Mass matrix, inverse dynamics and potential energy of a tree.

use super::joint::{Joint, Pose};
use super::{Tree, TreeFactor};
use crate::linalg::{Matrix, Vector};
use crate::model::{Links, Parameters};
use crate::scalar::{Jet, Over, Scalar};
use crate::spatial::{Carried, RigidInertia, Twist, Vec3, Wrench};

impl<C: Scalar, const N: usize> Tree<C, N> {
    /// Where the joints are; phantoms slide, which takes no sines.
    #[inline]
    pub(super) fn poses<T: Over<C>>(&self, q: &Vector<T, N>) -> [Pose<T>; N] {
        let mut positions = q.iter();
        self.joints.each_ref().map(|joint| joint.at(positions.next().unwrap_or(T::ZERO)))
    }

    /// Where the joints are along a motion that starts at `poses`.
    #[inline]
    fn poses_along<T: Over<C>, const K: usize>(
        &self,
        poses: &[Pose<T>; N],
        q: &Vector<Jet<T, K>, N>,
    ) -> [Pose<Jet<T, K>>; N] {
        let mut along = poses.each_ref().map(Pose::still);
        for (i, (joint, pose)) in self.chain(poses) {
            if let Some(slot) = along.get_mut(i) {
                *slot = joint.along(pose, q[i]);
            }
        }
        along
    }

    /// The modified Newton–Euler pass: M(q) a_r + C(q, v) v_r plus the torque that holds the tree against a base
    /// accelerating with `base` [m/s²]. `OWN`: v_r is v, the ordinary pass, with fewer products.
    ///
    /// C is the Christoffel matrix. It is that of point masses, Jᵀ m J̇ with the derivative J̇ along v (Γ_kij = Σ m ∂_k x · ∂_ij x), so
    /// nothing has to be made symmetric: a body carries two angular velocities, ω of v and ω_r of v_r, the rate α of ω_r, and the acceleration a of
    /// its origin. A point x of it has the acceleration a + A x, A = [α]× + ω ω_rᵀ − (ω·ω_r) 1, and with the mass m and the first and second
    /// moments h = ∫ x dm and Σ = ∫ x xᵀ dm of the body that sums up to
    ///
    /// f = m a + A h,  n = h × a + ∫ x × A x dm, where the integral is twice the axial vector of A Σ.
    #[inline]
    fn newton_euler<T: Over<C>, const OWN: bool>(
        &self,
        poses: &[Pose<T>; N],
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
        base: Vec3<T>,
    ) -> Vector<T, N> {
        self.newton_euler_of::<T, OWN>(poses, [v, v_r, a_r], base, |_, joint, body| joint.wrench(body))
    }

    /// Visits the bodies from the base outwards with how they move.
    #[inline]
    fn carried<T: Over<C>, const OWN: bool>(
        &self,
        poses: &[Pose<T>; N],
        [v, v_r, a_r]: [&Vector<T, N>; 3],
        base: Vec3<T>,
        mut visit: impl FnMut(usize, &Joint<C>, &Carried<T>),
    ) {
        let ground = Carried::straight(base);
        let mut bodies = Vector([ground; N]);
        for (i, (joint, pose)) in self.chain(poses) {
            // Written where it stays: series in lanes are kilobytes.
            let (carriers, rest) = bodies.0.split_at_mut(i);
            let Some(body) = rest.first_mut() else { break };
            let carrier = carriers.get(joint.parent).unwrap_or(&ground);
            joint.carry::<T, OWN>(pose, carrier, [v[i], v_r[i], a_r[i]], body);
            visit(i, joint, body);
        }
    }

    /// [`newton_euler`](Self::newton_euler) with the force that `wrench` says for a body that moves.
    #[inline]
    fn newton_euler_of<T: Over<C>, const OWN: bool>(
        &self,
        poses: &[Pose<T>; N],
        [v, v_r, a_r]: [&Vector<T, N>; 3],
        base: Vec3<T>,
        wrench: impl Fn(usize, &Joint<C>, &Carried<T>) -> Wrench<T>,
    ) -> Vector<T, N> {
        let mut force = Vector([Wrench::ZERO; N]);
        self.carried::<T, OWN>(poses, [v, v_r, a_r], base, |i, joint, body| {
            force[i] = wrench(i, joint, body);
        });
        // Phantoms: unit inertia.
        let mut torque = *a_r;
        for (i, (joint, pose)) in self.chain(poses).rev() {
            let (carriers, rest) = force.0.split_at_mut(i);
            let Some(passed) = rest.first() else { break };
            torque[i] = joint.project(passed);
            if let Some(parent) = carriers.get_mut(joint.parent) {
                *parent += joint.wrench_to_parent(pose, passed);
            }
        }
        torque
    }

    /// The acceleration of the base that stands for gravity [m/s²].
    #[inline]
    fn upwards<T: Over<C>>(&self) -> Vec3<T> {
        -self.gravity.map(T::constant)
    }

    /// The mass matrix, by composite rigid bodies.
    #[inline]
    pub(super) fn composite<T: Over<C>>(&self, poses: &[Pose<T>; N]) -> Matrix<T, N, N> {
        let mut composite = Vector(self.joints.each_ref().map(|joint| joint.inertia.lift::<T>()));
        let mut mass = Matrix::identity();
        for (i, (joint, pose)) in self.chain(poses).rev() {
            let body = composite[i];
            if let Some(parent) = composite.0.get_mut(joint.parent) {
                *parent = parent.plus(&joint.body_to_parent(pose, &body));
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

    #[inline]
    fn mass_matrix<T: Over<C>>(&self, q: &Vector<T, N>) -> Matrix<T, N, N> {
        self.composite(&self.poses(q))
    }

    /// Minus weight times height, from composite first moments of mass.
    #[inline]
    fn potential_energy<T: Over<C>>(&self, q: &Vector<T, N>) -> T {
        let poses = self.poses(q);
        let mut mass = Vector(self.joints.each_ref().map(|joint| joint.inertia.mass));
        let mut moment =
            Vector(self.joints.each_ref().map(|joint| joint.inertia.first_moment.map(T::constant)));
        let mut total = self.grounded.map(T::constant);
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
        self.newton_euler::<T, true>(&self.poses(q), &rest, &rest, &rest, self.upwards())
    }

    #[inline]
    fn inertial_torque<T: Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
    ) -> Vector<T, N> {
        self.newton_euler::<T, false>(&self.poses(q), v, v_r, a_r, Vec3::ZERO)
    }

    #[inline]
    fn inverse_dynamics<T: Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
    ) -> Vector<T, N> {
        self.newton_euler::<T, false>(&self.poses(q), v, v_r, a_r, self.upwards())
    }

    #[inline]
    fn mass_mul<T: Over<C>>(&self, q: &Vector<T, N>, a: &Vector<T, N>) -> Vector<T, N> {
        let rest = Vector::ZERO;
        self.newton_euler::<T, true>(&self.poses(q), &rest, &rest, a, Vec3::ZERO)
    }

    /// Of the bodies in their turned frames, less what parents have: mass, first moments x, y, z, second moments xx, xy, xz, yy, yz, zz.
    #[inline]
    fn parameters(&self) -> Parameters<C, N> {
        let mut parameters = [Vector::ZERO; 10];
        for (i, joint) in self.joints.iter().enumerate().take(self.count) {
            for (slot, number) in parameters.iter_mut().zip(joint.inertia.numbers()) {
                slot[i] = number;
            }
        }
        parameters
    }

    #[inline]
    fn regressor_mul<T: Over<C>>(
        &self,
        parameters: &Parameters<T, N>,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
    ) -> Vector<T, N> {
        self.newton_euler_of::<T, false>(&self.poses(q), [v, v_r, a_r], self.upwards(), |i, joint, body| {
            let load = RigidInertia::from_numbers(parameters.map(|slot| slot[i]));
            joint.wrench_on(&load, body, T::mul)
        })
    }

    #[inline]
    fn regressor_transpose_mul<T: Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
        s: &Vector<T, N>,
    ) -> Parameters<T, N> {
        let poses = self.poses(q);
        let mut powers = [Vector::ZERO; 10];
        let mut twists = [Twist::ZERO; N];
        self.carried::<T, false>(&poses, [v, v_r, a_r], self.upwards(), |i, joint, body| {
            let (carriers, rest) = twists.split_at_mut(i);
            let (Some(twist), Some(pose)) = (rest.first_mut(), poses.get(i)) else { return };
            let carrier = carriers.get(joint.parent).copied().unwrap_or(Twist::ZERO);
            *twist = joint.twist_to_child(pose, &carrier) + joint.along_axis(s[i]);
            for (slot, power) in powers.iter_mut().zip(joint.power(body, twist).numbers()) {
                slot[i] = power;
            }
        });
        powers
    }

    #[inline]
    fn motion_torque<T: Over<C>, const K: usize>(
        &self,
        start: &TreeFactor<'_, C, T, N>,
        q: &Vector<Jet<T, K>, N>,
        v: &Vector<Jet<T, K>, N>,
        a: &Vector<Jet<T, K>, N>,
    ) -> Vector<Jet<T, K>, N> {
        self.newton_euler::<_, true>(&self.poses_along(start.poses(), q), v, v, a, self.upwards())
    }

    #[inline]
    fn reference_torque<T: Over<C>, const K: usize>(
        &self,
        start: &TreeFactor<'_, C, T, N>,
        q: &Vector<Jet<T, K>, N>,
        v: &Vector<Jet<T, K>, N>,
        v_r: &Vector<Jet<T, K>, N>,
        a_r: &Vector<Jet<T, K>, N>,
    ) -> Vector<Jet<T, K>, N> {
        self.newton_euler::<_, false>(&self.poses_along(start.poses(), q), v, v_r, a_r, self.upwards())
    }

    #[inline]
    fn torque_along<T: Over<C>, const U: usize, const U2: usize>(
        &self,
        q: &Vector<Jet<T, U2>, N>,
    ) -> Vector<Jet<T, U>, N> {
        let poses = self.poses(&q.map(|x| x.coefficient(0)));
        let (v, a) = (q.map(|x| x.differentiate()), q.map(|x| x.differentiate_twice()));
        let poses = self.poses_along(&poses, &q.map(|x| x.truncate()));
        self.newton_euler::<_, true>(&poses, &v, &v, &a, self.upwards())
    }
}
