//! Finsler functions that are no Riemannian metrics: weighted 1- and ∞-norms of variations.

use crate::linalg::{Matrix, Vector};
use crate::scalar::{Over, Piecewise, Scalar};

use super::{Dynamics, MatrixField, field_rate, measure_1, measure_infinity};

/// A norm with corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Norm {
    /// |z|_1 = Σ |z_i|.
    One,
    /// |z|_∞ = max |z_i|.
    Infinity,
}

impl Norm {
    /// |z|.
    #[inline]
    pub fn of<S: Piecewise, const N: usize>(self, z: &Vector<S, N>) -> S {
        self.ahead(z, &Vector::ZERO).value
    }

    /// D⁺|z| where z moves at `rate`: the derivative from the right, which exists at corners too.
    #[inline]
    pub fn upper_rate<S: Piecewise, const N: usize>(self, z: &Vector<S, N>, rate: &Vector<S, N>) -> S {
        self.ahead(z, rate).slope
    }

    /// The matrix measure that belongs to it: D⁺|z| ≤ μ(A) |z| along ż = A z.
    #[inline]
    pub fn measure<S: Piecewise, const N: usize>(self, a: &Matrix<S, N, N>) -> S {
        match self {
            Self::One => measure_1(a),
            Self::Infinity => measure_infinity(a),
        }
    }

    #[inline]
    fn ahead<S: Piecewise, const N: usize>(self, z: &Vector<S, N>, rate: &Vector<S, N>) -> Ahead<S> {
        let sizes = (0..N).map(|i| Ahead { value: z[i], slope: rate[i] }.abs());
        let zero = Ahead { value: S::ZERO, slope: S::ZERO };
        match self {
            Self::One => sizes.fold(zero, Ahead::plus),
            Self::Infinity => sizes.fold(zero, Ahead::max),
        }
    }
}

/// A number and its derivative from the right.
#[derive(Clone, Copy)]
struct Ahead<S> {
    value: S,
    slope: S,
}

impl<S: Piecewise> Ahead<S> {
    /// `then` where x > 0, `at` where x = 0, `otherwise` where x < 0.
    #[inline]
    fn three_ways(x: S, then: S, at: S, otherwise: S) -> S {
        x.select((-x).select(at, then), otherwise)
    }

    #[inline]
    fn abs(self) -> Self {
        let slope = Self::three_ways(self.value, self.slope, self.slope.abs(), -self.slope);
        Self { value: self.value.abs(), slope }
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }

    #[inline]
    fn max(self, other: Self) -> Self {
        let (a, b) = (self.slope, other.slope);
        let slope = Self::three_ways(self.value - other.value, a, a.max(b), b);
        Self { value: self.value.max(other.value), slope }
    }
}

/// V(x, δx, t) = |Θ(x, t) δx|: a Finsler structure and Lyapunov function of the prolonged system at once. Paper, eq. finslerlyapunov with
/// p = c_1 = c_2 = 1.
#[derive(Clone, Copy, Debug)]
pub struct Finsler<W> {
    /// Θ.
    pub weight: W,
    /// |·|.
    pub norm: Norm,
}

impl<W> Finsler<W> {
    /// V.
    #[inline]
    pub fn value<C, T, const N: usize>(&self, x: &Vector<T, N>, delta_x: &Vector<T, N>, t: T) -> T
    where
        C: Scalar,
        T: Over<C> + Piecewise,
        W: MatrixField<C, N>,
    {
        self.norm.of(&(self.weight.at(x, t) * *delta_x))
    }

    /// D⁺V along the prolonged system. Paper, eq. finslerlyapunovinequality: at most −β V where the system contracts.
    #[inline]
    pub fn upper_rate<C, T, const N: usize>(
        &self,
        system: &impl Dynamics<C, N>,
        x: &Vector<T, N>,
        delta_x: &Vector<T, N>,
        t: T,
    ) -> T
    where
        C: Scalar,
        T: Over<C> + Piecewise,
        W: MatrixField<C, N>,
    {
        let [theta, theta_rate] = field_rate(&self.weight, x, &system.rate(x, t), t);
        let rate = theta_rate * *delta_x + theta * system.variation(x, delta_x, t);
        self.norm.upper_rate(&(theta * *delta_x), &rate)
    }

    /// Length of the straight line from `from` to `to` at `t`: ∫ V(γ, γ') ds by the midpoint rule in `pieces` pieces. Paper, eq.
    /// finslerdistance1.
    ///
    /// The distance is the least length of a curve, so this bounds it; where Θ is constant no curve is shorter.
    #[inline]
    pub fn length<C, T, const N: usize>(&self, from: &Vector<T, N>, to: &Vector<T, N>, t: T, pieces: u16) -> T
    where
        C: Scalar,
        T: Over<C> + Piecewise,
        W: MatrixField<C, N>,
    {
        let step = (*to - *from).scaled(T::from_ratio(1, i32::from(pieces)));
        let middle = |k: u16| *from + step.scaled(T::from_ratio(2 * i32::from(k) + 1, 2));
        (0..pieces).fold(T::ZERO, |sum, k| sum + self.value(&middle(k), &step, t))
    }
}
