//! Margins as text for the terminal.

use comfy_table::Cell;

use super::columns::laid_out;
use super::summary::{headed, right};
use crate::files::number::{NONE, significant};
use crate::margins::{Edge, Margins};
use crate::units;

/// One row a loop, in so many columns.
pub fn margins_table(loops: &[Margins], width: usize) -> String {
    // Of one robot, whose joints these are.
    let unit = |unit, prefix| loops.first().map_or_else(String::new, |first| first.unit(unit, prefix));
    let [milli, angle, torque] = [unit(units::ANGLE, "m"), unit(units::ANGLE, ""), unit(units::TORQUE, "")];
    let titles = [
        "loop",
        &format!("rms\n|e_l|\n[{milli}]"),
        "delay\nadded\n[ms]",
        "torque\ngain\nfrom … to",
        "plant\nstiffness\nfrom … to",
        &format!("noise\nadded\n[{milli}]"),
        &format!("error\nper noise\n[{angle}/{angle}]"),
        &format!("torque step\nper noise\n[{torque}/{milli}]"),
    ];
    let mut table = headed(titles.into_iter());
    for loop_ in loops {
        let milli = |x: Option<f64>, scale: f64| x.map_or(NONE.to_owned(), |x| significant(scale * x, 3));
        table.add_row(vec![
            Cell::new(format!("{}\n{}", loop_.name, loop_.law())),
            right(milli(loop_.rms_e_l, 1e3)),
            right(upper(&loop_.delay, 1e3)),
            right(range(&loop_.gain_low, &loop_.gain_high)),
            right(range(&loop_.stiffness_low, &loop_.stiffness_high)),
            right(upper(&loop_.noise, 1e3)),
            right(milli(loop_.noise_to_error, 1.0)),
            right(milli(loop_.noise_to_torque, 1e-3)),
        ]);
    }
    laid_out(&table, 1, width)
}

/// The farthest change at which the loop holds, in units of 1/`scale`.
fn upper(edge: &Edge, scale: f64) -> String {
    match edge {
        Edge::Between { holds, .. } => significant(scale * holds, 3),
        Edge::Beyond { holds } => format!("> {}", significant(scale * holds, 3)),
        Edge::Open { holds } => format!("≥ {}", significant(scale * holds, 3)),
        Edge::Nowhere => NONE.to_owned(),
    }
}

fn range(low: &Edge, high: &Edge) -> String {
    let low = match low {
        Edge::Between { holds, .. } => significant(*holds, 3),
        Edge::Beyond { holds } => format!("< {}", significant(*holds, 3)),
        Edge::Open { holds } => format!("≤ {}", significant(*holds, 3)),
        Edge::Nowhere => return NONE.to_owned(),
    };
    format!("{low} … {}", upper(high, 1.0))
}
