//! Regulation by the power port of the motors.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::Drive;
use crate::laws::gain::{Gain, MOTOR};
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `control-by-interconnection`: [`control::ControlByInterconnection`].
pub struct ControlByInterconnection;

impl LawKind for ControlByInterconnection {
    const NAME: &'static str = "control-by-interconnection";
    const SUMMARY: &'static str = "regulation by the power port of the motors (after Ortega, Borja 2014)";
    const MEMORY: &'static [(&'static str, &'static str)] = &[("x_1", "rad"), ("x_2", "rad")];

    type Gains = [Vec<f64>; 3];
    const GAINS: [Gain; 3] = [
        MOTOR[0],
        Gain::new(
            "elastic",
            Quantity::positive("stiffness K_2 of the Maxwell element", units::STIFFNESS),
            |drive| 10.0 * drive.bandwidth() * drive.motor_damping(),
        ),
        Gain::new(
            "viscous",
            Quantity::positive("damping R of the Maxwell element", units::DAMPING),
            Drive::motor_damping,
        ),
    ];

    type Core<C: Scalar, const N: usize> = control::ControlByInterconnection<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [stiffness, elastic, viscous] = gains.each_ref().map(vector);
        control::ControlByInterconnection { stiffness, elastic, viscous }
    }
}
