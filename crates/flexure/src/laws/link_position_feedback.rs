//! Tracking from link encoders alone.

use flexure_core::control::{self, ImmersionInvariance, InnerLoop, MotorPd, observer_gains};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::{Gain, INNER, LINK};
use crate::laws::registry::LawKind;
use crate::robot::Robot;
use crate::units;

/// The kind `link-position-feedback`: [`control::LinkPositionFeedback`].
pub struct LinkPositionFeedback;

impl LawKind for LinkPositionFeedback {
    const NAME: &'static str = "link-position-feedback";
    const SUMMARY: &'static str =
        "tracking from link encoders alone, with an observer (after Nicosia, Tomei 1995)";
    const MEMORY: &'static [(&'static str, &'static str)] =
        &[("q_l", "rad"), ("dq_l", "rad/s"), ("q_m", "rad"), ("dq_m", "rad/s")];

    type Gains = [Vec<f64>; 5];
    const GAINS: [Gain; 5] = [
        LINK[0],
        LINK[1],
        INNER[0],
        INNER[1],
        Gain::new("bandwidth", Quantity::positive("bandwidth ℓ of the observer", units::RATE), |drive| {
            6.0 * drive.bandwidth()
        }),
    ];

    type Core<C: Scalar, const N: usize> = control::LinkPositionFeedback<C, ImmersionInvariance<C, N>, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        robot: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [.., bandwidth] = gains;
        let of_joint = |(i, &bandwidth): (usize, &f64)| {
            observer_gains(bandwidth, robot.motor_damping[i] / robot.motor_inertia[i])
        };
        let joints: Vec<[f64; 4]> = bandwidth.iter().enumerate().map(of_joint).collect();
        let rows: [Vec<f64>; 4] = std::array::from_fn(|k| joints.iter().map(|joint| joint[k]).collect());
        let [stiffness, damping, position, velocity, _] = gains.each_ref().map(&vector);
        let law = ImmersionInvariance {
            link: MotorPd { stiffness, damping },
            inner: InnerLoop { position, velocity },
        };
        control::LinkPositionFeedback { law, observer: rows.each_ref().map(&vector) }
    }
}
