//! The inequality that a funnel rests on, in intervals.
//!
//! With V = zᵀ X(t)⁻¹ z and y = X⁻¹ z, along ż = A z + Σ n w + δ
//!
//! V̇ = −yᵀ Ẋ y + 2 yᵀ (A X y + Σ n w + δ),
//!
//! and 2 yᵀ n w ≤ α + (D²/α) (yᵀ n)² + τ (yᵀ n)² + (cᵀ X y)²/τ for |w| ≤ D + |c·z|, sums over the numbers of w where it has several, where α = α yᵀ X y on the surface V = 1. So no
//! motion leaves {V ≤ 1} if
//!
//! Ẋ − A X − X Aᵀ − Σ α X − Σ (D²/α + τ) n nᵀ − Σ X c cᵀ X / τ ≻ 0
//!
//! at all times. Where A, n and the bounds are those of larger errors too, V̇ ≤ −Σ α (V − 1) there: they come back. X, A and n are linear in
//! time between two ellipsoids, h s apart. But for the product A X this is concave in time: it is no less between them than what the ends
//! make of it. The product is by λ B, B = h²/4 (Ȧ Ẋ + Ẋ Ȧᵀ) and λ from 0 to 1, less than the ends make of it. So it is enough that both ends
//! have this with any λ B added.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric, lower_inverse};
use crate::prove::engine::envelope::flow::{Channel, Flow};
use crate::prove::engine::envelope::recursion::{Multipliers, drives};
use crate::prove::engine::envelope::shape::{Shape, congruent};

/// Whether it holds over the times `time` in s, from one ellipsoid to the other.
pub fn holds(flow: &Flow, with: &Multipliers, ends: [&Shape; 2], time: Interval) -> bool {
    let squares = ends.map(Shape::square);
    let times = [time.lo(), time.hi()].map(Interval::point);
    let step = times[1] - times[0];
    let rate = squares[1].minus(&squares[0], Interval::ONE).map(|x| x / step);
    let bent = bent(flow, &rate, step);
    let drives = drives(flow);
    let positive = |x: &f64| *x >= 0.0 && x.is_finite();
    let fit = with.alpha.len() == drives.len() && with.tau.len() == drives.len();
    fit && with.alpha.iter().chain(&with.tau).all(positive)
        && (0..2).all(|k| {
            let matrix = flow.at(times[k]);
            let late = times[k] - Interval::point(flow.time);
            let least = residual((&matrix, late), with, &drives, &rate, &squares[k]);
            let left = Symmetric::from_fn(least.size(), |i, j| least.at(i, j) + bent.at(i, j));
            congruent(&lower_inverse(&ends[k].lower), &left).smallest_pivot() > 0.0
        })
}

/// All λ B.
fn bent(flow: &Flow, rate: &Symmetric<Interval>, step: Interval) -> Symmetric<Interval> {
    let moved = &flow.drift.map(Interval::point) * &Dense::from(rate);
    let factor = Interval::point(0.25) * step.square();
    Symmetric::from_fn(rate.size(), |i, j| ((moved[(i, j)] + moved[(j, i)]) * factor).hull(Interval::ZERO))
}

/// Ẋ − A X − X Aᵀ − Σ α X − Σ (D²/α + τ) n nᵀ − Σ X c cᵀ X / τ.
fn residual(
    (matrix, late): (&Dense<Interval>, Interval),
    with: &Multipliers,
    drives: &[Channel],
    rate: &Symmetric<Interval>,
    x: &Symmetric<Interval>,
) -> Symmetric<Interval> {
    let n = x.size();
    let point = Interval::point;
    let moved = matrix * &Dense::from(x);
    let growth = with.alpha.iter().fold(Interval::ZERO, |sum, &alpha| sum + point(alpha));
    let mut left =
        Symmetric::from_fn(n, |i, j| rate.at(i, j) - moved[(i, j)] - moved[(j, i)] - growth * x.at(i, j));
    let mut less = |column: &[Interval], weight: Interval| {
        let outer = |i: usize, j: usize| if i == j { column[i].square() } else { column[i] * column[j] };
        left = Symmetric::from_fn(n, |i, j| left.at(i, j) - outer(i, j) * weight);
    };
    for ((drive, &alpha), &tau) in drives.iter().zip(&with.alpha).zip(&with.tau) {
        let constant =
            if drive.size > 0.0 { point(drive.size).square() / point(alpha) } else { Interval::ZERO };
        for column in drive.at(late) {
            less(&column, constant + point(tau));
        }
        for slope in &drive.slopes {
            let pulled =
                (0..n).map(|i| (0..n).fold(Interval::ZERO, |sum, k| sum + x.at(i, k) * point(slope[k])));
            less(&pulled.collect::<Vec<_>>(), point(tau).recip());
        }
    }
    left
}
