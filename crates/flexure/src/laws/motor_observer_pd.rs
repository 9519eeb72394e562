//! Regulation from motor encoders with an observer.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::Drive;
use crate::laws::gain::{Gain, MOTOR};
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `motor-observer-pd`: [`control::MotorObserverPd`].
pub struct MotorObserverPd;

impl LawKind for MotorObserverPd {
    const NAME: &'static str = "motor-observer-pd";
    const SUMMARY: &'static str =
        "regulation from motor encoders with an observer (after Ailon, Ortega 1993)";
    const MEMORY: &'static [(&'static str, &'static str)] = &[("x_c", "rad"), ("v_c", "rad/s")];

    type Gains = [Vec<f64>; 4];
    const GAINS: [Gain; 4] = [
        MOTOR[0],
        Gain::new(
            "damping",
            Quantity::positive("damping D_c of the motor that the controller computes", units::DAMPING),
            Drive::motor_damping,
        ),
        Gain::new("inertia", Quantity::positive("inertia B_c of that motor", units::INERTIA), |drive| {
            0.1 * drive.motor_inertia
        }),
        Gain::new(
            "coupling",
            Quantity::positive("stiffness K_c of the spring to it", units::STIFFNESS),
            |drive| 4.0 * drive.motor_stiffness(),
        ),
    ];

    type Core<C: Scalar, const N: usize> = control::MotorObserverPd<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [stiffness, damping, inertia, coupling] = gains.each_ref().map(vector);
        control::MotorObserverPd { stiffness, inertia, damping, coupling }
    }
}
