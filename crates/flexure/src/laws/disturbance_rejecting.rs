//! Tracking that holds against constant torques nobody knows.

use flexure_core::control::{self, ImmersionInvariance, InnerLoop, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::{Gain, INNER, LINK};
use crate::laws::registry::{Claim, LawKind};
use crate::robot::Robot;
use crate::units;

/// ω of the residuals.
pub(super) const BANDWIDTH: Gain =
    Gain::new("bandwidth", Quantity::positive("bandwidth ω of the residuals", units::RATE), |drive| {
        2.0 * drive.bandwidth()
    });

/// Residuals come from these.
pub(super) const MEMORY: [(&str, &str); 2] = [("sigma_l", "kg m²/s"), ("sigma_m", "kg m²/s")];

/// The kind `disturbance-rejecting`: [`control::DisturbanceRejecting`].
pub struct DisturbanceRejecting;

impl LawKind for DisturbanceRejecting {
    const NAME: &'static str = "disturbance-rejecting";
    const SUMMARY: &'static str = "immersion-invariance with the momentum residuals of both sides inside";
    const CLAIM: Claim = Claim::Errors;
    const MEMORY: &'static [(&'static str, &'static str)] = &MEMORY;

    type Gains = [Vec<f64>; 5];
    const GAINS: [Gain; 5] = [LINK[0], LINK[1], INNER[0], INNER[1], BANDWIDTH];

    type Core<C: Scalar, const N: usize> = control::DisturbanceRejecting<C, ImmersionInvariance<C, N>, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [stiffness, damping, position, velocity, bandwidth] = gains.each_ref().map(vector);
        let law = ImmersionInvariance {
            link: MotorPd { stiffness, damping },
            inner: InnerLoop { position, velocity },
        };
        control::DisturbanceRejecting { law, bandwidth }
    }
}
