//! The slope of φ_3, which couples the joints by tanh.

use flexure_core::scalar::{Interval, Scalar};

use super::{Certified, Numbers};
use crate::prove::engine::position::Ends;

/// The certificate of `coupled-tanh`.
pub(super) struct CoupledTanh;

impl Certified for CoupledTanh {
    fn name(&self) -> &'static str {
        "coupled-tanh"
    }

    fn cases(&self, joints: usize) -> Vec<Ends> {
        if joints == 1 {
            return vec![Vec::new()];
        }
        (0..self.case_count(joints)).map(|word| (0..joints).map(|j| word >> j & 1 == 1).collect()).collect()
    }

    fn case_count(&self, joints: usize) -> usize {
        if joints == 1 { 1 } else { 1 << joints }
    }

    fn slope(&self, numbers: &Numbers, a: &[Interval], i: usize, j: usize) -> Interval {
        let Numbers { theta, kappa, .. } = numbers;
        if i == j {
            return Interval::ONE + kappa[i];
        }
        let others = Interval::point(theta.len().saturating_sub(1).max(1) as f64);
        theta[j] / theta[i] * a[j] / others
    }

    fn is_diagonal(&self, joints: usize) -> bool {
        joints == 1
    }

    fn is_constant(&self) -> bool {
        false
    }

    fn has_rate_everywhere(&self) -> bool {
        true
    }

    /// ½ min κ.
    fn paper_rate(&self, kappa: &[f64]) -> Option<f64> {
        Some(0.5 * kappa.iter().copied().fold(f64::INFINITY, f64::min))
    }
}
