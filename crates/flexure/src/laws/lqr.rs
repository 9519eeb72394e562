//! Optimal feedback of the whole state around the reference.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::Problems;
use crate::laws::gain::Gain;
use crate::laws::optimal::{self, NO_DESIGN, Rows, WEIGHTS, matrix, rows};
use crate::laws::registry::{Claim, LawKind};
use crate::robot::Robot;
use crate::robot::sized::{OF_THE_KIND, fjr, sized};

/// The kind `lqr`: [`control::Lqr`], designed where all joints are at 0.
pub struct Lqr;

impl LawKind for Lqr {
    const NAME: &'static str = "lqr";
    const SUMMARY: &'static str = "optimal feedback of the whole state, designed where the joints are at 0";
    const CLAIM: Claim = Claim::Nothing;

    type Gains = [Vec<f64>; 5];
    const GAINS: [Gain; 5] = WEIGHTS;

    fn objection(gains: &Self::Gains, robot: &Robot) -> Option<String> {
        let found = designed(robot, gains).ok()?;
        let none = found.iter().flatten().flatten().any(|gain| !gain.is_finite());
        none.then(|| NO_DESIGN.to_owned())
    }

    type Core<C: Scalar, const N: usize> = control::Lqr<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        robot: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let nothing = |_| std::array::from_fn(|_| optimal::nothing(robot.joint_count()));
        control::Lqr {
            gain: designed(robot, gains).unwrap_or_else(nothing).map(|rows| matrix(&rows, &vector)),
        }
    }
}

/// F of q, θ, v and w; not numbers where the weights have no stabilising solution.
///
/// # Errors
/// If the robot has more joints than this program was built for.
fn designed(robot: &Robot, gains: &[Vec<f64>; 5]) -> Result<[Rows; 4], Problems> {
    let n = robot.joint_count();
    Ok(sized!(roomy robot, L, N => {
        let arm = fjr::<_, L<f64>, N>(robot, &robot.links, |x| x, &|x| x).expect(OF_THE_KIND);
        let law = control::Lqr::design(&arm, &Vector::ZERO, &optimal::cost(gains.each_ref()), f64::INFINITY);
        law.map_or_else(|_| [(); 4].map(|()| optimal::nothing(n)), |law| law.gain.map(|block| rows(&block, n)))
    }))
}
