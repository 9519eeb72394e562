//! Eigenvalues and eigenvectors of symmetric matrices by cyclic Jacobi rotations. Golub & Van Loan, *Matrix Computations*,
//! 4th ed., section 8.5. Accurate also where some eigenvalues are equal.

use super::{Dense, Leading};

/// Convergence is quadratic: six sweeps reach rounding for the sizes of robots.
const SWEEPS: usize = 6;

/// Sweeps for the larger matrices whose eigenvectors are asked for, at most, and what may be left of the entries off the
/// diagonal: the sum of their squares as a part of that of all entries.
const SWEEPS_WITH_VECTORS: usize = 8;
const REST: f64 = 1e-36;

/// The eigenvalues of the symmetric matrix `a`, in no order. Its storage is used up: no allocation.
pub fn eigenvalues(mut a: Leading<'_>) -> impl Iterator<Item = f64> {
    for _ in 0..SWEEPS {
        if !sweep(&mut a, None) {
            break;
        }
    }
    (0..a.size()).map(move |i| a[(i, i)])
}

/// Diagonalises the symmetric matrix `a`: its diagonal holds the eigenvalues afterwards, in no order. Column k of what it
/// returns is the eigenvector of length 1 to eigenvalue k.
pub fn eigenvectors(mut a: Leading<'_>) -> Dense<f64> {
    let n = a.size();
    let mut vectors = Dense::from_fn(n, n, |i, j| if i == j { 1.0 } else { 0.0 });
    let all = |a: &Leading<'_>| -> f64 {
        (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|at| a[at] * a[at]).sum()
    };
    let below = |a: &Leading<'_>| -> f64 {
        (0..n).flat_map(|i| (0..i).map(move |j| (i, j))).map(|at| a[at] * a[at]).sum()
    };
    let size = all(&a);
    for _ in 0..SWEEPS_WITH_VECTORS {
        if below(&a) <= REST * size {
            break;
        }
        sweep(&mut a, Some(&mut vectors));
    }
    vectors
}

/// Turns each pair of axes once so that its entry off the diagonal vanishes; `vectors` are turned along. False if nothing
/// was left to turn.
fn sweep(a: &mut Leading<'_>, mut vectors: Option<&mut Dense<f64>>) -> bool {
    let n = a.size();
    let mut turned = false;
    for p in 0..n {
        for q in p + 1..n {
            if a[(p, q)] == 0.0 {
                continue;
            }
            turned = true;
            let tau = (a[(q, q)] - a[(p, p)]) / (2.0 * a[(p, q)]);
            let t = tau.signum() / (tau.abs() + tau.hypot(1.0));
            let c = 1.0 / t.hypot(1.0);
            let s = t * c;
            let turn = |x: f64, y: f64| (c * x - s * y, s * x + c * y);
            for k in 0..n {
                (a[(k, p)], a[(k, q)]) = turn(a[(k, p)], a[(k, q)]);
            }
            for k in 0..n {
                (a[(p, k)], a[(q, k)]) = turn(a[(p, k)], a[(q, k)]);
            }
            if let Some(vectors) = vectors.as_deref_mut() {
                for k in 0..n {
                    (vectors[(k, p)], vectors[(k, q)]) = turn(vectors[(k, p)], vectors[(k, q)]);
                }
            }
        }
    }
    turned
}

#[cfg(test)]
mod tests {
    use super::{Dense, Leading, eigenvalues, eigenvectors};

    fn sorted(a: Leading<'_>) -> Vec<f64> {
        let mut values: Vec<f64> = eigenvalues(a).collect();
        values.sort_by(f64::total_cmp);
        values
    }

    /// Symmetric matrices of numbers from −1 to 1, always the same.
    fn random(n: usize, seed: u64) -> Dense<f64> {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let half = Dense::from_fn(n, n, |_, _| next());
        Dense::from_fn(n, n, |i, j| half[(i.max(j), i.min(j))])
    }

    /// The second-difference matrix: 2 − 2 cos(kπ/(n+1)).
    #[test]
    fn eigenvalues_of_a_path_graph() {
        for n in 1..=16_u32 {
            let size = n as usize;
            let mut a = Dense::from_fn(size, size, |i, j| match i.abs_diff(j) {
                0 => 2.0,
                1 => -1.0,
                _ => 0.0,
            });
            for (k, value) in (1..).zip(sorted(Leading::whole(&mut a))) {
                let exact = 2.0 - 2.0 * (f64::from(k) * std::f64::consts::PI / f64::from(n + 1)).cos();
                assert!((value - exact).abs() < 2e-14, "{value} against {exact}, {n}");
            }
        }
    }

    /// ½ (a + c) ± √(¼ (a − c)² + b²), equal eigenvalues and a diagonal matrix among them.
    #[test]
    fn two_by_two_in_closed_form() {
        for [a, b, c] in [[4.0, 1.0, -2.0], [3.0, 0.0, 5.0], [2.0, 2.0, 2.0], [1.0, 1e-9, 1.0], [0.0; 3]] {
            let (middle, radius): (f64, f64) = (0.5 * (a + c), f64::hypot(0.5 * (a - c), b));
            let found = sorted(Leading::of(&mut [[a, b], [b, c]], 2));
            for (found, exact) in found.into_iter().zip([middle - radius, middle + radius]) {
                assert!((found - exact).abs() < 4e-15, "{found} against {exact}");
            }
        }
    }

    /// Sums of powers of the eigenvalues are traces of powers of the matrix, up to the size where robots end.
    #[test]
    fn traces_of_powers() {
        for n in [1, 2, 3, 7, 12, 16, 28] {
            let mut a = random(n, 3 + n as u64);
            let trace: f64 = (0..n).map(|i| a[(i, i)]).sum();
            let squares: f64 = a.rows().flatten().map(|x| x * x).sum();
            let values: Vec<f64> = eigenvalues(Leading::whole(&mut a)).collect();
            let tolerance = 1e-14 * n as f64;
            assert!((values.iter().sum::<f64>() - trace).abs() < tolerance, "{n}");
            assert!((values.iter().map(|x| x * x).sum::<f64>() - squares).abs() < tolerance * squares, "{n}");
        }
    }

    /// Without vectors there are fewer sweeps: enough for more joints than robots have.
    #[test]
    fn few_sweeps_suffice() {
        for (n, seed) in (1..=16).flat_map(|n| (0..20).map(move |seed| (n, seed))) {
            let mut a = random(n, 100 * n as u64 + seed);
            let mut diagonal = a.clone();
            eigenvectors(Leading::whole(&mut diagonal));
            let mut exact: Vec<f64> = (0..n).map(|i| diagonal[(i, i)]).collect();
            exact.sort_by(f64::total_cmp);
            for (found, exact) in sorted(Leading::whole(&mut a)).into_iter().zip(exact) {
                assert!((found - exact).abs() < 1e-14 * n as f64, "{found} against {exact}, {n}");
            }
        }
    }

    /// What lies outside the leading block changes nothing, and is not changed.
    #[test]
    fn the_leading_block_counts_alone() {
        let mut exact = random(5, 11);
        let mut padded = [[f64::NAN; 8]; 8];
        for (row, from) in padded.iter_mut().zip(exact.rows()) {
            row[..5].copy_from_slice(from);
        }
        assert_eq!(sorted(Leading::of(&mut padded, 5)), sorted(Leading::whole(&mut exact)));
        let outside = |i: usize, j: usize| i >= 5 || j >= 5;
        assert!((0..64).filter(|k| outside(k / 8, k % 8)).all(|k| padded[k / 8][k % 8].is_nan()));
    }

    /// A v = λ v, the vectors orthonormal.
    #[test]
    fn residuals_of_eigenvectors() {
        for n in [1, 2, 6, 16, 28] {
            let a = random(n, 40 + n as u64);
            let mut diagonal = a.clone();
            let vectors = eigenvectors(Leading::whole(&mut diagonal));
            let bound = 1e-14 * n as f64;
            for (k, l) in (0..n).flat_map(|k| (0..n).map(move |l| (k, l))) {
                let image: f64 = a.row(k).iter().enumerate().map(|(j, x)| x * vectors[(j, l)]).sum();
                assert!((image - diagonal[(l, l)] * vectors[(k, l)]).abs() < bound, "{n}");
                let inner: f64 = vectors.rows().map(|row| row[k] * row[l]).sum();
                assert!((inner - f64::from(u8::from(k == l))).abs() < bound, "{n}");
            }
        }
    }
}
