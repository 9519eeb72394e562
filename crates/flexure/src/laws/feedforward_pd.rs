//! Nominal torque of the reference and PD of the motors.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::gain::{Gain, MOTOR};
use crate::laws::registry::LawKind;
use crate::robot::Robot;

/// The kind `feedforward-pd`: [`control::FeedforwardPd`].
pub struct FeedforwardPd;

impl LawKind for FeedforwardPd {
    const NAME: &'static str = "feedforward-pd";
    const SUMMARY: &'static str = "nominal torque of the reference and PD of the motors (De Luca 2000)";

    type Gains = [Vec<f64>; 2];
    const GAINS: [Gain; 2] = MOTOR;

    type Core<C: Scalar, const N: usize> = control::FeedforwardPd<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [stiffness, damping] = gains.each_ref().map(vector);
        control::FeedforwardPd { motor: MotorPd { stiffness, damping } }
    }
}
