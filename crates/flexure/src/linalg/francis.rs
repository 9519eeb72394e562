//! All eigenvalues of a matrix that is not symmetric: balancing, Hessenberg form, Francis' QR iterations with two shifts at once, all in
//! real numbers. Golub & Van Loan, *Matrix Computations*, 4th ed., chapter 7.

use std::ops::Range;

use super::{Complex, Dense};

/// Iterations for each eigenvalue, or pair of them, after which the matrix is given up: three are usual.
const ITERATIONS: usize = 60;

/// An iteration of so many balances the block again and takes another shift, which breaks cycles.
const EXCEPTIONAL: usize = 10;

/// After so many iterations that do not end twice the error is small enough: 2¹⁵ roundings at the last, of a matrix with equal eigenvalues.
const PATIENCE: usize = 4;

/// All eigenvalues of the square matrix `a`, in no order; none if it is not finite or the iterations do not end.
pub fn spectrum(a: &Dense<f64>) -> Option<Vec<Complex>> {
    let n = a.columns();
    if !a.rows().flatten().all(|x| x.is_finite()) {
        return None;
    }
    let rest = connected(a);
    let apart = (0..n).filter(|i| !rest.contains(i));
    let mut values: Vec<Complex> = apart.map(|i| Complex::real(a[(i, i)])).collect();
    let mut h = hessenberg(balanced(&Dense::from_fn(rest.len(), rest.len(), |i, j| a[(rest[i], rest[j])])));
    // Every iteration has errors of this size.
    let rounding = f64::EPSILON * h.rows().flatten().fold(0.0, |norm: f64, x| norm.hypot(*x));
    let (mut end, mut iterations) = (rest.len(), 0);
    while end > 0 {
        // Of many equal eigenvalues what lies below the diagonal is such errors, and several of them: what takes long gets on with more.
        let patience = f64::from(1_u32 << (iterations / PATIENCE));
        let start = active(&h, end, patience * rounding);
        match end - start {
            1 => values.push(Complex::real(h[(start, start)])),
            2 => values.extend(Corner::of(&h, end).eigenvalues()),
            _ if iterations == ITERATIONS => return None,
            _ => {
                iterations += 1;
                let corner = if iterations % EXCEPTIONAL == 0 {
                    rebalance(&mut h, start..end);
                    Corner::exceptional(&h, end)
                } else {
                    Corner::of(&h, end)
                };
                step(&mut h, start, end, &corner.shifts());
                continue;
            }
        }
        (end, iterations) = (start, 0);
    }
    Some(values)
}

/// What is left of the rows and columns of `a` without those that show their eigenvalue on the diagonal, as nothing else is in their row
/// or in their column: what nobody reads, and what is read once and forgotten.
fn connected(a: &Dense<f64>) -> Vec<usize> {
    let mut rest: Vec<usize> = (0..a.columns()).collect();
    loop {
        let alone = |i: usize, entry: &dyn Fn(usize) -> f64| rest.iter().all(|&j| j == i || entry(j) == 0.0);
        let is_apart = |i: usize| alone(i, &|j| a[(i, j)]) || alone(i, &|j| a[(j, i)]);
        let fewer: Vec<usize> = rest.iter().copied().filter(|&i| !is_apart(i)).collect();
        if fewer.len() == rest.len() {
            return rest;
        }
        rest = fewer;
    }
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

/// Balances a block on the diagonal by itself: what lies outside of it does not change its eigenvalues. Delays leave nearly equal
/// eigenvalues that are far smaller than the entries beside them, and before this no shift comes near enough to one of them.
fn rebalance(h: &mut Dense<f64>, block: Range<usize>) {
    let (from, count) = (block.start, block.len());
    let balanced = balanced(&Dense::from_fn(count, count, |i, j| h[(from + i, from + j)]));
    for (i, row) in block.clone().zip(balanced.rows()) {
        let n = h.columns();
        h.entries_mut()[i * n..][block.clone()].copy_from_slice(row);
    }
}

/// The same eigenvalues with nothing below the first subdiagonal, by Householder's reflections.
fn hessenberg(mut a: Dense<f64>) -> Dense<f64> {
    let n = a.columns();
    let mut along = vec![0.0; n];
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
        // Row by row, as the entries lie.
        along.fill(0.0);
        for (x, row) in v.iter().zip(a.rows().skip(k + 1)) {
            for (sum, entry) in along.iter_mut().zip(row) {
                *sum += x * entry;
            }
        }
        for (x, row) in v.iter().zip(a.entries_mut().chunks_exact_mut(n).skip(k + 1)) {
            let factor = 2.0 / square * x;
            for (entry, sum) in row.iter_mut().zip(&along) {
                *entry -= factor * sum;
            }
        }
        for row in a.entries_mut().chunks_exact_mut(n) {
            let row = &mut row[k + 1..];
            let factor = 2.0 / square * dot(&v, row);
            for (entry, x) in row.iter_mut().zip(&v) {
                *entry -= factor * x;
            }
        }
    }
    Dense::from_fn(n, n, |i, j| if i > j + 1 { 0.0 } else { a[(i, j)] })
}

/// The inner product, in four sums side by side.
fn dot(x: &[f64], y: &[f64]) -> f64 {
    let ((xs, x_left), (ys, y_left)) = (x.as_chunks::<4>(), y.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (x, y) in xs.iter().zip(ys) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    let left: f64 = x_left.iter().zip(y_left).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + left
}

/// Where the last block begins that does not fall apart, of the leading `end` rows: what is `least` in size counts as nothing.
fn active(h: &Dense<f64>, end: usize, least: f64) -> usize {
    (1..end).rev().find(|&i| h[(i, i - 1)].abs() <= least).unwrap_or(0)
}

/// The last 2 × 2 block [[a, b], [c, d]] of some rows.
struct Corner {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
}

/// Shifts σ and τ, which are both real or conjugate to each other.
struct Shifts {
    /// σ + τ.
    sum: f64,
    /// σ τ.
    product: f64,
}

impl Corner {
    /// Of the leading `end` rows.
    fn of(h: &Dense<f64>, end: usize) -> Self {
        let (i, j) = (end - 2, end - 1);
        Self { a: h[(i, i)], b: h[(i, j)], c: h[(j, i)], d: h[(j, j)] }
    }

    /// One in its place that has nothing to do with it but its size, as in LAPACK's `dlahqr`: breaks cycles.
    fn exceptional(h: &Dense<f64>, end: usize) -> Self {
        let size = h[(end - 1, end - 2)].abs() + h[(end - 2, end - 3)].abs();
        let a = h[(end - 1, end - 1)] + 0.75 * size;
        Self { a, b: -0.4375 * size, c: size, d: a }
    }

    fn eigenvalues(&self) -> [Complex; 2] {
        let Self { a, b, c, d } = *self;
        let (middle, half) = (0.5 * (a + d), 0.5 * (a - d));
        let square = half * half + b * c;
        if square < 0.0 {
            let im = (-square).sqrt();
            return [Complex { re: middle, im }, Complex { re: middle, im: -im }];
        }
        // The one that is larger in size, and the other from what it is beside d: no difference of near numbers.
        let root = half + square.sqrt().copysign(half);
        let one = d + root;
        let other = if root == 0.0 { d } else { d - b * c / root };
        [Complex::real(one), Complex::real(other)]
    }

    /// Its eigenvalues; if they are real, twice the one nearer to its last entry.
    fn shifts(&self) -> Shifts {
        let [one, other] = self.eigenvalues();
        if one.im != 0.0 {
            return Shifts { sum: one.re + other.re, product: one.re * one.re + one.im * one.im };
        }
        let near = if (one.re - self.d).abs() < (other.re - self.d).abs() { one.re } else { other.re };
        Shifts { sum: 2.0 * near, product: near * near }
    }
}

/// (H − σ) (H − τ) = Q R makes Qᵀ H Q of H, on the rows from `start` to `end`, of which there are at least three: Q begins as its first
/// column does, and the rest of it follows from what keeps the form.
fn step(h: &mut Dense<f64>, start: usize, end: usize, shifts: &Shifts) {
    // From the last row where that may begin: on its way through small entries above, the shift would be lost in rounding.
    let begins = |k: usize| {
        let x = shifts.first_column(h, k);
        let size = h[(k - 1, k - 1)].abs() + h[(k, k)].abs() + h[(k + 1, k + 1)].abs();
        h[(k, k - 1)].abs() * (x[1].abs() + x[2].abs()) <= f64::EPSILON * x[0].abs() * size
    };
    let begin = (start + 1..end - 2).rev().find(|&k| begins(k)).unwrap_or(start);
    let mut x = shifts.first_column(h, begin);
    for k in begin..end - 1 {
        let count = 3.min(end - k);
        if let Some(reflection) = Reflection::of(x) {
            reflection.rows(h, k, count, k.saturating_sub(1).max(start)..end);
            reflection.columns(h, k, count, start..end.min(k + 4));
        }
        if k > start {
            for i in k + 1..k + count {
                h[(i, k - 1)] = 0.0;
            }
        }
        x = [1, 2, 3].map(|i| if k + i < end { h[(k + i, k)] } else { 0.0 });
    }
}

impl Shifts {
    /// The first column of (H − σ) (H − τ) of H from row `k` on.
    fn first_column(&self, h: &Dense<f64>, k: usize) -> [f64; 3] {
        let (a, b, c, d) = (h[(k, k)], h[(k, k + 1)], h[(k + 1, k)], h[(k + 1, k + 1)]);
        [a * (a - self.sum) + self.product + b * c, c * (a + d - self.sum), c * h[(k + 2, k + 1)]]
    }
}

/// Householder's reflection 1 − v wᵀ of three numbers.
struct Reflection {
    v: [f64; 3],
    w: [f64; 3],
}

impl Reflection {
    /// The one that leaves of `x` the first alone; none for zeros.
    fn of(x: [f64; 3]) -> Option<Self> {
        let scale = x.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        if scale == 0.0 {
            return None;
        }
        let mut v = x.map(|x| x / scale);
        let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        v[0] += length.copysign(v[0]);
        let factor = 2.0 / (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        Some(Self { v, w: v.map(|v| factor * v) })
    }

    /// Reflects `count` rows from row `k` on.
    fn rows(&self, h: &mut Dense<f64>, k: usize, count: usize, columns: Range<usize>) {
        let n = h.columns();
        let mut rows = h.entries_mut()[k * n..(k + count) * n].chunks_exact_mut(n);
        let mut next = || rows.next().map_or(&mut [][..], |row| &mut row[columns.clone()]);
        let ([x, y, z], [v, w]) = ([next(), next(), next()], [self.v, self.w]);
        if z.is_empty() {
            for (x, y) in x.iter_mut().zip(y) {
                let along = w[0] * *x + w[1] * *y;
                (*x, *y) = (*x - v[0] * along, *y - v[1] * along);
            }
            return;
        }
        for ((x, y), z) in x.iter_mut().zip(y).zip(z) {
            let along = w[0] * *x + w[1] * *y + w[2] * *z;
            (*x, *y, *z) = (*x - v[0] * along, *y - v[1] * along, *z - v[2] * along);
        }
    }

    /// Reflects `count` columns from column `k` on.
    fn columns(&self, h: &mut Dense<f64>, k: usize, count: usize, rows: Range<usize>) {
        let n = h.columns();
        for row in h.entries_mut()[rows.start * n..rows.end * n].chunks_exact_mut(n) {
            let row = &mut row[k..k + count];
            let along: f64 = row.iter().zip(&self.w).map(|(x, w)| x * w).sum();
            for (x, v) in row.iter_mut().zip(&self.v) {
                *x -= v * along;
            }
        }
    }
}
