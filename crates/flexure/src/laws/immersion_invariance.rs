//! Links under computed torque, motors driven to where that takes them.

use flexure_core::control::{self, InnerLoop, MotorPd};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::gain::{Gain, INNER, LINK};
use crate::laws::registry::LawKind;
use crate::robot::Robot;

/// The kind `immersion-invariance`: [`control::ImmersionInvariance`].
pub struct ImmersionInvariance;

impl LawKind for ImmersionInvariance {
    const NAME: &'static str = "immersion-invariance";
    const SUMMARY: &'static str = "the robot immersed in a controlled rigid one (Astolfi, Ortega 2003)";

    type Gains = [Vec<f64>; 4];
    const GAINS: [Gain; 4] = [LINK[0], LINK[1], INNER[0], INNER[1]];

    type Core<C: Scalar, const N: usize> = control::ImmersionInvariance<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [stiffness, damping, position, velocity] = gains.each_ref().map(vector);
        control::ImmersionInvariance {
            link: MotorPd { stiffness, damping },
            inner: InnerLoop { position, velocity },
        }
    }
}
