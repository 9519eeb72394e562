//! The slope of φ_1 = Λ tanh q̃.

use flexure_core::scalar::{Interval, Scalar};

use super::{Certified, Numbers};
use crate::prove::engine::position::Ends;

/// The certificate of `tanh`.
pub(super) struct Tanh;

impl Certified for Tanh {
    fn name(&self) -> &'static str {
        "tanh"
    }

    fn cases(&self, joints: usize) -> Vec<Ends> {
        vec![vec![false; joints]]
    }

    fn case_count(&self, _: usize) -> usize {
        1
    }

    fn slope(&self, numbers: &Numbers, a: &[Interval], i: usize, j: usize) -> Interval {
        if i == j { numbers.shaping[i] * a[i] } else { Interval::ZERO }
    }

    fn is_diagonal(&self, _: usize) -> bool {
        true
    }

    fn is_constant(&self) -> bool {
        false
    }

    fn has_rate_everywhere(&self) -> bool {
        false
    }

    fn paper_rate(&self, _: &[f64]) -> Option<f64> {
        None
    }
}
