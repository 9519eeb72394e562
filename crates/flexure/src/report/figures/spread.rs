//! How the metrics of a sweep are spread, as a picture.

use crate::files::number::engineering;
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
    let metrics = sweep.metrics().iter();
    let rows: Vec<Track> =
        metrics.filter_map(|metric| track(metric.titled(), statistics.metrics.get(metric.name)?)).collect();
    tracks(&format!("{}: how the runs are spread", sweep.name()), &subtitle, &legend, rows)
}

/// The row of a metric; none if no run has it.
fn track(name: String, figures: &Figures) -> Option<Track> {
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
    let axis = Range { low: from - room, high: to + room };
    let power = ticks::power(axis);
    let (ticks, name) = match (is_wide, power) {
        (true, _) => (ticks::logarithmic(axis, 6.0), name),
        (false, 0) => (ticks::even(axis, 6.0), name),
        (false, power) => (
            ticks::even_by(axis, 6.0, power),
            format!("{name} · {}", crate::files::number::power_of_ten(-power)),
        ),
    };
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
