//! Norms of matrices of intervals, from above, and what they bound.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric};

/// Above the largest singular value, about, by these parts.
const ABOVE: [f64; 4] = [1e-7, 1e-5, 1e-3, 1e-1];

/// Squarings after which a trace is the largest eigenvalue to a part in a million.
const SQUARINGS: u32 = 24;

/// Of its width, and of the way to go, what a box for times to come has beside it.
const ROOM: f64 = 0.25;

/// Numbers that are in `x` now, on their way by `way` or any part of it, about.
pub fn onwards(x: Interval, way: Interval) -> Interval {
    let way = Interval::ZERO.hull(way * Interval::point(1.0 + ROOM));
    x + way + around_zero(ROOM * x.width())
}

/// How far the ends of `x` are from its middle, from above.
pub fn radius(x: Interval) -> Interval {
    Interval::point((x - Interval::point(x.midpoint())).magnitude())
}

/// [−radius, radius].
pub fn around_zero(radius: f64) -> Interval {
    Interval::new(-radius, radius).unwrap_or(Interval::ENTIRE)
}

/// √Σ x².
pub fn frobenius(all: impl Iterator<Item = Interval>) -> f64 {
    all.fold(Interval::ZERO, |sum, x| sum + Interval::point(x.magnitude()).square()).sqrt().hi()
}

/// The largest singular value of every matrix in `a`: that of the middles, by a number that is tried, and the root of the sum of squares of what is beside them.
pub fn spectral(a: &Dense<Interval>) -> f64 {
    let middle = a.map(Interval::midpoint);
    let n = middle.columns();
    let beside = frobenius(a.rows().flatten().map(|&x| radius(x)));
    let exact = middle.map(Interval::point);
    let product = &exact.transposed() * &exact;
    let about = largest(&(&middle.transposed() * &middle)).sqrt();
    let is_above = |bound: f64| {
        let square = Interval::point(bound).square();
        let left = |i: usize, j: usize| {
            if i == j { square - product[(i, j)] } else { -product[(i, j)] }
        };
        Symmetric::from_fn(n, left).smallest_pivot() > 0.0
    };
    let found = ABOVE.into_iter().map(|above| about * (1.0 + above)).find(|&bound| is_above(bound));
    let bound = found.unwrap_or_else(|| frobenius(exact.rows().flatten().copied()));
    (Interval::point(bound) + Interval::point(beside)).hi()
}

/// The largest eigenvalue of a matrix with none below 0, about: trace(A^(2^k))^(2^-k).
fn largest(a: &Dense<f64>) -> f64 {
    let (mut power, mut root, mut logarithm) = (a.clone(), 1.0, 0.0);
    for _ in 0..SQUARINGS {
        let trace: f64 = (0..power.columns()).map(|i| power[(i, i)]).sum();
        if trace.is_nan() || trace <= 0.0 {
            return trace;
        }
        logarithm += trace.ln() * root;
        root *= 0.5;
        let scaled = power.scaled(1.0 / trace);
        power = &scaled * &scaled;
    }
    logarithm.exp()
}

#[cfg(test)]
mod tests {
    use flexure_core::scalar::Interval;

    use super::{Dense, spectral};

    /// A rotation times a scale, singular values known; and intervals around it.
    #[test]
    fn singular_values_are_bounded_closely() {
        let (c, s) = (0.6, 0.8);
        let entries = [[3.0 * c, -2.0 * s, 0.0], [3.0 * s, 2.0 * c, 0.0], [0.0, 0.0, 1.0]];
        let of = |wide: f64| {
            Dense::from_fn(3, 3, |i, j| Interval::point(entries[i][j]) + Interval::new(-wide, wide).unwrap())
        };
        let known = spectral(&of(0.0));
        assert!((3.0..3.0 * (1.0 + 1e-6)).contains(&known), "{known}");
        let wide = spectral(&of(0.01));
        assert!((3.01..3.031).contains(&wide), "{wide}");
        assert!(spectral(&Dense::from_fn(2, 2, |_, _| Interval::ENTIRE)).is_infinite());
        assert!(spectral(&Dense::from_fn(2, 2, |_, _| Interval::point(0.0))) < 1e-300);
    }
}
