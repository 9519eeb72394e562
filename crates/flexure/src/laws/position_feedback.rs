//! Tracking from positions of both sides.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::{Gain, INNER_MOTOR, LINK};
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `position-feedback`: [`control::PositionFeedback`].
pub struct PositionFeedback;

impl LawKind for PositionFeedback {
    const NAME: &'static str = "position-feedback";
    const SUMMARY: &'static str =
        "tracking from positions alone (after Ávila-Becerril, Loría, Panteley 2016)";
    const MEMORY: &'static [(&'static str, &'static str)] =
        &[("f", "rad"), ("df", "rad/s"), ("ddf", "rad/s^2"), ("z_m", "rad")];

    type Gains = [Vec<f64>; 6];
    const GAINS: [Gain; 6] = [
        LINK[0],
        LINK[1],
        Gain::new(
            "link_cutoff",
            Quantity::positive("triple pole a_l of the filter of link errors", units::RATE),
            |drive| 12.0 * drive.bandwidth(),
        ),
        INNER_MOTOR[0],
        INNER_MOTOR[1],
        Gain::new(
            "motor_cutoff",
            Quantity::positive("cutoff a_m of differentiating motor errors", units::RATE),
            |drive| 10.0 * drive.bandwidth(),
        ),
    ];

    type Core<C: Scalar, const N: usize> = control::PositionFeedback<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [link_stiffness, link_damping, link_cutoff, motor_stiffness, motor_damping, motor_cutoff] =
            gains.each_ref().map(vector);
        let link = MotorPd { stiffness: link_stiffness, damping: link_damping };
        let motor = MotorPd { stiffness: motor_stiffness, damping: motor_damping };
        control::PositionFeedback { link, link_cutoff, motor, motor_cutoff }
    }
}
