//! Regulation after gravity is cancelled.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::gain::{Gain, MOTOR};
use crate::laws::registry::LawKind;
use crate::robot::Robot;

/// The kind `gravity-cancellation`: [`control::GravityCancellation`].
pub struct GravityCancellation;

impl LawKind for GravityCancellation {
    const NAME: &'static str = "gravity-cancellation";
    const SUMMARY: &'static str = "regulation after gravity is cancelled (De Luca, Flacco 2010)";

    type Gains = [Vec<f64>; 2];
    const GAINS: [Gain; 2] = MOTOR;

    type Core<C: Scalar, const N: usize> = control::GravityCancellation<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [stiffness, damping] = gains.each_ref().map(vector);
        control::GravityCancellation { motor: MotorPd { stiffness, damping } }
    }
}
