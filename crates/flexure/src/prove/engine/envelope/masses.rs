//! Inverse mass matrices over slab and tube, of the model and of robots whose links are heavier or lighter.
//!
//! With numbers N = L Lᵀ and Ṅ near it, the model's is N(t) + L E Lᵀ with N(t) = N + (t − t_c) Ṅ and ‖E‖ ≤ ε, and at most 1 + w times N. Masses
//! that are by parts of at most μ off have (1 − μ) M_l ≤ M'_l ≤ (1 + μ) M_l. So M'_l⁻¹ is M_l⁻¹ / (1 − μ²) but for what is between −M_l⁻¹ and M_l⁻¹
//! times μ/(1 − μ²).

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric, cholesky, lower_inverse};
use crate::prove::engine::envelope::shape::{congruent, square};

/// Steps of the power method.
const POWERS: usize = 6;

/// c N(t) + L E Lᵀ with ‖E‖ ≤ r.
pub(super) struct About {
    /// c.
    pub middle: Interval,
    /// r.
    pub radius: Interval,
}

/// M_l⁻¹ and M'_l⁻¹ [1/(kg m²)].
pub(super) struct Masses {
    /// L, lower triangular.
    pub root: Dense<f64>,
    /// N [1/(kg m²)].
    pub number: Symmetric<Interval>,
    /// Ṅ [1/(kg m² s)].
    pub rate: Symmetric<f64>,
    /// ε.
    pub model: Interval,
    /// The robot's.
    pub robot: About,
    /// The robot's less the model's.
    pub more: About,
}

impl Masses {
    /// From M_l⁻¹ over slab and tube, the lines in time near its entries and how far it is beside those, and by which parts masses may be off.
    pub fn new(
        inverse_mass: &Symmetric<Interval>,
        on_lines: &Symmetric<[f64; 2]>,
        beside: &Symmetric<Interval>,
        parts: &[Interval],
    ) -> Self {
        let (n, one) = (inverse_mass.size(), Interval::ONE);
        let middle = on_lines.map(|[at, _]| at);
        // Where that does not exist nothing is bounded, with any numbers.
        let root = cholesky(&middle).unwrap_or_else(|| Dense::identity(n));
        let number = square(&root);
        let inverse = lower_inverse(&root);
        let model = scaled_norm(&root, &inverse, |i, j| {
            beside.at(i, j) + Interval::point(middle.at(i, j)) - number.at(i, j)
        });
        let whole = scaled_norm(&root, &inverse, |i, j| inverse_mass.at(i, j) - number.at(i, j));
        let mu = Interval::point(parts.iter().map(|part| part.magnitude()).fold(0.0, f64::max));
        let between = one - mu.square();
        let [times, apart] = [between.recip(), mu / between * (one + whole)];
        let about = |middle: Interval| About { middle, radius: middle * model + apart };
        let [robot, more] = [about(times), about(mu.square() / between)];
        Self { root, number, rate: on_lines.map(|[_, rate]| rate), model, robot, more }
    }
}

/// A bound of ‖L⁻¹ D L⁻ᵀ‖ for the symmetric D of these entries; `inverse` is about L⁻¹: R D Rᵀ with R L = 1 + δ is by at most
/// (1 − ‖δ‖)² smaller.
fn scaled_norm(
    root: &Dense<f64>,
    inverse: &Dense<f64>,
    entry: impl FnMut(usize, usize) -> Interval,
) -> Interval {
    let n = root.columns();
    let scaled = congruent(inverse, &Symmetric::from_fn(n, entry));
    let unit = |i: usize, j: usize| {
        let sum = (j..=i).fold(Interval::ZERO, |sum, k| {
            sum + Interval::point(inverse[(i, k)]) * Interval::point(root[(k, j)])
        });
        if i == j { sum - Interval::ONE } else { sum }
    };
    let off = (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| unit(i, j).square());
    let off = off.fold(Interval::ZERO, |sum, x| sum + x).sqrt();
    let least = Interval::ONE - Interval::point(off.hi());
    let norm = Interval::point(norm(n, &|i, j| scaled.at(i, j).magnitude()));
    if least.lo() > 0.0 { norm / least.square() } else { Interval::ENTIRE }
}

/// A bound of ‖E‖ for symmetric E with |E_ij| ≤ `entry(i, j)`: the largest of (|E| v)_i / v_i for any v > 0 (Collatz and Wielandt), near its least
/// after some steps of the power method.
fn norm(n: usize, entry: &dyn Fn(usize, usize) -> f64) -> f64 {
    let mut v = vec![1.0; n];
    let mut least = f64::INFINITY;
    for _ in 0..POWERS {
        let product = |i: usize| {
            (0..n).fold(Interval::ZERO, |sum, j| sum + Interval::point(entry(i, j)) * Interval::point(v[j]))
        };
        let next: Vec<_> = (0..n).map(product).collect();
        let ratios = next.iter().zip(&v).map(|(x, &v)| (*x / Interval::point(v)).hi());
        least = ratios.fold(0.0, f64::max).min(least);
        let largest = next.iter().map(|x| x.hi()).fold(0.0, f64::max);
        if !(largest > 0.0 && largest.is_finite()) {
            break;
        }
        // Not 0 where a row is.
        v = next.iter().map(|x| x.hi() / largest + 1e-3).collect();
    }
    least
}
