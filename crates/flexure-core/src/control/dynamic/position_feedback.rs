//! Tracking from positions of both sides.

use super::dirty_derivative::dirty_derivative;
use super::{Applied, DynamicLaw};
use crate::control::{MotorPd, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// A reconstruction of the idea of Ávila-Becerril, Loría and Panteley, *Global position-feedback tracking control of flexible-joint robots*,
/// American Control Conf., 2016, not their formula: positions of both sides are all that is measured, links follow a filter of their error, and
/// motors follow what the springs shall give.
///
/// With e = q − q_d through a filter of third order, f⃛ = a_l³ (e − f) − 3 a_l² ḟ − 3 a_l f̈, and τ_d = M(q_d) q̈_d + C(q_d, q̇_d) q̇_d + D_l q̇_d + g(q_d),
/// θ_d = q_d + K⁻¹ (τ_d − K_Pl f − K_Dl ḟ) has two derivatives that are memory or measured, and
/// u = B θ̈_d + D_m θ̇_d + K (θ_d − q) − K_Pm e_m − K_Dm ϑ_m with ϑ_m the dirty derivative of e_m = θ − θ_d. Only derivatives of the reference meet
/// the model.
///
/// The motor error is autonomous, B ë_m + D_m ė_m + (K + K_Pm) e_m + K_Dm ϑ_m = 0, and drives the links: global for the motors, local to semi-global
/// for the links, where K + K_Pl and D_l + K_Dl beat what the model differs by between q and q_d, and a_l is fast. Memory: f, ḟ, f̈, z_m.
#[derive(Clone, Copy, Debug)]
pub struct PositionFeedback<C, const N: usize> {
    /// K_Pl and K_Dl, feedback of the filtered link error [N m/rad, N m s/rad].
    pub link: MotorPd<C, N>,
    /// a_l, the filter's triple pole [1/s].
    pub link_cutoff: Vector<C, N>,
    /// K_Pm and K_Dm, feedback of the motor error.
    pub motor: MotorPd<C, N>,
    /// a_m, where differentiating the motor error ends [1/s].
    pub motor_cutoff: Vector<C, N>,
}

/// The filter's next derivative, and where the motors shall be with two derivatives.
struct Wanted<T, const N: usize> {
    third: Vector<T, N>,
    motors: [Vector<T, N>; 3],
}

impl<C: Scalar, const N: usize> PositionFeedback<C, N> {
    #[inline]
    fn wanted<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        q_l: &Vector<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [f, df, ddf]: [&Vector<T, N>; 3],
    ) -> Wanted<T, N> {
        let error = *q_l - q_ld.map(|q| q.coefficient(0));
        let three = C::from_ratio(3, 1);
        let third = Vector::from_fn(|i| {
            let a = self.link_cutoff[i];
            ((error[i] - f[i]).scale(a) - df[i].scale(three)).scale(a * a) - ddf[i].scale(three * a)
        });
        let nominal = robot.links.torque_along::<_, 3, 5>(q_ld)
            + robot.link_damping.diag_mul(&q_ld.map(|q| q.differentiate::<3>()));
        let [q_d, v_d, a_d, ..] = q_ld.derivatives();
        let [torque, torque_rate, torque_second] = nominal.derivatives();
        let compliance = robot.stiffness.map(C::recip);
        let motors = |q: Vector<T, N>, torque: Vector<T, N>, f: &Vector<T, N>, df: &Vector<T, N>| {
            q + compliance.diag_mul(&(torque + self.link.feedback(f, df)))
        };
        Wanted {
            third,
            motors: [
                motors(q_d, torque, f, df),
                motors(v_d, torque_rate, df, ddf),
                motors(a_d, torque_second, ddf, &third),
            ],
        }
    }
}

impl<C: Scalar, const N: usize> DynamicLaw<C, N, 4> for PositionFeedback<C, N> {
    const READS: Signals = Signals::POSITIONS;
    const JOINTWISE: bool = true;

    /// For links that rest: the filter then starts on the ramp that their error is.
    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 4] {
        let [q_d, v_d, ..] = q_ld.derivatives();
        let lag = self.link_cutoff.map(|a| C::from_ratio(3, 1) / a);
        let (f, df, ddf) = (x.q_l - q_d + lag.diag_mul(&v_d), -v_d, Vector::ZERO);
        let [theta_d, ..] = self.wanted(robot, &x.q_l, q_ld, [&f, &df, &ddf]).motors;
        [f, df, ddf, x.q_m - theta_d]
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [f, df, ddf, z_m]: &[Vector<T, N>; 4],
    ) -> Vector<T, N> {
        let [theta_d, rate_d, second_d] = self.wanted(robot, &x.q_l, q_ld, [f, df, ddf]).motors;
        let error = x.q_m - theta_d;
        robot.motor_inertia.diag_mul(&second_d)
            + robot.motor_damping.diag_mul(&rate_d)
            + robot.stiffness.diag_mul(&(theta_d - x.q_l))
            + self.motor.feedback(&error, &dirty_derivative(&self.motor_cutoff, &error, z_m))
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [f, df, ddf, z_m]: &[Vector<T, N>; 4],
        _: &Applied<T, N>,
    ) -> [Vector<T, N>; 4] {
        let Wanted { third, motors: [theta_d, ..] } = self.wanted(robot, &x.q_l, q_ld, [f, df, ddf]);
        [*df, *ddf, third, dirty_derivative(&self.motor_cutoff, &(x.q_m - theta_d), z_m)]
    }
}
