//! Matrices that depend affinely on unknowns and shall stay positive definite while the first unknown falls: a damped Newton
//! method on the logarithmic barrier t v₀ − Σ log det F(v). S. Boyd, L. Vandenberghe, *Convex Optimization*, section 11.
//! Floats: what it finds is a suggestion.

use crate::linalg::{Dense, Symmetric, cholesky, lower_inverse, solved};

/// F(v) = `constant` + Σ v_i · slope_i, which shall be positive definite.
pub struct Block {
    pub constant: Symmetric<f64>,
    /// The unknowns that it depends on, with their slopes.
    pub slopes: Vec<(usize, Symmetric<f64>)>,
}

impl Block {
    fn at(&self, v: &[f64]) -> Symmetric<f64> {
        self.slopes.iter().fold(self.constant.clone(), |sum, (i, slope)| sum.minus(slope, -v[*i]))
    }
}

/// By how much t grows from one point of the central path to the next.
const GROWTH: f64 = 8.0;

/// The path ends where v₀ is this close to its least value, relatively.
const GAP: f64 = 1e-7;

/// Steps towards a point of the path, at most.
const STEPS: usize = 200;

/// A point of the path is found where another step would lower the barrier by less than half of this.
const CENTRED: f64 = 1e-4;

/// The same where rounding hides whether a step lowers the barrier.
const NEARLY_CENTRED: f64 = 0.1;

/// Shorter steps are rounding.
const SHORTEST: f64 = 1e-9;

/// What is added to the scaled diagonal of the Newton equations, whose rounding it outweighs.
const RIDGE: f64 = 1e-13;

/// Points of the central path from `start`, where every block is positive definite and v₀ > 0: v₀ falls from each to the
/// next, and blocks come closer to being singular. It ends at [`GAP`], or before, where rounding does not let it on.
pub fn central_path(blocks: &[Block], start: Vec<f64>) -> Vec<Vec<f64>> {
    let dimension: usize = blocks.iter().map(|block| block.constant.size()).sum();
    let dimension = dimension as f64;
    let (mut v, mut path) = (start, Vec::new());
    let mut t = dimension / v[0];
    while centre(blocks, &mut v, t) {
        path.push(v.clone());
        if dimension / t < GAP * v[0] {
            break;
        }
        t *= GROWTH;
    }
    path
}

/// Moves `v` to where t v₀ − Σ log det F is least; false where rounding keeps it from getting near.
fn centre(blocks: &[Block], v: &mut Vec<f64>, t: f64) -> bool {
    for _ in 0..STEPS {
        let Some(Newton { direction, decrease }) = newton(blocks, v, t) else { return false };
        if decrease < CENTRED {
            return true;
        }
        let here = barrier(blocks, v, t);
        let moved = |step: f64| v.iter().zip(&direction).map(|(x, d)| x + step * d).collect::<Vec<_>>();
        let shorter = std::iter::successors(Some(1.0), |step| Some(0.5 * step));
        let found = shorter.take_while(|&step| step > SHORTEST).map(|step| (step, moved(step))).find(
            |(step, there)| match (here, barrier(blocks, there, t)) {
                (Some(here), Some(there)) => there <= here - 0.1 * step * decrease,
                _ => false,
            },
        );
        let Some((_, there)) = found else { return decrease < NEARLY_CENTRED };
        *v = there;
    }
    false
}

/// t v₀ − Σ log det F; none outside the region where all blocks are positive definite.
fn barrier(blocks: &[Block], v: &[f64], t: f64) -> Option<f64> {
    blocks.iter().try_fold(t * v[0], |sum, block| {
        let lower = cholesky(&block.at(v))?;
        let half: f64 = (0..lower.columns()).map(|i| lower[(i, i)].ln()).sum();
        Some(sum - 2.0 * half)
    })
}

struct Newton {
    direction: Vec<f64>,
    /// The square of Newton's decrement.
    decrease: f64,
}

fn newton(blocks: &[Block], v: &[f64], t: f64) -> Option<Newton> {
    let m = v.len();
    let mut gradient = vec![0.0; m];
    gradient[0] = t;
    let mut hessian = Dense::from_fn(m, m, |_, _| 0.0);
    for block in blocks {
        let root = lower_inverse(&cholesky(&block.at(v))?);
        // With F = L Lᵀ: slopes L⁻¹ A L⁻ᵀ, of which the gradient takes traces and the Hessian inner products.
        let slopes: Vec<(usize, Dense<f64>)> =
            block.slopes.iter().map(|(i, slope)| (*i, congruent(&root, slope))).collect();
        for (p, (i, a)) in slopes.iter().enumerate() {
            gradient[*i] -= (0..a.columns()).map(|k| a[(k, k)]).sum::<f64>();
            for (j, b) in &slopes[..=p] {
                let inner: f64 = a.rows().flatten().zip(b.rows().flatten()).map(|(x, y)| x * y).sum();
                hessian[(*i.max(j), *i.min(j))] += inner;
            }
        }
    }
    // Unknowns have units that differ by many powers of ten.
    let scale: Vec<f64> = (0..m).map(|i| hessian[(i, i)].sqrt().recip()).collect();
    let scaled = Symmetric::from_fn(m, |i, j| {
        hessian[(i, j)] * scale[i] * scale[j] + if i == j { RIDGE } else { 0.0 }
    });
    let right: Vec<f64> = gradient.iter().zip(&scale).map(|(g, s)| -g * s).collect();
    let step = solved(&cholesky(&scaled)?, &right);
    let direction: Vec<f64> = step.iter().zip(&scale).map(|(x, s)| x * s).collect();
    let decrease = -gradient.iter().zip(&direction).map(|(g, d)| g * d).sum::<f64>();
    decrease.is_finite().then_some(Newton { direction, decrease })
}

/// R A Rᵀ of a lower triangular R.
fn congruent(root: &Dense<f64>, a: &Symmetric<f64>) -> Dense<f64> {
    let n = a.size();
    let half: Dense<f64> = Dense::from_fn(n, n, |i, j| (0..=i).map(|k| root[(i, k)] * a.at(k, j)).sum());
    Dense::from_fn(n, n, |i, j| (0..=j).map(|k| half[(i, k)] * root[(j, k)]).sum())
}

#[cfg(test)]
mod tests {
    use super::{Block, Symmetric, central_path};

    /// The least v₀ with [[v₀, 1], [1, v₁]] and 4 − v₁ positive semidefinite is 1/4, at v₁ = 4.
    #[test]
    fn the_edge_is_approached_from_inside() {
        let matrix = |entries: [f64; 3]| Symmetric::from_fn(2, |i, j| entries[i + j]);
        let blocks = [
            Block {
                constant: matrix([0.0, 1.0, 0.0]),
                slopes: vec![(0, matrix([1.0, 0.0, 0.0])), (1, matrix([0.0, 0.0, 1.0]))],
            },
            Block { constant: Symmetric::diagonal(&[4.0]), slopes: vec![(1, Symmetric::diagonal(&[-1.0]))] },
        ];
        let path = central_path(&blocks, vec![10.0, 1.0]);
        let last = path.last().expect("a path");
        assert!(last[0] > 0.25 && last[0] < 0.25 * (1.0 + 1e-6), "{last:?}");
        assert!(path.windows(2).all(|pair| pair[1][0] < pair[0][0]));
        assert!(path.iter().all(|v| v[0] * v[1] > 1.0 && v[1] < 4.0));
    }

    /// From outside nothing is found.
    #[test]
    fn a_start_outside_leads_nowhere() {
        let block =
            Block { constant: Symmetric::diagonal(&[-1.0]), slopes: vec![(0, Symmetric::diagonal(&[1.0]))] };
        assert!(central_path(&[block], vec![0.5]).is_empty());
    }
}
