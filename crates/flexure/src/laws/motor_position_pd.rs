//! Regulation from motor encoders alone.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::{Gain, MOTOR};
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `motor-position-pd`: [`control::MotorPositionPd`].
pub struct MotorPositionPd;

impl LawKind for MotorPositionPd {
    const NAME: &'static str = "motor-position-pd";
    const SUMMARY: &'static str = "regulation from motor encoders alone (Kelly, Ortega, Ailon, Loría 1994)";
    const MEMORY: &'static [(&'static str, &'static str)] = &[("z", "rad")];

    type Gains = [Vec<f64>; 3];
    const GAINS: [Gain; 3] = [
        MOTOR[0],
        MOTOR[1],
        Gain::new("cutoff", Quantity::positive("cutoff a of differentiation", units::RATE), |drive| {
            10.0 * drive.bandwidth()
        }),
    ];

    type Core<C: Scalar, const N: usize> = control::MotorPositionPd<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [stiffness, damping, cutoff] = gains.each_ref().map(vector);
        control::MotorPositionPd { motor: MotorPd { stiffness, damping }, cutoff }
    }
}
