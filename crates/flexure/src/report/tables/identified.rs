//! What was identified, as a table for the terminal.

use comfy_table::{Cell, Row};

use super::summary::{headed, right};
use crate::files::number::{NONE, significant};
use crate::identify::{Estimate, Identified, Parameter};

/// One row a joint, `value ± error` with errors of three standard deviations; what the logs do not know stands in brackets.
pub fn identified_table(found: &Identified) -> String {
    let titles = [
        "joint",
        "K\n[N m/rad]",
        "M_m\n[kg m²]",
        "D_l\n[N m s/rad]",
        "D_m\n[N m s/rad]",
        "friction,\nlink [N m]",
        "friction,\nmotor [N m]",
    ];
    let mut table = headed(titles.into_iter());
    for (i, joint) in found.joints.iter().enumerate() {
        let numbers = Parameter::ALL.map(|parameter| right(number(found.estimate(i, parameter))));
        table.add_row(Row::from([Cell::new(&joint.name)].into_iter().chain(numbers).collect::<Vec<_>>()));
    }
    table.to_string()
}

fn number(estimate: &Estimate) -> String {
    if estimate.known {
        return format!("{}\n± {}", significant(estimate.value, 5), significant(estimate.error, 2));
    }
    match estimate.before {
        Some(before) => format!("({})\nnot known", significant(before, 5)),
        None => format!("{NONE}\nnot known"),
    }
}
