//! Torques that the model does not know, estimated inside the law.

use super::{Applied, DynamicLaw};
use crate::control::{ControlLaw, Signals, Vcbc};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// A combination that is this project's, of the momentum residual of De Luca and Mattone, *Actuator failure detection and isolation using generalized momenta*, IEEE
/// Int. Conf. Robotics and Automation, 2003, with any law that can count on a constant load ([`LoadedLaw`]): a constant unknown torque on links or motors leaves no
/// error.
///
/// r_l = ω (M q̇ − σ_l), σ̇_l = K ζ + Cᵀ q̇ − g − D_l q̇ + r_l and r_m = ω (B θ̇ − σ_m), σ̇_m = u − K ζ − D_m θ̇ + r_m with u the torque that the motors got, so that
/// ṙ = ω (d − r) on both sides. The torque is that of the law for a robot whose links bear r_l, less r_m. Memory: σ_l, σ_m.
#[derive(Clone, Copy, Debug)]
pub struct DisturbanceRejecting<C, F, const N: usize> {
    /// The law for the robot with its load.
    pub law: F,
    /// ω, how fast residuals follow [1/s].
    pub bandwidth: Vector<C, N>,
}

/// The same with v-CBC inside: this project's. Where the residuals have found constant torques, the loop is that of [`Vcbc`] for a robot whose model has them.
pub type DisturbanceRejectingVcbc<C, Pl, Pm, const N: usize> = DisturbanceRejecting<C, Vcbc<C, Pl, Pm, N>, N>;

/// A law that can count on a constant torque on the links that is not in the model.
pub trait LoadedLaw<C: Scalar, const N: usize>: ControlLaw<C, N> {
    /// Motor torque [N m] for a robot whose links bear `load` [N m] besides: accelerations are those under it, and the springs are to carry its opposite.
    fn torque_under<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        load: &Vector<T, N>,
    ) -> Vector<T, N>;
}

impl<C: Scalar, F, const N: usize> DisturbanceRejecting<C, F, N> {
    /// r_l and r_m [N m].
    #[inline]
    pub fn residuals<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        [sigma_l, sigma_m]: &[Vector<T, N>; 2],
    ) -> [Vector<T, N>; 2] {
        let p = robot.state(x);
        [self.bandwidth.diag_mul(&(p.p_l - *sigma_l)), self.bandwidth.diag_mul(&(p.p_m - *sigma_m))]
    }
}

impl<C: Scalar, F: LoadedLaw<C, N>, const N: usize> DynamicLaw<C, N, 2> for DisturbanceRejecting<C, F, N> {
    const READS: Signals = Signals::ALL;
    const JOINTWISE: bool = true;

    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        _: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 2] {
        let p = robot.state(x);
        [p.p_l, p.p_m]
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        sigma: &[Vector<T, N>; 2],
    ) -> Vector<T, N> {
        let [load, motor] = self.residuals(robot, x, sigma);
        self.law.torque_under(robot, x, q_ld, &load) - motor
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        _: &Vector<Jet<T, 5>, N>,
        sigma: &[Vector<T, N>; 2],
        applied: &Applied<T, N>,
    ) -> [Vector<T, N>; 2] {
        let [link, motor] = self.residuals(robot, x, sigma);
        let spring = robot.spring_torque(&x.q_l, &x.q_m);
        [
            spring + robot.links.momentum_gain(&x.q_l, &x.v_l) - robot.link_damping.diag_mul(&x.v_l) + link,
            applied.given - spring - robot.motor_damping.diag_mul(&x.v_m) + motor,
        ]
    }
}
