//! Whether every matrix of an interval matrix is positive definite.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric, cholesky, lower_inverse};

/// The answer for one interval matrix.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Definite {
    /// All of its matrices are positive definite.
    Yes,
    /// Not shown. With how much the uncertainty of row or column i counts, where the midpoint is positive definite.
    Unknown(Option<Vec<f64>>),
}

/// Tries elimination on `a` as it is, then on R `a` Rᵀ with R the inverse factor of the midpoint. R is triangular with
/// positive diagonal, hence regular: the one is positive definite if the other is, whatever rounding did to R.
pub(crate) fn definite(a: &Symmetric<Interval>) -> Definite {
    if a.smallest_pivot() > 0.0 {
        return Definite::Yes;
    }
    let Some(root) = cholesky(&a.map(Interval::midpoint)).map(|lower| lower_inverse(&lower)) else {
        return Definite::Unknown(None);
    };
    let regular = (0..a.size()).all(|i| root[(i, i)] > 0.0 && root.row(i).iter().all(|x| x.is_finite()));
    if !regular {
        return Definite::Unknown(None);
    }
    let preconditioned = congruent(a, &root);
    if dominant(&preconditioned) || preconditioned.smallest_pivot() > 0.0 {
        return Definite::Yes;
    }
    // An entry's width reaches R a Rᵀ through column i of R from one side, and column j from the other.
    let reach = |j: usize| root.rows().map(|row| row[j].abs()).sum();
    Definite::Unknown(Some((0..a.size()).map(reach).collect()))
}

/// R `a` Rᵀ for a lower triangular R. What multiplies an entry of `a` is summed first: each is used once.
fn congruent(a: &Symmetric<Interval>, root: &Dense<f64>) -> Symmetric<Interval> {
    let product = |x: f64, y: f64| Interval::point(x) * Interval::point(y);
    Symmetric::from_fn(a.size(), |i, j| {
        let mut sum = Interval::ZERO;
        for k in 0..=i {
            for l in 0..=k.min(j) {
                let mut factor = product(root[(i, k)], root[(j, l)]);
                if l < k && k <= j {
                    factor += product(root[(i, l)], root[(j, k)]);
                }
                sum += a.at(k, l) * factor;
            }
        }
        sum
    })
}

/// Whether a_ii x_i > Σ_j |a_ij| x_j for some x > 0: diagonally dominant after a scaling, hence positive definite.
fn dominant(a: &Symmetric<Interval>) -> bool {
    let n = a.size();
    let off = |i: usize| (0..n).filter(move |&j| j != i);
    // Towards the eigenvector of the scaled off-diagonal part, damped: it is no wrong x, only a better or a worse one.
    let mut x = vec![1.0; n];
    for _ in 0..8 {
        let next: Vec<f64> = (0..n)
            .map(|i| {
                let others: f64 = off(i).map(|j| a.at(i, j).magnitude() * x[j]).sum();
                x[i] + others / a.at(i, i).lo()
            })
            .collect();
        let largest = next.iter().fold(0.0, |m: f64, y| m.max(*y));
        x = next.iter().map(|y| (y / largest).max(1e-100)).collect();
    }
    (0..n).all(|i| {
        let mut margin = Interval::point(a.at(i, i).lo()) * Interval::point(x[i]);
        for j in off(i) {
            margin -= Interval::point(a.at(i, j).magnitude()) * Interval::point(x[j]);
        }
        x[i] > 0.0 && margin.lo() > 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::{Definite, Dense, Interval, Symmetric, cholesky, congruent, definite, dominant};

    fn around(x: f64, radius: f64) -> Interval {
        Interval::new(x - radius, x + radius).expect("ordered")
    }

    /// Ill-conditioned with wide entries: elimination alone loses it, preconditioning does not.
    #[test]
    fn preconditioning_decides_more() {
        let (n, size) = (6, |i: usize| 10_f64.powi(i32::try_from(i).unwrap()));
        let entry = |radius: f64| {
            move |i: usize, j: usize| {
                let gap = i - j;
                let value: f64 = if gap == 0 { 1.0 } else { 0.9_f64.powi(i32::try_from(gap).unwrap()) };
                around(value * size(i) * size(j), radius * size(i) * size(j))
            }
        };
        // The least eigenvalue of 0.9^|i−j| is about 0.054, and the radius of all ones adds up to n times an entry's.
        let inside = Symmetric::from_fn(n, entry(0.005));
        assert!(inside.smallest_pivot() <= 0.0, "too easy");
        assert_eq!(definite(&inside), Definite::Yes);
        assert!(matches!(definite(&Symmetric::from_fn(n, entry(0.06))), Definite::Unknown(_)));
    }

    #[test]
    fn indefinite_and_unbounded_matrices_are_not_definite() {
        let swap = |i: usize, j: usize| Interval::point(if i == j { 1.0 } else { 1.0 + 1e-15 });
        assert_eq!(definite(&Symmetric::from_fn(2, swap)), Definite::Unknown(None));
        let entire = Symmetric::from_fn(3, |i, j| if i == j { around(2.0, 1.0) } else { Interval::ENTIRE });
        assert!(matches!(definite(&entire), Definite::Unknown(_)));
        assert!(!dominant(&entire));
        let zero = Symmetric::from_fn(2, |_, _| Interval::point(0.0));
        assert!(matches!(definite(&zero), Definite::Unknown(_)) && !dominant(&zero));
    }

    /// Dominant only after scaling.
    #[test]
    fn scaled_dominance() {
        let entries = [[1.0, 0.0], [9.0, 100.0]];
        assert!(dominant(&Symmetric::from_fn(2, |i, j| Interval::point(entries[i][j]))));
        let entries = [[1.0, 0.0], [11.0, 100.0]];
        assert!(!dominant(&Symmetric::from_fn(2, |i, j| Interval::point(entries[i][j]))));
    }

    /// It is the lower end of the diagonal that counts.
    #[test]
    fn wide_diagonals() {
        let wide = |i: usize, j: usize| if i == j { around(1.5, 1.0) } else { Interval::point(0.75) };
        assert!(!dominant(&Symmetric::from_fn(2, wide)));
        assert!(matches!(definite(&Symmetric::from_fn(2, wide)), Definite::Unknown(_)));
    }

    /// R A Rᵀ by hand.
    #[test]
    fn congruence() {
        let a = Symmetric::from_fn(3, |i, j| Interval::point((1 + 4 * i + 2 * j) as f64));
        let rows = [[2.0, 0.0, 0.0], [-1.0, 3.0, 0.0], [5.0, -2.0, 1.0]];
        let root = Dense::from_fn(3, 3, |i, j| rows[i][j]);
        let got = congruent(&a, &root);
        for (i, row) in rows.iter().enumerate() {
            for (j, other) in rows.iter().enumerate() {
                let product = |k: usize, l: usize| row[k] * a.at(k, l).midpoint() * other[l];
                let sum: f64 = (0..9).map(|k| product(k / 3, k % 3)).sum();
                assert_eq!(got.at(i, j), Interval::point(sum), "({i}, {j})");
            }
        }
    }

    /// Random matrices around the border: of those found definite, every corner that is tried is.
    #[test]
    fn corners_of_what_is_definite_are_definite() {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let mut decided = 0;
        for _ in 0..2_000 {
            let entries: Vec<Interval> = (0..16).map(|_| around(next(), 0.3 * next().abs())).collect();
            let shift = Interval::point(1.5);
            let entry =
                |i: usize, j: usize| entries[4 * i + j] + if i == j { shift } else { Interval::point(0.0) };
            let matrix = Symmetric::from_fn(4, entry);
            if definite(&matrix) != Definite::Yes {
                continue;
            }
            decided += 1;
            for _ in 0..40 {
                let corner = Symmetric::from_fn(4, |i, j| {
                    let x = matrix.at(i, j);
                    if next() > 0.0 { x.lo() } else { x.hi() }
                });
                assert!(cholesky(&corner).is_some(), "{corner:?}");
            }
        }
        assert!((200..1_800).contains(&decided), "{decided}");
    }
}
