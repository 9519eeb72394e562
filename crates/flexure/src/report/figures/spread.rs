//! How the metrics of a sweep are spread, as a picture.

use crate::files::number::{engineering, power_of_ten};
use crate::report::draw::range::Range;
use crate::report::draw::scene::Scene;
use crate::report::draw::style::{HOLDS, INK, SHADES, Stroke};
use crate::report::draw::ticks;
use crate::report::draw::tracks::{Bar, Track, swatch, tracks};
use crate::sweep::{Figures, Statistics, Sweep};

const MEDIAN: Stroke = Stroke::solid(INK, 2.4);
/// Factor between the ends of a metric from which its axis is logarithmic.
const WIDE: f64 = 20.0;

/// A row a metric, on an axis of its own: from the least to the largest of all runs that have it, the middle nine tenths of them, and the
/// median.
pub fn spread_figure(sweep: &Sweep, statistics: &Statistics) -> Scene {
    let subtitle =
        format!("{} of {} runs; each metric over the runs that have it", statistics.rows, sweep.rows());
    let legend =
        [swatch("least to largest", SHADES[3]), swatch("5 % to 95 %", HOLDS), ("median".to_owned(), MEDIAN)];
    let kinds = sweep.kinds();
    let rows: Vec<Track> = sweep
        .metrics()
        .iter()
        .filter_map(|metric| track(metric.name, metric.unit_of(&kinds), statistics.metrics.get(metric.name)?))
        .collect();
    tracks(&format!("{}: how the runs are spread", sweep.name()), &subtitle, &legend, rows)
}

/// The row of a metric; none if no run has it.
fn track(name: &str, unit: Option<String>, figures: &Figures) -> Option<Track> {
    let (least, largest) = (figures.least?, figures.largest?);
    let [low, median, high] =
        [0.05, 0.5, 0.95].map(|part| figures.quantile(part).unwrap_or(f64::NAN).clamp(least, largest));
    let is_wide = least > 0.0 && largest > WIDE * least;
    let at = |value: f64| if is_wide { value.log10() } else { value };
    let (from, to) = (at(least), at(largest));
    let room = match (to > from, from == 0.0) {
        (true, _) => 0.06 * (to - from),
        (false, true) => 1.0,
        (false, false) => 0.1 * from.abs(),
    };
    // What is never anything but zero is not below it.
    let start = if from == 0.0 && to == 0.0 { 0.0 } else { from - room };
    let axis = Range { low: start, high: to + room };
    let power = if is_wide { 0 } else { ticks::power(axis) };
    let ticks = if is_wide { ticks::logarithmic(axis, 6.0) } else { ticks::even_by(axis, 6.0, power) };
    let scale = (power != 0).then(|| power_of_ten(power));
    let unit: Vec<String> = scale.into_iter().chain(unit).collect();
    let name = if unit.is_empty() { name.to_owned() } else { format!("{name} [{}]", unit.join(" ")) };
    Some(Track {
        name,
        axis,
        ticks,
        bars: vec![
            Bar { height: 0.3, ..Bar::whole(from, to, SHADES[3]) },
            Bar { height: 0.8, ..Bar::whole(at(low), at(high), HOLDS) },
        ],
        marks: vec![(at(median), MEDIAN)],
        words: vec![
            format!("median {}, {} runs", engineering(median), figures.count),
            format!("{} … {}", engineering(least), engineering(largest)),
        ],
    })
}
