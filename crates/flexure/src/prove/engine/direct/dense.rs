//! Small dense matrices in `f64`: what suggests, and never proves.
#![expect(clippy::needless_range_loop, reason = "rows and columns by their numbers, as on paper")]

use crate::prove::engine::direct::form::Form;

/// The lower triangular L with L Lᵀ = `a`, row by row; `None` where rounding finds no positive pivot.
pub(crate) fn cholesky(a: &Form<f64>) -> Option<Vec<Vec<f64>>> {
    let n = a.size();
    let mut lower = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest = a.at(i, j) - known;
            lower[i][j] = if i != j {
                rest / lower[j][j]
            } else if rest > 0.0 && rest.is_finite() {
                rest.sqrt()
            } else {
                return None;
            };
        }
    }
    Some(lower)
}

/// The inverse of a lower triangular matrix.
pub(crate) fn inverse(lower: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = lower.len();
    let mut inverse = vec![vec![0.0; n]; n];
    for i in 0..n {
        inverse[i][i] = 1.0 / lower[i][i];
        for j in 0..i {
            let known: f64 = (j..i).map(|k| lower[i][k] * inverse[k][j]).sum();
            inverse[i][j] = -known / lower[i][i];
        }
    }
    inverse
}

/// The least of dᵀ A d / dᵀ P d and the direction d where it is, scaled to dᵀ P d = 1. `None` where P is not positive
/// definite or something is not finite.
pub(crate) fn weakest(a: &Form<f64>, p: &Form<f64>) -> Option<(f64, Vec<f64>)> {
    let n = a.size();
    let root = inverse(&cholesky(p)?);
    // L⁻¹ A L⁻ᵀ.
    let half: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| (0..=i).map(|k| root[i][k] * a.at(k, j)).sum()).collect()).collect();
    let mut scaled: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| (0..=j).map(|k| half[i][k] * root[j][k]).sum()).collect()).collect();
    let vectors = jacobi(&mut scaled);
    let least = (0..n).min_by(|&i, &j| scaled[i][i].total_cmp(&scaled[j][j]))?;
    let direction: Vec<f64> = (0..n).map(|i| (i..n).map(|k| root[k][i] * vectors[k][least]).sum()).collect();
    // Rayleigh's quotient forgives an error of the direction; large eigenvalues leave no rounding in small ones.
    let rate = a.value(&direction) / p.value(&direction);
    rate.is_finite().then_some((rate, direction))
}

/// Diagonalises `a` by cyclic Jacobi rotations; the columns of what it returns are the eigenvectors. Golub & Van Loan,
/// *Matrix Computations*, 4th ed., section 8.5.
fn jacobi(a: &mut [Vec<f64>]) -> Vec<Vec<f64>> {
    /// Convergence is quadratic: eight sweeps reach rounding for the sizes of robots.
    const SWEEPS: usize = 8;
    let n = a.len();
    let mut vectors: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| if i == j { 1.0 } else { 0.0 }).collect()).collect();
    let size: f64 = a.iter().flatten().map(|x| x * x).sum();
    for _ in 0..SWEEPS {
        let rest: f64 =
            (0..n).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| a[i][j] * a[i][j]).sum();
        if rest <= 1e-36 * size {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q] == 0.0 {
                    continue;
                }
                let tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = tau.signum() / (tau.abs() + tau.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                let turn = |x: f64, y: f64| (c * x - s * y, s * x + c * y);
                for row in a.iter_mut().chain(&mut vectors) {
                    (row[p], row[q]) = turn(row[p], row[q]);
                }
                for k in 0..n {
                    (a[p][k], a[q][k]) = turn(a[p][k], a[q][k]);
                }
            }
        }
    }
    vectors
}

#[cfg(test)]
mod tests {
    use super::{Form, weakest};

    /// Second differences, eigenvalues 2 − 2 cos(kπ/(n + 1)), in a metric that scales the variables.
    #[test]
    fn the_weakest_direction() {
        let scale = [1.0, 100.0, 3.0, 0.01, 5.0];
        let entry = |i: usize, j: usize| match i - j {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        };
        let a = Form::from_fn(5, |i, j| entry(i, j) * scale[i] * scale[j]);
        let p = Form::from_fn(5, |i, j| if i == j { scale[i] * scale[i] } else { 0.0 });
        let (rate, direction) = weakest(&a, &p).expect("a metric");
        assert!((rate - (2.0 - 3.0_f64.sqrt())).abs() < 1e-15, "{rate}");
        assert!((p.value(&direction) - 1.0).abs() < 1e-14);
        let indefinite = Form::from_fn(5, |i, j| if i == j { -1.0 } else { 0.0 });
        assert!(weakest(&a, &indefinite).is_none());
    }
}
