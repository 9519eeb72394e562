//! Factorisations of symmetric matrices in `f64`: what suggests, and never proves.

use super::{Dense, Leading, Symmetric, eigenvectors};

/// Where elimination leaves its pivots.
#[derive(Clone, Copy, Debug)]
enum Pivots {
    /// Their roots on the diagonal of L: A = L Lᵀ.
    InL,
    /// On the diagonal of D: A = L D Lᵀ, ones on the diagonal of L.
    InD,
}

/// The lower triangular L, row by row, up to the first row whose pivot is not positive and finite; and that row.
fn eliminate(a: &Symmetric<f64>, pivots: Pivots) -> (Dense<f64>, Option<usize>) {
    let n = a.size();
    let mut lower = Dense::from_fn(n, n, |_, _| 0.0);
    let mut d = vec![1.0; n];
    for i in 0..n {
        for j in 0..i {
            let known: f64 = (0..j).map(|k| lower[(i, k)] * lower[(j, k)] * d[k]).sum();
            lower[(i, j)] = (a.at(i, j) - known) / (lower[(j, j)] * d[j]);
        }
        let known: f64 = (0..i).map(|k| lower[(i, k)] * lower[(i, k)] * d[k]).sum();
        let pivot = a.at(i, i) - known;
        if !(pivot > 0.0 && pivot.is_finite()) {
            return (lower, Some(i));
        }
        (lower[(i, i)], d[i]) = match pivots {
            Pivots::InL => (pivot.sqrt(), 1.0),
            Pivots::InD => (1.0, pivot),
        };
    }
    (lower, None)
}

/// The lower triangular L with L Lᵀ = `a`; `None` where rounding finds no positive pivot.
pub fn cholesky(a: &Symmetric<f64>) -> Option<Dense<f64>> {
    let (lower, stopped) = eliminate(a, Pivots::InL);
    stopped.is_none().then_some(lower)
}

/// An x with xᵀ `a` x ≤ 0, x_k = 1 in the row k of the first pivot that is not positive and 0 beyond; `None` where rounding
/// finds no such pivot.
pub fn direction_of_descent(a: &Symmetric<f64>) -> Option<Vec<f64>> {
    let (lower, stopped) = eliminate(a, Pivots::InD);
    // Lᵀ x = e_k gives xᵀ A x = d_k.
    let k = stopped?;
    let mut x = vec![0.0; a.size()];
    x[k] = 1.0;
    for i in (0..k).rev() {
        x[i] = -(i + 1..=k).map(|m| lower[(m, i)] * x[m]).sum::<f64>();
    }
    Some(x)
}

/// The x with L Lᵀ x = `b`.
pub fn solved(lower: &Dense<f64>, b: &[f64]) -> Vec<f64> {
    let mut x = b.to_vec();
    let n = x.len();
    for i in 0..n {
        let known: f64 = (0..i).map(|k| lower[(i, k)] * x[k]).sum();
        x[i] = (x[i] - known) / lower[(i, i)];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| lower[(k, i)] * x[k]).sum();
        x[i] = (x[i] - known) / lower[(i, i)];
    }
    x
}

/// The inverse of a lower triangular matrix.
pub fn lower_inverse(lower: &Dense<f64>) -> Dense<f64> {
    let n = lower.columns();
    let mut inverse = Dense::from_fn(n, n, |_, _| 0.0);
    for i in 0..n {
        inverse[(i, i)] = 1.0 / lower[(i, i)];
        for j in 0..i {
            let known: f64 = (j..i).map(|k| lower[(i, k)] * inverse[(k, j)]).sum();
            inverse[(i, j)] = -known / lower[(i, i)];
        }
    }
    inverse
}

/// The least of dᵀ `a` d / dᵀ `p` d and the direction d where it is, scaled to dᵀ `p` d = 1. `None` where `p` is not positive
/// definite or something is not finite.
pub fn weakest(a: &Symmetric<f64>, p: &Symmetric<f64>) -> Option<(f64, Vec<f64>)> {
    let n = a.size();
    let root = lower_inverse(&cholesky(p)?);
    // L⁻¹ A L⁻ᵀ.
    let half: Dense<f64> = Dense::from_fn(n, n, |i, j| (0..=i).map(|k| root[(i, k)] * a.at(k, j)).sum());
    let mut scaled: Dense<f64> =
        Dense::from_fn(n, n, |i, j| (0..=j).map(|k| half[(i, k)] * root[(j, k)]).sum());
    let vectors = eigenvectors(Leading::whole(&mut scaled));
    let least = (0..n).min_by(|&i, &j| scaled[(i, i)].total_cmp(&scaled[(j, j)]))?;
    let direction: Vec<f64> =
        (0..n).map(|i| (i..n).map(|k| root[(k, i)] * vectors[(k, least)]).sum()).collect();
    // Rayleigh's quotient forgives an error of the direction; large eigenvalues leave no rounding in small ones.
    let rate = a.value(&direction) / p.value(&direction);
    rate.is_finite().then_some((rate, direction))
}

#[cfg(test)]
mod tests {
    use super::{Dense, Symmetric, cholesky, direction_of_descent, lower_inverse, solved, weakest};

    fn second_difference(size: usize, shift: f64) -> Symmetric<f64> {
        Symmetric::from_fn(size, |i, j| match i - j {
            0 => 2.0 - shift,
            1 => -1.0,
            _ => 0.0,
        })
    }

    fn product(a: &Dense<f64>, b: &Dense<f64>) -> Dense<f64> {
        Dense::from_fn(a.columns(), a.columns(), |i, j| (0..a.columns()).map(|k| a[(i, k)] * b[(k, j)]).sum())
    }

    /// L Lᵀ = A and L L⁻¹ = 1, to rounding.
    #[test]
    fn residuals() {
        for n in [1, 2, 5, 16, 28] {
            let hilbert_like =
                Symmetric::from_fn(n, |i, j| if i == j { 2.0 } else { 1.0 / (i + j + 1) as f64 });
            for a in [second_difference(n, 0.0), hilbert_like] {
                let lower = cholesky(&a).expect("positive definite");
                let transposed = Dense::from_fn(n, n, |i, j| lower[(j, i)]);
                let (square, unit) = (product(&lower, &transposed), product(&lower, &lower_inverse(&lower)));
                for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                    assert!((square[(i, j)] - a.at(i, j)).abs() < 1e-15 * n as f64, "{n}");
                    assert!((unit[(i, j)] - f64::from(u8::from(i == j))).abs() < 1e-14 * n as f64, "{n}");
                }
            }
        }
    }

    /// A x = b, to rounding.
    #[test]
    fn solutions() {
        for n in [1, 2, 7, 28] {
            let a = second_difference(n, 0.0);
            let b: Vec<f64> = (0..n).map(|i| 1.0 - 0.3 * i as f64).collect();
            let x = solved(&cholesky(&a).expect("positive definite"), &b);
            for (i, b) in b.iter().enumerate() {
                let image: f64 = (0..n).map(|j| a.at(i, j) * x[j]).sum();
                assert!((image - b).abs() < 1e-12 * n as f64, "{n}");
            }
        }
    }

    /// A direction exactly where the least eigenvalue, 2 − 2 cos(π/(n + 1)) less the shift, is negative; and it descends.
    #[test]
    fn directions_of_descent() {
        for n in [1, 2, 7, 28] {
            let least = 2.0 - 2.0 * (std::f64::consts::PI / (n as f64 + 1.0)).cos();
            assert!(direction_of_descent(&second_difference(n, least * (1.0 - 1e-9))).is_none(), "{n}");
            let a = second_difference(n, least * (1.0 + 1e-9));
            let x = direction_of_descent(&a).expect("indefinite");
            assert!(a.value(&x) < 0.0, "{n}");
            assert!(cholesky(&a).is_none(), "{n}");
        }
        assert_eq!(direction_of_descent(&Symmetric::diagonal(&[1.0, -2.0, -3.0])), Some(vec![0.0, 1.0, 0.0]));
    }

    /// Second differences, eigenvalues 2 − 2 cos(kπ/(n + 1)), in a metric that scales the variables.
    #[test]
    fn the_weakest_direction() {
        let scale = [1.0, 100.0, 3.0, 0.01, 5.0];
        let plain = second_difference(5, 0.0);
        let a = Symmetric::from_fn(5, |i, j| plain.at(i, j) * scale[i] * scale[j]);
        let p = Symmetric::diagonal(&scale.map(|x| x * x));
        let (rate, direction) = weakest(&a, &p).expect("a metric");
        assert!((rate - (2.0 - 3.0_f64.sqrt())).abs() < 1e-15, "{rate}");
        assert!((p.value(&direction) - 1.0).abs() < 1e-14);
        assert!(weakest(&a, &Symmetric::diagonal(&[-1.0; 5])).is_none());
    }
}
