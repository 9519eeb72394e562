//! How predictions are corrected by what is measured: the steady gain of a Kalman filter, joint by joint.
//!
//! Any gain gives a consistent estimate; a good one gives a precise one, and short memory, which is what keeps the search from
//! local minima (Ljung, *System Identification*, 2nd ed., sections 7.2 and 10.1). Joints are coupled through the mass matrix in
//! the prediction; the gain takes each alone, with the inertia that it shows while the others are free.

use crate::linalg::{Dense, exponential};

/// Corrections of (q_l, q_m, q̇_l, q̇_m) of a joint per error of its link position and of its motor position.
pub(crate) type Gain = [[f64; 2]; 4];

/// A joint by itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Alone {
    /// Inertia of the link, of the motor [kg m²].
    pub inertia: [f64; 2],
    pub stiffness: f64,
    pub damping: [f64; 2],
}

/// What disturbs a joint, standard deviations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    /// Of torque on link and motor, white from sample to sample [N m].
    pub torque: f64,
    /// Of the positions of link and motor \[rad\]; infinite for one that is not measured.
    pub position: [f64; 2],
}

/// Steps of the Riccati recursion at most; it doubles the time that it looks at.
const DOUBLINGS: usize = 40;

impl Alone {
    /// The fastest rate of the joint [1/s].
    pub fn rate(&self) -> f64 {
        let [link, motor] = self.inertia;
        let spring = (self.stiffness * (1.0 / link + 1.0 / motor)).sqrt();
        spring.max(self.damping[0] / link).max(self.damping[1] / motor)
    }

    /// The steady gain at samples every `h` s; none if the recursion leaves the finite numbers.
    pub fn gain(&self, noise: &Noise, h: f64) -> Option<Gain> {
        let [m, b] = self.inertia;
        let (K, [d_l, d_m]) = (self.stiffness, self.damping);
        // Motion and the two torques.
        let rows = [
            [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
            [-K / m, K / m, -d_l / m, 0.0, 1.0 / m, 0.0],
            [K / b, -K / b, 0.0, -d_m / b, 0.0, 1.0 / b],
            [0.0; 6],
            [0.0; 6],
        ];
        let map = exponential(&Dense::from_fn(6, 6, |i, j| h * rows[i][j]));
        let A = Dense::from_fn(4, 4, |i, j| map[(i, j)]);
        let variance = noise.torque * noise.torque;
        let Q = Dense::from_fn(4, 4, |i, j| {
            variance * (map[(i, 4)] * map[(j, 4)] + map[(i, 5)] * map[(j, 5)])
        });
        let precision = noise.position.map(|sigma| if sigma.is_finite() { (sigma * sigma).recip() } else { 0.0 });
        let P = riccati(A, precision, Q)?;
        // P Cᵀ (C P Cᵀ + R)⁻¹ = (1 + P CᵀR⁻¹C)⁻¹ P CᵀR⁻¹.
        let information = Dense::from_fn(4, 4, |i, j| if i == j && i < 2 { precision[i] } else { 0.0 });
        let gain = solve(&(&Dense::identity(4) + &(&P * &information)), &(&P * &information))?;
        let found = std::array::from_fn(|i| [gain[(i, 0)], gain[(i, 1)]]);
        found.iter().flatten().all(|x: &f64| x.is_finite()).then_some(found)
    }
}

/// The covariance of a steady prediction, by doubling (Anderson & Moore, *Optimal Filtering*, section 6.7).
fn riccati(A: Dense<f64>, precision: [f64; 2], Q: Dense<f64>) -> Option<Dense<f64>> {
    let transposed = |a: &Dense<f64>| Dense::from_fn(4, 4, |i, j| a[(j, i)]);
    // The recursion is written for the control problem: there A is transposed.
    let mut alpha = transposed(&A);
    let mut beta = Dense::from_fn(4, 4, |i, j| if i == j && i < 2 { precision[i] } else { 0.0 });
    let mut gamma = Q;
    for _ in 0..DOUBLINGS {
        let inner = &Dense::identity(4) + &(&beta * &gamma);
        let by_alpha = solve(&inner, &alpha)?;
        let by_beta = solve(&inner, &beta)?;
        let next_alpha = &alpha * &by_alpha;
        let next_beta = &beta + &(&(&alpha * &by_beta) * &transposed(&alpha));
        let added = &(&transposed(&alpha) * &gamma) * &by_alpha;
        let next_gamma = &gamma + &added;
        let small = (0..4).all(|i| added[(i, i)].abs() <= 1e-12 * next_gamma[(i, i)]);
        (alpha, beta, gamma) = (next_alpha, next_beta, next_gamma);
        if small {
            break;
        }
    }
    Some(gamma)
}

/// a⁻¹ b of 4 × 4 matrices, by elimination with pivots; none if a is singular.
fn solve(a: &Dense<f64>, b: &Dense<f64>) -> Option<Dense<f64>> {
    let n = 4;
    let mut rows: Vec<Vec<f64>> =
        (0..n).map(|i| a.row(i).iter().chain(b.row(i)).copied().collect()).collect();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        rows.swap(k, pivot);
        if !(rows[k][k].abs() > 0.0 && rows[k][k].is_finite()) {
            return None;
        }
        let row = rows[k].clone();
        for (i, other) in rows.iter_mut().enumerate().filter(|&(i, _)| i != k) {
            let _ = i;
            let factor = other[k] / row[k];
            for (x, y) in other.iter_mut().zip(&row) {
                *x -= factor * y;
            }
        }
    }
    Some(Dense::from_fn(n, n, |i, j| rows[i][n + j] / rows[i][i]))
}

#[cfg(test)]
mod tests {
    use super::{Alone, Noise};

    /// A mass whose position is measured, driven by white torque: the double integrator's gain is known in closed form
    /// (Kalata, *IEEE Trans. AES* 20, 1984): α, β with β²/(1 − α) = (σ_a h²/σ)².
    #[test]
    fn of_a_free_motor_is_the_tracking_filter() {
        let (h, torque, position) = (1e-3, 2.0, 1e-5);
        let alone = Alone { inertia: [1.0, 0.5], stiffness: 1e-9, damping: [0.0; 2] };
        let gain = alone.gain(&Noise { torque, position: [position; 2] }, h).unwrap();
        for (inertia, side) in [(1.0, 0), (0.5, 1)] {
            let index = torque / inertia * h * h / position;
            let (alpha, beta) = (gain[side][side], gain[2 + side][side] * h);
            assert!((beta * beta / (1.0 - alpha) / (index * index) - 1.0).abs() < 1e-6, "{alpha} {beta} {index}");
            let of_alpha = 2.0 * (2.0 - alpha) - 4.0 * (1.0_f64 - alpha).sqrt();
            assert!((beta / of_alpha - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn without_a_link_encoder_the_motor_corrects_both() {
        let alone = Alone { inertia: [0.9, 0.6], stiffness: 14000.0, damping: [0.5, 1.0] };
        let gain = alone.gain(&Noise { torque: 0.1, position: [f64::INFINITY, 4e-6] }, 1e-3).unwrap();
        assert!(gain.iter().all(|row| row[0] == 0.0) && gain[0][1] > 0.0, "{gain:?}");
    }
}
