//! Passivity-based tracking.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::{Gain, LINK_DAMPING, SHAPING};
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `passivity`: [`control::Passivity`].
pub struct Passivity;

impl LawKind for Passivity {
    const NAME: &'static str = "passivity";
    const SUMMARY: &'static str = "passivity-based tracking (Brogliato, Ortega, Lozano 1995)";

    type Gains = [Vec<f64>; 3];
    const GAINS: [Gain; 3] = [
        SHAPING,
        LINK_DAMPING,
        Gain::new(
            "motor_damping",
            Quantity::non_negative("damping injected into the motors", units::DAMPING),
            |drive| drive.motor_inertia * drive.bandwidth(),
        ),
    ];

    type Core<C: Scalar, const N: usize> = control::Passivity<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [shaping, link_damping, motor_damping] = gains.each_ref().map(vector);
        control::Passivity { shaping, link_damping, motor_damping }
    }
}
