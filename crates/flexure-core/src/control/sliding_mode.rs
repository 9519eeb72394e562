//! Feedback linearisation that holds against torques it does not know.

use super::ControlLaw;
use super::feedback_linearization::chain;
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// Sliding mode in the flat output with a boundary layer: a textbook design on [`FeedbackLinearization`](super::FeedbackLinearization) (Utkin, *Sliding modes in
/// control and optimization*, 1992; Slotine and Li, *Applied nonlinear control*, 1991), not one law of one paper.
///
/// σ = e⃛ + 3λ ë + 3λ² ė + λ³ e obeys σ̇ + μ σ + η tanh(σ/ε) = 0, and e follows σ through (s + λ)³. Torques on the motors that would move σ by less than η are
/// held off up to the boundary layer.
#[derive(Clone, Copy, Debug)]
pub struct SlidingMode<C, const N: usize> {
    /// λ, how fast errors decay on the surface [1/s].
    pub surface: Vector<C, N>,
    /// μ, how fast σ decays [1/s].
    pub reaching: Vector<C, N>,
    /// η, what is held off [rad/s⁴].
    pub authority: Vector<C, N>,
    /// ε, the boundary layer of σ [rad/s³].
    pub layer: Vector<C, N>,
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for SlidingMode<C, N> {
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        chain(robot, x, q_ld, |snap, [e, de, dde, d3e]| {
            let three = C::from_ratio(3, 1);
            Vector::from_fn(|i| {
                let l = self.surface[i];
                let (once, twice, cube) = (three * l, three * l * l, l * l * l);
                let sigma = d3e[i] + dde[i].scale(once) + de[i].scale(twice) + e[i].scale(cube);
                let reaching = sigma.scale(self.reaching[i]);
                let held_off = sigma.scale(self.layer[i].recip()).tanh().scale(self.authority[i]);
                snap[i] - d3e[i].scale(once) - dde[i].scale(twice) - de[i].scale(cube) - reaching - held_off
            })
        })
    }
}
