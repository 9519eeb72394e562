//! Regulation from motor encoders alone, with torques that saturate smoothly.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::{Gain, MOTOR};
use crate::laws::registry::{Claim, LawKind};
use crate::robot::Robot;
use crate::units;

/// The kind `motor-position-pd-capped`: [`control::MotorPositionPdCapped`].
pub struct MotorPositionPdCapped;

impl LawKind for MotorPositionPdCapped {
    const NAME: &'static str = "motor-position-pd-capped";
    const SUMMARY: &'static str =
        "regulation from motor encoders alone with feedback that saturates smoothly";
    const CLAIM: Claim = Claim::Regulation;
    const MEMORY: &'static [(&'static str, &'static str)] = &[("z", "rad")];

    type Gains = [Vec<f64>; 5];
    const GAINS: [Gain; 5] = [
        MOTOR[0],
        MOTOR[1],
        Gain::new("cutoff", Quantity::positive("cutoff a of differentiation", units::RATE), |drive| {
            10.0 * drive.bandwidth()
        }),
        Gain::new(
            "stiffness_cap",
            Quantity::positive("most torque T_P against position errors", units::TORQUE),
            |drive| 0.25 * drive.motor_stiffness(),
        ),
        Gain::new(
            "damping_cap",
            Quantity::positive("most torque T_D against their derivative", units::TORQUE),
            |drive| 0.125 * drive.motor_stiffness(),
        ),
    ];

    type Core<C: Scalar, const N: usize> = control::MotorPositionPdCapped<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [stiffness, damping, cutoff, stiffness_cap, damping_cap] = gains.each_ref().map(vector);
        let motor = MotorPd { stiffness, damping };
        control::MotorPositionPdCapped { motor, cutoff, stiffness_cap, damping_cap }
    }
}
