//! How much of the power each line gets: the design of largest determinant, by multiplications.

use flexure_core::linalg::{Matrix, Vector};

/// Rounds of multiplication.
const ROUNDS: usize = 400;

/// Weights, one per line, of sum 1, that maximise the mean over several cases of log det Σ w_k J_k; `cases` holds the J_k of each.
///
/// w_k ← w_k · mean tr(I⁻¹ J_k) / P raises the determinant in every round (Titterington 1976, Yu, *Annals of Statistics* 38, 2010);
/// at the largest one no line has a larger trace than P (Kiefer and Wolfowitz 1960).
pub(super) fn weights<const P: usize>(cases: &[Vec<Matrix<f64, P, P>>]) -> Vec<f64> {
    let lines = cases.first().map_or(0, Vec::len);
    let mut weights = vec![(lines as f64).recip(); lines];
    for _ in 0..ROUNDS {
        let traces = traces(cases, &weights);
        for (weight, trace) in weights.iter_mut().zip(traces) {
            *weight *= trace / P as f64;
        }
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
    }
    weights
}

/// Mean over the cases of tr(I⁻¹ J_k), of each line.
fn traces<const P: usize>(cases: &[Vec<Matrix<f64, P, P>>], weights: &[f64]) -> Vec<f64> {
    let mut mean = vec![0.0; weights.len()];
    for lines in cases {
        let sum =
            lines.iter().zip(weights).fold(Matrix::ZERO, |sum, (line, weight)| sum + line.scaled(*weight));
        let factor = sum.ldl();
        for (mean, line) in mean.iter_mut().zip(lines) {
            let column = |j: usize| factor.solve(&Vector::from_fn(|i| line[(i, j)]))[j];
            *mean += (0..P).map(column).sum::<f64>() / cases.len() as f64;
        }
    }
    mean
}

#[cfg(test)]
mod tests {
    use flexure_core::linalg::Matrix;

    use super::{traces, weights};

    /// Information of y = a + b x + c x² at x: the design of largest determinant is a third at either end and in the middle.
    #[test]
    fn parabolas_are_seen_best_from_three_points() {
        let at = |x: f64| Matrix::<f64, 3, 3>::from_fn(|i, j| x.powi(i32::try_from(i + j).unwrap()));
        let lines: Vec<_> = (0..=20).map(|k| at(-1.0 + 0.1 * f64::from(k))).collect();
        let cases = [lines];
        let found = weights(&cases);
        for (k, weight) in found.iter().enumerate() {
            let best = if [0, 10, 20].contains(&k) { 1.0 / 3.0 } else { 0.0 };
            // What lies beside the middle fades slowest, as 1/rounds.
            assert!((weight - best).abs() < 0.02, "{k}: {weight}");
        }
        assert!(traces(&cases, &found).iter().all(|trace| *trace < 3.02));
    }
}
