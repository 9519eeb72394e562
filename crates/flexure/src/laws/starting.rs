//! Gains to start from, for any robot and any law.

use std::f64::consts::FRAC_PI_2;

use crate::files::field::Field;
use crate::files::{Problem, Problems};
use crate::laws::{Controller, Drive, MAKERS};
use crate::robot::Robot;

/// Starting gains for what a file leaves out.
pub(crate) struct Starting<'a> {
    /// None if it could not be read: the file is bad already.
    pub robot: Option<&'a Robot>,
}

impl Starting<'_> {
    /// What each joint has to move, for what `field` leaves out; none after it has noted what is wrong.
    pub fn drives(&self, field: &Field<'_>) -> Option<Vec<Drive>> {
        let note = |problems: Problems| {
            for problem in problems {
                field.error(problem.code_word(), problem.to_string(), problem.hint());
            }
        };
        drives(self.robot?).map_err(note).ok()
    }
}

impl Controller {
    /// The law of this kind with gains made from stiffness, motor inertia and link inertia of each joint: where tuning
    /// starts on any robot. All laws are to make errors decay at the same [rate](Drive::bandwidth); the file of each law says
    /// for each gain how.
    ///
    /// # Errors
    /// For an unknown kind, and if the robot has more joints than this program was built for.
    pub fn default_for(kind: &str, robot: &Robot) -> Result<Self, Problems> {
        let drives = drives(robot)?;
        let Some((_, maker)) = MAKERS.iter().find(|(name, _)| *name == kind) else {
            let hint = "`flexure list controllers` shows them";
            return Err(
                Problem::new("unknown-name", format!("no controller is called '{kind}'"), hint).into()
            );
        };
        Ok((maker.start)(&drives))
    }

    /// The same law with gain number `gain`, of all joints, times `factor`; the order is that of [`gains`](Self::gains).
    #[must_use]
    pub fn with_gain(&self, gain: usize, factor: f64) -> Self {
        let mut changed = self.clone();
        for value in changed.slots().swap_remove(gain) {
            *value *= factor;
        }
        changed
    }
}

/// What each joint has to move.
pub(crate) fn drives(robot: &Robot) -> Result<Vec<Drive>, Problems> {
    const SIZES: &str = "slices of n joints";
    let (n, arm) = (robot.joint_count(), robot.arm()?);
    let mut mass = vec![0.0; n * n];
    arm.mass_matrix(&vec![0.0; n], &mut mass).expect(SIZES);
    let only = |joint: usize, value: f64| {
        let mut q = vec![0.0; n];
        q[joint] = value;
        q
    };
    let postures: Vec<_> = (0..n).map(|joint| only(joint, FRAC_PI_2)).chain([vec![0.0; n]]).collect();
    let free_inertia = |i: usize| {
        let at = |q: &Vec<f64>| {
            let mut acceleration = vec![0.0; n];
            arm.solve_mass(q, &only(i, 1.0), &mut acceleration).expect(SIZES);
            1.0 / acceleration[i]
        };
        postures.iter().map(at).fold(f64::INFINITY, f64::min)
    };
    let drive = |i: usize| Drive {
        stiffness: robot.stiffness[i],
        motor_inertia: robot.motor_inertia[i],
        link_inertia: mass[i * (n + 1)],
        free_inertia: free_inertia(i),
        link_damping: robot.link_damping[i],
    };
    Ok((0..n).map(drive).collect())
}
