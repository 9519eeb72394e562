//! Computed torque without motor velocities and without jerks.

use flexure_core::control::{self, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::{Gain, INNER_MOTOR, LINK};
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `loria-ortega`: [`control::LoriaOrtega`].
pub struct LoriaOrtega;

impl LawKind for LoriaOrtega {
    const NAME: &'static str = "loria-ortega";
    const SUMMARY: &'static str =
        "computed torque without motor velocities and jerks (after Loría, Ortega 1995)";
    const MEMORY: &'static [(&'static str, &'static str)] = &[("z_l", "rad"), ("z_m", "rad")];

    type Gains = [Vec<f64>; 5];
    const GAINS: [Gain; 5] = [
        LINK[0],
        LINK[1],
        INNER_MOTOR[0],
        INNER_MOTOR[1],
        Gain::new("cutoff", Quantity::positive("cutoff a of differentiation", units::RATE), |drive| {
            10.0 * drive.bandwidth()
        }),
    ];

    type Core<C: Scalar, const N: usize> = control::LoriaOrtega<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [link_stiffness, link_damping, motor_stiffness, motor_damping, cutoff] =
            gains.each_ref().map(vector);
        let link = MotorPd { stiffness: link_stiffness, damping: link_damping };
        let motor = MotorPd { stiffness: motor_stiffness, damping: motor_damping };
        control::LoriaOrtega { link, motor, cutoff }
    }
}
