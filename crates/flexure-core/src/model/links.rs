//! What a robot must say of its links.

use crate::linalg::{Ldl, Matrix, Vector};
use crate::scalar::{Dual, Jet, Over, Scalar};

/// The rigid links of a robot with `N` joints and constants of type `C`: everything between the springs and the world.
///
/// A robot in closed form gives its mass matrix and potential energy; torques follow by [`Dual`] numbers. A tree of
/// joints overrides the torques with O(n) recursions. Either way no derivative is written by hand.
///
/// A robot of one's own in closed form:
///
/// ```
/// use flexure_core::linalg::{Ldl, Matrix, Vector};
/// use flexure_core::model::Links;
/// use flexure_core::scalar::{Over, Scalar};
///
/// /// A mass in kg that slides up and down.
/// struct Lift<C>(C);
///
/// impl<C: Scalar> Links<C, 1> for Lift<C> {
///     type Factor<'a, T: Over<C>> = Ldl<T, 1> where C: 'a;
///
///     fn mass_matrix<T: Over<C>>(&self, _: &Vector<T, 1>) -> Matrix<T, 1, 1> {
///         Matrix([[T::constant(self.0)]])
///     }
///
///     fn potential_energy<T: Over<C>>(&self, q: &Vector<T, 1>) -> T {
///         q[0].scale(self.0 * C::from_f64(9.81))
///     }
///
///     fn carrier_rates<T: Over<C>>(&self, _: &Vector<T, 1>, _: &Vector<T, 1>) -> Vector<T, 1> {
///         Vector::ZERO // the motor stands on the ground
///     }
///
///     fn factor<T: Over<C>>(&self, q: &Vector<T, 1>) -> Ldl<T, 1> {
///         self.mass_matrix(q).ldl()
///     }
/// }
///
/// let lift = Lift(2.0);
/// assert_eq!(lift.gravity_torque(&Vector([0.3])), Vector([2.0 * 9.81])); // by dual numbers
/// assert_eq!(lift.forward_dynamics(&Vector([0.3]), &Vector([1.0]), &Vector([0.0])), Vector([-9.81]));
/// ```
pub trait Links<C: Scalar, const N: usize> {
    /// The mass matrix made ready for solving.
    type Factor<'a, T: Over<C>>: MassFactor<T, N>
    where
        Self: 'a;

    /// Joints that are the robot's own, at most `N`: the first ones. The others only fill a capacity
    /// ([`Tree`](crate::robots::Tree)).
    #[inline]
    fn joints(&self) -> usize {
        N
    }

    /// Mass matrix M_l(q) [kg m²], symmetric positive definite.
    fn mass_matrix<T: Over<C>>(&self, q: &Vector<T, N>) -> Matrix<T, N, N>;

    /// Potential energy P_l(q) of the links in the gravity field, in J.
    fn potential_energy<T: Over<C>>(&self, q: &Vector<T, N>) -> T;

    /// The mass matrix at q, ready for [`MassFactor::solve`].
    fn factor<T: Over<C>>(&self, q: &Vector<T, N>) -> Self::Factor<'_, T>;

    /// Rates at which the bodies that carry the motors turn about the motors' axes, a_i·ω of the parent of joint i
    /// [rad/s]: linear in `v` [rad/s], zero for motors on the base. A motor sits on the body that carries its joint and
    /// its axis is the joint's.
    fn carrier_rates<T: Over<C>>(&self, q: &Vector<T, N>, v: &Vector<T, N>) -> Vector<T, N>;

    /// Gravity torque g_l(q) = ∂P_l/∂q [N m].
    #[inline]
    fn gravity_torque<T: Over<C>>(&self, q: &Vector<T, N>) -> Vector<T, N> {
        Vector(self.potential_energy(&seeded(q)).gradient)
    }

    /// M(q) a_r + C(q, v) v_r [N m], with the Christoffel factorisation of the Coriolis terms.
    ///
    /// `v` is the velocity of the links [rad/s]; `v_r` and `a_r` are any velocity and acceleration, for instance a
    /// reference [rad/s, rad/s²].
    #[inline]
    fn inertial_torque<T: Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
    ) -> Vector<T, N> {
        // C v_r = ½ [Ṁ(v) v_r + Ṁ(v_r) v − ∂(vᵀ M v_r)/∂q], Ṁ(v) = Σ_i ∂M/∂q_i v_i.
        let mass = self.mass_matrix(&seeded(q));
        let half = T::from_f64(0.5);
        let mut torque = Vector::ZERO;
        for (k, row) in mass.0.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                let slope = Vector(entry.gradient);
                torque[k] += entry.value * a_r[j] + half * (slope.dot(v) * v_r[j] + slope.dot(v_r) * v[j]);
                let product = half * v[k] * v_r[j];
                for (torque_i, slope_i) in torque.0.iter_mut().zip(entry.gradient) {
                    *torque_i -= slope_i * product;
                }
            }
        }
        torque
    }

    /// M(q) a_r + C(q, v) v_r + g(q) [N m]; with `v_r = v` the ordinary inverse dynamics.
    #[inline]
    fn inverse_dynamics<T: Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
    ) -> Vector<T, N> {
        self.inertial_torque(q, v, v_r, a_r) + self.gravity_torque(q)
    }

    /// Joint torque that moves the links along a trajectory, τ = M(q) q̈ + C(q, q̇) q̇ + g(q) [N m], with its exact time
    /// derivatives: `U` Taylor coefficients of τ from the `U2 = U + 2` of q in rad.
    ///
    /// With `U = 3`, from q, q̇, q̈, q⃛, q⃜: τ, τ̇ and τ̈. What other libraries call `rnea`, along a trajectory instead of at
    /// an instant, for O(n) whatever `U` is. Derivatives without their factorials go in and come out by
    /// [`Vector::from_derivatives`] and [`Vector::derivatives`]:
    ///
    /// ```
    /// use flexure_core::{linalg::Vector, model::Links, robots::Pendulum};
    /// let (links, zero) = (Pendulum { inertia: 0.1, weight_moment: 5.0 }, Vector([0.0]));
    /// // Turning at a constant 2 rad/s, now hanging: the torque is 5 sin 2t.
    /// let q = Vector::from_derivatives(&[zero, Vector([2.0]), zero, zero, zero]);
    /// let [torque, rate, second] = links.torque_along::<_, 3, 5>(&q).derivatives();
    /// assert_eq!([torque[0], rate[0], second[0]], [0.0, 10.0, 0.0]);
    /// ```
    #[inline]
    fn torque_along<T: Over<C>, const U: usize, const U2: usize>(
        &self,
        q: &Vector<Jet<T, U2>, N>,
    ) -> Vector<Jet<T, U>, N> {
        let v = q.map(|x| x.differentiate());
        self.inverse_dynamics(&q.map(|x| x.truncate()), &v, &v, &q.map(|x| x.differentiate_twice()))
    }

    /// [`inverse_dynamics`](Self::inverse_dynamics) of a motion itself, v_r = v, as Taylor series of `K` coefficients: M a + C v + g [N m] from the
    /// position where `start` was factorised on. What a robot computed for `start`, such as sines, need not be computed again.
    #[inline]
    fn motion_torque<T: Over<C>, const K: usize>(
        &self,
        _start: &Self::Factor<'_, T>,
        q: &Vector<Jet<T, K>, N>,
        v: &Vector<Jet<T, K>, N>,
        a: &Vector<Jet<T, K>, N>,
    ) -> Vector<Jet<T, K>, N> {
        self.inverse_dynamics(q, v, v, a)
    }

    /// [`motion_torque`](Self::motion_torque) with a reference beside the motion: M a_r + C v_r + g [N m].
    #[inline]
    fn reference_torque<T: Over<C>, const K: usize>(
        &self,
        _start: &Self::Factor<'_, T>,
        q: &Vector<Jet<T, K>, N>,
        v: &Vector<Jet<T, K>, N>,
        v_r: &Vector<Jet<T, K>, N>,
        a_r: &Vector<Jet<T, K>, N>,
    ) -> Vector<Jet<T, K>, N> {
        self.inverse_dynamics(q, v, v_r, a_r)
    }

    /// Accelerations under the joint torque `torque` [N m]: M(q)⁻¹ (τ − C(q, v) v − g(q)) [rad/s²].
    #[inline]
    fn forward_dynamics<T: Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        torque: &Vector<T, N>,
    ) -> Vector<T, N> {
        let factor = self.factor(q);
        let bias = self.motion_torque(&factor, &q.map(Jet::<T, 1>::value), &v.map(Jet::value), &Vector::ZERO);
        factor.solve(&(*torque - bias.map(|x| x.coefficient(0))))
    }

    /// φ, the numbers that torques of the links are linear in: up to ten per joint, those that a robot has fewer of are 0. Of a
    /// [`Tree`](crate::robots::Tree) mass in kg, first moments [kg m] and second moments of mass [kg m²] of its bodies.
    ///
    /// A closed form whose parameters shall be adapted gives them here and overrides [`regressor_mul`](Self::regressor_mul). One that says nothing
    /// has none, and nothing is adapted.
    #[inline]
    fn parameters(&self) -> Parameters<C, N> {
        [Vector::ZERO; 10]
    }

    /// Y(q, v, v_r, a_r) φ = M(q) a_r + C(q, v) v_r + g(q) [N m] of links with the numbers `parameters` in place of
    /// [those of the robot](Self::parameters): linear in them but for what the robot has no numbers for.
    #[inline]
    fn regressor_mul<T: Over<C>>(
        &self,
        _parameters: &Parameters<T, N>,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
    ) -> Vector<T, N> {
        self.inverse_dynamics(q, v, v_r, a_r)
    }

    /// Yᵀ s with the regressor Y(q, v, v_r, a_r) and a velocity `s` [rad/s]: how the power of Y φ against s in W grows with each number of φ. Slots
    /// that the robot has no number in give 0.
    #[expect(clippy::indexing_slicing, reason = "slots run over a const dimension")]
    #[inline]
    fn regressor_transpose_mul<T: Over<C>>(
        &self,
        q: &Vector<T, N>,
        v: &Vector<T, N>,
        v_r: &Vector<T, N>,
        a_r: &Vector<T, N>,
        s: &Vector<T, N>,
    ) -> Parameters<T, N> {
        let power = |parameters: &Parameters<T, N>| self.regressor_mul(parameters, q, v, v_r, a_r).dot(s);
        let mut numbers = [Vector::ZERO; 10];
        let without = power(&numbers);
        core::array::from_fn(|slot| {
            Vector::from_fn(|i| {
                numbers[slot][i] = T::ONE;
                let with = power(&numbers);
                numbers[slot][i] = T::ZERO;
                with - without
            })
        })
    }

    /// M(q) [kg m²] of links with the numbers `parameters`: what [`regressor_mul`](Self::regressor_mul) has for accelerations.
    #[inline]
    fn mass_matrix_of<T: Over<C>>(&self, parameters: &Parameters<T, N>, q: &Vector<T, N>) -> Matrix<T, N, N> {
        let rest = Vector::ZERO;
        let torque = |a: &Vector<T, N>| self.regressor_mul(parameters, q, &rest, &rest, a);
        let gravity = torque(&rest);
        // A row is a column.
        Matrix(core::array::from_fn(|k| (torque(&unit(k)) - gravity).0))
    }

    /// Cᵀ(q, v) v − g(q) [N m]: how the momentum M v changes beside joint torques and dampers. Ṁ v comes from the momentum along q + v t, and
    /// Cᵀ v = Ṁ v − C v.
    #[inline]
    fn momentum_gain<T: Over<C>>(&self, q: &Vector<T, N>, v: &Vector<T, N>) -> Vector<T, N> {
        let momentum = self.mass_mul(&q.with_rate(v), &v.map(Jet::<T, 2>::value));
        momentum.map(|p| p.coefficient(1)) - self.inverse_dynamics(q, v, v, &Vector::ZERO)
    }

    /// M(q) a [N m].
    #[inline]
    fn mass_mul<T: Over<C>>(&self, q: &Vector<T, N>, a: &Vector<T, N>) -> Vector<T, N> {
        self.mass_matrix(q) * *a
    }
}

/// Numbers that the torques of links are linear in: up to ten per joint ([`Links::parameters`]).
pub type Parameters<T, const N: usize> = [Vector<T, N>; 10];

/// The mass matrix at one position, ready for solving: from [`Links::factor`].
pub trait MassFactor<T, const N: usize> {
    /// M⁻¹ b: accelerations [rad/s²] of torques [N m], velocities [rad/s] of momenta [kg m²/s].
    fn solve(&self, b: &Vector<T, N>) -> Vector<T, N>;
}

impl<T: Scalar, const N: usize> MassFactor<T, N> for Ldl<T, N> {
    #[inline]
    fn solve(&self, b: &Vector<T, N>) -> Vector<T, N> {
        Self::solve(self, b)
    }
}

/// 1 at `i`, else 0.
#[inline]
fn unit<T: Scalar, const N: usize>(i: usize) -> Vector<T, N> {
    Vector::from_fn(|k| if k == i { T::ONE } else { T::ZERO })
}

/// `q` as dual numbers seeded with the identity.
#[inline]
pub(crate) fn seeded<T: Scalar, const N: usize>(q: &Vector<T, N>) -> Vector<Dual<T, N>, N> {
    Vector::from_fn(|i| Dual::variable(q[i], i))
}
