//! A sweep as text for the terminal.

use comfy_table::Cell;

use super::columns::laid_out;
use super::summary::{headed, right};
use crate::files::number::{NONE, engineering};
use crate::sweep::{Statistics, Sweep};

/// One row a metric, in so many columns: how many runs have it, how it is spread.
pub fn sweep_table(sweep: &Sweep, statistics: &Statistics, width: usize) -> String {
    let titles = ["metric", "unit", "runs", "least", "5 %", "median", "95 %", "largest", "mean", "deviation"];
    let mut table = headed(titles.into_iter());
    for metric in sweep.metrics() {
        let Some(figures) = statistics.metrics.get(metric.name) else { continue };
        let mean = (figures.count > 0).then_some(figures.mean);
        let numbers = [
            figures.least,
            figures.quantile(0.05),
            figures.quantile(0.5),
            figures.quantile(0.95),
            figures.largest,
            mean,
            figures.deviation(),
        ];
        let numbers = numbers.map(|number| right(number.map_or(NONE.to_owned(), engineering)));
        let words = [metric.name, metric.unit].map(Cell::new);
        let count = right(figures.count.to_string());
        table.add_row(words.into_iter().chain([count]).chain(numbers).collect::<Vec<_>>());
    }
    laid_out(&table, 2, width)
}
