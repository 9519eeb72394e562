//! PD of the motors with the gravity of the goal.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::gain::{Gain, MOTOR};
use crate::laws::registry::LawKind;
use crate::robot::Robot;

/// The kind `pd`: [`control::Pd`].
pub struct Pd;

impl LawKind for Pd {
    const NAME: &'static str = "pd";
    const SUMMARY: &'static str = "PD of the motors with the gravity of the goal (Tomei 1991)";

    type Gains = [Vec<f64>; 2];
    const GAINS: [Gain; 2] = MOTOR;

    type Core<C: Scalar, const N: usize> = control::Pd<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [stiffness, damping] = gains.each_ref().map(vector);
        control::Pd { motor: MotorPd { stiffness, damping } }
    }
}
