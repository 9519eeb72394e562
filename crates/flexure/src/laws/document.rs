//! `[controller]`: the law and its gains.

use crate::files::field::{Field, Joints};
use crate::laws::registry::Doubt;
use crate::laws::starting::Starting;
use crate::laws::{Controller, MAKERS};
use crate::robot::Robot;

impl Controller {
    /// What files have of it: `[controller]` with every gain.
    pub fn to_toml(&self) -> String {
        let phi = self.phi().map(|phi| format!("phi = \"{phi}\"\n")).unwrap_or_default();
        let mut text = format!("[controller]\nkind = \"{}\"\n{phi}", self.kind());
        let mut table = "";
        let gains = self.gains();
        for (path, values) in &gains {
            let (within, key) = path.rsplit_once('.').unwrap_or(("", path));
            if within != table {
                text.extend(["[controller.", within, "]\n"]);
                table = within;
            }
            text.extend([key, " = ", &format!("{values:?}"), "\n"]);
        }
        text
    }

    /// The same law with other gains, in the order of [`gains`](Self::gains); gains beyond the end of `values` stay.
    pub fn with_gains(&self, values: &[Vec<f64>]) -> Self {
        let mut changed = self.clone();
        for (slot, value) in changed.slots().into_iter().zip(values) {
            slot.clone_from(value);
        }
        changed
    }
}

/// Reads `[controller]` for `robot`, if that could be read. With `kind` alone the gains are the starting ones.
pub(crate) fn read(field: &Field<'_>, joints: &Joints, robot: Option<&Robot>) -> Option<Controller> {
    let maker = field.any_table()?.choice("kind", MAKERS)?;
    let controller = (maker.read)(field, joints, &Starting { robot })?;
    if let Some(message) = robot.and_then(|robot| controller.objection(robot)) {
        field.error("gains", message, "leave the gains out to start from those made for the robot");
        return None;
    }
    if let Some(Doubt { message, help }) = robot.and_then(|robot| controller.doubt(robot)) {
        field.warn("gains", message, help);
    }
    Some(controller)
}
