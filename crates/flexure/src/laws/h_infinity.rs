//! Optimal feedback of the whole state against torques on the links.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::Gain;
use crate::laws::optimal::{NO_DESIGN, Rows, WEIGHTS, is_designed, matrix, one_for_all, regulator};
use crate::laws::registry::{Claim, LawKind};
use crate::robot::Robot;
use crate::units;

/// The kind `h-infinity`: [`control::HInfinity`], designed where all joints are at 0, torques on links weighed as those of their motors.
pub struct HInfinity;

impl LawKind for HInfinity {
    const NAME: &'static str = "h-infinity";
    const SUMMARY: &'static str =
        "optimal feedback of the whole state against the worst torques on the links";
    const CLAIM: Claim = Claim::Nothing;

    type Gains = [Vec<f64>; 6];
    const GAINS: [Gain; 6] = {
        let [q, theta, v, w, torque] = WEIGHTS;
        let above = Quantity::at_least_one("attenuation over the least that any feedback has", units::NONE);
        [q, theta, v, w, torque, Gain::new("attenuation", above, |_| 1.5)]
    };

    fn objection(gains: &Self::Gains, robot: &Robot) -> Option<String> {
        let [.., attenuation] = gains;
        if let Err(objection) = one_for_all("attenuation", attenuation, "the whole state has one feedback") {
            return Some(objection);
        }
        (!is_designed(&designed(robot, gains))).then(|| NO_DESIGN.to_owned())
    }

    type Core<C: Scalar, const N: usize> = control::HInfinity<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        robot: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        control::Lqr { gain: designed(robot, gains).map(|rows| matrix(&rows, &vector)) }
    }
}

/// F with these gains.
fn designed(robot: &Robot, [q, theta, v, w, torque, attenuation]: &[Vec<f64>; 6]) -> [Rows; 4] {
    // All are alike.
    regulator(robot, [q, theta, v, w, torque], attenuation.first().copied())
}
