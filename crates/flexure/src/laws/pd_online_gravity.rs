//! PD of the motors with the gravity of where they are.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::gain::{Gain, MOTOR};
use crate::laws::registry::LawKind;
use crate::robot::Robot;

/// The kind `pd-online-gravity`: [`control::PdOnlineGravity`].
pub struct PdOnlineGravity;

impl LawKind for PdOnlineGravity {
    const NAME: &'static str = "pd-online-gravity";
    const SUMMARY: &'static str =
        "PD of the motors with the gravity of where they are (De Luca, Siciliano, Zollo 2005)";

    type Gains = [Vec<f64>; 2];
    const GAINS: [Gain; 2] = MOTOR;

    type Core<C: Scalar, const N: usize> = control::PdOnlineGravity<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [stiffness, damping] = gains.each_ref().map(vector);
        control::PdOnlineGravity { motor: MotorPd { stiffness, damping } }
    }
}
