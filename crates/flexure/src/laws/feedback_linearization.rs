//! Feedback linearisation by static state feedback.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::Gain;
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `feedback-linearization`: [`control::FeedbackLinearization`], from the gains of (s + ω)⁴.
pub struct FeedbackLinearization;

impl LawKind for FeedbackLinearization {
    const NAME: &'static str = "feedback-linearization";
    const SUMMARY: &'static str = "four integrators per joint (Spong 1987)";

    type Gains = [Vec<f64>; 4];
    const GAINS: [Gain; 4] = [
        Gain::new(
            "position",
            Quantity::positive("gain k_0 of the link position error", units::RATE_4),
            |drive| drive.bandwidth().powi(4),
        ),
        Gain::new(
            "velocity",
            Quantity::positive("gain k_1 of the link velocity error", units::RATE_3),
            |drive| 4.0 * drive.bandwidth().powi(3),
        ),
        Gain::new(
            "acceleration",
            Quantity::positive("gain k_2 of the link acceleration error", units::RATE_2),
            |drive| 6.0 * drive.bandwidth().powi(2),
        ),
        Gain::new("jerk", Quantity::positive("gain k_3 of the link jerk error", units::RATE), |drive| {
            4.0 * drive.bandwidth()
        }),
    ];

    type Core<C: Scalar, const N: usize> = control::FeedbackLinearization<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let gains = gains.each_ref().map(vector);
        control::FeedbackLinearization { gains }
    }
}
