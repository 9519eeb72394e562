//! Backstepping without accelerations: what it would differentiate goes through filters.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::Drive;
use crate::laws::gain::{Gain, LINK_DAMPING, SHAPING};
use crate::laws::registry::{Claim, LawKind};
use crate::robot::Robot;
use crate::units;

/// The kind `command-filtered-backstepping`: [`control::CommandFilteredBackstepping`].
pub struct CommandFilteredBackstepping;

/// Λ, K_2, W_3, k_3, W_4, k_4, ω.
pub(super) const FILTERED: [Gain; 7] = [
    SHAPING,
    LINK_DAMPING,
    // Four times the springs: what the links' velocity error does to the motor, times K/W_3, stays slower than the filters.
    Gain::new("metric", Quantity::positive("weight W_3 of motor errors", units::STIFFNESS), |drive| {
        4.0 * drive.stiffness
    }),
    Gain::new(
        "motor_shaping",
        Quantity::positive("decay k_3 of motor errors", units::RATE),
        Drive::inner_bandwidth,
    ),
    Gain::new(
        "rate_metric",
        Quantity::positive("weight W_4 of errors of motor velocities", units::INERTIA),
        |drive| drive.stiffness / drive.inner_bandwidth().powi(2),
    ),
    Gain::new(
        "rate_shaping",
        Quantity::positive("decay k_4 of errors of motor velocities", units::RATE),
        |drive| 2.0 * drive.inner_bandwidth(),
    ),
    Gain::new("bandwidth", Quantity::positive("bandwidth ω of the filters", units::RATE), |drive| {
        120.0 * drive.bandwidth()
    }),
];

/// What its filters and their compensation keep.
pub(super) const FILTERS: [(&str, &str); 6] = [
    ("x_3c", "rad"),
    ("dx_3c", "rad/s"),
    ("x_4c", "rad/s"),
    ("dx_4c", "rad/s^2"),
    ("xi_2", "rad/s"),
    ("xi_3", "rad"),
];

/// The law with these gains.
pub(super) fn filtered<C: Scalar, const N: usize>(
    gains: [&Vec<f64>; 7],
    vector: &impl Fn(&Vec<f64>) -> Vector<C, N>,
) -> control::CommandFilteredBackstepping<C, N> {
    let [shaping, link_damping, metric, motor_shaping, rate_metric, rate_shaping, bandwidth] =
        gains.map(vector);
    control::CommandFilteredBackstepping {
        shaping,
        link_damping,
        metric,
        motor_shaping,
        rate_metric,
        rate_shaping,
        bandwidth,
    }
}

impl LawKind for CommandFilteredBackstepping {
    const NAME: &'static str = "command-filtered-backstepping";
    const SUMMARY: &'static str =
        "backstepping by filters instead of derivatives (after Pan, Wang, Li, Yu 2017)";
    const CLAIM: Claim = Claim::Errors;
    const MEMORY: &'static [(&'static str, &'static str)] = &FILTERS;

    type Gains = [Vec<f64>; 7];
    const GAINS: [Gain; 7] = FILTERED;

    type Core<C: Scalar, const N: usize> = control::CommandFilteredBackstepping<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        filtered(gains.each_ref(), &vector)
    }
}
