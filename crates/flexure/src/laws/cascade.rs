//! Spring torques by an inner loop of motor positions.

use flexure_core::control::{self, InnerLoop};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::gain::{Gain, INNER, LINK_DAMPING, SHAPING};
use crate::laws::registry::LawKind;
use crate::robot::Robot;

/// The kind `cascade`: [`control::Cascade`].
pub struct Cascade;

impl LawKind for Cascade {
    const NAME: &'static str = "cascade";
    const SUMMARY: &'static str = "spring torques by an inner loop of motor positions";

    type Gains = [Vec<f64>; 4];
    const GAINS: [Gain; 4] = [SHAPING, LINK_DAMPING, INNER[0], INNER[1]];

    type Core<C: Scalar, const N: usize> = control::Cascade<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        _: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [shaping, link_damping, position, velocity] = gains.each_ref().map(vector);
        control::Cascade { shaping, link_damping, inner: InnerLoop { position, velocity } }
    }
}
