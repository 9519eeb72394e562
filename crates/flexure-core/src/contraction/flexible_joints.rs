//! The flexible-joint robot under v-CBC, as one instance of the method.

use crate::control::{Command, Input, Shaping, Vcbc};
use crate::linalg::{Matrix, Vector};
use crate::model::{Fjr, Links, MassFactor, Motion, State, seeded};
use crate::reference::Reference;
use crate::scalar::{Dual, Jet, Over, Piecewise, Scalar};
use crate::virtual_system::{error_coordinates, virtual_dynamics};

use super::blocks::{join, quarters};
use super::system::rows;
use super::{ControlSystem, VirtualSystem};

/// A flexible-joint robot with the state (q_l, q_m, p_l, p_m) of `D = 4 N` numbers as a [`ControlSystem`], and with a v-CBC law and a reference
/// as a [`VirtualSystem`]. The weight is Θ = ∂x̃/∂x_v, the Jacobian of the error coordinates: in it, the virtual closed loop is that of
/// [`ErrorLoop`](super::ErrorLoop).
#[derive(Clone, Copy, Debug)]
pub struct FlexibleJoints<C, L, Pl, Pm, R, const N: usize> {
    /// The robot.
    pub robot: Fjr<C, L, N>,
    /// The law.
    pub law: Vcbc<C, Pl, Pm, N>,
    /// The reference q_ld(t) of the links in rad.
    pub reference: R,
}

impl<C: Scalar, L: Links<C, N>, const N: usize, const D: usize> ControlSystem<C, D, N> for Fjr<C, L, N> {
    #[inline]
    fn drift<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, _: T) -> Vector<T, D> {
        self.hamiltonian_dynamics(&State::from_vector(x), &Vector::ZERO).to_vector()
    }
    #[inline]
    fn port<T: Over<C> + Piecewise>(&self, _: &Vector<T, D>, _: T) -> Matrix<T, D, N> {
        Matrix::from_fn(|i, j| if i == 3 * N + j { T::ONE } else { T::ZERO })
    }
    /// q̇_m.
    #[inline]
    fn output<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, _: T) -> Vector<T, N> {
        self.motion(&State::from_vector(x)).v_m
    }
}

impl<C, L, Pl, Pm, R, const N: usize, const D: usize> VirtualSystem<C, D, N>
    for FlexibleJoints<C, L, Pl, Pm, R, N>
where
    C: Scalar,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
    R: Reference<C, N>,
{
    type Actual = Fjr<C, L, N>;

    #[inline]
    fn actual(&self) -> &Fjr<C, L, N> {
        &self.robot
    }
    #[inline]
    fn virtual_rate<T: Over<C> + Piecewise>(
        &self,
        x_v: &Vector<T, D>,
        x: &Vector<T, D>,
        u_v: &Vector<T, N>,
        _: T,
    ) -> Vector<T, D> {
        let x = self.robot.motion(&State::from_vector(x));
        virtual_dynamics(&self.robot, &State::from_vector(x_v), &x, u_v).to_vector()
    }
    #[inline]
    fn virtual_output<T: Over<C> + Piecewise>(
        &self,
        x_v: &Vector<T, D>,
        _: &Vector<T, D>,
        _: T,
    ) -> Vector<T, N> {
        self.robot.motor_inertia.map(C::recip).diag_mul(&State::from_vector(x_v).p_m)
    }
    #[inline]
    fn law<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, D>, x: &Vector<T, D>, t: T) -> Vector<T, N> {
        self.command(&State::from_vector(x_v), &self.robot.motion(&State::from_vector(x)), t).u_m
    }
    /// The state without error: q_l = q_ld, p_l = M_l q̇_ld, q_m = q_md, p_m = p_mr.
    #[inline]
    fn reference<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, t: T) -> Vector<T, D> {
        let x = self.robot.motion(&State::from_vector(x));
        let [q_l, v_l] = self.reference.on(Jet::<T, 2>::variable(t)).derivatives();
        let p_l = self.robot.links.mass_mul(&x.q_l, &v_l);
        // q_md needs nothing of the motors, q̇_mr = q̇_m − s_m not their velocity.
        let still = State { q_l, q_m: Vector::ZERO, p_l, p_m: Vector::ZERO };
        let placed = State { q_m: self.command(&still, &x, t).q_md, ..still };
        let v_mr = -self.command(&placed, &x, t).s_m;
        State { p_m: self.robot.motor_inertia.diag_mul(&v_mr), ..placed }.to_vector()
    }
    #[inline]
    fn weight<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, D>, x: &Vector<T, D>, t: T) -> Matrix<T, D, D> {
        let (x_v, x) =
            (State::from_vector(&seeded(x_v)), self.robot.motion(&State::from_vector(x)).map(Dual::constant));
        let q_ld = self.reference.on(Jet::variable(Dual::<T, D>::constant(t)));
        rows(&error_coordinates(&self.robot, &self.law, &x_v, &x, &q_ld, &Input::ZERO).to_vector())
    }
}

impl<C, L, Pl, Pm, R, const N: usize> FlexibleJoints<C, L, Pl, Pm, R, N>
where
    C: Scalar,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
    R: Reference<C, N>,
{
    /// The law at the virtual state `x_v`.
    #[inline]
    fn command<T: Over<C> + Piecewise>(&self, x_v: &State<T, N>, x: &Motion<T, N>, t: T) -> Command<T, N> {
        let virtual_motion = Motion {
            q_l: x_v.q_l,
            q_m: x_v.q_m,
            v_l: self.robot.links.factor(&x.q_l).solve(&x_v.p_l),
            v_m: self.robot.motor_inertia.map(C::recip).diag_mul(&x_v.p_m),
        };
        let q_ld = self.reference.on(Jet::variable(t));
        self.law.virtual_command(&self.robot, &virtual_motion, x, &q_ld, &Input::ZERO)
    }
}

impl<T: Copy, const N: usize> State<T, N> {
    /// The state whose numbers are those of `x`, of `D = 4 N` entries: (q_l, q_m, p_l, p_m).
    #[inline]
    pub fn from_vector<const D: usize>(x: &Vector<T, D>) -> Self {
        let [q_l, q_m, p_l, p_m] = quarters(x);
        Self { q_l, q_m, p_l, p_m }
    }

    /// Its numbers as a vector of `D = 4 N` entries.
    #[inline]
    pub fn to_vector<const D: usize>(&self) -> Vector<T, D> {
        join([self.q_l, self.q_m, self.p_l, self.p_m])
    }
}
