//! Flexible joints with full matrices: springs, motors and dampers that couple the joints.

use crate::linalg::{Matrix, Vector};
use crate::model::{LinkMatrices, Links, MassFactor, State};
use crate::scalar::{Float, Over, Piecewise, Scalar};

use super::ControlSystem;
use super::structures::{Refusal, symmetric_positive};

/// A flexible-joint robot like [`Fjr`](crate::model::Fjr) whose matrices are full and symmetric, with the state (q_l, q_m, p_l, p_m) of
/// `D = 4 N` numbers. M_m is constant, so that E_m = 0.
#[derive(Clone, Copy, Debug)]
pub struct FullJoints<C, L, const N: usize> {
    /// The rigid links.
    pub links: L,
    /// M_m [kg m²].
    pub motor_inertia: Matrix<C, N, N>,
    /// K [N m/rad].
    pub stiffness: Matrix<C, N, N>,
    /// D_l [N m s/rad].
    pub link_damping: Matrix<C, N, N>,
    /// D_m [N m s/rad].
    pub motor_damping: Matrix<C, N, N>,
}

impl<C: Scalar, L: Links<C, N>, const N: usize> FullJoints<C, L, N> {
    /// Refuses what is no robot: M_m and K have to be symmetric positive definite. K regular is what lets the springs pass on any torque,
    /// q_md = q_l + K⁻¹ u_l.
    ///
    /// # Errors
    ///
    /// [`Refusal::NotSymmetric`], [`Refusal::NotPositiveDefinite`].
    pub fn check(&self) -> Result<(), Refusal<C>>
    where
        C: Float,
    {
        symmetric_positive("M_m", &self.motor_inertia)?;
        symmetric_positive("K", &self.stiffness)
    }

    /// The virtual system along the real state `x`, under the torque `u_mv` [N m]; the robot itself for `x_v = x`.
    #[inline]
    pub fn virtual_dynamics<T: Over<C>>(
        &self,
        x_v: &State<T, N>,
        x: &State<T, N>,
        u_mv: &Vector<T, N>,
    ) -> State<T, N> {
        let factor = self.links.factor(&x.q_l);
        let (v_l, v_lv) = (factor.solve(&x.p_l), factor.solve(&x_v.p_l));
        let v_mv = self.motor_inertia.map(T::constant).ldl().solve(&x_v.p_m);
        let E_l = LinkMatrices::new(&self.links, &x.q_l, &v_l).workless();
        let spring = times(&self.stiffness, &(x_v.q_m - x_v.q_l));
        State {
            q_l: v_lv,
            q_m: v_mv,
            p_l: spring - E_l * v_lv - times(&self.link_damping, &v_lv) - self.links.gravity_torque(&x_v.q_l),
            p_m: *u_mv - spring - times(&self.motor_damping, &v_mv),
        }
    }
}

impl<C: Scalar, L: Links<C, N>, const N: usize, const D: usize> ControlSystem<C, D, N>
    for FullJoints<C, L, N>
{
    #[inline]
    fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, _: T) -> Vector<T, D> {
        let x = State::from_vector(x);
        self.virtual_dynamics(&x, &x, &Vector::ZERO).to_vector()
    }
    #[inline]
    fn port<T: Over<C> + Piecewise>(&self, _: &Vector<T, D>, _: T) -> Matrix<T, D, N> {
        Matrix::from_fn(|i, j| if i == 3 * N + j { T::ONE } else { T::ZERO })
    }
    /// q̇_m.
    #[inline]
    fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, _: T) -> Vector<T, N> {
        self.motor_inertia.map(T::constant).ldl().solve(&State::from_vector(x).p_m)
    }
}

/// A matrix of constants times a vector.
#[inline]
pub(super) fn times<C: Scalar, T: Over<C>, const N: usize>(
    a: &Matrix<C, N, N>,
    x: &Vector<T, N>,
) -> Vector<T, N> {
    a.map(T::constant) * *x
}
