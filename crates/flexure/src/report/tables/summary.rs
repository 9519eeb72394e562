//! Tables for the terminal: the summary of several runs, the joints of a robot.

use comfy_table::presets::UTF8_HORIZONTAL_ONLY;
use comfy_table::{Cell, CellAlignment, ContentArrangement, LineStyle, Row, Table};

use super::columns::laid_out;
use crate::feasible::Usage;
use crate::files::number::{NONE, engineering, short};
use crate::robot::JointRow;
use crate::simulate::Summary;
use crate::units::{self, Unit};

/// A column of numbers: three lines of heading, and what stands in it.
type Column = (&'static str, fn(&Summary) -> String);

const NUMBERS: [Column; 5] = [
    ("max\n|e_l|\n[rad]", |summary| number(summary.max_abs_e_l)),
    ("final\n|e_l|\n[rad]", |summary| number(summary.final_abs_e_l)),
    ("settled\n\n[s]", |summary| optional(summary.settling_time)),
    ("max\n|u_m|\n[N m]", |summary| number(summary.max_abs_u_m)),
    ("rate at\nstates\n[1/s]", |summary| number(summary.rate_pointwise)),
];
const AT_LIMIT: Column = ("at\nlimit\n[%]", |summary| number(100.0 * summary.saturated_fraction));
const UNKNOWN: Column = ("unknown\nto the\nlaw", |summary| words(&summary.plant));
const PROVED: Column = ("rate\nproved\n[1/s]", |summary| proved_rate(summary.rate_certified));

/// A proved rate [1/s], if there is one: far from the reference that of tanh is positive and nothing else.
pub(crate) fn proved_rate(rate: Option<f64>) -> String {
    match rate {
        Some(rate) if rate < 1e-3 => "<0.001".to_owned(),
        rate => optional(rate),
    }
}

/// One row a run, in so many columns, without colours: the same text on a terminal and in a file. Torque limits,
/// proved rates and what a plant has that the law does not know have a column where any run has them.
pub fn summary_table(summaries: &[Summary], width: usize) -> String {
    let limited = summaries.iter().any(|summary| summary.saturated_fraction > 0.0);
    let proved = summaries.iter().any(|summary| summary.rate_certified.is_some());
    let unknown = summaries.iter().any(|summary| !summary.plant.is_empty());
    let columns: Vec<Column> = NUMBERS
        .into_iter()
        .chain(limited.then_some(AT_LIMIT))
        .chain(proved.then_some(PROVED))
        .chain(unknown.then_some(UNKNOWN))
        .collect();
    let mut table = headed(["run", "φ"].into_iter().chain(columns.iter().map(|(title, _)| *title)));
    for summary in summaries {
        table.add_row(row(summary, &columns));
    }
    laid_out(&table, 1, width)
}

/// An empty table with these column titles.
pub(crate) fn headed<'a>(titles: impl Iterator<Item = &'a str>) -> Table {
    let mut table = Table::new();
    table
        .load_style(UTF8_HORIZONTAL_ONLY.row_separator(LineStyle::none()))
        .set_content_arrangement(ContentArrangement::Disabled);
    let centred = |title| Cell::new(title).set_alignment(CellAlignment::Center);
    table.set_header(titles.map(centred).collect::<Vec<_>>());
    table.column_iter_mut().for_each(|column| {
        column.set_padding((1, 0));
    });
    table
}

/// A cell of numbers.
pub(crate) fn right(text: String) -> Cell {
    Cell::new(text).set_alignment(CellAlignment::Right)
}

/// A column about a joint: three lines of heading, and what stands in it.
type JointColumn = (&'static str, fn(&JointRow) -> Option<String>);

const JOINT_NUMBERS: [JointColumn; 11] = [
    ("K\n\n[N m/rad]", |joint| Some(short(joint.stiffness, 5))),
    ("M_m\n\n[kg m²]", |joint| Some(short(joint.motor_inertia, 4))),
    ("M_l at\nq = 0\n[kg m²]", |joint| Some(short(joint.link_inertia, 4))),
    ("reso-\nnance\n[Hz]", |joint| Some(short(joint.resonance, 3))),
    ("D_l\n[N m\ns/rad]", |joint| Some(short(joint.link_damping, 4))),
    ("D_m\n[N m\ns/rad]", |joint| Some(short(joint.motor_damping, 4))),
    ("gear\n\n", |joint| Some(short(joint.gear_ratio?, 4))),
    ("max\n|u_m|\n[N m]", |joint| Some(short(joint.torque_limit?, 4))),
    ("max\n|dq|\n[rad/s]", |joint| Some(short(joint.velocity_limit?, 4))),
    ("max\n|ζ|\n[rad]", |joint| Some(short(joint.deflection_limit?, 4))),
    ("q_l from … to\n\n[rad]", |joint| {
        let end = |limit: Option<f64>| limit.map_or(NONE.to_owned(), |limit| short(limit, 4));
        joint.position_lower.or(joint.position_upper)?;
        Some(format!("{} … {}", end(joint.position_lower), end(joint.position_upper)))
    }),
];

/// One row a joint, in so many columns, without colours. What no joint has has no column; what carries a joint is
/// named where it is not the joint above.
pub fn joint_table(joints: &[JointRow], width: usize) -> String {
    let columns: Vec<JointColumn> = JOINT_NUMBERS
        .into_iter()
        .filter(|(_, show)| joints.iter().any(|joint| show(joint).is_some()))
        .collect();
    let mut table = headed(["joint"].into_iter().chain(columns.iter().map(|(title, _)| *title)));
    for (i, joint) in joints.iter().enumerate() {
        let above = i.checked_sub(1).map(|above| &joints[above].name);
        let mut name = joint.name.clone();
        if joint.parent.as_ref() != above {
            name = format!("{name}\non {}", joint.parent.as_deref().unwrap_or("the base"));
        }
        if joint.kind != "revolute" {
            name = format!("{name}\n({})", joint.kind);
        }
        let numbers = columns.iter().map(|(_, show)| right(show(joint).unwrap_or(NONE.to_owned())));
        table.add_row(Row::from(std::iter::once(Cell::new(name)).chain(numbers).collect::<Vec<_>>()));
    }
    laid_out(&table, 1, width)
}

/// One row a limit that `joints` (their names) have, in so many columns, without colours.
pub fn usage_table(joints: &[String], usages: &[Usage], width: usize) -> String {
    let mut table = headed(["joint", "limit", "", "reference", "share", "t [s]"].into_iter());
    for usage in usages {
        let name = joints.get(usage.joint).map_or(NONE, String::as_str);
        let unit = Unit::of_key(usage.key).unwrap_or(units::NONE).plain;
        let amount = |x: f64| format!("{} {unit}", short(x, 5)).trim_end().to_owned();
        let numbers = [amount(usage.limit), amount(usage.value), short(usage.share, 3), short(usage.time, 5)];
        let words = [name, usage.key].map(Cell::new);
        table.add_row(Row::from(words.into_iter().chain(numbers.map(right)).collect::<Vec<_>>()));
    }
    laid_out(&table, 2, width)
}

/// A dash for what a run that diverged at once has no figure of.
fn number(value: f64) -> String {
    optional(Some(value).filter(|value| value.is_finite()))
}

fn optional(value: Option<f64>) -> String {
    value.map_or(NONE.to_owned(), engineering)
}

fn words(options: &[&str]) -> String {
    if options.is_empty() { NONE.to_owned() } else { options.join("\n").replace('_', " ") }
}

fn row(summary: &Summary, columns: &[Column]) -> Row {
    let words = [&summary.name, &summary.law()].map(Cell::new);
    let numbers = columns.iter().map(|(_, show)| right(show(summary)));
    Row::from(words.into_iter().chain(numbers).collect::<Vec<_>>())
}
