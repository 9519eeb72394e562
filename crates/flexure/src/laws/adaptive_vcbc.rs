//! v-CBC by filters that finds out what the links weigh.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::adaptation::{self, ADAPTED, PARAMETERS, adaptation};
use crate::laws::command_filtered_backstepping::{FILTERED, FILTERS, filtered};
use crate::laws::gain::Gain;
use crate::laws::registry::{Claim, LawKind};
use crate::robot::Robot;
use crate::units;

/// The kind `adaptive-vcbc`: [`control::AdaptiveVcbc`].
pub struct AdaptiveVcbc;

impl LawKind for AdaptiveVcbc {
    const NAME: &'static str = "adaptive-vcbc";
    const SUMMARY: &'static str = "v-CBC by filters, adapting the parameters of the links";
    const CLAIM: Claim = Claim::Errors;
    const MEMORY: &'static [(&'static str, &'static str)] = &MEMORY;

    type Gains = [Vec<f64>; 11];
    const GAINS: [Gain; 11] = {
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
            Gain::new(
                "link_metric",
                Quantity::positive("metric Π_l of link errors", units::STIFFNESS),
                |drive| drive.free_inertia * drive.bandwidth().powi(2),
            ),
            adaptation,
            range,
            least,
        ]
    };

    fn objection(gains: &Self::Gains, _robot: &Robot) -> Option<String> {
        let [.., least] = gains;
        adaptation::objection(least)
    }

    type Core<C: Scalar, const N: usize> = control::AdaptiveVcbc<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        robot: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let [a, b, c, d, e, f, g, link_metric, rate, range, least] = gains;
        control::AdaptiveVcbc {
            backstepping: filtered([a, b, c, d, e, f, g], &vector),
            link_metric: vector(link_metric),
            adaptation: adaptation(robot, [rate, range, least], &vector),
        }
    }
}

const MEMORY: [(&str, &str); 17] = {
    let [x_3c, dx_3c, x_4c, dx_4c, xi_2, xi_3] = FILTERS;
    let [p0, p1, p2, p3, p4, p5, p6, p7, p8, p9] = PARAMETERS;
    [x_3c, dx_3c, x_4c, dx_4c, ("xi_1", "rad"), xi_2, xi_3, p0, p1, p2, p3, p4, p5, p6, p7, p8, p9]
};
