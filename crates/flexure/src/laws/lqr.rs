//! Optimal feedback of the whole state around the reference.

use flexure_core::control::{self, QuadraticCost};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::Scalar;

use crate::files::Problems;
use crate::files::quantity::Quantity;
use crate::laws::gain::Gain;
use crate::laws::registry::{Claim, LawKind};
use crate::robot::sized::{OF_THE_KIND, fjr, sized};
use crate::robot::{Robot, padded};
use crate::units;

/// The kind `lqr`: [`control::Lqr`], designed where all joints are at 0.
pub struct Lqr;

/// The error that costs 1 a second.
const ERROR: f64 = 0.05;

impl LawKind for Lqr {
    const NAME: &'static str = "lqr";
    const SUMMARY: &'static str = "optimal feedback of the whole state, designed where the joints are at 0";
    const CLAIM: Claim = Claim::Nothing;

    type Gains = [Vec<f64>; 5];
    const GAINS: [Gain; 5] = [
        Gain::new("link_position", Quantity::positive("weight of link position errors", units::NONE), |_| {
            ERROR.powi(-2)
        }),
        Gain::new(
            "motor_position",
            Quantity::positive("weight of motor position errors", units::NONE),
            |_| 0.1 * ERROR.powi(-2),
        ),
        Gain::new(
            "link_velocity",
            Quantity::positive("weight of link velocity errors", units::NONE),
            |drive| (ERROR * drive.bandwidth()).powi(-2),
        ),
        Gain::new(
            "motor_velocity",
            Quantity::positive("weight of motor velocity errors", units::NONE),
            |drive| 0.1 * (ERROR * drive.bandwidth()).powi(-2),
        ),
        Gain::new(
            "torque",
            Quantity::positive("weight of torques beside those of the reference", units::NONE),
            |drive| (ERROR * drive.motor_stiffness()).powi(-2),
        ),
    ];

    fn objection(gains: &Self::Gains, robot: &Robot) -> Option<String> {
        let found = designed(robot, gains).ok()?;
        let none = found.iter().flatten().flatten().any(|gain| !gain.is_finite());
        none.then(|| {
            "no feedback is optimal for these weights: they leave a motion unseen, or lie too far apart"
                .to_owned()
        })
    }

    type Core<C: Scalar, const N: usize> = control::Lqr<C, N>;

    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        robot: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N> {
        let n = robot.joint_count();
        // Weights without a stabilising solution: no torque is a number, and the loop says so at its first instant.
        let design =
            designed(robot, gains).unwrap_or_else(|_| std::array::from_fn(|_| vec![vec![f64::NAN; n]; n]));
        let none = vec![0.0; n];
        control::Lqr {
            gain: design.map(|rows| {
                let mut rows = rows.iter();
                Matrix([(); N].map(|()| vector(rows.next().unwrap_or(&none)).0))
            }),
        }
    }
}

/// F of q, θ, v and w, rows of numbers each; not numbers where the weights have no stabilising solution.
///
/// # Errors
/// If the robot has more joints than this program was built for.
fn designed(robot: &Robot, gains: &[Vec<f64>; 5]) -> Result<[Vec<Vec<f64>>; 4], Problems> {
    let n = robot.joint_count();
    Ok(sized!(robot, L, N => {
        let arm = fjr::<_, L<f64>, N>(robot, &robot.links, |x| x, &|x| x).expect(OF_THE_KIND);
        let [q, theta, v, w, torque] = gains.each_ref().map(|gain| padded(gain, 1.0));
        let cost = QuadraticCost { state: [q, theta, v, w], torque };
        let law = control::Lqr::design(&arm, &Vector::ZERO, &cost, f64::INFINITY);
        let gain = law.map_or([Matrix([[f64::NAN; N]; N]); 4], |law| law.gain);
        gain.map(|block| (0..n).map(|i| block.row(i).iter().take(n).collect()).collect())
    }))
}
