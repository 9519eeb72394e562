//! Links from a URDF: `kind = "urdf"`.

use crate::files::base::Base;
use crate::files::document::Log;
use crate::files::field::Field;
use crate::files::quantity;
use crate::files::table::Table;
use crate::robot::links::Assembled;
use crate::robot::links::assembly::Fixed;
use crate::robot::links::rigid::Pose;
use crate::robot::looks::LinkLook;
use crate::robot::urdf::looks::{Looks, looks};
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
        let links: Vec<String> = urdf.joints.iter().map(|joint| joint.link.to_owned()).collect();
        let root = urdf.root.to_owned();
        let assembled = urdf.assemble(
            &locked.iter().map(|(name, q, _)| (*name, *q)).collect::<Locks<'_>>(),
            unknown_limits,
            file.log.decimals(),
        )?;
        Some(pictured(assembled, (root, links), looks(&source.text)))
    });
    let place = file.text()?;
    // What is wrong with the locks is in this file's log, not in that of the URDF.
    let mut assembled = file.log.absorb(log.finish(Some(assembled)))??;
    assembled.looks.base = Some(base.beside(place));
    Some(assembled)
}

/// With what its links look like: the root link, and those that its joints carry.
fn pictured(mut assembled: Assembled, (root, links): (String, Vec<String>), mut looks: Looks) -> Assembled {
    let base = Fixed { body: None, pose: Pose::identity() };
    let frames = std::iter::once(base).chain(assembled.frames.iter().copied());
    let names = std::iter::once(root).chain(links);
    let of_link = |(name, Fixed { body, pose }): (String, Fixed<f64>)| {
        Some(LinkLook { body, pose, look: looks.remove(&name)? })
    };
    assembled.looks.links = names.zip(frames).filter_map(of_link).collect();
    assembled
}

/// Joints to hold still, where, and where that stands.
fn locked<'a>(field: &Field<'a>) -> Option<Vec<(&'a str, f64, Field<'a>)>> {
    let table = field.any_table()?;
    let entries: Vec<_> =
        table.fields().map(|(name, field)| Some((name, field.number(&quantity::ANGLE)?, field))).collect();
    entries.into_iter().collect()
}
