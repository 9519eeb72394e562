//! How predictions are corrected by what is measured: the steady gain of a Kalman filter.
//!
//! Any gain under which errors fade gives a consistent estimate; a good one gives a precise one, and short memory, which is what
//! keeps the search from local minima (Ljung, *System Identification*, 2nd ed., sections 7.2 and 10.1). It is that of the whole
//! arm in one posture, since joints are coupled: with motor encoders alone, joints corrected one by one drive each other wild.

use crate::linalg::{Dense, Symmetric, cholesky, exponential, lower_inverse};

/// A robot in one posture, linear.
#[derive(Clone, Debug)]
pub(crate) struct Posture {
    /// M_l [kg m²].
    pub mass: Symmetric<f64>,
    /// Per joint M_m [kg m²], K [N m/rad], D_l, D_m [N m s/rad].
    pub motor_inertia: Vec<f64>,
    pub stiffness: Vec<f64>,
    pub link_damping: Vec<f64>,
    pub motor_damping: Vec<f64>,
}

/// What disturbs a joint, standard deviations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    /// Of torque on link and motor, white from sample to sample [N m].
    pub torque: f64,
    /// Of the positions of link and motor \[rad\]; infinite for one that is not measured.
    pub position: [f64; 2],
}

/// Doublings of the time that the Riccati recursion looks at, at most.
const DOUBLINGS: usize = 40;

impl Posture {
    fn joints(&self) -> usize {
        self.stiffness.len()
    }

    /// The inverse of the mass matrix [1/(kg m²)]; none if it is not positive definite.
    fn mobility(&self) -> Option<Dense<f64>> {
        let lower = lower_inverse(&cholesky(&self.mass)?);
        let n = self.joints();
        Some(Dense::from_fn(n, n, |i, j| (i.max(j)..n).map(|k| lower[(k, i)] * lower[(k, j)]).sum()))
    }

    /// The fastest rate of a joint while the others are free [1/s].
    pub fn rate(&self) -> Option<f64> {
        let mobility = self.mobility()?;
        let of = |i: usize| {
            let (link, motor) = (mobility[(i, i)], self.motor_inertia[i].recip());
            let spring = (self.stiffness[i] * (link + motor)).sqrt();
            spring.max(self.link_damping[i] * link).max(self.motor_damping[i] * motor)
        };
        Some((0..self.joints()).map(of).fold(0.0, f64::max))
    }

    /// The steady gain at samples every `h` s: a row for each of q_l, q_m, q̇_l, q̇_m of every joint, a column for each link
    /// position and each motor position. None if the recursion leaves the finite numbers.
    pub fn gain(&self, noise: &[Noise], h: f64) -> Option<Dense<f64>> {
        let n = self.joints();
        let mobility = self.mobility()?;
        // Motion, then the torques on links and motors.
        let rate = Dense::from_fn(6 * n, 6 * n, |row, column| {
            let (row, i) = (row / n, row % n);
            let (column, j) = (column / n, column % n);
            let own = |x: f64| if i == j { x } else { 0.0 };
            let (link, motor) = (mobility[(i, j)], own(self.motor_inertia[i].recip()));
            match (row, column) {
                (0, 2) | (1, 3) => own(1.0),
                (2, 0) => -link * self.stiffness[j],
                (2, 1) => link * self.stiffness[j],
                (2, 2) => -link * self.link_damping[j],
                (2, 4) => link,
                (3, 0) => motor * self.stiffness[j],
                (3, 1) => -motor * self.stiffness[j],
                (3, 3) => -motor * self.motor_damping[j],
                (3, 5) => motor,
                _ => 0.0,
            }
        });
        let map = exponential(&rate.scaled(h));
        let A = Dense::from_fn(4 * n, 4 * n, |i, j| map[(i, j)]);
        let B = Dense::from_fn(4 * n, 2 * n, |i, j| map[(i, 4 * n + j)] * noise[j % n].torque);
        let precision: Vec<f64> = (0..2 * n)
            .map(|column| noise[column % n].position[column / n])
            .map(|sigma| if sigma.is_finite() { (sigma * sigma).recip() } else { 0.0 })
            .collect();
        let information =
            Dense::from_fn(4 * n, 4 * n, |i, j| if i == j && i < 2 * n { precision[i] } else { 0.0 });
        let P = riccati(&A, &information, &B * &transposed(&B))?;
        // P Cᵀ (C P Cᵀ + R)⁻¹ = (1 + P CᵀR⁻¹C)⁻¹ P CᵀR⁻¹.
        let product = &P * &information;
        let gain = solve(&(&Dense::identity(4 * n) + &product), &product)?;
        let gain = Dense::from_fn(4 * n, 2 * n, |i, j| gain[(i, j)]);
        let finite = gain.rows().all(|row| row.iter().all(|x| x.is_finite()));
        finite.then_some(gain)
    }
}

fn transposed(a: &Dense<f64>) -> Dense<f64> {
    Dense::from_fn(a.columns(), a.rows().len(), |i, j| a[(j, i)])
}

/// The covariance of a steady prediction, by doubling (Anderson & Moore, *Optimal Filtering*, section 6.7).
fn riccati(A: &Dense<f64>, information: &Dense<f64>, Q: Dense<f64>) -> Option<Dense<f64>> {
    let size = A.columns();
    let (mut alpha, mut beta, mut gamma) = (transposed(A), information.clone(), Q);
    for _ in 0..DOUBLINGS {
        let inner = &Dense::identity(size) + &(&beta * &gamma);
        let both =
            Dense::from_fn(size, 2 * size, |i, j| if j < size { alpha[(i, j)] } else { beta[(i, j - size)] });
        let both = solve(&inner, &both)?;
        let by_alpha = Dense::from_fn(size, size, |i, j| both[(i, j)]);
        let by_beta = Dense::from_fn(size, size, |i, j| both[(i, size + j)]);
        let added = &(&transposed(&alpha) * &gamma) * &by_alpha;
        beta = &beta + &(&(&alpha * &by_beta) * &transposed(&alpha));
        alpha = &alpha * &by_alpha;
        gamma = &gamma + &added;
        if (0..size).all(|i| added[(i, i)].abs() <= 1e-9 * gamma[(i, i)]) {
            break;
        }
    }
    Some(gamma)
}

/// a⁻¹ b by elimination with pivots; none if a is singular.
fn solve(a: &Dense<f64>, b: &Dense<f64>) -> Option<Dense<f64>> {
    let n = a.columns();
    let mut rows: Vec<Vec<f64>> = (0..n).map(|i| [a.row(i), b.row(i)].concat()).collect();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        rows.swap(k, pivot);
        let row = rows[k].clone();
        if !(row[k].abs() > 0.0 && row[k].is_finite()) {
            return None;
        }
        for (i, other) in rows.iter_mut().enumerate() {
            let factor = other[k] / row[k];
            if i != k && factor != 0.0 {
                other[k..].iter_mut().zip(&row[k..]).for_each(|(x, y)| *x -= factor * y);
            }
        }
    }
    Some(Dense::from_fn(n, b.columns(), |i, j| rows[i][n + j] / rows[i][i]))
}

#[cfg(test)]
mod tests {
    use super::{Noise, Posture, Symmetric};

    fn alone(inertia: [f64; 2], stiffness: f64, damping: f64) -> Posture {
        Posture {
            mass: Symmetric::diagonal(&[inertia[0]]),
            motor_inertia: vec![inertia[1]],
            stiffness: vec![stiffness],
            link_damping: vec![damping],
            motor_damping: vec![damping],
        }
    }

    /// A mass whose position is measured, driven by white torque: the double integrator's gain is known in closed form
    /// (Kalata, *IEEE Trans. AES* 20, 1984): β² / (1 − α) = (σ_a h²/σ)², β = 2 (2 − α) − 4 √(1 − α).
    #[test]
    fn of_a_free_motor_is_the_tracking_filter() {
        let (h, torque, position) = (1e-3, 2.0, 1e-5);
        let gain =
            alone([1.0, 0.5], 1e-9, 0.0).gain(&[Noise { torque, position: [position; 2] }], h).unwrap();
        for (inertia, side) in [(1.0, 0), (0.5, 1)] {
            let index = torque / inertia * h * h / position;
            let (alpha, beta) = (gain[(side, side)], gain[(2 + side, side)] * h);
            assert!(
                (beta * beta / (1.0 - alpha) / (index * index) - 1.0).abs() < 1e-6,
                "{alpha} {beta} {index}"
            );
            let of_alpha = 2.0 * (2.0 - alpha) - 4.0 * (1.0_f64 - alpha).sqrt();
            assert!((beta / of_alpha - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn without_a_link_encoder_the_motor_corrects_both() {
        let noise = Noise { torque: 0.1, position: [f64::INFINITY, 4e-6] };
        let gain = alone([0.9, 0.6], 14000.0, 0.5).gain(&[noise], 1e-3).unwrap();
        assert!((0..4).all(|i| gain[(i, 0)] == 0.0) && gain[(0, 1)] > 0.0, "{gain:?}");
    }
}
