//! The robot, linearised.

use crate::array::filled;
use crate::linalg::{BlockMatrix, Matrix, Vector};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Dual, Float};

/// Terms of the series over the shortest step: (1/2)¹⁶/16! is far below the precision of any float.
const TERMS: i32 = 16;
/// Halvings of a period that are enough for any robot: rates up to 2⁶³ periods.
const HALVINGS: u32 = 64;

/// ẋ = A x + B u + G τ, or with [`held`](Self::held) x⁺ = A x + B u + G τ: small deviations of x = (q, θ, v, w) [rad, rad/s] from rest, under motor
/// torques u beyond gravity and torques τ on the links [N m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearModel<S, const N: usize> {
    /// A, in blocks of joints.
    pub state: BlockMatrix<S, N, 4>,
    /// B: what torques of the motors do to q, θ, v and w.
    pub input: [Matrix<S, N, N>; 4],
    /// G: what torques on the links do to q, θ, v and w.
    pub disturbance: [Matrix<S, N, N>; 4],
}

impl<S: Float, const N: usize> LinearModel<S, N> {
    /// The Jacobians of the robot at rest with links at `posture` in rad and springs that carry gravity: exact, by dual numbers.
    pub fn at_rest<L: Links<S, N>>(robot: &Fjr<S, L, N>, posture: &Vector<S, N>) -> Self {
        let (zero, motors) = (Vector::ZERO, robot.motors_at_rest(posture));
        // A column of blocks for each of q, θ, v, w, u and τ.
        let columns: [[Matrix<S, N, N>; 4]; 6] = filled(|column| {
            let seeded = |part: usize, x: &Vector<S, N>| {
                let number = if part == column { Dual::<S, N>::variable } else { |x, _| Dual::constant(x) };
                Vector::from_fn(|i| number(x[i], i))
            };
            let (q_l, q_m) = (seeded(0, posture), seeded(1, &motors));
            let x = Motion { q_l, q_m, v_l: seeded(2, &zero), v_m: seeded(3, &zero) };
            let (u, tau) = (seeded(4, &zero), seeded(5, &zero));
            let a_l = robot.links.forward_dynamics(&x.q_l, &x.v_l, &(robot.link_torque(&x) + tau));
            let a_m = robot.motor_acceleration(&x, &u);
            [x.v_l, x.v_m, a_l, a_m].map(|rate| Matrix(rate.map(|x| x.gradient).0))
        });
        let [q_l, q_m, v_l, v_m, input, disturbance] = columns;
        Self { state: BlockMatrix::from_columns(&[q_l, q_m, v_l, v_m]), input, disturbance }
    }

    /// The model over a `period` in s with torques that are held: x⁺ = e^{AT} x + ∫₀ᵀ e^{As} ds (B u + G τ).
    ///
    /// The integral Φ is a series over a step of T/2ᵏ, where it converges at once, and is doubled, Φ(2h) = (1 + e^{Ah}) Φ(h), e^{Ah} = 1 + A Φ(h).
    pub fn held(&self, period: S) -> Self {
        let (half, one) = (S::from_ratio(1, 2), BlockMatrix::identity());
        let size = self.state.norm();
        let (mut step, mut halvings) = (period, 0);
        while halvings < HALVINGS && size * step > half {
            (step, halvings) = (step * half, halvings + 1);
        }
        // 1 + Ah/2 (1 + Ah/3 (1 + …)).
        let mut integral = one;
        for k in (2..=TERMS).rev() {
            integral = &self.state * &integral;
            integral.scale(step / S::from_ratio(k, 1));
            integral += &one;
        }
        integral.scale(step);
        let mut transition = &self.state * &integral;
        transition += &one;
        for _ in 0..halvings {
            let second = &transition * &integral;
            integral += &second;
            transition = &transition * &transition;
        }
        Self { state: transition, input: &integral * &self.input, disturbance: &integral * &self.disturbance }
    }
}
