//! The coefficients of Gauss–Legendre collocation.

use std::ops::{AddAssign, SubAssign};

use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::{Lane, Lanes, Over, Scalar};

/// One number per collocation point, or stage.
pub(crate) type Stages<const S: usize, T = f64> = Vector<T, S>;

/// One number per pair of stages.
pub(crate) type Block<const S: usize, T = f64> = Matrix<T, S, S>;

/// A linear map of stage values, by columns: what it makes of values is a sum of columns, all entries of which are computed side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StageMap<const S: usize, T = f64>([Stages<S, T>; S]);

impl<const S: usize, T: Scalar> StageMap<S, T> {
    pub(crate) const ZERO: Self = Self([Stages::ZERO; S]);

    /// With the entries of `block`.
    pub(crate) fn new(block: &Block<S, T>) -> Self {
        Self(std::array::from_fn(|j| block.column(j)))
    }

    /// Its entries.
    pub(crate) fn block(&self) -> Block<S, T> {
        Matrix::from_fn(|i, j| self.0[j][i])
    }

    /// Row `i`.
    pub(crate) fn row(&self, i: usize) -> Stages<S, T> {
        Vector::from_fn(|j| self.0[j][i])
    }

    /// Stage `i` of what it makes of `values`.
    #[inline]
    pub(crate) fn at<U: Over<T>>(&self, i: usize, values: &Stages<S, U>) -> U {
        let mut sum = U::ZERO;
        for (column, value) in self.0.iter().zip(values.iter()) {
            sum += value.scale(column[i]);
        }
        sum
    }

    /// What it makes of `values`.
    #[inline]
    pub(crate) fn of<V: AtStages<S, T>>(&self, values: &V) -> V {
        values.mapped(self)
    }
}

/// Numbers at the stages: of several robots an array of lanes, of one robot a register.
pub(crate) trait AtStages<const S: usize, T>: Copy + AddAssign + SubAssign {
    const ZERO: Self;

    /// What `map` makes of them.
    fn mapped(&self, map: &StageMap<S, T>) -> Self;

    /// All of them times `factor`.
    fn scaled(self, factor: T) -> Self;
}

impl<const S: usize, T: Scalar, U: Over<T>> AtStages<S, T> for Stages<S, U> {
    const ZERO: Self = Vector::ZERO;

    #[inline]
    fn mapped(&self, map: &StageMap<S, T>) -> Self {
        let mut sums = Self::ZERO;
        for (column, value) in map.0.iter().zip(self.iter()) {
            for (sum, entry) in sums.0.iter_mut().zip(column.iter()) {
                *sum += value.scale(entry);
            }
        }
        sums
    }

    #[inline]
    fn scaled(self, factor: T) -> Self {
        self.map(|x| x.scale(factor))
    }
}

impl<const S: usize> AtStages<S, f64> for Lanes<f64, S>
where
    f64: Lane<S>,
{
    const ZERO: Self = <Self as Scalar>::ZERO;

    #[inline]
    fn mapped(&self, map: &StageMap<S, f64>) -> Self {
        let mut sums = <Self as Scalar>::ZERO;
        for (column, value) in map.0.iter().zip(self.to_array()) {
            sums += Self::from_array(column.0).scale(value);
        }
        sums
    }

    #[inline]
    fn scaled(self, factor: f64) -> Self {
        self.scale(factor)
    }
}

/// Collocation at the `S` points of Gauss on [0, 1], of order 2 S.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scheme<const S: usize> {
    /// Nodes c.
    pub nodes: Stages<S>,
    /// Weights b.
    pub weights: Stages<S>,
    /// A: integrates stage values once.
    pub once: Block<S>,
    /// A²: integrates them twice.
    pub twice: Block<S>,
    /// A and A² again, as they are applied.
    pub maps: [StageMap<S>; 2],
    /// bᵀA, which integrates twice up to the end of the step.
    pub end_twice: Stages<S>,
    /// Coefficients, constant term first, of the polynomials that are 1 at one node and 0 at the others, a row each.
    pub polynomials: Block<S>,
    /// Values at 0 of these polynomials.
    pub start: Stages<S>,
}

impl<const S: usize> Scheme<S> {
    /// The defect at the start of a step of length h of an oscillation at ω, relative to its acceleration, in units of (h ω)^s for small
    /// h ω.
    pub(crate) const DEFECT: f64 = factorial(S) / factorial(2 * S);

    /// What this makes by the end of the step, in the same units: the error of the exponential is s!² (h ω)^(2s+1) / ((2s)! (2s+1)!).
    pub(crate) const ERROR_OF_DEFECT: f64 = factorial(S) / factorial(2 * S + 1);

    /// How much larger the defect of half as many stages is, in units of (h ω)^(s/2).
    pub(crate) const DEFECT_OF_HALF: f64 = factorial(S / 2) / factorial(2 * (S / 2)) / Self::DEFECT;

    /// The points of Gauss.
    pub(crate) fn gauss() -> Self {
        let nodes = gauss_nodes();
        let polynomials = Matrix(std::array::from_fn(|j| lagrange(&nodes, j).0));
        let integral = |j: usize, x| integral(&polynomials.row(j), x);
        let weights = Vector::from_fn(|j| integral(j, 1.0));
        let once = Matrix::from_fn(|i, j| integral(j, nodes[i]));
        Self {
            nodes,
            weights,
            once,
            twice: once * once,
            maps: [StageMap::new(&once), StageMap::new(&(once * once))],
            end_twice: once.transpose() * weights,
            polynomials,
            start: polynomials.column(0),
        }
    }

    /// What stage values are multiplied by to have their polynomial at `x`.
    #[inline]
    pub(crate) fn at(&self, x: f64) -> Stages<S> {
        Vector::from_fn(|j| self.polynomials.0[j].iter().rev().fold(0.0, |sum, c| sum * x + c))
    }
}

/// The roots of the Legendre polynomial of degree `S`, moved to [0, 1], by Newton's iteration.
fn gauss_nodes<const S: usize>() -> Stages<S> {
    Vector::from_fn(|i| {
        let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (S as f64 + 0.5)).cos();
        for _ in 0..10 {
            let (mut before, mut value) = (1.0, x);
            for n in 1..S {
                let n = n as f64;
                (before, value) = (value, ((2.0 * n + 1.0) * x * value - n * before) / (n + 1.0));
            }
            let slope = S as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        0.5 * (1.0 + x)
    })
}

/// n!
pub(crate) const fn factorial(n: usize) -> f64 {
    let (mut product, mut k) = (1.0, 1);
    while k < n {
        k += 1;
        product *= k as f64;
    }
    product
}

/// Coefficients, constant term first, of the Lagrange polynomial that is 1 at node `j`.
fn lagrange<const S: usize>(nodes: &Stages<S>, j: usize) -> Stages<S> {
    let mut coefficients = Vector::ZERO;
    coefficients[0] = 1.0;
    for (k, node) in nodes.iter().enumerate().filter(|&(k, _)| k != j) {
        let scale = 1.0 / (nodes[j] - nodes[k]);
        for power in (0..S).rev() {
            let lower = if power == 0 { 0.0 } else { coefficients[power - 1] };
            coefficients[power] = (lower - node * coefficients[power]) * scale;
        }
    }
    coefficients
}

/// ∫₀ˣ of a polynomial.
fn integral<const S: usize>(coefficients: &Stages<S>, x: f64) -> f64 {
    (0..S).rev().fold(0.0, |sum, k| (sum + coefficients[k] / (k + 1) as f64) * x)
}

#[cfg(test)]
mod tests {
    use super::{Scheme, factorial};

    fn check<const S: usize>(node: f64) {
        let scheme = Scheme::<S>::gauss();
        assert!((scheme.nodes[0] - node).abs() < 1e-15, "{scheme:?}");
        for power in (0..).take(2 * S) {
            let sum: f64 = (0..S).map(|i| scheme.weights[i] * scheme.nodes[i].powi(power)).sum();
            assert!((sum * f64::from(power + 1) - 1.0).abs() < 1e-14, "power {power}: {sum}");
        }
        // What is left of s^S / S! at 0.
        let defect = scheme.start.dot(&scheme.nodes.map(|c| c.powi(i32::try_from(S).expect("a few")))).abs()
            / factorial(S);
        assert!((defect / Scheme::<S>::DEFECT - 1.0).abs() < 1e-13, "{defect}");
    }

    /// Abramowitz & Stegun, *Handbook of Mathematical Functions*, table 25.4.
    #[test]
    fn nodes_are_those_of_gauss() {
        check::<2>(0.5 - 0.5 * 0.577_350_269_189_625_8);
        check::<4>(0.5 - 0.5 * 0.861_136_311_594_052_6);
    }
}
