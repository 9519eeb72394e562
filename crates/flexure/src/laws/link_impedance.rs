//! Impedance of the links by energy that only motors see.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::{Gain, MOTOR, SHAPED_INERTIA};
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `link-impedance`: [`control::LinkImpedance`].
pub struct LinkImpedance;

impl LawKind for LinkImpedance {
    const NAME: &'static str = "link-impedance";
    const SUMMARY: &'static str = "impedance of the links (after Ott, Albu-Schäffer, Kugi, Hirzinger 2008)";

    type Gains = [Vec<f64>; 3];
    const GAINS: [Gain; 3] = [
        SHAPED_INERTIA,
        Gain::new(
            "stiffness",
            Quantity::positive(
                "stiffness K_des of the links at rest, below that of the springs",
                units::STIFFNESS,
            ),
            |drive| 0.5 * drive.stiffness,
        ),
        MOTOR[1],
    ];

    type Core<C: Scalar, const N: usize> = control::LinkImpedance<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [inertia, stiffness, damping] = gains.each_ref().map(vector);
        control::LinkImpedance { inertia, motor: MotorPd { stiffness, damping } }
    }
}
