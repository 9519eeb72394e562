//! `[controller]`: the law and its gains.

use crate::files::field::{Field, Joints};
use crate::laws::{Controller, MAKERS};

impl Controller {
    /// The same law with other gains, in the order of [`gains`](Self::gains); gains beyond the end of `values` stay.
    pub fn with_gains(&self, values: &[Vec<f64>]) -> Self {
        let mut changed = self.clone();
        for (slot, value) in changed.slots().into_iter().zip(values) {
            slot.clone_from(value);
        }
        changed
    }
}

/// Reads `[controller]`.
pub(crate) fn read(field: &Field<'_>, joints: &Joints) -> Option<Controller> {
    let maker = field.any_table()?.choice("kind", MAKERS)?;
    (maker.read)(field, joints)
}
