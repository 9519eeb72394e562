//! Any smooth odd shaping function, as a series.

use super::Shaping;
use crate::linalg::Vector;
use crate::scalar::{Over, Scalar};

/// Most terms of a series.
pub const TERMS: usize = 24;

/// φ = Λ Σ_k c_k T_{2k+1}(x) with x = q̃ / √(s² + q̃²), entry by entry, T the polynomials of Chebyshev: what a smooth odd function of the
/// error is close to, bounded far from the reference. It runs on every number type, as φ has to.
#[derive(Clone, Copy, Debug)]
pub struct OddSeries<C, const N: usize> {
    /// Diagonal of Λ [rad/s].
    pub gain: Vector<C, N>,
    /// s, the error at which x = 1/√2 \[rad\].
    pub scale: C,
    /// c_k; zero where there are fewer.
    pub coefficients: [C; TERMS],
}

impl<C: Scalar, const N: usize> Shaping<C, N> for OddSeries<C, N> {
    #[inline]
    fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
        self.gain.diag_mul(&error.map(|e| self.one(e)))
    }
}

impl<C: Scalar, const N: usize> OddSeries<C, N> {
    /// T_{2k+1}(x) = x V_k(2x² − 1) with V_0 = 1, V_1(y) = 2y − 1, V_{k+1} = 2y V_k − V_{k−1}.
    fn one<T: Over<C>>(&self, error: T) -> T {
        let scale = T::constant(self.scale);
        let x = error / (scale.square() + error.square()).sqrt();
        let twice = (x.square() + x.square() - T::ONE) + (x.square() + x.square() - T::ONE);
        let (mut before, mut now, mut sum) = (T::ONE, T::ONE, T::ZERO);
        for (k, coefficient) in self.coefficients.iter().enumerate() {
            if k == 1 {
                now = twice - T::ONE;
            } else if k > 1 {
                (before, now) = (now, twice * now - before);
            }
            sum += now.scale(*coefficient);
        }
        x * sum
    }
}

#[cfg(test)]
mod tests {
    use super::{OddSeries, TERMS};
    use crate::control::Shaping;
    use crate::linalg::Vector;

    fn series(coefficients: &[f64]) -> OddSeries<f64, 1> {
        let mut all = [0.0; TERMS];
        all[..coefficients.len()].copy_from_slice(coefficients);
        OddSeries { gain: Vector([2.0]), scale: 0.5, coefficients: all }
    }

    /// x = cos θ gives T_m = cos mθ; and slopes by dual numbers are those of differences.
    #[test]
    fn terms_are_those_of_chebyshev() {
        for e in [-3.0_f64, -0.2, 0.0, 0.1, 0.5, 4.0] {
            let angle = libm::acos(e / libm::sqrt(0.25 + e * e));
            for (k, degree) in (0..TERMS).zip((1_u32..).step_by(2)) {
                let mut coefficients = [0.0; TERMS];
                coefficients[k] = 1.0;
                let expected = 2.0 * libm::cos(f64::from(degree) * angle);
                let found = series(&coefficients).eval(&Vector([e]))[0];
                assert!((found - expected).abs() < 1e-11, "{k} at {e}: {found}, not {expected}");
            }
        }
        let phi = series(&[1.0, -0.2, 0.05]);
        let (at, h) = (0.3, 1e-5);
        let difference = (phi.eval(&Vector([at + h]))[0] - phi.eval(&Vector([at - h]))[0]) / (2.0 * h);
        assert!((phi.slope(&Vector([at])).0[0][0] - difference).abs() < 1e-8);
    }
}
