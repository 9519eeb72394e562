//! v-CBC with full matrices, derived by dual numbers.

use crate::control::Shaping;
use crate::linalg::{Matrix, Vector};
use crate::model::{Links, MassFactor, State, seeded};
use crate::reference::Reference;
use crate::scalar::{Dual, Float, Over, Piecewise, Scalar};
use crate::virtual_system::ErrorState;

use super::full_joints::times;
use super::structures::{Refusal, symmetric_positive};
use super::system::rows;
use super::tangent::{direction, moving, passing};
use super::{FullJoints, VirtualSystem};

/// The design data (Π, φ, K_d) of one side, with full matrices.
#[derive(Clone, Copy, Debug)]
pub struct FullGains<C, P, const N: usize> {
    /// Π, constant [N m/rad].
    pub metric: Matrix<C, N, N>,
    /// φ.
    pub shaping: P,
    /// K_d [N m s/rad].
    pub damping: Matrix<C, N, N>,
}

impl<C: Float, P, const N: usize> FullGains<C, P, N> {
    /// Refuses Π and K_d that are not symmetric positive definite.
    ///
    /// # Errors
    ///
    /// [`Refusal::NotSymmetric`], [`Refusal::NotPositiveDefinite`].
    pub fn check(&self) -> Result<(), Refusal<C>> {
        symmetric_positive("Π", &self.metric)?;
        symmetric_positive("K_d", &self.damping)
    }
}

/// v-CBC of flexible joints with full matrices, as a [`VirtualSystem`] of `D = 4 N` states. On diagonal matrices it is the law of
/// [`FlexibleJoints`](super::FlexibleJoints).
///
/// Time derivatives of p_lr, q_md and v_mr are derivatives along the virtual and the real system, by dual numbers in dual numbers. It is for
/// theory and tests: [`Vcbc`](crate::control::Vcbc) is the law that runs on a controller.
#[derive(Clone, Copy, Debug)]
pub struct FullDesign<C, L, Pl, Pm, R, const N: usize> {
    /// The robot.
    pub joints: FullJoints<C, L, N>,
    /// Gains of the link side.
    pub link: FullGains<C, Pl, N>,
    /// Gains of the motor side.
    pub motor: FullGains<C, Pm, N>,
    /// The reference q_ld(t) of the links in rad.
    pub reference: R,
}

/// Virtual state, real state and time.
struct Instant<T, const N: usize> {
    x_v: State<T, N>,
    x: State<T, N>,
    t: T,
}

impl<C, L, Pl, Pm, R, const N: usize> FullDesign<C, L, Pl, Pm, R, N>
where
    C: Scalar,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
    R: Reference<C, N>,
{
    /// Refuses what the theory does not allow: every matrix but the dampers has to be symmetric positive definite.
    ///
    /// # Errors
    ///
    /// [`Refusal::NotSymmetric`], [`Refusal::NotPositiveDefinite`].
    pub fn check(&self) -> Result<(), Refusal<C>>
    where
        C: Float,
    {
        self.joints.check()?;
        self.link.check()?;
        self.motor.check()
    }

    /// The error x̃ of a virtual state. Paper, eq. changeofcoordinatesError and changeofcoordinatesError-motor.
    #[inline]
    pub fn error<T: Over<C> + Piecewise, const D: usize>(
        &self,
        x_v: &Vector<T, D>,
        x: &Vector<T, D>,
        t: T,
    ) -> ErrorState<T, N> {
        let now = Instant { x_v: State::from_vector(x_v), x: State::from_vector(x), t };
        let (links, v_mr) = (&self.joints.links, self.motor_reference(&now));
        ErrorState {
            e_l: now.x_v.q_l - self.reference.on(t),
            e_m: now.x_v.q_m - self.motor_target(&now),
            sigma_l: now.x_v.p_l - links.mass_mul(&now.x.q_l, &self.link_reference(&now.x_v.q_l, t)),
            sigma_m: now.x_v.p_m - times(&self.joints.motor_inertia, &v_mr),
        }
    }

    /// The instant as it moves with time. The motors get no torque: what is derived here does not depend on p_m.
    #[inline]
    fn moved<T: Over<C> + Piecewise>(&self, now: &Instant<T, N>) -> Instant<Dual<T, 1>, N> {
        let along = |x_v: &State<T, N>| {
            let rate = self.joints.virtual_dynamics(x_v, &now.x, &Vector::ZERO);
            State {
                q_l: moving(&x_v.q_l, &rate.q_l),
                q_m: moving(&x_v.q_m, &rate.q_m),
                p_l: moving(&x_v.p_l, &rate.p_l),
                p_m: moving(&x_v.p_m, &rate.p_m),
            }
        };
        Instant { x_v: along(&now.x_v), x: along(&now.x), t: passing(now.t) }
    }

    /// q̇_lr = q̇_ld − φ_l(q̃_l).
    #[inline]
    fn link_reference<T: Over<C> + Piecewise>(&self, q_lv: &Vector<T, N>, t: T) -> Vector<T, N> {
        let q_ld = self.reference.on(passing(t));
        direction(&q_ld) - self.link.shaping.eval(&(*q_lv - q_ld.map(|q| q.value)))
    }

    /// q_md = q_lv + K⁻¹ u_lv.
    #[inline]
    fn motor_target<T: Over<C> + Piecewise>(&self, now: &Instant<T, N>) -> Vector<T, N> {
        let (Instant { x_v, x, t }, links) = (now, &self.joints.links);
        let factor = links.factor(&x.q_l);
        let (v_l, v_lv) = (factor.solve(&x.p_l), factor.solve(&x_v.p_l));
        let moved = self.link_reference(&moving(&x_v.q_l, &v_lv), passing(*t));
        let (v_lr, a_lr) = (moved.map(|v| v.value), direction(&moved));
        let u_lv = links.inertial_torque(&x.q_l, &v_l, &v_lr, &a_lr)
            + links.gravity_torque(&x_v.q_l)
            + times(&self.joints.link_damping, &v_lr)
            - times(&self.link.metric, &(x_v.q_l - self.reference.on(*t)))
            - times(&self.link.damping, &(v_lv - v_lr));
        x_v.q_l + self.joints.stiffness.map(T::constant).ldl().solve(&u_lv)
    }

    /// q̇_mr = q̇_md − φ_m(q̃_m) − Π_m⁻¹ Kᵀ M_l⁻¹ σ_l.
    #[inline]
    fn motor_reference<T: Over<C> + Piecewise>(&self, now: &Instant<T, N>) -> Vector<T, N> {
        let target = self.motor_target(&self.moved(now));
        let e_m = now.x_v.q_m - target.map(|q| q.value);
        let v_lv = self.joints.links.factor(&now.x.q_l).solve(&now.x_v.p_l);
        let s_l = v_lv - self.link_reference(&now.x_v.q_l, now.t);
        let spring = times(&self.joints.stiffness.transpose(), &s_l);
        let coupling = self.motor.metric.map(T::constant).ldl().solve(&spring);
        direction(&target) - self.motor.shaping.eval(&e_m) - coupling
    }

    /// u_mv. Paper, eq. controlaw-motor.
    #[inline]
    fn torque<T: Over<C> + Piecewise>(&self, now: &Instant<T, N>) -> Vector<T, N> {
        let moved = self.motor_reference(&self.moved(now));
        let (v_mr, a_mr) = (moved.map(|v| v.value), direction(&moved));
        let joints = &self.joints;
        let e_m = now.x_v.q_m - self.motor_target(now);
        let s_m = joints.motor_inertia.map(T::constant).ldl().solve(&now.x_v.p_m) - v_mr;
        times(&joints.motor_inertia, &a_mr)
            + times(&joints.stiffness, &(now.x_v.q_m - now.x_v.q_l))
            + times(&joints.motor_damping, &v_mr)
            - times(&self.motor.metric, &e_m)
            - times(&self.motor.damping, &s_m)
    }
}

impl<C, L, Pl, Pm, R, const N: usize, const D: usize> VirtualSystem<C, D, N>
    for FullDesign<C, L, Pl, Pm, R, N>
where
    C: Scalar,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
    R: Reference<C, N>,
{
    type Actual = FullJoints<C, L, N>;

    #[inline]
    fn actual(&self) -> &FullJoints<C, L, N> {
        &self.joints
    }
    #[inline]
    fn virtual_rate<T: Over<C> + Piecewise>(
        &self,
        x_v: &Vector<T, D>,
        x: &Vector<T, D>,
        u_v: &Vector<T, N>,
        _: T,
    ) -> Vector<T, D> {
        let (x_v, x) = (State::from_vector(x_v), State::from_vector(x));
        self.joints.virtual_dynamics(&x_v, &x, u_v).to_vector()
    }
    #[inline]
    fn virtual_output<T: Over<C> + Piecewise>(
        &self,
        x_v: &Vector<T, D>,
        _: &Vector<T, D>,
        _: T,
    ) -> Vector<T, N> {
        self.joints.motor_inertia.map(T::constant).ldl().solve(&State::from_vector(x_v).p_m)
    }
    #[inline]
    fn law<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, D>, x: &Vector<T, D>, t: T) -> Vector<T, N> {
        self.torque(&Instant { x_v: State::from_vector(x_v), x: State::from_vector(x), t })
    }
    #[inline]
    fn reference<T: Over<C> + Piecewise>(&self, x: &Vector<T, D>, t: T) -> Vector<T, D> {
        let x = State::from_vector(x);
        let q_ld = self.reference.on(passing(t));
        let p_l = self.joints.links.mass_mul(&x.q_l, &direction(&q_ld));
        // q_md needs nothing of the motors, q̇_mr not their momenta.
        let mut now = Instant {
            x_v: State { q_l: q_ld.map(|q| q.value), q_m: Vector::ZERO, p_l, p_m: Vector::ZERO },
            x,
            t,
        };
        now.x_v.q_m = self.motor_target(&now);
        now.x_v.p_m = times(&self.joints.motor_inertia, &self.motor_reference(&now));
        now.x_v.to_vector()
    }
    #[inline]
    fn weight<T: Over<C> + Piecewise>(&self, x_v: &Vector<T, D>, x: &Vector<T, D>, t: T) -> Matrix<T, D, D> {
        rows(&self.error(&seeded(x_v), &x.map(Dual::constant), Dual::<T, D>::constant(t)).to_vector())
    }
}
