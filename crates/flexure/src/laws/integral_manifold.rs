//! Composite control on an integral manifold.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::gain::{Gain, TWO_TIME_SCALES};
use crate::laws::registry::LawKind;
use crate::robot::Robot;

/// The kind `integral-manifold`: [`control::IntegralManifold`].
pub struct IntegralManifold;

impl LawKind for IntegralManifold {
    const NAME: &'static str = "integral-manifold";
    const SUMMARY: &'static str =
        "rigid computed torque corrected for compliance (Spong, Khorasani, Kokotović 1987)";

    type Gains = [Vec<f64>; 3];
    const GAINS: [Gain; 3] = TWO_TIME_SCALES;

    type Core<C: Scalar, const N: usize> = control::IntegralManifold<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [position, velocity, damping] = gains.each_ref().map(vector);
        control::IntegralManifold { position, velocity, damping }
    }
}
