//! Gains for the motor encoder alone, by pole placement joint by joint.

use crate::scalar::Float;

/// One joint between its motor and the base, with the other joints held, in half periods h = T/2: V = h v.
///
/// q_l'' = κ_l (q_m − q_l) − δ_l q_l', q_m'' = −κ_m (q_m − q_l) − δ_m q_m' + torque.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointModel<C> {
    /// h² K / M_ii.
    pub kappa_l: C,
    /// h D_l / M_ii.
    pub delta_l: C,
    /// h² K / J.
    pub kappa_m: C,
    /// h D_m / J.
    pub delta_m: C,
}

/// What the residual r̄ = ȳ − q̄_m of the motor position adds to the mean rates of a joint, in half periods.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointGains<C> {
    pub q_l: C,
    pub v_l: C,
    pub q_m: C,
    pub v_m: C,
}

impl<C: Float> JointGains<C> {
    /// The model alone.
    pub const ZERO: Self = Self { q_l: C::ZERO, v_l: C::ZERO, q_m: C::ZERO, v_m: C::ZERO };

    /// Gains under which every pole z of the sampled joint becomes ρ z, with ρ = e^{−ωT} given by t = tanh(ωT/2).
    ///
    /// The trapezoidal rule maps the poles w of the joint (in half periods) to z = (1 + w) / (1 − w), so ρ z belongs to
    /// (w − t) / (1 − t w). With n(w) the polynomial of the joint the wanted one is Σ n_k (w + t)^k (1 + t w)^{4−k}. What
    /// is stiff or quickly damped stays so: nothing is fought that the robot does by itself.
    #[inline]
    pub fn shifting(joint: &JointModel<C>, t: C) -> Self {
        let JointModel { kappa_l, delta_l, kappa_m, delta_m } = *joint;
        let natural = [
            C::ZERO,
            kappa_m * delta_l + kappa_l * delta_m,
            kappa_m + kappa_l + delta_m * delta_l,
            delta_m + delta_l,
            C::ONE,
        ];
        let [c_0, c_1, c_2, c_3] = shifted(&natural, t);
        // wanted = (w² + A w + B)(w² + δ_l w + κ_l) + κ_m (λ_ql w + λ_ql δ_l + λ_vl − κ_l)
        let A = c_3 - delta_l;
        let B = c_2 - A * delta_l - kappa_l;
        let q_l = (c_1 - A * kappa_l - B * delta_l) / kappa_m;
        let q_m = A - delta_m;
        Self {
            q_l,
            v_l: (c_0 - B * kappa_l) / kappa_m + kappa_l - q_l * delta_l,
            q_m,
            v_m: B - delta_m * q_m - kappa_m,
        }
    }
}

/// Σ n_k (w + t)^k (1 + t w)^{4−k} by Horner's rule, divided by its leading coefficient, which is left out.
#[inline]
fn shifted<C: Float>([n_0, n_1, n_2, n_3, n_4]: &[C; 5], t: C) -> [C; 4] {
    let mut sum = [*n_4, C::ZERO, C::ZERO, C::ZERO, C::ZERO];
    let mut power = [C::ONE, C::ZERO, C::ZERO, C::ZERO, C::ZERO];
    for n in [n_3, n_2, n_1, n_0] {
        power = times(power, C::ONE, t);
        sum = times(sum, t, C::ONE);
        for (s, p) in sum.iter_mut().zip(power) {
            *s += *n * p;
        }
    }
    let [c_0, c_1, c_2, c_3, leading] = sum;
    [c_0, c_1, c_2, c_3].map(|c| c / leading)
}

/// A polynomial times a + b w, up to order 4.
#[inline]
fn times<C: Float>([p_0, p_1, p_2, p_3, p_4]: [C; 5], a: C, b: C) -> [C; 5] {
    [a * p_0, a * p_1 + b * p_0, a * p_2 + b * p_1, a * p_3 + b * p_2, a * p_4 + b * p_3]
}
