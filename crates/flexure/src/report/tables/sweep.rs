//! A sweep as a table.

use super::grid::Grid;
use crate::files::number::{NONE, engineering};
use crate::sweep::{Statistics, Sweep};

/// One row a metric, in so many columns: how many runs have it, how it is spread.
pub fn sweep_table(sweep: &Sweep, statistics: &Statistics, width: usize) -> String {
    metrics(sweep, statistics).text(width)
}

pub(crate) fn metrics(sweep: &Sweep, statistics: &Statistics) -> Grid {
    let kinds = sweep.kinds();
    let rows = sweep.metrics().iter().filter_map(|metric| {
        let figures = statistics.metrics.get(metric.name)?;
        let mean = (figures.count > 0).then_some(figures.mean);
        let [low, median, high] = [0.05, 0.5, 0.95].map(|part| figures.quantile(part));
        let numbers = [figures.least, low, median, high, figures.largest, mean, figures.deviation()]
            .map(|number| number.map_or(NONE.to_owned(), engineering));
        let words =
            [metric.name.to_owned(), metric.unit_of(&kinds).unwrap_or_default(), figures.count.to_string()];
        Some(words.into_iter().chain(numbers).collect())
    });
    let headings =
        ["metric", "unit", "runs", "least", "5 %", "median", "95 %", "largest", "mean", "deviation"];
    Grid { words: 2, ..Grid::new(&headings, rows.collect()) }
}
