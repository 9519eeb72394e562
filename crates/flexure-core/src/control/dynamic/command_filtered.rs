//! Backstepping whose filters give what would have to be differentiated.

use super::{Applied, DynamicLaw};
use crate::control::Signals;
use crate::linalg::Vector;
use crate::model::{Fjr, Links, MassFactor, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// A reconstruction of the idea of Pan, Wang, Li and Yu, *Adaptive command-filtered backstepping control of robot arms with compliant actuators*,
/// IEEE Trans. Control Systems Technology 26(3), 2018, not their formula: backstepping from links to motors that needs neither accelerations nor
/// jerks, because filters of second order follow each virtual input and give its derivative, and ξ takes what they lag behind out of the errors.
///
/// With e = q − q_d, α_1 = q̇_d − Λ e, z_2 = q̇ − α_1:
/// - α_2 = q + K⁻¹ (M α̇_1 + C α_1 + g + D_l α_1 − K_2 z_2), where motors would make links follow α_1; x_3 follows α_2 with the bandwidth ω
/// - z_3 = θ − x_3, α_3 = ẋ_3 − k_3 z_3 − W_3⁻¹ K z_2; x_4 follows α_3 with the bandwidth ω
/// - M ξ̇_2 = K (x_3 − α_2 + ξ_3) − (C + D_l + K_2) ξ_2, ξ̇_3 = −k_3 ξ_3 − W_3⁻¹ K ξ_2 + x_4 − α_3
/// - v_2 = z_2 − ξ_2, v_3 = z_3 − ξ_3, v_4 = θ̇ − x_4, and u = K (θ − q) + D_m θ̇ + B (ẋ_4 − k_4 v_4 − W_4⁻¹ W_3 v_3)
///
/// V = ½ v_2ᵀ M v_2 + ½ v_3ᵀ W_3 v_3 + ½ v_4ᵀ W_4 v_4 decays as V̇ = −v_2ᵀ (D_l + K_2) v_2 − v_3ᵀ W_3 k_3 v_3 − v_4ᵀ W_4 k_4 v_4, whatever ω is. What
/// is left of the error is ξ, driven by the lag of the filters: it shrinks as 1/ω. Reads the reference to order 2. Memory: x_3, ẋ_3, x_4, ẋ_4, ξ_2, ξ_3.
#[derive(Clone, Copy, Debug)]
pub struct CommandFilteredBackstepping<C, const N: usize> {
    /// Λ, how fast link errors decay [1/s].
    pub shaping: Vector<C, N>,
    /// K_2, damping of v_2 on the links [N m s/rad].
    pub link_damping: Vector<C, N>,
    /// W_3, the weight of motor errors [N m/rad].
    pub metric: Vector<C, N>,
    /// k_3, how fast motor errors decay [1/s].
    pub motor_shaping: Vector<C, N>,
    /// W_4, the weight of errors of the motors' velocities [kg m²].
    pub rate_metric: Vector<C, N>,
    /// k_4, how fast errors of the motors' velocities decay [1/s].
    pub rate_shaping: Vector<C, N>,
    /// ω, the double pole of the filters [rad/s]: at most 0.4 over the control period.
    pub bandwidth: Vector<C, N>,
}

/// x_3, ẋ_3, x_4, ẋ_4, ξ_2, ξ_3.
pub(super) type Filters<T, const N: usize> = [Vector<T, N>; 6];

/// What links shall do in the first step of backstepping.
#[derive(Clone, Copy)]
pub(super) struct Virtual<T, const N: usize> {
    /// e = q − q_d in rad.
    pub e: Vector<T, N>,
    /// α_1 [rad/s] and α̇_1 [rad/s²].
    pub velocity: Vector<T, N>,
    pub acceleration: Vector<T, N>,
}

/// The links that a law reckons with at one motion: torque [N m] for a virtual velocity and acceleration, and accelerations of torques.
pub(super) struct Reckoned<F, G> {
    pub torque: F,
    pub solve: G,
}

impl<C: Scalar, const N: usize> CommandFilteredBackstepping<C, N> {
    #[inline]
    pub(super) fn wanted<T: Over<C>>(&self, x: &Motion<T, N>, q_ld: &Vector<Jet<T, 5>, N>) -> Virtual<T, N> {
        let [q_d, v_d, a_d, ..] = q_ld.derivatives();
        let e = x.q_l - q_d;
        Virtual {
            e,
            velocity: v_d - self.shaping.diag_mul(&e),
            acceleration: a_d - self.shaping.diag_mul(&(x.v_l - v_d)),
        }
    }

    /// α_2 in rad from the links' `torque` for α_1 and what pulls them besides [N m].
    #[inline]
    pub(super) fn motor_goal<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        wanted: &Virtual<T, N>,
        torque: &Vector<T, N>,
        pull: &Vector<T, N>,
    ) -> Vector<T, N> {
        let damped = robot.link_damping.diag_mul(&wanted.velocity)
            - self.link_damping.diag_mul(&(x.v_l - wanted.velocity));
        x.q_l + robot.stiffness.map(C::recip).diag_mul(&(*torque + damped - *pull))
    }

    /// Rates of the filters, if links are pulled by `pull` [N m] in α_2 and by `pull_xi` in ξ_2.
    #[inline]
    pub(super) fn filter_rates<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        wanted: &Virtual<T, N>,
        [x_3, dx_3, x_4, dx_4, xi_2, xi_3]: &Filters<T, N>,
        [pull, pull_xi]: [&Vector<T, N>; 2],
        links: &Reckoned<
            impl Fn(&Vector<T, N>, &Vector<T, N>) -> Vector<T, N>,
            impl Fn(&Vector<T, N>) -> Vector<T, N>,
        >,
    ) -> Filters<T, N> {
        let spring = |x: &Vector<T, N>| robot.stiffness.diag_mul(x);
        let weighted =
            |x: &Vector<T, N>| Vector::from_fn(|i| x[i].scale(robot.stiffness[i] / self.metric[i]));
        let follow = |goal: &Vector<T, N>, at: &Vector<T, N>, rate: &Vector<T, N>| {
            let once = |x: &Vector<T, N>| self.bandwidth.diag_mul(x);
            once(&(once(&(*goal - *at)) - *rate - *rate))
        };
        let torque = (links.torque)(&wanted.velocity, &wanted.acceleration);
        let coriolis = (links.torque)(&(wanted.velocity + *xi_2), &wanted.acceleration) - torque;
        let alpha_2 = self.motor_goal(robot, x, wanted, &torque, pull);
        let damping = robot.link_damping + self.link_damping;
        let lag = spring(&(*x_3 - alpha_2 + *xi_3)) - coriolis - damping.diag_mul(xi_2) - *pull_xi;
        let alpha_3 =
            *dx_3 - self.motor_shaping.diag_mul(&(x.q_m - *x_3)) - weighted(&(x.v_l - wanted.velocity));
        let xi_3_rate = *x_4 - alpha_3 - self.motor_shaping.diag_mul(xi_3) - weighted(xi_2);
        [
            *dx_3,
            follow(&alpha_2, x_3, dx_3),
            *dx_4,
            follow(&alpha_3, x_4, dx_4),
            (links.solve)(&lag),
            xi_3_rate,
        ]
    }

    /// u [N m].
    #[inline]
    pub(super) fn motor_torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        [x_3, x_4, dx_4, xi_3]: [&Vector<T, N>; 4],
    ) -> Vector<T, N> {
        let coupling = Vector::from_fn(|i| self.metric[i] / self.rate_metric[i]);
        let a =
            *dx_4 - self.rate_shaping.diag_mul(&(x.v_m - *x_4)) - coupling.diag_mul(&(x.q_m - *x_3 - *xi_3));
        robot.motor_torque(x, &a)
    }
}

impl<C: Scalar, const N: usize> DynamicLaw<C, N, 6> for CommandFilteredBackstepping<C, N> {
    const READS: Signals = Signals::ALL;
    const JOINTWISE: bool = false;

    /// The first filter starts on its input, the second at rest.
    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 6] {
        let (wanted, zero) = (self.wanted(x, q_ld), Vector::ZERO);
        let torque = robot.links.inverse_dynamics(&x.q_l, &x.v_l, &wanted.velocity, &wanted.acceleration);
        [self.motor_goal(robot, x, &wanted, &torque, &zero), zero, zero, zero, zero, zero]
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        _: &Vector<Jet<T, 5>, N>,
        [x_3, _, x_4, dx_4, _, xi_3]: &[Vector<T, N>; 6],
    ) -> Vector<T, N> {
        self.motor_torque(robot, x, [x_3, x_4, dx_4, xi_3])
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        z: &[Vector<T, N>; 6],
        _: &Applied<T, N>,
    ) -> [Vector<T, N>; 6] {
        let factor = robot.links.factor(&x.q_l);
        let links = Reckoned {
            torque: |v_r: &Vector<T, N>, a_r: &Vector<T, N>| {
                robot.links.inverse_dynamics(&x.q_l, &x.v_l, v_r, a_r)
            },
            solve: |torque: &Vector<T, N>| factor.solve(torque),
        };
        let still = Vector::ZERO;
        self.filter_rates(robot, x, &self.wanted(x, q_ld), z, [&still, &still], &links)
    }
}
