//! Optimal feedback that knows the torque limits.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::Problems;
use crate::files::quantity::Quantity;
use crate::laws::gain::Gain;
use crate::laws::optimal::{self, NO_DESIGN, Rows, WEIGHTS, matrix, rows};
use crate::laws::registry::{Claim, LawKind};
use crate::robot::Robot;
use crate::robot::sized::{OF_THE_KIND, fjr, sized};
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
        let first = steps.first()?;
        #[expect(clippy::float_cmp, reason = "one number, or another")]
        if let Some(other) = steps.iter().find(|step| *step != first) {
            return Some(format!(
                "step is {first} s for one joint and {other} s for another: all torques are planned together"
            ));
        }
        let found = designed(robot, gains).ok()?;
        let none = found.reach.iter().any(|reach| !reach.is_finite());
        none.then(|| NO_DESIGN.to_owned())
    }

    type Core<C: Scalar, const N: usize> = control::Mpc<C, N, HORIZON>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        robot: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let n = robot.joint_count();
        let Designed { plan, leaving, reach } =
            designed(robot, gains).unwrap_or_else(|_| Designed::nothing(n));
        control::Mpc {
            plan: plan.map(|gain| gain.map(|rows| matrix(&rows, &vector))),
            leaving: leaving.map(|rows| matrix(&rows, &vector)),
            reach: vector(&reach),
            limit: vector(&robot.limits.torque),
        }
    }
}

/// What the law has of a design, by joints of the robot; no numbers where the weights have no stabilising solution.
struct Designed {
    plan: [[Rows; 4]; HORIZON],
    leaving: [Rows; HORIZON],
    reach: Vec<f64>,
}

impl Designed {
    fn nothing(n: usize) -> Self {
        let nothing = || optimal::nothing(n);
        Self {
            plan: [(); HORIZON].map(|()| [(); 4].map(|()| nothing())),
            leaving: [(); HORIZON].map(|()| nothing()),
            reach: vec![f64::NAN; n],
        }
    }
}

/// # Errors
/// If the robot has more joints than this program was built for.
fn designed(robot: &Robot, gains: &[Vec<f64>; 6]) -> Result<Designed, Problems> {
    let n = robot.joint_count();
    let [q, theta, v, w, torque, step] = gains;
    Ok(sized!(roomy robot, L, N => {
        let arm = fjr::<_, L<f64>, N>(robot, &robot.links, |x| x, &|x| x).expect(OF_THE_KIND);
        let (cost, limit) = (optimal::cost([q, theta, v, w, torque]), Vector([f64::INFINITY; N]));
        let law = control::Mpc::<f64, N, HORIZON>::design(&arm, &Vector::ZERO, &cost, step[0], &limit);
        law.map_or_else(|_| Designed::nothing(n), |law| Designed {
            plan: law.plan.each_ref().map(|gain| gain.each_ref().map(|block| rows(block, n))),
            leaving: law.leaving.each_ref().map(|block| rows(block, n)),
            reach: law.reach.iter().take(n).collect(),
        })
    }))
}
