//! What several modules share: the workspace, numbers at random, places in texts, distances, an oracle for linear motion.

pub mod packed;
pub mod python;

use std::path::{Path, PathBuf};

use flexure_core::linalg::Matrix;
use flexure_core::model::Motion;

/// Sebastiano Vigna's splitmix64: every test has its own seed and is repeatable.
pub struct Random(pub u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [−1, 1).
    pub fn next(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// From 0 to `bound` − 1; 0 where `bound` is 0.
    pub fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.bits() % bound.max(1) as u64).unwrap()
    }
}

/// The folder of the workspace.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Line and column, counted from 1, of the first `needle` in `text`.
pub fn place(text: &str, needle: &str) -> (usize, usize) {
    let offset = text.find(needle).unwrap_or_else(|| panic!("{needle} is not in\n{text}"));
    let before = &text[..offset];
    (before.matches('\n').count() + 1, before.chars().rev().take_while(|&c| c != '\n').count() + 1)
}

/// The largest difference of any position or velocity, in rad or rad/s.
pub fn distance<const N: usize>(a: &Motion<f64, N>, b: &Motion<f64, N>) -> f64 {
    [a.q_l - b.q_l, a.q_m - b.q_m, a.v_l - b.v_l, a.v_m - b.v_m]
        .iter()
        .flat_map(|v| v.0)
        .fold(0.0, |m: f64, x| m.max(x.abs()))
}

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
