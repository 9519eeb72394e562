//! Links from a URDF: `kind = "urdf"`.

use crate::files::base::Base;
use crate::files::document::Log;
use crate::files::field::Field;
use crate::files::quantity;
use crate::files::table::Table;
use crate::robot::links::Assembled;
use crate::robot::urdf::{self, Locks};

pub(crate) fn read(table: &Table<'_>, base: &Base) -> Option<Assembled> {
    let locked = table.optional("locked", locked);
    let unknown_limits = table.optional("unknown_limits", Field::boolean);
    let file = table.required("file", "path of a URDF, relative to this file")?;
    let source = match base.read(file.text()?, urdf::LIMIT) {
        Ok(source) => source,
        Err(problem) => {
            file.log.push(problem.or_at(&file.log.source, file.span.clone()));
            return None;
        }
    };
    let (locked, unknown_limits) = (locked?.unwrap_or_default(), unknown_limits?.unwrap_or(false));
    let log = Log::new(&source);
    let assembled = urdf::with(&log, |urdf| {
        let sound: Vec<_> = locked.iter().map(|(name, q, field)| urdf.can_hold(name, *q, field)).collect();
        sound.into_iter().collect::<Option<()>>()?;
        file.log.note(log.decimals());
        file.log.contain(&file.path, urdf.normal.clone());
        urdf.assemble(
            &locked.iter().map(|(name, q, _)| (*name, *q)).collect::<Locks<'_>>(),
            unknown_limits,
            file.log.decimals(),
        )
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
