//! The summary of several runs for the terminal.

use comfy_table::{
    Cell, CellAlignment, ContentArrangement, LineStyle, Row, Table, presets::UTF8_HORIZONTAL_ONLY,
};

use super::number::{NONE, engineering};
use crate::summary::Summary;

/// Columns of a terminal that the table is laid out for.
const WIDTH: u16 = 100;

/// One row a run, at most 100 columns wide, without colours: the same text on a terminal and in a file.
pub fn summary_table(summaries: &[Summary]) -> String {
    const HEADER: [&str; 8] = [
        "run",
        "φ",
        "final\n|e_l|\n[rad]",
        "settled\n\n[s]",
        "max\n|u_m|\n[N m]",
        "at limit\n\n[%]",
        "rate\nsampled\n[1/s]",
        "rate\nproved\n[1/s]",
    ];
    let mut table = Table::new();
    table
        .load_style(UTF8_HORIZONTAL_ONLY.row_separator(LineStyle::none()))
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(WIDTH);
    table.set_header(HEADER.map(|title| Cell::new(title).set_alignment(CellAlignment::Center)));
    for summary in summaries {
        table.add_row(row(summary));
    }
    table.to_string()
}

fn row(summary: &Summary) -> Row {
    let optional = |value: Option<f64>| value.map_or(NONE.to_owned(), engineering);
    let numbers = [
        engineering(summary.final_abs_e_l),
        optional(summary.settling_time),
        engineering(summary.max_abs_u_m),
        engineering(100.0 * summary.saturated_fraction),
        engineering(summary.rate_measured),
        optional(summary.rate_certified),
    ];
    let words = [&summary.name, &summary.phi].map(Cell::new);
    let numbers = numbers.map(|number| Cell::new(number).set_alignment(CellAlignment::Right));
    Row::from(words.into_iter().chain(numbers).collect::<Vec<_>>())
}
