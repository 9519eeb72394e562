//! `[[imperfection]]`: what real sensors, actuators and mechanics do and the ideal loop does not.

use crate::files::base::Base;
use crate::files::field::{Field, Joints};
use crate::files::quantity::Quantity;
use crate::files::table::Table;
use crate::imperfections::kind::Kind;
use crate::imperfections::{Imperfection, READERS};
use crate::robot::Robot;

/// What readers of imperfections know of the rest of the scenario.
#[derive(Clone, Copy)]
pub(crate) struct Context<'a> {
    pub joints: &'a Joints,
    /// None if its file could not be read.
    pub robot: Option<&'a Robot>,
    /// Length of the run and control period \[s\], if they could be read.
    pub times: Option<(f64, f64)>,
    /// What paths are relative to.
    pub base: &'a Base,
}

impl Context<'_> {
    /// What `table` has at `limit`, per joint, or the robot's limit, which stands under `key` in its file and must then be there.
    pub fn limit(
        &self,
        table: &Table<'_>,
        quantity: &Quantity,
        (key, of): (&str, impl Fn(&Robot) -> Vec<f64>),
    ) -> Option<Vec<f64>> {
        if let Some(field) = table.get("limit") {
            return field.per_joint(self.joints, quantity);
        }
        let robot = self.robot?;
        let limit = of(robot);
        if limit.iter().any(|limit| !limit.is_finite()) {
            let message =
                format!("missing key {}, and robot {} has no {key}", table.key("limit"), robot.name);
            let hint =
                format!("{}, per joint; or add {key} to [joints] of the robot file", quantity.described());
            table.error("missing-key", message, hint);
            return None;
        }
        Some(limit)
    }
}

impl Context<'_> {
    /// Notes an error if what `name`s from `from` until `until` \[s\] is over before it begins, and doubt if it begins after the run.
    pub fn begins_before_it_ends(&self, table: &Table<'_>, name: &str, from: f64, until: f64) -> Option<()> {
        if from >= until {
            let message = format!("{name}: from is {from} s and until {until} s, must be from < until");
            table.get("until")?.error("range", message, "the readings of [from, until) are concerned");
            return None;
        }
        if let Some((duration, _)) = self.times
            && from > duration
        {
            let field = table.get("from")?;
            let message = format!("{} is {from} s, after the end of the run at {duration} s", field.path);
            field.warn("unused", message, "it never happens");
        }
        Some(())
    }
}

/// Reads an entry, whose kind was read before.
pub(crate) type Reader = fn(&Table<'_>, &Context<'_>) -> Option<Imperfection>;

/// An imperfection with the entry that it was read from.
pub(crate) struct Found<'a> {
    pub field: Field<'a>,
    pub table: Table<'a>,
    pub what: Imperfection,
}

/// Reads every `[[imperfection]]`.
pub(crate) fn read<'a>(root: &Table<'a>, context: &Context<'_>) -> Option<Vec<Found<'a>>> {
    let Some(field) = root.get("imperfection") else { return Some(Vec::new()) };
    let found: Vec<_> = field.tables()?.into_iter().map(|field| one(field, context)).collect();
    found.into_iter().collect()
}

fn one<'a>(field: Field<'a>, context: &Context<'_>) -> Option<Found<'a>> {
    let table = field.any_table()?;
    let reader = table.choice("kind", READERS)?;
    let what = reader(&table, context)?;
    Some(Found { field, table, what })
}

/// The data of an entry of kind `K`, which has no other keys than the kind's.
pub(crate) fn entry<K: Kind>(table: &Table<'_>, context: &Context<'_>) -> Option<K> {
    table.refuse_unknown(&[&["kind"], K::KEYS].concat());
    K::read(table, context)
}
