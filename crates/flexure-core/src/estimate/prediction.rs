//! The robot one control period ahead.

use super::placement::{Drive, Gains};
use crate::linalg::{Ldl, Matrix, Vector};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::Float;

/// What the motor encoders add to a prediction.
pub(super) struct Correction<'a, C, const N: usize> {
    /// Mean of the motor positions read at both ends of the period in rad.
    pub reading: &'a Vector<C, N>,
    /// tanh(ωT/2) per joint.
    pub shift: &'a Vector<C, N>,
}

/// The flexible-joint robot over one period by the trapezoidal rule, implicit in springs and dampers: second order, one
/// mass matrix, two inverse dynamics, and stable however stiff the drives are.
///
/// Everything is in half periods, h = T/2 and V = h v, and solved for the means over the period (locals `_bar`); motors are
/// eliminated joint by joint. Mass matrix, Coriolis and gravity torques are those at mid-period: the first pass takes the
/// velocity at the start for that and gives the mean velocity for the second.
///
/// `period` in s; `correction` feeds back the motor residual on the way, in the same implicit rule.
#[inline]
pub(super) fn predict<C: Float, L: Links<C, N>, const N: usize>(
    robot: &Fjr<C, L, N>,
    x: &Motion<C, N>,
    u_m: &Vector<C, N>,
    period: C,
    correction: Option<&Correction<C, N>>,
) -> Motion<C, N> {
    let h = period * C::from_ratio(1, 2);
    let (V_l, V_m) = (x.v_l.scaled(h), x.v_m.scaled(h));
    let middle = x.q_l + V_l;
    let M_l = robot.links.mass_matrix(&middle);
    let joints: Vector<Joint<C>, N> = Vector::from_fn(|i| Joint::new(robot, x, u_m, h, i, correction));

    let factor = Ldl::new(&Matrix::<C, N, N>::from_fn(|i, j| {
        if i == j { M_l[(i, i)] + joints[i].added / joints[i].scale } else { M_l[(i, j)] }
    }));
    let momentum = M_l * Vector::<C, N>::from_fn(|i| V_l[i] + joints[i].boost);
    // U and V̄_l, with Coriolis torques at the velocity v.
    let means = |v: &Vector<C, N>| {
        let bias = robot.links.inverse_dynamics(&middle, v, v, &Vector::ZERO);
        let torque = Vector::from_fn(|i| momentum[i] + joints[i].push - h.square() * bias[i]);
        let scaled = factor.solve(&torque);
        let U = Vector::<C, N>::from_fn(|i| scaled[i] / joints[i].scale);
        (U, correction.map_or(U, |_| U - injected(&M_l, &joints, &U)))
    };
    let (_, first) = means(&x.v_l);
    let (U, V_l_bar) = means(&first.scaled(h.recip()));
    let motors: Vector<(C, C), N> = Vector::from_fn(|i| joints[i].motor(U[i]));

    let ahead = |bar: C, start: C| bar + (bar - start);
    let two = C::ONE + C::ONE;
    Motion {
        q_l: x.q_l + U.scaled(two),
        q_m: Vector::from_fn(|i| ahead(motors[i].0, x.q_m[i])),
        v_l: Vector::from_fn(|i| ahead(V_l_bar[i], V_l[i]) / h),
        v_m: Vector::from_fn(|i| ahead(motors[i].1, V_m[i]) / h),
    }
}

/// α r̄ − M⁻¹ β r̄: what the correction adds to the mean rate of the link positions.
#[inline]
fn injected<C: Float, const N: usize>(
    M_l: &Matrix<C, N, N>,
    joints: &Vector<Joint<C>, N>,
    U: &Vector<C, N>,
) -> Vector<C, N> {
    let residual: Vector<C, N> = Vector::from_fn(|i| joints[i].residual(U[i]));
    let back = Vector::from_fn(|i| joints[i].gains.link_position_torque * residual[i]);
    let back = M_l.ldl().solve(&back);
    Vector::from_fn(|i| joints[i].gains.link_position * residual[i] - back[i])
}

/// J (δ/2) / tanh(δ/2) with δ = D_m T / J: the inertia with which the trapezoidal rule damps a motor by exactly e^{−δ}.
#[inline]
fn seen_inertia<C: Float>(inertia: C, damping: C, h: C) -> C {
    let half = h * damping / inertia;
    // Below that the quotient is 1 + half²/3, to the last digit.
    let quotient = if half > C::from_f64(1e-3) {
        half / half.tanh()
    } else {
        C::ONE + half.square() * C::from_ratio(1, 3)
    };
    inertia * quotient
}

/// One joint over the period, with the mean displacement U = q̄_l − q_l of the link as unknown:
///
/// - q̄_m = q_m + V̄_m + λ_q r̄, with the residual r̄ = ȳ − q̄_m,
/// - (1 + δ) V̄_m = V_m + h² u_m / J − κ (q̄_m − q̄_l) + λ_v r̄,
/// - M (U − (α + γ) r̄) = M V_l + h² K (q̄_m − q̄_l) − h D_l U − (β + η) r̄ − h² (C q̇_l + g).
///
/// The first two make r̄ affine in U, so that the third is a system of equations for (1 + (α + γ) slope) U with the
/// mass matrix and a diagonal on top.
#[derive(Clone, Copy)]
struct Joint<C> {
    drive: Drive<C>,
    gains: Gains<C>,
    /// ȳ.
    reading: C,
    q_l: C,
    /// V_m + h² u_m / J.
    driven: C,
    /// r̄ at U = 0.
    offset: C,
    /// −∂r̄/∂U.
    slope: C,
    /// 1 + (α + γ) slope.
    scale: C,
    /// What multiplies U besides the mass matrix [kg m²].
    added: C,
    /// (α + γ) r̄ at U = 0.
    boost: C,
    /// What pushes the link at U = 0 [kg m²].
    push: C,
}

impl<C: Float> Joint<C> {
    #[inline]
    fn new<L, const N: usize>(
        robot: &Fjr<C, L, N>,
        x: &Motion<C, N>,
        u_m: &Vector<C, N>,
        h: C,
        i: usize,
        correction: Option<&Correction<C, N>>,
    ) -> Self {
        let J = seen_inertia(robot.motor_inertia[i], robot.motor_damping[i], h);
        let K = h.square() * robot.stiffness[i];
        let drive = Drive {
            inertia: J,
            damping: h * robot.motor_damping[i] / J,
            stiffness: K / J,
            link_damping: h * robot.link_damping[i],
        };
        let (gains, reading) = match correction {
            Some(given) => (Gains::shifting(&drive, given.shift[i]), given.reading[i]),
            None => (Gains::ZERO, x.q_m[i]),
        };
        let driven = h * x.v_m[i] + h.square() * u_m[i] / J;

        let damped = (C::ONE + drive.damping).recip();
        let share = (C::ONE + gains.position + damped * (drive.stiffness + gains.velocity)).recip();
        let stretch = reading - x.q_l[i];
        let offset = share * (reading - x.q_m[i] - damped * (driven - drive.stiffness * stretch));
        let slope = share * damped * drive.stiffness;
        let forward = gains.link_position + gains.link_velocity;
        let back = gains.link_position_torque + gains.link_velocity_torque;
        Self {
            scale: C::ONE + forward * slope,
            added: K + drive.link_damping - (K + back) * slope,
            boost: forward * offset,
            push: K * stretch - (K + back) * offset,
            q_l: x.q_l[i],
            drive,
            gains,
            reading,
            driven,
            offset,
            slope,
        }
    }

    /// r̄.
    #[inline]
    fn residual(&self, U: C) -> C {
        self.offset - self.slope * U
    }

    /// q̄_m and V̄_m.
    #[inline]
    fn motor(&self, U: C) -> (C, C) {
        let residual = self.residual(U);
        let q_m_bar = self.reading - residual;
        let spring = self.drive.stiffness * (q_m_bar - self.q_l - U);
        let V_m_bar = (self.driven - spring + self.gains.velocity * residual) / (C::ONE + self.drive.damping);
        (q_m_bar, V_m_bar)
    }
}
