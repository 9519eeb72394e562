//! `[plant]`: what is simulated and the law does not know.

use crate::files::field::{Field, Joints};
use crate::files::quantity;
use crate::files::table::Table;
use crate::robot::Robot;

/// What the simulated robot has beyond the model of the law: nothing by default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plant {
    /// Gear ratios by which rotors couple to the links; none for the reduced model.
    pub rotor_coupling: Option<Vec<f64>>,
    /// Whether the drives give more than the robot's torque limits; they saturate there by default.
    pub unlimited: bool,
    /// k ≥ 0 in the spring torque K ζ + k ζ³; none for linear springs [N m/rad³].
    pub spring_hardening: Option<Vec<f64>>,
}

impl Plant {
    /// What it has, as keys of the file.
    pub fn options(&self) -> Vec<&'static str> {
        let coupling = self.rotor_coupling.as_ref().map(|_| "rotor_coupling");
        let hardening = self.spring_hardening.as_ref().map(|_| "spring_hardening");
        coupling.into_iter().chain(hardening).collect()
    }
}

/// Reads `[plant]` of a scenario; `robot` is none if its own file could not be read.
pub(crate) fn read(root: &Table<'_>, joints: &Joints, robot: Option<&Robot>) -> Option<Plant> {
    let Some(field) = root.get("plant") else { return Some(Plant::default()) };
    let table = field.table(&["rotor_coupling", "spring_hardening", "torque_limits"])?;
    let limited = table.optional("torque_limits", Field::boolean);
    let coupling = table.optional("rotor_coupling", |field| gears(field, robot));
    let hardening =
        table.optional("spring_hardening", |field| field.per_joint(joints, &quantity::SPRING_HARDENING));
    Some(Plant {
        rotor_coupling: coupling?.flatten(),
        unlimited: !limited?.unwrap_or(true),
        spring_hardening: hardening?,
    })
}

/// The robot's gear ratios if the rotors shall couple.
#[expect(clippy::option_option, reason = "bad, coupled and uncoupled are three cases")]
fn gears(field: &Field<'_>, robot: Option<&Robot>) -> Option<Option<Vec<f64>>> {
    if !field.boolean()? {
        return Some(None);
    }
    let robot = robot?;
    if robot.gear_ratio.is_none() {
        let message = format!("{} is true, but robot {} has no gear ratios", field.path, robot.name);
        field.error(
            "missing-key",
            message,
            "add gear_ratio to [joints] of the robot file: motor turns per joint turn, negative if they turn in \
             opposite senses; with motor_inertia it says how much spin momentum couples to the links",
        );
        return None;
    }
    Some(robot.gear_ratio.clone())
}
