//! The rigid law and damping of the springs, port-Hamiltonian.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::Drive;
use crate::laws::gain::{Gain, SHAPING};
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `composite-ph`: [`control::CompositePh`].
pub struct CompositePh;

impl LawKind for CompositePh {
    const NAME: &'static str = "composite-ph";
    const SUMMARY: &'static str =
        "rigid port-Hamiltonian law and a fast one (after Jardón-Kojakhmetov et al. 2016)";

    type Gains = [Vec<f64>; 5];
    const GAINS: [Gain; 5] = [
        SHAPING,
        Gain::new(
            "metric",
            Quantity::positive("metric Π of link errors", units::STIFFNESS),
            Drive::motor_stiffness,
        ),
        Gain::new("damping", Quantity::non_negative("injected damping K_d", units::DAMPING), |drive| {
            drive.inertia() * drive.bandwidth()
        }),
        Gain::new(
            "fast_stiffness",
            Quantity::non_negative("stiffness K_z beside the springs", units::STIFFNESS),
            |drive| 0.5 * drive.stiffness,
        ),
        Gain::new(
            "fast_damping",
            Quantity::non_negative("damping K_f of the springs", units::DAMPING),
            |drive| (drive.stiffness * drive.motor_inertia).sqrt(),
        ),
    ];

    type Core<C: Scalar, const N: usize> = control::CompositePh<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [shaping, metric, damping, fast_stiffness, fast_damping] = gains.each_ref().map(vector);
        control::CompositePh { shaping, metric, damping, fast_stiffness, fast_damping }
    }
}
