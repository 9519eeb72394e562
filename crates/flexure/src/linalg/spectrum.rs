//! Eigenvalues of matrices that are not symmetric: balancing, Hessenberg form, QR iterations with Wilkinson's shift in
//! complex numbers; an eigenvector by inverse iteration. Golub & Van Loan, *Matrix Computations*, 4th ed., chapter 7.

use super::{Complex, Dense};

/// Iterations for each eigenvalue after which the matrix is given up: three are usual.
const ITERATIONS: usize = 60;

/// An iteration of so many takes another shift, which breaks cycles.
const EXCEPTIONAL: usize = 10;

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

/// All eigenvalues of the square matrix `a`, in no order; none if it is not finite or the iterations do not end.
pub fn spectrum(a: &Dense<f64>) -> Option<Vec<Complex>> {
    let n = a.columns();
    if !a.rows().flatten().all(|x| x.is_finite()) {
        return None;
    }
    let mut h = hessenberg(balanced(a));
    let mut end = n;
    let mut iterations = 0;
    while end > 1 {
        let start = active(&h, end);
        if start + 1 == end {
            (end, iterations) = (end - 1, 0);
            continue;
        }
        if iterations == ITERATIONS {
            return None;
        }
        iterations += 1;
        let shift = if iterations % EXCEPTIONAL == 0 {
            h[(end - 1, end - 1)] + Complex::real(h[(end - 1, end - 2)].abs())
        } else {
            wilkinson(&h, end)
        };
        step(&mut h, start, end, shift);
    }
    Some((0..n).map(|i| h[(i, i)]).collect())
}

/// Scales rows and columns by powers of two until they are of like size.
fn balanced(a: &Dense<f64>) -> Dense<f64> {
    let n = a.columns();
    let mut a = a.clone();
    for _ in 0..100 {
        let mut done = true;
        for i in 0..n {
            let others = |entry: &dyn Fn(usize) -> f64| -> f64 {
                (0..n).filter(|&j| j != i).map(|j| entry(j).abs()).sum()
            };
            let (column, row) = (others(&|j| a[(j, i)]), others(&|j| a[(i, j)]));
            if column == 0.0 || row == 0.0 {
                continue;
            }
            let factor = (0.5 * (row / column).log2()).round().clamp(-500.0, 500.0).exp2();
            if column * factor + row / factor < 0.95 * (column + row) {
                done = false;
                for j in 0..n {
                    a[(j, i)] *= factor;
                    a[(i, j)] /= factor;
                }
            }
        }
        if done {
            break;
        }
    }
    a
}

/// The same eigenvalues with nothing below the first subdiagonal, by Householder's reflections.
fn hessenberg(mut a: Dense<f64>) -> Dense<Complex> {
    let n = a.columns();
    for k in 0..n.saturating_sub(2) {
        let mut v: Vec<f64> = (k + 1..n).map(|i| a[(i, k)]).collect();
        let scale = v.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        if scale == 0.0 {
            continue;
        }
        for x in &mut v {
            *x /= scale;
        }
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v[0] += length.copysign(v[0]);
        let square: f64 = v.iter().map(|x| x * x).sum();
        for j in 0..n {
            let along: f64 = v.iter().zip(k + 1..).map(|(x, i)| x * a[(i, j)]).sum();
            for (x, i) in v.iter().zip(k + 1..) {
                a[(i, j)] -= 2.0 * along / square * x;
            }
        }
        for i in 0..n {
            let along: f64 = v.iter().zip(k + 1..).map(|(x, j)| x * a[(i, j)]).sum();
            for (x, j) in v.iter().zip(k + 1..) {
                a[(i, j)] -= 2.0 * along / square * x;
            }
        }
    }
    Dense::from_fn(n, n, |i, j| if i > j + 1 { Complex::ZERO } else { Complex::real(a[(i, j)]) })
}

/// Where the last block begins that does not fall apart, of the leading `end` rows.
fn active(h: &Dense<Complex>, end: usize) -> usize {
    (1..end)
        .rev()
        .find(|&i| {
            let size = h[(i - 1, i - 1)].abs() + h[(i, i)].abs();
            h[(i, i - 1)].abs() <= f64::EPSILON * size.max(f64::MIN_POSITIVE)
        })
        .unwrap_or(0)
}

/// The eigenvalue of the last 2 × 2 block that is nearer to its last entry.
fn wilkinson(h: &Dense<Complex>, end: usize) -> Complex {
    let [a, b, c, d] =
        [(end - 2, end - 2), (end - 2, end - 1), (end - 1, end - 2), (end - 1, end - 1)].map(|at| h[at]);
    let half = (a - d).scaled(0.5);
    let root = (half * half + b * c).sqrt();
    let middle = (a + d).scaled(0.5);
    let (one, other) = (middle + root, middle - root);
    if (one - d).abs() < (other - d).abs() { one } else { other }
}

/// H − μ = Q R becomes R Q + μ, on the rows from `start` to `end`.
fn step(h: &mut Dense<Complex>, start: usize, end: usize, shift: Complex) {
    for i in start..end {
        h[(i, i)] = h[(i, i)] - shift;
    }
    let mut turns = Vec::with_capacity(end - start);
    for k in start..end - 1 {
        let (a, b) = (h[(k, k)], h[(k + 1, k)]);
        let length = a.abs().hypot(b.abs());
        let (c, s) = if length == 0.0 {
            (Complex::real(1.0), Complex::ZERO)
        } else {
            (a.scaled(1.0 / length), b.scaled(1.0 / length))
        };
        for j in k..end {
            let (x, y) = (h[(k, j)], h[(k + 1, j)]);
            h[(k, j)] = c.conjugate() * x + s.conjugate() * y;
            h[(k + 1, j)] = c * y - s * x;
        }
        turns.push((c, s));
    }
    for (k, (c, s)) in (start..).zip(turns) {
        for i in start..end.min(k + 2) {
            let (x, y) = (h[(i, k)], h[(i, k + 1)]);
            h[(i, k)] = x * c + y * s;
            h[(i, k + 1)] = y * c.conjugate() - x * s.conjugate();
        }
    }
    for i in start..end {
        h[(i, i)] = h[(i, i)] + shift;
    }
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
