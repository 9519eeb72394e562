//! Inverse mass matrices over slab and tube, of the model and of robots whose links are heavier or lighter.
//!
//! With numbers N = L Lᵀ about it, the model's is L (1 + E) Lᵀ with ‖E‖ ≤ ε. Masses that are by parts of at most μ off have
//! (1 − μ) M_l ≤ M'_l ≤ (1 + μ) M_l, so that M'_l⁻¹ has all of L (1 ± ε) Lᵀ / (1 ∓ μ), and M'_l⁻¹ − M_l⁻¹ is between −μ/(1 + μ) and μ/(1 − μ) times
//! M_l⁻¹.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric, cholesky, lower_inverse};
use crate::prove::engine::envelope::shape::congruent;

/// Steps of the power method.
const POWERS: usize = 6;

/// L (c + E) Lᵀ with ‖E‖ ≤ r.
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
    /// ε: of the model's, about 1.
    pub model: Interval,
    /// Of the robot's.
    pub robot: About,
    /// Of the robot's less the model's.
    pub more: About,
}

impl Masses {
    /// From M_l⁻¹ over slab and tube, and by which parts masses may be off.
    pub fn new(inverse_mass: &Symmetric<Interval>, parts: &[Interval]) -> Self {
        let (n, one) = (inverse_mass.size(), Interval::ONE);
        // Where that does not exist nothing is bounded, with any numbers.
        let root = cholesky(&inverse_mass.map(Interval::midpoint)).unwrap_or_else(|| Dense::identity(n));
        let scaled = congruent(&lower_inverse(&root), inverse_mass);
        let off = |i: usize, j: usize| scaled.at(i, j) - if i == j { one } else { Interval::ZERO };
        let model = Interval::point(norm(n, &|i, j| off(i, j).magnitude()));
        let mu = Interval::point(parts.iter().map(|part| part.magnitude()).fold(0.0, f64::max));
        let [least, most] = [(one - model) / (one + mu), (one + model) / (one - mu)];
        let robot = about(least, most);
        let more = if mu.magnitude() == 0.0 {
            About { middle: Interval::ZERO, radius: Interval::ZERO }
        } else {
            let About { middle, radius } = about(-mu / (one + mu), mu / (one - mu));
            About { middle, radius: Interval::point(middle.magnitude()) * model + radius * (one + model) }
        };
        Self { root, model, robot, more }
    }
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

/// All from `least` to `most`.
fn about(least: Interval, most: Interval) -> About {
    let half = Interval::point(0.5);
    let middle = Interval::point(((least + most) * half).midpoint());
    let radius = (most - middle).hi().max((middle - least).hi());
    About { middle, radius: Interval::point(radius) }
}
