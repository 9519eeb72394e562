//! The matrices of the theory: M_l, Ṁ_l, S_l, E_l, by dual numbers from the mass matrix.

use super::Links;
use super::links::seeded;
use crate::linalg::{Matrix, Vector};
use crate::scalar::{Over, Scalar};

/// The mass matrix and what follows from its derivatives, at one position and velocity.
#[derive(Clone, Copy, Debug)]
pub struct LinkMatrices<T, const N: usize> {
    /// Mass matrix M_l [kg m²].
    pub mass: Matrix<T, N, N>,
    /// Its rate Ṁ_l along the velocity [kg m²/s].
    pub mass_rate: Matrix<T, N, N>,
    /// Skew-symmetric S_l, S_kj = ½ Σ_i (∂M_ki/∂q_j − ∂M_ij/∂q_k) v_i [N m s/rad]. Paper, eq. SlLagrangian.
    pub skew: Matrix<T, N, N>,
}

impl<T: Scalar, const N: usize> LinkMatrices<T, N> {
    /// At position `q` in rad and velocity `v` [rad/s].
    #[inline]
    pub fn new<C: Scalar, L: Links<C, N>>(links: &L, q: &Vector<T, N>, v: &Vector<T, N>) -> Self
    where
        T: Over<C>,
    {
        let dual = links.mass_matrix(&seeded(q));
        let slope = |k: usize, j: usize| Vector(dual[(k, j)].gradient);
        let half = T::from_f64(0.5);
        let skew = Matrix::from_fn(|k, j| {
            let mut sum = T::ZERO;
            for i in 0..N {
                sum += (slope(k, i)[j] - slope(i, j)[k]) * v[i];
            }
            half * sum
        });
        Self { mass: dual.map(|m| m.value), mass_rate: Matrix::from_fn(|k, j| slope(k, j).dot(v)), skew }
    }

    /// E_l = S_l − ½ Ṁ_l [N m s/rad]. Paper, eq. workless-flexible.
    #[inline]
    pub fn workless(&self) -> Matrix<T, N, N> {
        self.skew - self.mass_rate.scaled(T::from_f64(0.5))
    }

    /// The Christoffel matrix C_l = S_l + ½ Ṁ_l [N m s/rad].
    #[inline]
    pub fn coriolis(&self) -> Matrix<T, N, N> {
        self.skew + self.mass_rate.scaled(T::from_f64(0.5))
    }
}
