//! Rigid computed torque with damping of the springs.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::gain::{Gain, TWO_TIME_SCALES};
use crate::laws::registry::LawKind;
use crate::robot::Robot;

/// The kind `singular-perturbation`: [`control::SingularPerturbation`].
pub struct SingularPerturbation;

impl LawKind for SingularPerturbation {
    const NAME: &'static str = "singular-perturbation";
    const SUMMARY: &'static str = "rigid computed torque with damping of the springs (Spong 1987)";

    type Gains = [Vec<f64>; 3];
    const GAINS: [Gain; 3] = TWO_TIME_SCALES;

    type Core<C: Scalar, const N: usize> = control::SingularPerturbation<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [position, velocity, damping] = gains.each_ref().map(vector);
        control::SingularPerturbation { position, velocity, damping }
    }
}
