//! Backstepping by filters that finds out what the links weigh.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::adaptation::{self, ADAPTED, PARAMETERS, adaptation};
use crate::laws::command_filtered_backstepping::{FILTERED, FILTERS, filtered};
use crate::laws::gain::Gain;
use crate::laws::registry::{Claim, LawKind};
use crate::robot::Robot;

/// The kind `adaptive-command-filtered-backstepping`: [`control::AdaptiveCommandFilteredBackstepping`].
pub struct AdaptiveCommandFilteredBackstepping;

impl LawKind for AdaptiveCommandFilteredBackstepping {
    const NAME: &'static str = "adaptive-command-filtered-backstepping";
    const SUMMARY: &'static str = "backstepping by filters, adapting the parameters of the links";
    const CLAIM: Claim = Claim::Errors;
    const MEMORY: &'static [(&'static str, &'static str)] = &MEMORY;

    type Gains = [Vec<f64>; 10];
    const GAINS: [Gain; 10] = {
        let [shaping, link_damping, metric, motor_shaping, rate_metric, rate_shaping, bandwidth] = FILTERED;
        let [adaptation, range, least] = ADAPTED;
        [
            shaping,
            link_damping,
            metric,
            motor_shaping,
            rate_metric,
            rate_shaping,
            bandwidth,
            adaptation,
            range,
            least,
        ]
    };

    fn objection(gains: &Self::Gains, _robot: &Robot) -> Option<String> {
        let [.., least] = gains;
        adaptation::objection(least)
    }

    type Core<C: Scalar, const N: usize> = control::AdaptiveCommandFilteredBackstepping<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        robot: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [a, b, c, d, e, f, g, rate, range, least] = gains;
        control::AdaptiveCommandFilteredBackstepping {
            nominal: filtered([a, b, c, d, e, f, g], &vector),
            adaptation: adaptation(robot, [rate, range, least], &vector),
        }
    }
}

const MEMORY: [(&str, &str); 16] = {
    let [x_3c, dx_3c, x_4c, dx_4c, xi_2, xi_3] = FILTERS;
    let [p0, p1, p2, p3, p4, p5, p6, p7, p8, p9] = PARAMETERS;
    [x_3c, dx_3c, x_4c, dx_4c, xi_2, xi_3, p0, p1, p2, p3, p4, p5, p6, p7, p8, p9]
};
