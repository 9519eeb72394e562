//! Eigenvalues of small symmetric matrices.

use flexure_core::linalg::{Matrix, Vector};

/// Eigenvalues of a symmetric matrix by cyclic Jacobi rotations. Golub & Van Loan, *Matrix Computations*, 4th ed.,
/// section 8.5. Accurate also where some are equal.
pub(crate) fn eigenvalues<const N: usize>(mut a: Matrix<f64, N, N>) -> Vector<f64, N> {
    for _ in 0..SWEEPS {
        for p in 0..N {
            for q in p + 1..N {
                if a[(p, q)] == 0.0 {
                    continue;
                }
                let tau = (a[(q, q)] - a[(p, p)]) / (2.0 * a[(p, q)]);
                let t = tau.signum() / (tau.abs() + tau.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for k in 0..N {
                    let (x, y) = (a[(k, p)], a[(k, q)]);
                    (a[(k, p)], a[(k, q)]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..N {
                    let (x, y) = (a[(p, k)], a[(q, k)]);
                    (a[(p, k)], a[(q, k)]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
    }
    Vector::from_fn(|i| a[(i, i)])
}

/// Convergence is quadratic: six sweeps reach rounding for the sizes of robots.
const SWEEPS: usize = 6;

#[cfg(test)]
mod tests {
    use super::{Matrix, eigenvalues};

    #[test]
    fn eigenvalues_of_a_path_graph() {
        // The second-difference matrix: 2 − 2 cos(kπ/(n+1)).
        let a = Matrix::<f64, 7, 7>::from_fn(|i, j| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        });
        let mut values = eigenvalues(a).0;
        values.sort_by(f64::total_cmp);
        for (k, value) in (1..).zip(values) {
            let exact = 2.0 - 2.0 * (f64::from(k) * std::f64::consts::PI / 8.0).cos();
            assert!((value - exact).abs() < 1e-14, "{value} against {exact}");
        }
    }
}
