//! Gains to start from, for any robot and any law.

use std::f64::consts::FRAC_PI_2;

use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, MassFactor};

use crate::files::{Problem, Problems};
use crate::laws::{Controller, Drive, MAKERS};
use crate::robot::{Robot, RobotVisitor, with_robot};

impl Controller {
    /// The law of this kind with gains made from stiffness, motor inertia and link inertia of each joint: where tuning
    /// starts on any robot. All laws are to make errors decay at the same [rate](Drive::bandwidth); the file of each law says
    /// for each gain how.
    ///
    /// # Errors
    /// For an unknown kind, and if the robot has more joints than this program was built for.
    pub fn default_for(kind: &str, robot: &Robot) -> Result<Self, Problems> {
        let drives = with_robot(robot, Drives)?;
        let Some((_, maker)) = MAKERS.iter().find(|(name, _)| *name == kind) else {
            let hint = "`flexure list controllers` shows them";
            return Err(
                Problem::new("unknown-name", format!("no controller is called '{kind}'"), hint).into()
            );
        };
        Ok((maker.start)(&drives))
    }
}

/// What each joint has to move.
struct Drives;

impl RobotVisitor for Drives {
    type Output = Vec<Drive>;

    fn visit<L: Links<f64, N> + Sync, const N: usize>(self, robot: Fjr<f64, L, N>) -> Vec<Drive> {
        let mass = robot.links.mass_matrix::<f64>(&Vector::ZERO);
        let turned = |joint: usize| Vector::from_fn(|i| if i == joint { FRAC_PI_2 } else { 0.0 });
        let postures: Vec<Vector<f64, N>> = (0..N).map(turned).chain([Vector::ZERO]).collect();
        let free_inertia = |i: usize| {
            let push = Vector::from_fn(|j| if i == j { 1.0 } else { 0.0 });
            let at = |q| 1.0 / robot.links.factor::<f64>(q).solve(&push)[i];
            postures.iter().map(at).fold(f64::INFINITY, f64::min)
        };
        let drive = |i: usize| Drive {
            stiffness: robot.stiffness[i],
            motor_inertia: robot.motor_inertia[i],
            link_inertia: mass[(i, i)],
            free_inertia: free_inertia(i),
        };
        (0..N).map(drive).collect()
    }
}
