//! The motion for identification, and what it tells, as a table.

use comfy_table::{Cell, Row};

use super::summary::{headed, right};
use crate::excite::{Excitation, JointMotion};
use crate::files::number::{NONE, short};

/// A column: three lines of heading, and what stands in it.
type Column = (&'static str, fn(&JointMotion) -> String);

const COLUMNS: [Column; 8] = [
    ("swing\n\n[Hz]", |joint| short(joint.resonance, 3)),
    ("lines\nfrom … to\n[Hz]", |joint| {
        let end = |line: Option<&crate::excite::Line>| {
            line.map_or(NONE.to_owned(), |line| short(line.frequency, 3))
        };
        format!("{} … {}", end(joint.lines.first()), end(joint.lines.last()))
    }),
    ("of its\nlimits\n[%]", |joint| short(100.0 * joint.crest_share, 2)),
    ("± K\n\n[%]", |joint| short(100.0 * joint.error_bars.stiffness, 2)),
    ("± M_m\n\n[%]", |joint| short(100.0 * joint.error_bars.motor_inertia, 2)),
    ("± D_l\n[N m\ns/rad]", |joint| short(joint.error_bars.link_damping, 2)),
    ("± D_m\n[N m\ns/rad]", |joint| short(joint.error_bars.motor_damping, 2)),
    ("± Coulomb\n\n[N m]", |joint| short(joint.error_bars.coulomb, 2)),
];

/// One row a joint, at most 100 columns wide, without colours.
pub fn excitation_table(found: &Excitation) -> String {
    let mut table = headed(["joint"].into_iter().chain(COLUMNS.iter().map(|(title, _)| *title)));
    for joint in &found.joints {
        let numbers = COLUMNS.iter().map(|(_, show)| right(show(joint)));
        table.add_row(Row::from(std::iter::once(Cell::new(&joint.name)).chain(numbers).collect::<Vec<_>>()));
    }
    table.to_string()
}
