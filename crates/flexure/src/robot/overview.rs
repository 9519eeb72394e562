//! The assembled robot at a glance: a row per moving joint.

use std::f64::consts::TAU;

use serde::Serialize;

use crate::files::Problems;
use crate::robot::{self, JointKind, Robot};

/// A moving joint of a robot. For a prismatic one read m for rad, N for N m and kg for kg m².
#[derive(Clone, Debug, Serialize)]
pub struct JointRow {
    /// Name of the joint.
    pub name: String,
    /// `revolute` or `prismatic`.
    pub kind: &'static str,
    /// Name of the moving joint that carries it; none for the base.
    pub parent: Option<String>,
    /// Joint stiffness K [N m/rad].
    pub stiffness: f64,
    /// Motor inertia M_m [kg m²].
    pub motor_inertia: f64,
    /// Inertia that the joint moves at q = 0 with the others held, the diagonal of M_l [kg m²].
    pub link_inertia: f64,
    /// Frequency at which link and motor swing against each other at q = 0 with the other joints held, in Hz.
    pub resonance: f64,
    /// Link damping D_l [N m s/rad].
    pub link_damping: f64,
    /// Motor damping D_m [N m s/rad].
    pub motor_damping: f64,
    /// Motor turns per joint turn (per metre for a prismatic joint), if the file says so.
    pub gear_ratio: Option<f64>,
    /// Largest motor torque [N m].
    pub torque_limit: Option<f64>,
    /// Largest velocity [rad/s].
    pub velocity_limit: Option<f64>,
    /// Largest deflection of the spring in rad.
    pub deflection_limit: Option<f64>,
    /// Smallest link position in rad.
    pub position_lower: Option<f64>,
    /// Largest link position in rad.
    pub position_upper: Option<f64>,
}

/// A row per moving joint of `robot`, in their order.
///
/// # Errors
/// If the robot has more joints than this program was built for.
///
/// # Panics
/// Never: the arm is asked for the joints that it has.
pub fn overview(robot: &Robot) -> Result<Vec<JointRow>, Problems> {
    let n = robot.joint_count();
    let mut mass = vec![0.0; n * n];
    robot.arm()?.mass_matrix(&vec![0.0; n], &mut mass).expect("n joints");
    let link_inertia: Vec<f64> = mass.iter().step_by(n + 1).copied().collect();
    // The links of a closed form are a chain.
    let tree = robot.links.tree();
    let parent = |i: usize| tree.get(i).map_or_else(|| i.checked_sub(1), |body| body.parent);
    let limit = |limits: &[f64], i: usize| Some(limits[i]).filter(|limit| limit.is_finite());
    let row = |(i, joint): (usize, &robot::MovingJoint)| {
        let (stiffness, motor_inertia) = (robot.stiffness[i], robot.motor_inertia[i]);
        JointRow {
            name: joint.name.clone(),
            kind: kind_in_words(joint.kind),
            parent: parent(i).map(|parent| robot.joints[parent].name.clone()),
            stiffness,
            motor_inertia,
            link_inertia: link_inertia[i],
            resonance: (stiffness * (motor_inertia.recip() + link_inertia[i].recip())).sqrt() / TAU,
            link_damping: robot.link_damping[i],
            motor_damping: robot.motor_damping[i],
            gear_ratio: robot.gear_ratio.as_ref().map(|ratios| ratios[i]),
            torque_limit: limit(&robot.limits.torque, i),
            velocity_limit: limit(&robot.limits.velocity, i),
            deflection_limit: limit(&robot.limits.deflection, i),
            position_lower: limit(&robot.limits.lower, i),
            position_upper: limit(&robot.limits.upper, i),
        }
    };
    Ok(robot.joints.iter().enumerate().map(row).collect())
}

/// How a joint moves, as in files.
pub(crate) fn kind_in_words(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
    }
}
