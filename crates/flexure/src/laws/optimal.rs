//! What optimal laws share: the weights of errors and torques, and designs whose joint count is hidden.

use flexure_core::control::{LinearModel, Mpc, QuadraticCost, Regulator};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::scalar::Scalar;

use crate::files::Problems;
use crate::files::quantity::Quantity;
use crate::laws::gain::Gain;
use crate::robot::sized::{OF_THE_KIND, fjr, sized};
use crate::robot::{Robot, padded};
use crate::units;

/// The error that costs 1 a second.
const ERROR: f64 = 0.05;

/// Weights of the errors of positions and velocities, and of torques.
pub(super) const WEIGHTS: [Gain; 5] = [
    Gain::new("link_position", Quantity::positive("weight of link position errors", units::NONE), |_| {
        ERROR.powi(-2)
    }),
    Gain::new("motor_position", Quantity::positive("weight of motor position errors", units::NONE), |_| {
        0.1 * ERROR.powi(-2)
    }),
    Gain::new("link_velocity", Quantity::positive("weight of link velocity errors", units::NONE), |drive| {
        (ERROR * drive.bandwidth()).powi(-2)
    }),
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

/// Why weights have no law.
pub(super) const NO_DESIGN: &str =
    "no feedback is optimal for these weights: they leave a motion unseen, or lie too far apart";

/// What the weights say, with joints that only fill the vectors.
fn cost<const N: usize>(weights: [&Vec<f64>; 5]) -> QuadraticCost<f64, N> {
    let [q, theta, v, w, torque] = weights.map(|weight| padded(weight, 1.0));
    QuadraticCost { state: [q, theta, v, w], torque }
}

/// A matrix by rows, of the joints that a robot has.
pub(super) type Rows = Vec<Vec<f64>>;

/// The rows of the first `n` joints.
fn rows<const N: usize>(matrix: &Matrix<f64, N, N>, n: usize) -> Rows {
    (0..n).map(|i| matrix.row(i).iter().take(n).collect()).collect()
}

/// No numbers, for `n` joints: of weights without a law no torque is one, and the loop says so at its first instant.
fn nothing(n: usize) -> Rows {
    vec![vec![f64::NAN; n]; n]
}

/// The matrix with these rows, each through `vector`, and zeros for joints that only fill it.
pub(super) fn matrix<C: Scalar, const N: usize>(
    rows: &Rows,
    vector: &impl Fn(&Vec<f64>) -> Vector<C, N>,
) -> Matrix<C, N, N> {
    let none = vec![0.0; rows.len()];
    let mut rows = rows.iter();
    Matrix([(); N].map(|()| vector(rows.next().unwrap_or(&none)).0))
}

/// F of q, θ, v and w, designed where all joints are at 0; not numbers where the weights have no stabilising solution, and of robots with more joints than this
/// program was built for. With a number `above` 1 it keeps torques on the links, each weighed as that of its motor, to so many times the least that any feedback
/// keeps them to.
pub(super) fn regulator(robot: &Robot, weights: [&Vec<f64>; 5], above: Option<f64>) -> [Rows; 4] {
    let n = robot.joint_count();
    let designed = || -> Result<_, Problems> {
        Ok(sized!(roomy robot, L, N => {
            let arm = fjr::<_, L<f64>, N>(robot, &robot.links, |x| x, &|x| x).expect(OF_THE_KIND);
            let (model, cost) = (LinearModel::at_rest(&arm, &Vector::ZERO), cost(weights));
            let by_torque = cost.torque.map(f64::sqrt);
            let attenuation = match above {
                None => Ok(f64::INFINITY),
                Some(above) => Regulator::least_attenuation(&model, &cost, &by_torque).map(|least| above * least),
            };
            let law = attenuation.and_then(|gamma| Regulator::continuous(&model, &cost, &by_torque.scaled(gamma)));
            law.ok().map(|law| law.gain.map(|block| rows(&block, n)))
        }))
    };
    designed().ok().flatten().unwrap_or_else(|| [(); 4].map(|()| nothing(n)))
}

/// Whether there is a law with these gains.
pub(super) fn is_designed(gains: &[Rows; 4]) -> bool {
    gains.iter().flatten().flatten().all(|gain| gain.is_finite())
}

/// What `values`, called `key`, are for all joints, or why they are not.
pub(super) fn one_for_all(key: &str, values: &[f64], reason: &str) -> Result<f64, String> {
    let first = values.first().copied().unwrap_or(f64::NAN);
    #[expect(clippy::float_cmp, reason = "one number, or another")]
    match values.iter().find(|value| **value != first) {
        Some(other) => Err(format!("{key} is {first} for one joint and {other} for another: {reason}")),
        None => Ok(first),
    }
}

/// What [`Mpc`] has of a design, by joints of the robot.
pub(super) struct Designed<const H: usize> {
    pub plan: [[Rows; 4]; H],
    pub leaving: [Rows; H],
    pub reach: Vec<f64>,
}

/// The plan of `H` torques, each held for a `step` in s, likewise.
pub(super) fn predictive<const H: usize>(robot: &Robot, weights: [&Vec<f64>; 5], step: f64) -> Designed<H> {
    let n = robot.joint_count();
    let designed = || -> Result<_, Problems> {
        Ok(sized!(roomy robot, L, N => {
            let arm = fjr::<_, L<f64>, N>(robot, &robot.links, |x| x, &|x| x).expect(OF_THE_KIND);
            let limit = Vector([f64::INFINITY; N]);
            let law = Mpc::<f64, N, H>::design(&arm, &Vector::ZERO, &cost(weights), step, &limit).ok();
            law.map(|law| Designed {
                plan: law.plan.each_ref().map(|gain| gain.each_ref().map(|block| rows(block, n))),
                leaving: law.leaving.each_ref().map(|block| rows(block, n)),
                reach: law.reach.iter().take(n).collect(),
            })
        }))
    };
    designed().ok().flatten().unwrap_or_else(|| Designed {
        plan: [(); H].map(|()| [(); 4].map(|()| nothing(n))),
        leaving: [(); H].map(|()| nothing(n)),
        reach: vec![f64::NAN; n],
    })
}
