//! Links from a URDF: `kind = "urdf"`.

use super::Assembled;
use crate::io::base::Base;
use crate::io::document::Log;
use crate::io::field::Field;
use crate::io::quantity;
use crate::io::suggest;
use crate::io::table::Table;
use crate::io::urdf::{self, Locks, Urdf};

pub(super) fn read(table: &Table<'_>, base: &Base) -> Option<Assembled> {
    let locked = table.optional("locked", locked);
    let file = table.required("file", "path of a URDF, relative to this file")?;
    let source = match base.read(file.text()?, urdf::LIMIT) {
        Ok(source) => source,
        Err(problem) => {
            file.log.push(problem.or_at(&file.log.source, file.span.clone()));
            return None;
        }
    };
    let locked = locked?.unwrap_or_default();
    let log = Log::new(&source);
    let assembled = urdf::with(&log, |urdf| {
        let sound: Vec<_> = locked.iter().map(|(name, q, field)| can_lock(&urdf, name, *q, field)).collect();
        sound.into_iter().collect::<Option<()>>()?;
        urdf.assemble(&locked.iter().map(|(name, q, _)| (*name, *q)).collect::<Locks<'_>>())
    });
    // What is wrong with the locks is in this file's log, not in that of the URDF.
    file.log.absorb(log.finish(Some(assembled)))?
}

/// Joints to hold still, where, and where that stands.
fn locked<'a>(field: &Field<'a>) -> Option<Vec<(&'a str, f64, Field<'a>)>> {
    let table = field.any_table()?;
    let entries: Vec<_> =
        table.fields().map(|(name, field)| Some((name, field.number(&quantity::ANGLE)?, field))).collect();
    entries.into_iter().collect()
}

/// Notes an error if there is no such joint, or none that moves, and a warning if it cannot be held there.
fn can_lock(urdf: &Urdf<'_>, name: &str, q: f64, field: &Field<'_>) -> Option<()> {
    let Some(joint) = urdf.joints.iter().find(|joint| joint.name == name) else {
        let message = format!("{} names no joint of the URDF", field.path);
        let moving = urdf.joints.iter().filter(|joint| joint.moves());
        field.error("unknown-name", message, suggest::hint(name, moving.map(|joint| joint.name)));
        return None;
    };
    if !joint.moves() {
        field.error(
            "lock",
            format!("{} is a fixed joint", field.path),
            "only joints that move can be locked",
        );
        return None;
    }
    let (lower, upper) = (joint.drive.position_lower, joint.drive.position_upper);
    if lower.is_some_and(|lower| q < lower) || upper.is_some_and(|upper| q > upper) {
        let range = format!("{} to {}", lower.unwrap_or(f64::NEG_INFINITY), upper.unwrap_or(f64::INFINITY));
        let message = format!("{} is {q}, outside the limits {range} of the URDF", field.path);
        field.warn("limits", message, "rad, or m for a prismatic joint");
    }
    Some(())
}
