//! Regulation with shaped motor inertia.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::gain::{Gain, MOTOR, SHAPED_INERTIA};
use crate::laws::registry::LawKind;
use crate::robot::Robot;

/// The kind `torque-feedback`: [`control::TorqueFeedback`].
pub struct TorqueFeedback;

impl LawKind for TorqueFeedback {
    const NAME: &'static str = "torque-feedback";
    const SUMMARY: &'static str = "regulation with shaped motor inertia (Albu-Schäffer, Ott, Hirzinger 2007)";

    type Gains = [Vec<f64>; 3];
    const GAINS: [Gain; 3] = [SHAPED_INERTIA, MOTOR[0], MOTOR[1]];

    type Core<C: Scalar, const N: usize> = control::TorqueFeedback<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [inertia, stiffness, damping] = gains.each_ref().map(vector);
        control::TorqueFeedback { inertia, motor: MotorPd { stiffness, damping } }
    }
}
