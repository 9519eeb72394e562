//! Matrix exponential by scaling and squaring. Golub & Van Loan, *Matrix Computations*, 4th ed., section 9.3.

use super::Dense;

/// The series is cut after this power; with a norm of at most a half the rest is below rounding.
const ORDER: u32 = 14;

/// e^`a` of a square matrix.
pub fn exponential(a: &Dense<f64>) -> Dense<f64> {
    let n = a.columns();
    let norm = a.rows().map(|row| row.iter().map(|x| x.abs()).sum()).fold(0.0, f64::max);
    // No power of two makes an infinite norm small; the result is not finite then either.
    let squarings = if norm.is_finite() { (norm * 2.0).max(1.0).log2().ceil() } else { 0.0 };
    let small = a.scaled((-squarings).exp2());
    let one = Dense::identity(n);
    let series =
        (1..=ORDER).rev().fold(one.clone(), |sum, k| &one + &(&small * &sum).scaled(1.0 / f64::from(k)));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 1025")]
    (0..squarings as u32).fold(series, |power, _| &power * &power)
}

#[cfg(test)]
mod tests {
    use super::{Dense, exponential};

    #[test]
    fn rotations_and_shears_have_closed_forms() {
        let angle = 20.0_f64;
        let turn = exponential(&Dense::from_columns(&[vec![0.0, angle], vec![-angle, 0.0]]));
        let exact = [[angle.cos(), -angle.sin()], [angle.sin(), angle.cos()]];
        // Squaring five times loses as many bits.
        for (i, row) in exact.iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                assert!((turn[(i, j)] - x).abs() < 1e-14, "{turn:?}");
            }
        }
        let shear = exponential(&Dense::from_columns(&[vec![0.0, 0.0], vec![3.0, 0.0]]));
        assert_eq!(shear, Dense::from_columns(&[vec![1.0, 0.0], vec![3.0, 1.0]]));
    }

    #[test]
    fn decay_stays_accurate_where_the_norm_is_large() {
        let decay = exponential(&Dense::from_columns(&[vec![-700.0]]));
        assert!((decay[(0, 0)] / (-700.0_f64).exp() - 1.0).abs() < 1e-11);
    }
}
