//! A tree of joints: `kind = "tree"`.

use std::collections::HashMap;

use crate::files::base::Base;
use crate::files::suggest;
use crate::files::table::Table;
use crate::robot::links::assembly::{self, Joint};
use crate::robot::links::{Assembled, joint};

pub(crate) fn read(table: &Table<'_>, _: &Base) -> Option<Assembled> {
    let fields = table.required("joint", "[[links.joint]], once for each joint")?.tables()?;
    let entries: Vec<_> = fields.iter().map(joint::read).collect();
    let entries = entries.into_iter().collect::<Option<Vec<_>>>()?;
    assembly::assemble(&linked(entries)?, table.decimals(), || {
        table.error(
            "immovable",
            "links.joint: no joint moves",
            "at least one joint must be revolute or prismatic",
        );
    })
}

/// The joints with their parents found; notes an error at the first that has none, or the name of another.
fn linked(entries: Vec<joint::Entry<'_>>) -> Option<Vec<Joint<'_>>> {
    let mut indices = HashMap::new();
    let mut joints = Vec::new();
    for entry in entries {
        let mut joint = entry.joint;
        if let Some((name, field)) = &entry.parent {
            joint.parent = indices.get(name).copied();
            if joint.parent.is_none() {
                let message = format!("{} is {}, which is no joint above", field.path, suggest::quoted(name));
                let mut known: Vec<&str> = indices.keys().copied().collect();
                known.sort_unstable();
                let help = suggest::hint(name, known.into_iter());
                field.error("parent", message, format!("parents stand before their children; {help}"));
                return None;
            }
        }
        if indices.insert(entry.name, joints.len()).is_some() {
            let message =
                format!("{}: a second joint is called {}", joint.site.path, suggest::quoted(entry.name));
            joint.site.error("duplicate", message, "every joint has a name of its own");
            return None;
        }
        joints.push(joint);
    }
    Some(joints)
}
