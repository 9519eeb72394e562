//! Optimal feedback that knows the torque limits.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::gain::Gain;
use crate::laws::optimal::{Designed, NO_DESIGN, WEIGHTS, matrix, one_for_all, predictive};
use crate::laws::registry::{Claim, LawKind};
use crate::robot::Robot;
use crate::units;

/// The kind `mpc`: [`control::Mpc`], designed where all joints are at 0, for the torque limits of the robot.
pub struct Mpc;

/// Torques that are planned.
const HORIZON: usize = 10;

impl LawKind for Mpc {
    const NAME: &'static str = "mpc";
    const SUMMARY: &'static str =
        "optimal torques within the limits of the robot, ten steps ahead, designed where the joints are at 0";
    const CLAIM: Claim = Claim::Nothing;

    type Gains = [Vec<f64>; 6];
    const GAINS: [Gain; 6] = {
        let [q, theta, v, w, torque] = WEIGHTS;
        let step = Quantity::positive("time for which each of ten planned torques is held", units::TIME);
        [q, theta, v, w, torque, Gain::new("step", step, |_| 0.002)]
    };

    fn objection(gains: &Self::Gains, robot: &Robot) -> Option<String> {
        let [.., steps] = gains;
        if let Err(objection) = one_for_all("step", steps, "all torques are planned together") {
            return Some(objection);
        }
        let none = designed(robot, gains).reach.iter().any(|reach| !reach.is_finite());
        none.then(|| NO_DESIGN.to_owned())
    }

    type Core<C: Scalar, const N: usize> = control::Mpc<C, N, HORIZON>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        robot: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let Designed { plan, leaving, reach } = designed(robot, gains);
        control::Mpc {
            plan: plan.map(|gain| gain.map(|rows| matrix(&rows, &vector))),
            leaving: leaving.map(|rows| matrix(&rows, &vector)),
            reach: vector(&reach),
            limit: vector(&robot.limits.torque),
        }
    }
}

/// The plan with these gains.
fn designed(robot: &Robot, gains: &[Vec<f64>; 6]) -> Designed<HORIZON> {
    let [q, theta, v, w, torque, step] = gains;
    // All are alike.
    predictive(robot, [q, theta, v, w, torque], step.first().copied().unwrap_or(f64::NAN))
}
