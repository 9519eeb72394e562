//! The matrices Ξ, Υ, Π, Ψ of the closed loop's variation.

use super::ErrorState;
use crate::control::{Shaping, Vcbc};
use crate::linalg::{Matrix, Vector};
use crate::model::{Fjr, LinkMatrices, Links, MassFactor, Motion};
use crate::scalar::{Over, Scalar};

/// A matrix over x̃ = (q̃_l, q̃_m, σ_l, σ_m) in `N` × `N` blocks.
pub type Blocks<T, const N: usize> = [[Matrix<T, N, N>; 4]; 4];

/// δx̃̇ = (Ξ − Υ) Π δx̃ + Ψ δω. Paper, eq. feedbackinterconnectionsystemsvariational-flexible.
#[derive(Clone, Copy, Debug)]
pub struct Structure<T, const N: usize> {
    /// Ξ: skew-symmetric, it moves storage about.
    pub interconnection: Blocks<T, N>,
    /// The diagonal blocks of Υ: ∂φ_l Π_l⁻¹, ∂φ_m Π_m⁻¹, D_l + K_ld − ½ Ṁ_l, D_m + K_md.
    pub dissipation: [Matrix<T, N, N>; 4],
    /// The diagonal blocks of the metric Π: Π_l, Π_m [N m/rad], M_l⁻¹, M_m⁻¹ [1/(kg m²)].
    pub metric: [Matrix<T, N, N>; 4],
    /// Ψ: ω_l and ω_m drive the momentum errors.
    pub port: [[Matrix<T, N, N>; 2]; 4],
}

impl<T: Scalar, const N: usize> Structure<T, N> {
    /// At the error `error`, along the real motion `x`. ∂φ comes from dual numbers.
    #[inline]
    pub fn new<C, L, Pl, Pm>(
        robot: &Fjr<C, L, N>,
        law: &Vcbc<C, Pl, Pm, N>,
        error: &ErrorState<T, N>,
        x: &Motion<T, N>,
    ) -> Self
    where
        T: Over<C>,
        C: Scalar,
        L: Links<C, N>,
        Pl: Shaping<C, N>,
        Pm: Shaping<C, N>,
    {
        let diagonal = |d: Vector<C, N>| Matrix::diagonal(&d.lift::<T>());
        let Pi_l = law.link.metric.at(&error.e_l);
        let m = LinkMatrices::new(&robot.links, &x.q_l, &x.v_l);
        let factor = robot.links.factor(&x.q_l);
        let unit = Matrix::<T, N, N>::identity();
        let inverse_mass = Matrix(core::array::from_fn(|j| factor.solve(&unit.row(j)).0)).transpose();

        let (zero, one) = (Matrix::ZERO, Matrix::identity());
        // K is diagonal, so K Π_m⁻¹ and Π_m⁻¹ Kᵀ are the same matrix.
        let coupling = diagonal(Vector::from_fn(|i| robot.stiffness[i] * law.motor.metric[i].recip()));
        Self {
            interconnection: [
                [zero, zero, one, zero],
                [zero, zero, -coupling, one],
                [-one, coupling, -m.skew, zero],
                [zero, -one, zero, zero],
            ],
            dissipation: [
                law.link.shaping.slope(&error.e_l) * Matrix::diagonal(&Pi_l.map(T::recip)),
                law.motor.shaping.slope(&error.e_m) * diagonal(law.motor.metric.map(C::recip)),
                diagonal(robot.link_damping + law.link.damping) - m.mass_rate.scaled(T::from_f64(0.5)),
                diagonal(robot.motor_damping + law.motor.damping),
            ],
            metric: [
                Matrix::diagonal(&Pi_l),
                diagonal(law.motor.metric),
                inverse_mass,
                diagonal(robot.motor_inertia.map(C::recip)),
            ],
            port: [[zero, zero], [zero, zero], [one, zero], [zero, one]],
        }
    }

    /// (Ξ − Υ) Π: the Jacobian of the closed loop.
    #[inline]
    pub fn jacobian(&self) -> Blocks<T, N> {
        let mut jacobian = self.interconnection;
        for (i, (row, dissipation)) in jacobian.iter_mut().zip(&self.dissipation).enumerate() {
            for (j, (block, metric)) in row.iter_mut().zip(&self.metric).enumerate() {
                let entry = if i == j { *block - *dissipation } else { *block };
                *block = entry * *metric;
            }
        }
        jacobian
    }

    /// W = ½ δx̃ᵀ Π δx̃, the differential storage, in J. Paper, eq. design-dLCF-sigma-flexible.
    #[inline]
    pub fn storage(&self, delta: &ErrorState<T, N>) -> T {
        let [Pi_l, Pi_m, inverse_l, inverse_m] = self.metric;
        let form = |metric: Matrix<T, N, N>, d: &Vector<T, N>| d.dot(&(metric * *d));
        T::from_f64(0.5)
            * (form(Pi_l, &delta.e_l)
                + form(Pi_m, &delta.e_m)
                + form(inverse_l, &delta.sigma_l)
                + form(inverse_m, &delta.sigma_m))
    }
}
