//! Lyapunov's and Stein's equations by the squared Smith method. R. A. Smith, *Matrix equation XA + BX = C*, SIAM J. Appl. Math. 16 (1968);
//! Penzl, *A cyclic low-rank Smith method for large sparse Lyapunov equations*, SIAM J. Sci. Comput. 21 (2000), section 2.

use super::Dense;

/// Squarings after which it is given up: 2⁶⁴ terms of the series.
const SQUARINGS: u32 = 64;

/// The series ends where its next terms are this much smaller than their sum.
const ENOUGH: f64 = 1e-14;

/// The X with `a` X + X `a`ᵀ + `q` = 0, for a symmetric `q` and an `a` whose eigenvalues have negative real parts; none where they do
/// not.
///
/// With Φ = (p − A)⁻¹ (p + A) and p > 0 it is the sum of Φᵏ R Φᵏᵀ over all k ≥ 0, R = 2 p (p − A)⁻¹ Q (p − A)⁻ᵀ.
pub fn lyapunov(a: &Dense<f64>, q: &Dense<f64>) -> Option<Dense<f64>> {
    let n = a.columns();
    let shift = -(0..n).map(|i| a[(i, i)]).sum::<f64>() / n.max(1) as f64;
    if !(shift > 0.0 && shift.is_finite()) {
        return None;
    }
    let shifted =
        |sign: f64| Dense::from_fn(n, n, |i, j| sign * a[(i, j)] + if i == j { shift } else { 0.0 });
    let inverse = shifted(-1.0).solved(Dense::identity(n));
    stein(&inverse * &shifted(1.0), (&(&inverse * q) * &inverse.transposed()).scaled(2.0 * shift))
}

/// The X with X = `a` X `a`ᵀ + `q`, for a symmetric `q` and an `a` whose eigenvalues are below 1 in size; none where they are not.
pub fn stein(a: Dense<f64>, q: Dense<f64>) -> Option<Dense<f64>> {
    let n = a.columns();
    let (mut power, mut sum) = (a, q);
    let size = |x: &Dense<f64>| (0..n).map(|i| x[(i, i)].abs()).sum::<f64>();
    for _ in 0..SQUARINGS {
        let next = &(&power * &sum) * &power.transposed();
        let (before, more) = (size(&sum), size(&next));
        if !(before + more).is_finite() {
            return None;
        }
        sum = &sum + &next;
        if more <= ENOUGH * before {
            return Some(Dense::from_fn(n, n, |i, j| 0.5 * (sum[(i, j)] + sum[(j, i)])));
        }
        power = &power * &power;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{Dense, lyapunov};

    /// A X + X Aᵀ + Q = 0 to rounding, for eigenvalues from 1 to 1000 in size, real and complex.
    #[test]
    fn residuals() {
        for n in [1, 2, 5, 8, 28] {
            let a = Dense::from_fn(n, n, |i, j| match i.abs_diff(j) {
                0 => -(1000.0_f64.powf(i as f64 / n as f64)),
                1 if i > j => 3.0,
                1 => -5.0,
                _ => 0.1 / (1 + i + j) as f64,
            });
            let q = Dense::from_fn(n, n, |i, j| if i == j { 2.0 } else { 1.0 / (i + j + 1) as f64 });
            let x = lyapunov(&a, &q).expect("stable");
            let left = &a * &x;
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let residual = left[(i, j)] + left[(j, i)] + q[(i, j)];
                assert!(residual.abs() < 1e-12 * n as f64, "{n}: {residual}");
            }
        }
    }

    #[test]
    fn nothing_for_what_does_not_decay() {
        let q = Dense::identity(2);
        for a in [[1.0, -2.0], [0.5, -0.5], [f64::NAN, -1.0]] {
            let a = Dense::from_fn(2, 2, |i, j| if i == j { a[i] } else { 0.0 });
            assert_eq!(lyapunov(&a, &q), None, "{a:?}");
        }
    }
}
