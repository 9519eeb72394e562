//! Second derivatives over boxes.

use flexure_core::scalar::{Interval, Scalar};
use rayon::prelude::*;

use crate::linalg::Symmetric;

/// The matrices H of second derivatives of several functions of `size` numbers, from their second Taylor coefficients along sums of unit vectors:
/// `along(&[i])` has ½ H_ii for each function, `along(&[i, k])` ½ (H_ii + 2 H_ik + H_kk). Numbers i and k that are `apart` have H_ik = 0 as is known.
pub fn second_derivatives(
    size: usize,
    apart: &(dyn Fn(usize, usize) -> bool + Sync),
    along: &(dyn Fn(&[usize]) -> Vec<Interval> + Sync),
) -> Vec<Symmetric<Interval>> {
    let pairs: Vec<_> = (0..size).flat_map(|i| (0..=i).map(move |k| (i, k))).collect();
    let one = |&(i, k): &(usize, usize)| match (apart(i, k), i == k) {
        (true, _) => Vec::new(),
        (_, true) => along(&[i]),
        _ => along(&[i, k]),
    };
    let found: Vec<_> = pairs.par_iter().map(one).collect();
    let at = |i: usize, k: usize| &found[i * (i + 1) / 2 + k];
    // H_ii of the function j.
    let own = |i: usize, j: usize| at(i, i).get(j).map_or(Interval::ZERO, |&x| x + x);
    let half = Interval::point(0.5);
    let of = |j: usize| {
        Symmetric::from_fn(size, |i, k| match at(i, k).get(j) {
            Some(_) if i == k => own(i, j),
            Some(&both) => both - half * (own(i, j) + own(k, j)),
            None => Interval::ZERO,
        })
    };
    (0..found.iter().map(Vec::len).max().unwrap_or(0)).map(of).collect()
}

#[cfg(test)]
mod tests {
    use flexure_core::scalar::{Interval, Jet, Scalar};

    use super::second_derivatives;

    /// x₀² x₁ + sin x₂ and x₁ x₂ at a point: every entry known.
    #[test]
    fn products_have_mixed_derivatives() {
        let at = [0.3, -0.7, 1.1];
        let along = |directions: &[usize]| {
            let x: [Jet<Interval, 3>; 3] = std::array::from_fn(|i| {
                let rate = if directions.contains(&i) { Interval::ONE } else { Interval::ZERO };
                Jet::new([Interval::point(at[i]), rate, Interval::ZERO])
            });
            [x[0] * x[0] * x[1] + x[2].sin_cos().0, x[1] * x[2]].map(|f| f.coefficient(2)).to_vec()
        };
        let found = second_derivatives(3, &|i, k| (i, k) == (2, 0), &along);
        let exact = [
            [[2.0 * at[1], 2.0 * at[0], 0.0], [2.0 * at[0], 0.0, 0.0], [0.0, 0.0, -1.1_f64.sin()]],
            [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
        ];
        for (found, exact) in found.iter().zip(exact) {
            for (i, row) in exact.iter().enumerate() {
                for (k, x) in row.iter().enumerate() {
                    assert!((found.at(i, k).midpoint() - x).abs() < 1e-14, "{i} {k}: {:?}", found.at(i, k));
                }
            }
        }
    }
}
