//! The robot one control period ahead.

use super::placement::{JointGains, JointModel};
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
/// mass matrix, one factorisation, two inverse dynamics, and stable however stiff the drives are.
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
    let joints: [Joint<C>; N] = core::array::from_fn(|i| {
        let model = joint_model(robot, M_l[(i, i)], i, h);
        let (gains, reading) = match correction {
            Some(given) => (JointGains::shifting(&model, given.shift[i]), given.reading[i]),
            None => (JointGains::ZERO, x.q_m[i]),
        };
        // h² u_m / J
        let drive = model.kappa_m / robot.stiffness[i] * u_m[i];
        Joint { model, gains, reading, q_l: x.q_l[i], q_m: x.q_m[i], V_m: V_m[i] + drive }
    });
    let joints = Vector(joints);
    let eliminated: Vector<Eliminated<C>, N> = joints.map(|joint| joint.eliminate());

    let factor = Ldl::new(&Matrix::from_fn(|i, j| {
        if i == j { M_l[(i, i)] * (C::ONE + eliminated[i].added) } else { M_l[(i, j)] }
    }));
    let momentum = M_l * V_l;
    let mean = |v: &Vector<C, N>| {
        let bias = robot.links.inverse_dynamics(&middle, v, v, &Vector::ZERO);
        factor.solve(&Vector::from_fn(|i| {
            momentum[i] + M_l[(i, i)] * eliminated[i].push - h.square() * bias[i]
        }))
    };
    let V_l_bar = mean(&mean(&x.v_l).scaled(h.recip()));
    let means: Vector<[C; 3], N> = Vector::from_fn(|i| joints[i].means(&eliminated[i], V_l_bar[i]));

    let ahead = |bar: C, start: C| bar + (bar - start);
    Motion {
        q_l: Vector::from_fn(|i| ahead(means[i][0], x.q_l[i])),
        q_m: Vector::from_fn(|i| ahead(means[i][1], x.q_m[i])),
        v_l: Vector::from_fn(|i| ahead(V_l_bar[i], V_l[i]) / h),
        v_m: Vector::from_fn(|i| ahead(means[i][2], V_m[i]) / h),
    }
}

/// Joint `i` with the other joints held, in half periods; `inertia` is M_ii [kg m²].
#[inline]
fn joint_model<C: Float, L, const N: usize>(
    robot: &Fjr<C, L, N>,
    inertia: C,
    i: usize,
    h: C,
) -> JointModel<C> {
    let (K, D_m) = (robot.stiffness[i], robot.motor_damping[i]);
    let (link, motor) = (h / inertia, h / seen_inertia(robot.motor_inertia[i], D_m, h));
    JointModel {
        kappa_l: link * h * K,
        delta_l: link * robot.link_damping[i],
        kappa_m: motor * h * K,
        delta_m: motor * D_m,
    }
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

/// One joint over the period, in half periods:
///
/// - q̄_l = q_l + V̄_l + λ_ql r̄, with the residual r̄ = ȳ − q̄_m,
/// - q̄_m = q_m + V̄_m + λ_qm r̄,
/// - (1 + δ_m) V̄_m = V_m − κ_m (q̄_m − q̄_l) + λ_vm r̄,
/// - (M V̄_l)_i = (M V_l)_i + M_ii (κ_l (q̄_m − q̄_l) − δ_l V̄_l + λ_vl r̄) − h² bias_i.
#[derive(Clone, Copy)]
struct Joint<C> {
    model: JointModel<C>,
    gains: JointGains<C>,
    /// ȳ.
    reading: C,
    q_l: C,
    q_m: C,
    /// With what the motor torque adds, h² u_m / J.
    V_m: C,
}

/// The motor's part of a joint, affine in V̄_l.
#[derive(Clone, Copy)]
struct Eliminated<C> {
    /// r̄ at V̄_l = 0.
    offset: C,
    /// −∂r̄/∂V̄_l.
    slope: C,
    /// What M_ii V̄_l is multiplied by on top of 1.
    added: C,
    /// What pushes the link, over M_ii.
    push: C,
}

impl<C: Float> Joint<C> {
    #[inline]
    fn eliminate(&self) -> Eliminated<C> {
        let Self { model, gains, reading, q_l, q_m, V_m } = *self;
        let damped = (C::ONE + model.delta_m).recip();
        let stretch = reading - q_l;
        let feedback = gains.q_m + damped * (model.kappa_m * (C::ONE + gains.q_l) + gains.v_m);
        let share = (C::ONE + feedback).recip();
        let offset = share * (reading - q_m - damped * (V_m - model.kappa_m * stretch));
        let slope = share * damped * model.kappa_m;
        let coupling = gains.v_l - model.kappa_l * (C::ONE + gains.q_l);
        Eliminated {
            offset,
            slope,
            added: model.delta_l + model.kappa_l + coupling * slope,
            push: model.kappa_l * stretch + coupling * offset,
        }
    }

    /// q̄_l, q̄_m and V̄_m.
    #[inline]
    fn means(&self, eliminated: &Eliminated<C>, V_l_bar: C) -> [C; 3] {
        let Self { model, gains, reading, q_l, V_m, .. } = *self;
        let residual = eliminated.offset - eliminated.slope * V_l_bar;
        let q_l_bar = q_l + V_l_bar + gains.q_l * residual;
        let q_m_bar = reading - residual;
        let push = gains.v_m * residual - model.kappa_m * (q_m_bar - q_l_bar);
        [q_l_bar, q_m_bar, (V_m + push) / (C::ONE + model.delta_m)]
    }
}
