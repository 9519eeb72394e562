//! The baseline without a model.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::{Gain, MOTOR};
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `pid`: [`control::Pid`].
pub struct Pid;

impl LawKind for Pid {
    const NAME: &'static str = "pid";
    const SUMMARY: &'static str = "PID of motors with the integral of link errors: no model at all";
    const MEMORY: &'static [(&'static str, &'static str)] = &[("z", "rad s")];

    type Gains = [Vec<f64>; 3];
    const GAINS: [Gain; 3] = [
        MOTOR[0],
        MOTOR[1],
        Gain::new(
            "integral",
            Quantity::non_negative("gain K_I of the integral of link errors", units::STIFFNESS_RATE),
            |drive| 0.25 * drive.bandwidth() * drive.motor_stiffness(),
        ),
    ];

    type Core<C: Scalar, const N: usize> = control::Pid<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [stiffness, damping, integral] = gains.each_ref().map(vector);
        control::Pid { motor: MotorPd { stiffness, damping }, integral }
    }
}
