//! The eigenvalue of largest modulus of a matrix that is not symmetric, and its eigenvectors, by inverse iteration in complex numbers.
//! Golub & Van Loan, *Matrix Computations*, 4th ed., chapter 7.

use super::francis::spectrum;
use super::{Complex, Dense};

/// An eigenvalue λ of a matrix A with its eigenvectors: A r = λ r, lᵀ A = λ lᵀ, lᵀ r = 1.
#[derive(Clone, Debug)]
pub struct Mode {
    /// λ.
    pub value: Complex,
    /// r.
    pub right: Vec<Complex>,
    /// l.
    pub left: Vec<Complex>,
}

impl Mode {
    /// How much the modulus of λ grows when A does by `change`: Re (λ̄ lᵀ ΔA r) / |λ|.
    pub fn growth(&self, change: &Dense<f64>) -> f64 {
        let moved = change
            .rows()
            .map(|row| row.iter().zip(&self.right).fold(Complex::ZERO, |sum, (&x, r)| sum + r.scaled(x)));
        let slope = moved.zip(&self.left).fold(Complex::ZERO, |sum, (x, l)| sum + x * *l);
        (self.value.conjugate() * slope).re / self.value.abs()
    }
}

/// Largest modulus of the eigenvalues of the square matrix `a`; NaN if it is not finite.
pub fn spectral_radius(a: &Dense<f64>) -> f64 {
    dominant(a).map_or(f64::NAN, Complex::abs)
}

/// The eigenvalue of the square matrix `a` with the largest modulus; none if it is not finite.
pub fn dominant(a: &Dense<f64>) -> Option<Complex> {
    let values = spectrum(a)?;
    values.into_iter().max_by(|x, y| x.abs().total_cmp(&y.abs()))
}

/// The eigenvalue with the largest modulus, with its eigenvectors; none if there is no such matrix, or none of them.
pub fn dominant_mode(a: &Dense<f64>) -> Option<Mode> {
    let value = dominant(a)?;
    let n = a.columns();
    let right = eigenvector(n, |i, j| a[(i, j)], value)?;
    let left = eigenvector(n, |i, j| a[(j, i)], value)?;
    let product = left.iter().zip(&right).fold(Complex::ZERO, |sum, (l, r)| sum + *l * *r);
    let left: Vec<_> = left.into_iter().map(|l| l / product).collect();
    let finite = left.iter().all(|l| l.abs().is_finite());
    finite.then_some(Mode { value, right, left })
}

/// Part of the size of the matrix by which an eigenvalue is missed on purpose: what is left can be solved.
const MISSED: f64 = 1e-10;

/// A vector of length 1 with `entry` · v = `value` · v, by inverse iteration.
fn eigenvector(n: usize, entry: impl Fn(usize, usize) -> f64, value: Complex) -> Option<Vec<Complex>> {
    let shift = value + Complex { re: MISSED * value.abs(), im: MISSED * value.abs() };
    let diagonal = |i, j| if i == j { shift } else { Complex::ZERO };
    let shifted = Dense::from_fn(n, n, |i, j| Complex::real(entry(i, j)) - diagonal(i, j));
    // No eigenvector is likely to have nothing of these.
    let mut v: Vec<_> = (0..n).map(|i| Complex { re: 1.0, im: 0.1 * (i % 7) as f64 }).collect();
    for _ in 0..4 {
        v = solve(shifted.clone(), v);
        let length = v.iter().map(|x| x.abs()).fold(0.0, f64::hypot);
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        for x in &mut v {
            *x = x.scaled(1.0 / length);
        }
    }
    Some(v)
}

/// x with `a` x = `b`, by elimination with the largest pivot of each column.
fn solve(mut a: Dense<Complex>, mut b: Vec<Complex>) -> Vec<Complex> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[(i, k)].abs().total_cmp(&a[(j, k)].abs())).unwrap_or(k);
        b.swap(k, pivot);
        for j in k..n {
            let (x, y) = (a[(k, j)], a[(pivot, j)]);
            (a[(k, j)], a[(pivot, j)]) = (y, x);
        }
        for i in k + 1..n {
            let factor = a[(i, k)] / a[(k, k)];
            for j in k..n {
                a[(i, j)] = a[(i, j)] - factor * a[(k, j)];
            }
            b[i] = b[i] - factor * b[k];
        }
    }
    for i in (0..n).rev() {
        let known = (i + 1..n).fold(Complex::ZERO, |sum, j| sum + a[(i, j)] * b[j]);
        b[i] = (b[i] - known) / a[(i, i)];
    }
    b
}

#[cfg(test)]
mod tests {
    use super::{Complex, Dense, dominant_mode, spectral_radius, spectrum};

    /// Numbers that repeat, between −1 and 1.
    fn noise(mut seed: u64) -> impl FnMut() -> f64 {
        move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    fn random(n: usize, seed: u64) -> Dense<f64> {
        let mut noise = noise(seed);
        Dense::from_fn(n, n, |_, _| noise())
    }

    #[test]
    fn a_companion_matrix_has_the_roots_of_its_polynomial() {
        // (x − 2) (x + 5) (x² + 4) = x⁴ + 3 x³ − 6 x² + 12 x − 40
        let c = Dense::from_columns(&[
            vec![0.0, 0.0, 0.0, 40.0],
            vec![1.0, 0.0, 0.0, -12.0],
            vec![0.0, 1.0, 0.0, 6.0],
            vec![0.0, 0.0, 1.0, -3.0],
        ]);
        let found = spectrum(&c).unwrap();
        for root in [Complex::real(2.0), Complex::real(-5.0), Complex { re: 0.0, im: 2.0 }] {
            assert!(found.iter().any(|x| (*x - root).abs() < 1e-13), "{root:?} in {found:?}");
        }
    }

    /// The invariants of a similarity: the sum of the eigenvalues and of their squares are traces of A and A².
    #[test]
    fn eigenvalues_keep_the_traces() {
        for (n, seed) in [(1, 1), (2, 2), (3, 3), (8, 4), (40, 5), (90, 6)] {
            let a = random(n, seed);
            let found = spectrum(&a).unwrap();
            let trace = |a: &Dense<f64>| (0..n).map(|i| a[(i, i)]).sum::<f64>();
            let sum =
                |power: fn(Complex) -> Complex| found.iter().fold(Complex::ZERO, |sum, x| sum + power(*x));
            let tolerance = 1e-13 * (n * n) as f64;
            assert!((sum(|x| x) - Complex::real(trace(&a))).abs() < tolerance);
            assert!((sum(|x| x * x) - Complex::real(trace(&(&a * &a)))).abs() < tolerance);
        }
    }

    /// What delays, held readings and oscillators make: nilpotent blocks, turns that no shift moves, equal pairs.
    #[test]
    fn shifts_end_where_they_are_all_alike() {
        for n in [2, 3, 5, 8, 31] {
            let late = Dense::from_fn(n, n, |i, j| f64::from(u8::from(i == j + 1)));
            assert!(spectrum(&late).unwrap().iter().all(|x| x.abs() < 1e-300), "{n} instants of delay");
            // The roots of 1: a delay whose end is its beginning.
            let turn = Dense::from_fn(n, n, |i, j| f64::from(u8::from(i == (j + 1) % n)));
            let roots = spectrum(&turn).unwrap();
            for k in 0..n {
                let angle = std::f64::consts::TAU * k as f64 / n as f64;
                let root = Complex { re: angle.cos(), im: angle.sin() };
                assert!(roots.iter().any(|x| (*x - root).abs() < 1e-13), "{root:?} of {n}");
            }
            // Equal oscillators that do not know of each other, turned so that nobody sees it.
            let q = random(n, 10 + n as u64);
            let mix =
                Dense::from_fn(
                    2 * n,
                    2 * n,
                    |i, j| if i == j { 1.0 } else { 0.1 / n as f64 * q[(i / 2, j / 2)] },
                );
            let equal = Dense::from_fn(2 * n, 2 * n, |i, j| match (i / 2 == j / 2, i % 2, j % 2) {
                (false, ..) => 0.0,
                (true, 0, 1) => -1.0,
                (true, 1, 0) => 1.0,
                _ => 0.5,
            });
            let found = spectrum(&similar(&equal, &mix)).unwrap();
            assert!(found.iter().all(|x| (x.re - 0.5).abs() < 1e-10 && (x.im.abs() - 1.0).abs() < 1e-10));
        }
    }

    /// What is late by some instants grows and shrinks like what it follows, however the numbers are mixed: half of the eigenvalues are 0,
    /// with few eigenvectors, and rounding moves them a lot.
    #[test]
    fn delays_leave_the_radius_alone() {
        let (own, chains, late) = (6, 5, 5);
        let n = own + chains * late;
        for seed in 0..200 {
            let (lead, follows, mix) = (random(own, seed), random(n, seed + 1000), random(n, seed + 2000));
            let a = Dense::from_fn(n, n, |i, j| match (i < own, j < own) {
                (true, true) => lead[(i, j)],
                (true, false) => 0.0,
                (false, _) if (i - own) % late == 0 => {
                    if j < own {
                        follows[(i, j)]
                    } else {
                        0.0
                    }
                }
                _ => f64::from(u8::from(i == j + 1)),
            });
            let mix = Dense::from_fn(n, n, |i, j| f64::from(u8::from(i == j)) + 0.1 * mix[(i, j)]);
            let (all, alone) = (spectral_radius(&similar(&a, &mix)), spectral_radius(&lead));
            assert!((all - alone).abs() < 1e-9 * alone, "{seed}: {all} {alone}");
        }
    }

    /// As many conserved quantities as joints: eigenvalues 1 whose eigenvectors there are, beside as many that nearly vanish and others, in
    /// coordinates at random. Rounding spreads the equal ones, by much less than this where the others couple to them as here.
    #[test]
    fn equal_eigenvalues_are_found() {
        let n = 7;
        let m = 3 * n;
        for seed in 0..50 {
            let mut r = noise(seed);
            let mut a = Dense::from_fn(m, m, |i, j| match (i, j) {
                _ if i > j || i != j && j < n => 0.0,
                _ if i != j => r(),
                _ if i < n => 1.0,
                _ if i < 2 * n => 1e-9 * r(),
                _ => 0.9 * r(),
            });
            for _ in 0..m {
                let v: Vec<f64> = (0..m).map(|_| r()).collect();
                let square: f64 = v.iter().map(|x| x * x).sum();
                let mirror =
                    Dense::from_fn(m, m, |i, j| f64::from(u8::from(i == j)) - 2.0 / square * v[i] * v[j]);
                a = &(&mirror * &a) * &mirror;
            }
            assert!((spectral_radius(&a) - 1.0).abs() < 1e-11, "{seed}: {}", spectral_radius(&a));
        }
    }

    /// T A T⁻¹.
    fn similar(a: &Dense<f64>, t: &Dense<f64>) -> Dense<f64> {
        let n = a.columns();
        let (ta, complex) = (t * a, Dense::from_fn(n, n, |i, j| Complex::real(t[(j, i)])));
        // Rows x of the result with x T = a row of T A.
        let rows: Vec<Vec<Complex>> = ta
            .rows()
            .map(|row| super::solve(complex.clone(), row.iter().map(|&x| Complex::real(x)).collect()))
            .collect();
        Dense::from_fn(n, n, |i, j| rows[i][j].re)
    }

    #[test]
    fn badly_scaled_matrices_are_balanced_first() {
        let a = random(6, 7);
        let scale = |i: usize| 10.0_f64.powi(4 * i32::try_from(i).unwrap() - 10);
        let scaled = Dense::from_fn(6, 6, |i, j| a[(i, j)] * scale(i) / scale(j));
        let [plain, scaled] = [&a, &scaled].map(spectral_radius);
        assert!((plain - scaled).abs() < 1e-13 * plain, "{plain} {scaled}");
    }

    #[test]
    fn a_mode_is_one_and_says_how_its_modulus_moves() {
        let (a, change) = (random(12, 8), random(12, 9));
        let mode = dominant_mode(&a).unwrap();
        for (row, r) in a.rows().zip(&mode.right) {
            let moved = row.iter().zip(&mode.right).fold(Complex::ZERO, |sum, (&x, r)| sum + r.scaled(x));
            assert!((moved - mode.value * *r).abs() < 1e-12);
        }
        let h = 1e-6;
        let moved = |h: f64| spectral_radius(&(&a + &change.scaled(h)));
        let slope = (moved(h) - moved(-h)) / (2.0 * h);
        assert!((slope - mode.growth(&change)).abs() < 1e-8 * slope.abs().max(1.0));
    }

    #[test]
    fn what_is_not_finite_has_no_spectrum() {
        assert!(spectrum(&Dense::from_columns(&[vec![f64::NAN]])).is_none());
        assert!(spectral_radius(&Dense::from_columns(&[vec![f64::INFINITY]])).is_nan());
        // Jordan's block: a double eigenvalue with one eigenvector, which no mode can be scaled to.
        let jordan = Dense::from_columns(&[vec![1.0, 0.0], vec![1.0, 1.0]]);
        assert!((spectral_radius(&jordan) - 1.0).abs() < 1e-7);
    }
}
