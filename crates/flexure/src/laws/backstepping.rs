//! Integrator backstepping from links to motors.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::Drive;
use crate::laws::gain::{Gain, LINK_DAMPING, SHAPING};
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `backstepping`: [`control::Backstepping`].
pub struct Backstepping;

impl LawKind for Backstepping {
    const NAME: &'static str = "backstepping";
    const SUMMARY: &'static str = "from links to motors (Brogliato, Ortega, Lozano 1995)";

    type Gains = [Vec<f64>; 4];
    const GAINS: [Gain; 4] = [
        SHAPING,
        LINK_DAMPING,
        Gain::new(
            "metric",
            Quantity::positive("weight W of motor position errors", units::STIFFNESS),
            |drive| drive.stiffness,
        ),
        Gain::new(
            "motor_shaping",
            Quantity::positive("rate a at which motor errors decay", units::RATE),
            Drive::inner_bandwidth,
        ),
    ];

    type Core<C: Scalar, const N: usize> = control::Backstepping<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [shaping, link_damping, metric, motor_shaping] = gains.each_ref().map(vector);
        control::Backstepping { shaping, link_damping, metric, motor_shaping }
    }
}
