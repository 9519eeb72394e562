//! Spring torques by an inner loop of motor positions.

use flexure_core::control::{self, InnerLoop};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::gain::{Gain, LINK_DAMPING, POSITION, RATE, SHAPING};
use crate::laws::registry::LawKind;

/// The kind `cascade`: [`control::Cascade`].
pub struct Cascade;

impl LawKind for Cascade {
    const NAME: &'static str = "cascade";
    const SUMMARY: &'static str = "spring torques by an inner loop of motor positions";

    type Gains = [Vec<f64>; 4];
    const GAINS: [Gain; 4] = [
        SHAPING,
        LINK_DAMPING,
        Gain::new("position", POSITION, |drive| drive.inner_bandwidth().powi(2)),
        Gain::new("velocity", RATE, |drive| 2.0 * drive.inner_bandwidth()),
    ];

    type Core<C: Scalar, const N: usize> = control::Cascade<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [shaping, link_damping, position, velocity] = gains.each_ref().map(vector);
        control::Cascade { shaping, link_damping, inner: InnerLoop { position, velocity } }
    }
}
