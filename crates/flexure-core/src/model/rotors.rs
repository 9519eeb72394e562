//! Inertial coupling of rotors and links: what the reduced model leaves out.

use super::links::seeded;
use super::{Links, Motion};
use crate::linalg::{Matrix, Vector};
use crate::scalar::{Dual, Over, Scalar};

/// Rotors that feel their carriers turn.
///
/// Rotor i of inertia J about its axis spins at r q̇_m + w, with gear ratio r and the rate w of its carrier about that
/// axis ([`Links::carrier_rates`]). Its energy ½ J (r q̇_m + w)² has three parts: the motor's ½ M_m q̇_m², M_m = J r²; the
/// carrier's ½ J w², which belongs to the link inertias; and T_c = J r q̇_m w between them. The reduced model drops T_c,
/// the full one has the mass matrix [[M_l, S], [Sᵀ, M_m]]. Both need balanced rotors.
#[derive(Clone, Copy, Debug)]
pub struct RotorCoupling<C, const N: usize> {
    /// Spin momentum per motor rate, J r = M_m / r [kg m²]; it has the sign of the gear ratio.
    pub spin: Vector<C, N>,
}

impl<C: Scalar, const N: usize> RotorCoupling<C, N> {
    /// From motor inertias on the link side [kg m²] and gear ratios, motor turns per joint turn.
    pub fn new(motor_inertia: &Vector<C, N>, gear_ratio: &Vector<C, N>) -> Self {
        Self { spin: Vector::from_fn(|i| motor_inertia[i] / gear_ratio[i]) }
    }

    /// S(q), a row per link and a column per motor [kg m²]: S_ki = J_i r_i ∂w_i/∂v_k.
    #[inline]
    pub fn matrix<T: Over<C>>(&self, links: &impl Links<C, N>, q: &Vector<T, N>) -> Matrix<T, N, N> {
        let slopes = links.carrier_rates(&q.map(Dual::constant), &seeded(&Vector::ZERO));
        Matrix::from_fn(|k, i| Vector(slopes[i].gradient)[k].scale(self.spin[i]))
    }

    /// Coupling energy T_c = v_lᵀ S v_m in J.
    #[inline]
    pub fn energy<T: Over<C>>(&self, links: &impl Links<C, N>, x: &Motion<T, N>) -> T {
        self.spin.diag_mul(&links.carrier_rates(&x.q_l, &x.v_l)).dot(&x.v_m)
    }

    /// What the links need for the coupling at motor accelerations `a_m`: d/dt (S v_m) − ∂T_c/∂q_l [N m].
    #[inline]
    pub fn link_torque<T: Over<C>>(
        &self,
        links: &impl Links<C, N>,
        x: &Motion<T, N>,
        a_m: &Vector<T, N>,
    ) -> Vector<T, N> {
        let momentum = self.matrix(links, &x.q_l.with_rate(&x.v_l)) * x.v_m.with_rate(a_m);
        let constant = |v: &Vector<T, N>| v.map(Dual::<T, N>::constant);
        let near = Motion {
            q_l: seeded(&x.q_l),
            q_m: constant(&x.q_m),
            v_l: constant(&x.v_l),
            v_m: constant(&x.v_m),
        };
        momentum.map(|p| p.coefficient(1)) - Vector(self.energy(links, &near).gradient)
    }

    /// What the motors need for the coupling at link accelerations `a_l`: d/dt (Sᵀ v_l) [N m].
    #[inline]
    pub fn motor_torque<T: Over<C>>(
        &self,
        links: &impl Links<C, N>,
        x: &Motion<T, N>,
        a_l: &Vector<T, N>,
    ) -> Vector<T, N> {
        let rates = links.carrier_rates(&x.q_l.with_rate(&x.v_l), &x.v_l.with_rate(a_l));
        self.spin.diag_mul(&rates.map(|w| w.coefficient(1)))
    }
}
