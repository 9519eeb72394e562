//! Optimal feedback of the whole state around the reference.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::gain::Gain;
use crate::laws::optimal::{NO_DESIGN, WEIGHTS, is_designed, matrix, regulator};
use crate::laws::registry::{Claim, LawKind};
use crate::robot::Robot;

/// The kind `lqr`: [`control::Lqr`], designed where all joints are at 0.
pub struct Lqr;

impl LawKind for Lqr {
    const NAME: &'static str = "lqr";
    const SUMMARY: &'static str = "optimal feedback of the whole state, designed where the joints are at 0";
    const CLAIM: Claim = Claim::Nothing;

    type Gains = [Vec<f64>; 5];
    const GAINS: [Gain; 5] = WEIGHTS;

    fn objection(gains: &Self::Gains, robot: &Robot) -> Option<String> {
        let none = !is_designed(&regulator(robot, gains.each_ref(), None));
        none.then(|| NO_DESIGN.to_owned())
    }

    type Core<C: Scalar, const N: usize> = control::Lqr<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        robot: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        control::Lqr { gain: regulator(robot, gains.each_ref(), None).map(|rows| matrix(&rows, &vector)) }
    }
}
