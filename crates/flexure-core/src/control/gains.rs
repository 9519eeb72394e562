//! Gains of the link side and of the motor side, and the link part of the law that the rigid and the flexible-joint
//! controllers share.

use super::Shaping;
use crate::linalg::Vector;
use crate::scalar::{Jet, Over, Scalar};

/// A diagonal metric Π on position errors [N m/rad].
#[derive(Clone, Copy, Debug)]
pub enum Metric<C, const N: usize> {
    /// The diagonal of Π, constant [N m/rad].
    Constant(Vector<C, N>),
    /// Π_i = base_i + hardening_i q̃_i²: each row depends on its own error alone, so it is a conservative field.
    Hardening {
        /// Π at zero error [N m/rad].
        base: Vector<C, N>,
        /// Growth with the squared error [N m/rad³].
        hardening: Vector<C, N>,
    },
}

impl<C: Scalar, const N: usize> Metric<C, N> {
    /// The diagonal of Π(q̃) [N m/rad].
    #[inline]
    pub fn at<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
        match self {
            Self::Constant(base) => base.lift(),
            Self::Hardening { base, hardening } => {
                Vector::from_fn(|i| T::constant(base[i]) + error[i].square().scale(hardening[i]))
            }
        }
    }

    /// ∫₀^q̃ Π(ξ) dξ [N m].
    #[inline]
    pub fn integral<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
        match self {
            Self::Constant(base) => base.diag_mul(error),
            Self::Hardening { base, hardening } => Vector::from_fn(|i| {
                let cube = error[i].square() * error[i];
                error[i].scale(base[i]) + cube.scale(hardening[i] * C::from_ratio(1, 3))
            }),
        }
    }

    /// The potential of which [`integral`](Self::integral) is the gradient, 0 at no error [N m rad].
    #[inline]
    pub fn potential<T: Over<C>>(&self, error: &Vector<T, N>) -> T {
        match self {
            Self::Constant(base) => T::from_f64(0.5) * error.dot(&base.diag_mul(error)),
            Self::Hardening { base, hardening } => {
                let square = error.map(T::square);
                let quartic = square.dot(&hardening.diag_mul(&square)) * T::from_ratio(1, 12);
                T::from_f64(0.5) * error.dot(&base.diag_mul(error)) + quartic
            }
        }
    }
}

/// Design data of the link side: (Π_l, φ_l, K_ld).
#[derive(Clone, Copy, Debug)]
pub struct LinkGains<C, P, const N: usize> {
    /// Metric Π_l [N m/rad].
    pub metric: Metric<C, N>,
    /// Shaping function φ_l of link position errors.
    pub shaping: P,
    /// Damping injection, the diagonal of K_ld [N m s/rad].
    pub damping: Vector<C, N>,
}

/// Design data of the motor side: (Π_m, φ_m, K_md). Π_m is constant by type: the law's coupling term
/// Π_m⁻¹ Kᵀ M_l⁻¹ σ_l is not integrable otherwise.
#[derive(Clone, Copy, Debug)]
pub struct MotorGains<C, P, const N: usize> {
    /// Metric, the diagonal of Π_m [N m/rad].
    pub metric: Vector<C, N>,
    /// Shaping function φ_m of motor position errors.
    pub shaping: P,
    /// Damping injection, the diagonal of K_md [N m s/rad].
    pub damping: Vector<C, N>,
}

/// The link part of the law along the motion: `U` Taylor coefficients.
#[derive(Clone, Copy, Debug)]
pub struct LinkTorque<T, const N: usize, const U: usize> {
    /// u_l, the torque that the springs should put on the links [N m].
    pub torque: Vector<Jet<T, U>, N>,
    /// q̃_l = q_l − q_ld in rad.
    pub error: Vector<Jet<T, U>, N>,
    /// M_l⁻¹ σ_l = q̇_l − q̇_lr [rad/s].
    pub velocity_error: Vector<Jet<T, U>, N>,
}

impl<C: Scalar, P: Shaping<C, N>, const N: usize> LinkGains<C, P, N> {
    /// u_l = M q̈_lr + C q̇_lr + g + D_l q̇_lr − ∫Π_l − K_ld M_l⁻¹ σ_l. Paper, eq. controlaw1.
    ///
    /// `q` and `q_d` are Taylor series of the (virtual) link position and of the reference, with one and two
    /// coefficients more than the torque has: `U1 = U + 1`, `U2 = U + 2`. `rigid_torque(v_r, a_r)` gives
    /// M a_r + C v_r + g along the motion.
    #[inline]
    pub fn torque<T: Over<C>, const U: usize, const U1: usize, const U2: usize>(
        &self,
        link_damping: &Vector<C, N>,
        q: &Vector<Jet<T, U1>, N>,
        q_d: &Vector<Jet<T, U2>, N>,
        rigid_torque: impl FnOnce(&Vector<Jet<T, U>, N>, &Vector<Jet<T, U>, N>) -> Vector<Jet<T, U>, N>,
    ) -> LinkTorque<T, N, U> {
        let error = *q - q_d.map(|x| x.truncate::<U1>());
        let v_lr = q_d.map(|x| x.differentiate::<U1>()) - self.shaping.eval(&error);
        let a_lr = v_lr.map(|x| x.differentiate::<U>());
        let v_lr = v_lr.map(|x| x.truncate::<U>());
        let error = error.map(|x| x.truncate::<U>());
        let velocity_error = q.map(|x| x.differentiate::<U>()) - v_lr;
        let torque = rigid_torque(&v_lr, &a_lr) + link_damping.diag_mul(&v_lr)
            - self.metric.integral(&error)
            - self.damping.diag_mul(&velocity_error);
        LinkTorque { torque, error, velocity_error }
    }
}
