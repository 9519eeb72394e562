//! Optimal feedback of the whole state around the reference.

use super::{LinearModel, NoRegulator, QuadraticCost, Regulator, deviation, feedback};
use crate::control::ControlLaw;
use crate::linalg::{Matrix, Vector};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Float, Jet, Over, Scalar};

/// The published regulator, around the reference: u = u_d − F (x − x_d) with x = (q, θ, v, w), where θ_d, w_d and u_d follow from the reference of the
/// links alone, as in [`FeedforwardPd`](crate::control::FeedforwardPd), and F is optimal for the robot linearised at a posture. Anderson and Moore,
/// *Optimal control: linear quadratic methods*, 1990.
///
/// Stability is local: near references that are slow and near the posture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lqr<C, const N: usize> {
    /// F: gains of the errors of q and θ [N m/rad], of v and w [N m s/rad].
    pub gain: [Matrix<C, N, N>; 4],
}

/// The same feedback, published as well: F keeps what torques on the links may cost, where that of [`Lqr`] is for none. Made by [`Lqr::design`] with finite
/// attenuations; what is kept is in [`Regulator::continuous`], for errors that are small.
pub type HInfinity<C, const N: usize> = Lqr<C, N>;

impl<C: Float, const N: usize> Lqr<C, N> {
    /// The law for a robot linearised at rest with links at `posture` in rad: linear quadratic where each `attenuation` is ∞, H∞ where they are less
    /// [1/(N m √s)]. See [`Regulator::continuous`].
    ///
    /// # Errors
    /// Without a stabilising solution of the Riccati equation.
    pub fn design<L: Links<C, N>>(
        robot: &Fjr<C, L, N>,
        posture: &Vector<C, N>,
        cost: &QuadraticCost<C, N>,
        attenuation: &Vector<C, N>,
    ) -> Result<Self, NoRegulator> {
        let model = LinearModel::at_rest(robot, posture);
        Ok(Self { gain: Regulator::continuous(&model, cost, attenuation)?.gain })
    }
}

impl<C: Copy, const N: usize> Lqr<C, N> {
    /// The law with constants of another type, each through `f`.
    #[inline]
    pub fn map<D: Copy>(&self, f: impl Fn(C) -> D) -> Lqr<D, N> {
        Lqr { gain: self.gain.map(|block| block.map(&f)) }
    }
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for Lqr<C, N> {
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        let (error, u_d) = deviation(robot, x, q_ld);
        u_d + feedback(&self.gain, &error)
    }
}
