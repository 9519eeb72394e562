//! How large quadratic forms get over boxes of many numbers that are seen in few directions.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Leading, Symmetric, eigenvectors};

/// For each row, how far its product with z gets where |z_k| ≤ 1, from above.
pub fn reaches(rows: &Dense<Interval>) -> Vec<Interval> {
    let sum =
        |row: &[Interval]| row.iter().fold(Interval::ZERO, |sum, x| sum + Interval::point(x.magnitude()));
    rows.rows().map(sum).collect()
}

/// |wᵀ G w| for all w = B z with |z_k| ≤ 1, from above.
///
/// Entry by entry it would be Σ |G_ik| β_i β_k, β_i the reach of w_i: as if all w_i got there with any signs. With G = Σ λ_i v_i v_iᵀ + R, R the rest of rounding and of what is
/// open of G, it is between the sums of the λ_i (v_iᵀ B z)² below and above 0, but for R; v_iᵀ B z is known column by column. The least of this with v_i orthogonal as they are, with
/// v_i orthogonal in units of β, and entry by entry.
pub fn largest_value(g: &Symmetric<Interval>, b: &Dense<Interval>) -> Interval {
    let reach = reaches(b);
    if reach.iter().all(|x| x.hi() == 0.0) {
        return Interval::ZERO;
    }
    let sized = g.map(|x| Interval::point(x.magnitude()));
    let of_reach = reach.iter().map(|x| if x.midpoint() > 0.0 { x.midpoint() } else { 1.0 }).collect();
    let by_vectors = [vec![1.0; reach.len()], of_reach].map(|unit| by_vectors(g, b, &reach, &unit));
    Interval::point(by_vectors.iter().fold(sized.value(&reach).hi(), |least, bound| least.min(bound.hi())))
}

/// By v_i that are orthogonal in these units.
fn by_vectors(g: &Symmetric<Interval>, b: &Dense<Interval>, reach: &[Interval], unit: &[f64]) -> Interval {
    let n = g.size();
    let mut scaled = Dense::from_fn(n, n, |i, k| g.at(i, k).midpoint() * unit[i] * unit[k]);
    let vectors = eigenvectors(Leading::whole(&mut scaled));
    let v = Dense::from_fn(n, n, |i, k| Interval::point(vectors[(k, i)] / unit[k]));
    let values: Vec<_> = (0..n).map(|i| Interval::point(scaled[(i, i)])).collect();
    let [mut above, mut below] = [Interval::ZERO; 2];
    for (&value, reach) in values.iter().zip(reaches(&(&v * b))) {
        let sum = if value.lo() > 0.0 { &mut above } else { &mut below };
        *sum += Interval::point(value.magnitude()) * reach.square();
    }
    let rest = Symmetric::from_fn(n, |i, k| {
        let known = (0..n).fold(Interval::ZERO, |sum, m| sum + values[m] * v[(m, i)] * v[(m, k)]);
        Interval::point((g.at(i, k) - known).magnitude())
    });
    Interval::point(above.hi().max(below.hi())) + rest.value(reach)
}

#[cfg(test)]
mod tests {
    use flexure_core::scalar::Interval;

    use super::{Dense, Symmetric, largest_value};

    /// Numbers from −1 to 1.
    fn wave(i: usize) -> f64 {
        (1.7 * i as f64 + 0.4 * (i as f64).powi(2)).sin()
    }

    /// At the corners of the box, all of them, forms are no larger than is said, where G is known and where it is not; what is said is near what is so where w has one number, and no more
    /// than entry by entry.
    #[test]
    fn no_corner_is_beyond() {
        for (rows, columns) in [(1, 1), (3, 1), (4, 10), (8, 12)] {
            for open in [0.0, 0.1] {
                let g = Symmetric::from_fn(rows, |i, k| wave(7 * i + k) + 2.0);
                let b = Dense::from_fn(rows, columns, |i, k| wave(columns * i + k + 3) / (1 + i) as f64);
                let wide = |x: f64| Interval::new(x - open, x + open).unwrap();
                let said = largest_value(&g.map(wide), &b.map(Interval::point)).hi();
                let (mut most, mut entries) = (0.0_f64, 0.0);
                for corner in 0..1_u32 << columns {
                    let z: Vec<_> =
                        (0..columns).map(|k| if corner >> k & 1 == 0 { 1.0 } else { -1.0 }).collect();
                    let w = b.apply(&z);
                    // The corner of G that makes most of it.
                    let off = open * w.iter().map(|w| w.abs()).sum::<f64>().powi(2);
                    most = most.max(g.value(&w).abs() + off);
                }
                let reach: Vec<f64> = b.rows().map(|row| row.iter().map(|x| x.abs()).sum()).collect();
                for i in 0..rows {
                    for k in 0..rows {
                        entries += (g.at(i, k).abs() + open) * reach[i] * reach[k];
                    }
                }
                assert!(most <= said * (1.0 + 1e-12), "{rows} {columns}: {most} {said}");
                assert!(said <= entries * (1.0 + 1e-12), "{rows} {columns}: {said} {entries}");
                if open == 0.0 {
                    let least = if rows == 1 { 1.0 - 1e-12 } else { 0.6 };
                    assert!(most >= least * said, "{rows} {columns}: {most} {said}");
                }
            }
        }
    }
}
