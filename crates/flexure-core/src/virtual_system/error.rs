//! Error coordinates x̃ = (q̃, σ) and the dynamics that the law gives them.

use crate::control::{Input, Shaping, Vcbc};
use crate::linalg::{Matrix, Vector};
use crate::model::{Fjr, LinkMatrices, Links, MassFactor, Motion, State};
use crate::scalar::{Jet, Over, Scalar};

/// The error x̃ = (q̃_l, q̃_m, σ_l, σ_m), or its time derivative, or a variation δx̃.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorState<T, const N: usize> {
    /// Link position error q̃_l = q_lv − q_ld in rad.
    pub e_l: Vector<T, N>,
    /// Motor position error q̃_m = q_mv − q_md in rad.
    pub e_m: Vector<T, N>,
    /// Link momentum error σ_l = p_lv − p_lr [kg m²/s].
    pub sigma_l: Vector<T, N>,
    /// Motor momentum error σ_m = p_mv − p_mr [kg m²/s].
    pub sigma_m: Vector<T, N>,
}

/// The error with velocities in place of momenta, (q̃_l, q̃_m, s_l, s_m): what the law computes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityErrors<T, const N: usize> {
    /// Link position error q̃_l in rad.
    pub e_l: Vector<T, N>,
    /// Motor position error q̃_m in rad.
    pub e_m: Vector<T, N>,
    /// Link velocity error s_l = M_l⁻¹ σ_l [rad/s].
    pub s_l: Vector<T, N>,
    /// Motor velocity error s_m = M_m⁻¹ σ_m [rad/s].
    pub s_m: Vector<T, N>,
}

/// The error of the virtual state `x_v` under the law, along the real motion `x`. Paper, eq. changeofcoordinatesError
/// and changeofcoordinatesError-motor. `q_ld` is the reference in rad to order 4.
///
/// The motor error contains the link part of the law, so the coordinates depend on `omega` too.
#[inline]
pub fn error_coordinates<T, C, L, Pl, Pm, const N: usize>(
    robot: &Fjr<C, L, N>,
    law: &Vcbc<C, Pl, Pm, N>,
    x_v: &State<T, N>,
    x: &Motion<T, N>,
    q_ld: &Vector<Jet<T, 5>, N>,
    omega: &Input<T, N>,
) -> ErrorState<T, N>
where
    T: Over<C>,
    C: Scalar,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
{
    let virtual_motion = Motion {
        q_l: x_v.q_l,
        q_m: x_v.q_m,
        v_l: robot.links.factor(&x.q_l).solve(&x_v.p_l),
        v_m: robot.motor_inertia.map(C::recip).diag_mul(&x_v.p_m),
    };
    let command = law.virtual_command(robot, &virtual_motion, x, q_ld, omega);
    ErrorState {
        e_l: command.e_l,
        e_m: command.e_m,
        sigma_l: robot.links.mass_mul(&x.q_l, &command.s_l),
        sigma_m: robot.motor_inertia.diag_mul(&command.s_m),
    }
}

/// The rate of the error under the law, in closed form: what the paper refers to as eq. design-closed-complete and
/// does not print.
///
/// With s_l = M_l⁻¹ σ_l and s_m = M_m⁻¹ σ_m:
///
/// - d/dt q̃_l = −φ_l(q̃_l) + s_l
/// - d/dt q̃_m = −φ_m(q̃_m) − Π_m⁻¹ Kᵀ s_l + s_m
/// - d/dt σ_l = −∫Π_l − (E_l + D_l + K_ld) s_l + K q̃_m + ω_l
/// - d/dt σ_m = −∫Π_m − (D_m + K_md) s_m + ω_m
///
/// Neither the reference nor the real position of the motors appears; the real motion enters through M_l and E_l.
#[inline]
pub fn closed_loop<T, C, L, Pl, Pm, const N: usize>(
    robot: &Fjr<C, L, N>,
    law: &Vcbc<C, Pl, Pm, N>,
    error: &ErrorState<T, N>,
    x: &Motion<T, N>,
    omega: &Input<T, N>,
) -> ErrorState<T, N>
where
    T: Over<C>,
    C: Scalar,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
{
    let errors = VelocityErrors {
        e_l: error.e_l,
        e_m: error.e_m,
        s_l: robot.links.factor(&x.q_l).solve(&error.sigma_l),
        s_m: robot.motor_inertia.map(C::recip).diag_mul(&error.sigma_m),
    };
    let E_l = LinkMatrices::new(&robot.links, &x.q_l, &x.v_l).workless();
    velocity_error_rates(robot, law, &errors, &E_l, omega)
}

/// [`closed_loop`] at velocity errors: the rates of (q̃_l, q̃_m, σ_l, σ_m), without solving with a mass matrix.
///
/// `E_l` [N m s/rad] is [`LinkMatrices::workless`] of the real motion, all that enters of it. It is constant where errors
/// vary, so that it may be computed on a cheaper number and lifted: Jacobians with respect to the errors need no dual
/// numbers in the model.
#[inline]
pub fn velocity_error_rates<T, C, L, Pl, Pm, const N: usize>(
    robot: &Fjr<C, L, N>,
    law: &Vcbc<C, Pl, Pm, N>,
    errors: &VelocityErrors<T, N>,
    E_l: &Matrix<T, N, N>,
    omega: &Input<T, N>,
) -> ErrorState<T, N>
where
    T: Over<C>,
    C: Scalar,
    L: Links<C, N>,
    Pl: Shaping<C, N>,
    Pm: Shaping<C, N>,
{
    let VelocityErrors { e_l, e_m, s_l, s_m } = errors;
    let coupling = law.motor.metric.map(C::recip).diag_mul(&robot.stiffness.diag_mul(s_l));
    let damping_l = robot.link_damping + law.link.damping;
    let damping_m = robot.motor_damping + law.motor.damping;
    ErrorState {
        e_l: *s_l - law.link.shaping.eval(e_l),
        e_m: *s_m - law.motor.shaping.eval(e_m) - coupling,
        sigma_l: robot.stiffness.diag_mul(e_m) + omega.link.map(|w| w.coefficient(0))
            - law.link.metric.integral(e_l)
            - *E_l * *s_l
            - damping_l.diag_mul(s_l),
        sigma_m: omega.motor - law.motor.metric.diag_mul(e_m) - damping_m.diag_mul(s_m),
    }
}
