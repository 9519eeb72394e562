//! The slope of φ_2 = Λ q̃.

use flexure_core::scalar::{Interval, Scalar};

use super::{Certified, Numbers};
use crate::prove::engine::position::Ends;

/// The certificate of `linear`.
pub(super) struct Linear;

impl Certified for Linear {
    fn name(&self) -> &'static str {
        "linear"
    }

    fn cases(&self, _: usize) -> Vec<Ends> {
        vec![Vec::new()]
    }

    fn case_count(&self, _: usize) -> usize {
        1
    }

    fn slope(&self, numbers: &Numbers, _: &[Interval], i: usize, j: usize) -> Interval {
        if i == j { numbers.shaping[i] } else { Interval::ZERO }
    }

    fn is_diagonal(&self, _: usize) -> bool {
        true
    }

    fn is_constant(&self) -> bool {
        true
    }

    fn has_rate_everywhere(&self) -> bool {
        true
    }

    fn paper_rate(&self, _: &[f64]) -> Option<f64> {
        None
    }
}
