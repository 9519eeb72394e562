//! Damping injection that preserves the elastic structure.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::gain::{Gain, LINK_DAMPING, MOTOR};
use crate::laws::registry::LawKind;
use crate::robot::Robot;

/// The kind `esp`: [`control::Esp`].
pub struct Esp;

impl LawKind for Esp {
    const NAME: &'static str = "esp";
    const SUMMARY: &'static str = "elastic structure preserving damping injection (Keppler et al. 2018)";

    type Gains = [Vec<f64>; 3];
    const GAINS: [Gain; 3] = [LINK_DAMPING, MOTOR[0], MOTOR[1]];

    type Core<C: Scalar, const N: usize> = control::Esp<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [link_damping, stiffness, damping] = gains.each_ref().map(vector);
        control::Esp { link_damping, motor: MotorPd { stiffness, damping } }
    }
}
