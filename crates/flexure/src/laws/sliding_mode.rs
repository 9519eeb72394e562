//! Feedback linearisation that holds against torques it does not know.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::Drive;
use crate::laws::gain::Gain;
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `sliding-mode`: [`control::SlidingMode`].
pub struct SlidingMode;

impl LawKind for SlidingMode {
    const NAME: &'static str = "sliding-mode";
    const SUMMARY: &'static str = "sliding mode in the link positions with a boundary layer";

    type Gains = [Vec<f64>; 4];
    const GAINS: [Gain; 4] = [
        Gain::new(
            "surface",
            Quantity::positive("decay λ of errors on the surface", units::RATE),
            Drive::bandwidth,
        ),
        Gain::new("reaching", Quantity::positive("decay μ towards the surface", units::RATE), |drive| {
            1.5 * drive.bandwidth()
        }),
        Gain::new(
            "authority",
            Quantity::non_negative("fourth derivative η that is held off", units::SNAP),
            |drive| 0.1 * drive.bandwidth().powi(4),
        ),
        Gain::new("layer", Quantity::positive("boundary layer ε of the surface", units::JERK), |drive| {
            0.01 * drive.bandwidth().powi(3)
        }),
    ];

    type Core<C: Scalar, const N: usize> = control::SlidingMode<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [surface, reaching, authority, layer] = gains.each_ref().map(vector);
        control::SlidingMode { surface, reaching, authority, layer }
    }
}
