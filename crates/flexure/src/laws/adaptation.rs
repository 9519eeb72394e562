//! How laws find out what the links weigh: the gains of it in files.

use flexure_core::control::Adaptation;
use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Parameters};
use flexure_core::scalar::Scalar;

use crate::files::Problems;
use crate::files::quantity::Quantity;
use crate::laws::gain::Gain;
use crate::robot::Robot;
use crate::robot::links::FromFile;
use crate::robot::sized::sized;
use crate::units;

/// γ, how far bounds are, ε.
pub(super) const ADAPTED: [Gain; 3] = [
    Gain::new(
        "adaptation",
        Quantity::non_negative("rate γ of adapting the share of each parameter", units::PER_ENERGY),
        |drive| {
            // K_2 Λ over the square of the torque that the motor's stiffness gives at half a radian.
            let torque = 0.5 * drive.motor_stiffness();
            drive.free_inertia * drive.bandwidth().powi(2) / torque.powi(2)
        },
    ),
    Gain::new("range", Quantity::positive("share by which each parameter may be off", units::NONE), |_| 0.5),
    Gain::new(
        "least",
        Quantity::positive("share ε of each pivot of the mass matrix that adapting leaves", units::NONE),
        |_| 0.2,
    ),
];

/// What they adapt, of each body in the frame that the tree turns for it.
pub(super) const PARAMETERS: [(&str, &str); 10] = [
    ("phi_0", ""),
    ("phi_1", ""),
    ("phi_2", ""),
    ("phi_3", ""),
    ("phi_4", ""),
    ("phi_5", ""),
    ("phi_6", ""),
    ("phi_7", ""),
    ("phi_8", ""),
    ("phi_9", ""),
];

/// The parameters of the links of `robot`, a number per joint each.
///
/// # Errors
/// If the robot has more joints than this program was built for.
fn parameters(robot: &Robot) -> Result<[Vec<f64>; 10], Problems> {
    Ok(sized!(roomy robot, L, N => {
        let links = <L<f64> as FromFile<f64, N>>::from_file(&robot.links, robot.gravity, &|x| x);
        let found: Parameters<f64, N> = links.as_ref().map_or([Vector::ZERO; 10], Links::parameters);
        found.map(|slot| slot.iter().take(robot.joint_count()).collect())
    }))
}

/// Why ε is none, if it is not.
pub(super) fn objection(least: &[f64]) -> Option<String> {
    let share = least.iter().find(|share| **share >= 1.0)?;
    Some(format!(
        "least is {share}, must be < 1: it is a share of the pivots that the robot's own mass matrix has"
    ))
}

/// Adaptation with these gains: γ, range and ε per joint.
pub(super) fn adaptation<C: Scalar, const N: usize>(
    robot: &Robot,
    [rate, range, least]: [&Vec<f64>; 3],
    vector: &impl Fn(&Vec<f64>) -> Vector<C, N>,
) -> Adaptation<C, N> {
    // A robot that is too large has no loop either.
    let parameters = parameters(robot).unwrap_or_default();
    // Joints that only fill a vector have no parameters.
    let own = |values: Vec<f64>| {
        let padded = vector(&values);
        Vector::from_fn(|i| if i < values.len() { padded[i] } else { C::ZERO })
    };
    let each = |f: &dyn Fn(usize, f64) -> f64| {
        parameters.each_ref().map(|slot| own(slot.iter().enumerate().map(|(i, phi)| f(i, *phi)).collect()))
    };
    Adaptation {
        gain: each(&|i, phi| rate[i] * phi * phi),
        low: each(&|i, phi| phi - range[i] * phi.abs()),
        high: each(&|i, phi| phi + range[i] * phi.abs()),
        least: own(least.clone()),
    }
}
