//! Computed torque without motor velocities and without jerks.

use super::dirty_derivative::dirty_derivative;
use super::{Applied, DynamicLaw};
use crate::control::{MotorPd, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// A reconstruction of the idea of Loría and Ortega, *On tracking control of rigid and flexible joints robots*, Applied Mathematics and Computer
/// Science 5, 1995, not their formula: computed torque with dirty derivatives that needs link accelerations, from the model, but no jerk.
///
/// With e = q − q_d and ϑ_l its dirty derivative, the springs shall give u_R = M(q) q̈_d + C(q, q̇_d) q̇_d + D_l q̇_d + g(q) − K_Pl e − K_Dl ϑ_l. No link velocity
/// is in it, so that two derivatives of θ_d = q_d + K⁻¹ u_R need no jerk. Then, with e_m = θ − θ_d,
/// u = B θ̈_d + D_m θ̇_d + K (θ_d − q_d) − K_Pm e_m − K_Dm ϑ_m.
///
/// V = ½ ėᵀMė + ½ ė_mᵀBė_m + ½ (e_m − e)ᵀK(e_m − e) + ½ eᵀK_Pl e + ½ e_mᵀK_Pm e_m + ½ ϑ_lᵀK_Dl a⁻¹ϑ_l + ½ ϑ_mᵀK_Dm a⁻¹ϑ_m has
/// V̇ = −ėᵀD_lė − ė_mᵀD_mė_m − ϑ_lᵀK_Dlϑ_l − ϑ_mᵀK_Dmϑ_m − ėᵀC(q, ė) q̇_d: it never grows where D_l exceeds what the reference's speed makes of C.
/// Memory: z_l, z_m of the two filters.
#[derive(Clone, Copy, Debug)]
pub struct LoriaOrtega<C, const N: usize> {
    /// K_Pl and K_Dl, feedback of the link error and its dirty derivative.
    pub link: MotorPd<C, N>,
    /// K_Pm and K_Dm, feedback of the motor error and its dirty derivative.
    pub motor: MotorPd<C, N>,
    /// a, where differentiating ends [1/s].
    pub cutoff: Vector<C, N>,
}

impl<C: Scalar, const N: usize> LoriaOrtega<C, N> {
    /// u_R [N m] along the motion, for links that move as the series `q` in rad and the dirty derivative `slope` of their error [rad/s].
    #[inline]
    fn spring_torque<T: Over<C>, L: Links<C, N>, const U: usize>(
        &self,
        robot: &Fjr<C, L, N>,
        q: &Vector<Jet<T, U>, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        slope: &Vector<Jet<T, U>, N>,
    ) -> Vector<Jet<T, U>, N> {
        let (v_d, a_d) = (q_ld.map(|q| q.differentiate::<U>()), q_ld.map(|q| q.differentiate_twice::<U>()));
        robot.links.inverse_dynamics(q, &v_d, &v_d, &a_d)
            + robot.link_damping.diag_mul(&v_d)
            + self.link.feedback(&(*q - q_ld.map(|q| q.truncate())), slope)
    }

    /// Where the motors shall be in rad, without derivatives.
    #[inline]
    fn motors<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        q_l: &Vector<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        z_l: &Vector<T, N>,
    ) -> Vector<T, N> {
        let q_d = q_ld.map(|q| q.coefficient(0));
        let slope = dirty_derivative(&self.cutoff, &(*q_l - q_d), z_l).map(Jet::<T, 1>::value);
        let torque = self.spring_torque(robot, &q_l.map(Jet::value), q_ld, &slope);
        q_d + robot.stiffness.map(C::recip).diag_mul(&torque.map(|u| u.coefficient(0)))
    }
}

impl<C: Scalar, const N: usize> DynamicLaw<C, N, 2> for LoriaOrtega<C, N> {
    const READS: Signals = Signals { q_l: true, q_m: true, v_l: true, v_m: false };
    const JOINTWISE: bool = true;

    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 2] {
        let z_l = x.q_l - q_ld.map(|q| q.coefficient(0));
        [z_l, x.q_m - self.motors(robot, &x.q_l, q_ld, &z_l)]
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [z_l, z_m]: &[Vector<T, N>; 2],
    ) -> Vector<T, N> {
        let q = Vector::from_derivatives(&[x.q_l, x.v_l, robot.link_acceleration(x)]);
        let q_d = q_ld.map(|q| q.truncate::<3>());
        let [e, de, dde] = (q - q_d).derivatives();
        let slope = dirty_derivative(&self.cutoff, &e, z_l);
        let slope_rate = dirty_derivative(&self.cutoff, &de, &slope);
        let slope_second = dirty_derivative(&self.cutoff, &dde, &slope_rate);
        let slope = Vector::from_derivatives(&[slope, slope_rate, slope_second]);
        let wanted = self.spring_torque(robot, &q, q_ld, &slope);
        let theta_d = q_d + robot.stiffness.map(C::recip).diag_mul(&wanted);
        let [theta_d, rate_d, second_d] = theta_d.derivatives();
        let error = x.q_m - theta_d;
        robot.motor_inertia.diag_mul(&second_d)
            + robot.motor_damping.diag_mul(&rate_d)
            + wanted.map(|u| u.coefficient(0))
            + self.motor.feedback(&error, &dirty_derivative(&self.cutoff, &error, z_m))
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        [z_l, z_m]: &[Vector<T, N>; 2],
        _: &Applied<T, N>,
    ) -> [Vector<T, N>; 2] {
        let e = x.q_l - q_ld.map(|q| q.coefficient(0));
        let error = x.q_m - self.motors(robot, &x.q_l, q_ld, z_l);
        [dirty_derivative(&self.cutoff, &e, z_l), dirty_derivative(&self.cutoff, &error, z_m)]
    }
}
