//! The virtual-contraction law of rigid robots, on the motors.

use flexure_core::control::{self, Linear, LinkGains, Metric};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::Drive;
use crate::laws::gain::{Gain, INJECTED, METRIC, SHAPING};
use crate::laws::registry::LawKind;
use crate::robot::Robot;

/// The kind `rigid-vcbc`: [`control::RigidVcbc`] with φ linear.
pub struct RigidVcbc;

impl LawKind for RigidVcbc {
    const NAME: &'static str = "rigid-vcbc";
    const SUMMARY: &'static str =
        "virtual-contraction law of rigid robots on the motors, as if the springs were rigid";

    type Gains = [Vec<f64>; 3];
    const GAINS: [Gain; 3] = [
        Gain::new("metric", METRIC, Drive::motor_stiffness),
        SHAPING,
        Gain::new("damping", INJECTED, |drive| drive.inertia() * drive.bandwidth()),
    ];

    type Core<C: Scalar, const N: usize> = control::RigidVcbc<C, Linear<C, N>, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [metric, shaping, damping] = gains.each_ref().map(vector);
        let (metric, shaping) = (Metric::Constant(metric), Linear { gain: shaping });
        control::RigidVcbc { link: LinkGains { metric, shaping, damping } }
    }
}
