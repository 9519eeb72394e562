//! An oracle for linear motion.

use flexure_core::linalg::Matrix;

/// e^A by scaling and squaring with 20 Taylor terms: accurate to rounding for norms up to 1e5.
pub fn exponential<const D: usize>(a: &Matrix<f64, D, D>) -> Matrix<f64, D, D> {
    let squarings = 20;
    let a = a.scaled(0.5_f64.powi(squarings));
    let (mut sum, mut term) = (Matrix::identity(), Matrix::identity());
    for k in 1..=20 {
        term = (term * a).scaled(1.0 / f64::from(k));
        sum = sum + term;
    }
    (0..squarings).fold(sum, |e, _| e * e)
}
