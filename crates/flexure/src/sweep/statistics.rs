//! What rows come to together, put together from parts without reading the rows again.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sketches_ddsketch::{Config, DDSketch};

use super::parquet::beside_of_end;
use super::{Metric, Outcome, Status, Sweep};

/// Quantiles are off by this part of themselves at most.
const ACCURACY: f64 = 0.005;

/// Different sizes that a sketch tells apart, from 1e-30 up; smaller numbers are zero to it: below the rounding of everything that is kept.
/// Steps of a hundredth: 43 decades. A sketch holds those between its smallest and its largest number only.
const BINS: u32 = 10_000;
const SMALLEST: f64 = 1e-30;

/// Rows that were counted, and their metrics.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Statistics {
    /// Rows.
    pub rows: u64,
    /// How many have each status.
    pub statuses: BTreeMap<String, u64>,
    /// The metrics, by their names.
    pub metrics: BTreeMap<String, Figures>,
}

/// The values of a metric.
#[derive(Clone, Serialize, Deserialize)]
pub struct Figures {
    /// Rows that have one.
    pub count: u64,
    /// Their mean.
    pub mean: f64,
    /// Sum of the squares of what they differ from it.
    squares: f64,
    /// The smallest; none if there are none.
    pub least: Option<f64>,
    /// The largest; none if there are none.
    pub largest: Option<f64>,
    /// None of no values: JSON has no infinite ends.
    sketch: Option<DDSketch>,
}

/// What rows come to together, as it is told.
#[derive(Clone, Debug, Serialize)]
pub struct Told<'a> {
    /// Rows that are there.
    pub rows_there: u64,
    /// How many of them have each status.
    pub statuses: &'a BTreeMap<String, u64>,
    /// The metrics, by their names.
    pub metrics: BTreeMap<&'static str, Spread>,
}

/// How a metric is spread over the rows that have it.
#[derive(Clone, Debug, Serialize)]
pub struct Spread {
    /// Its unit.
    pub unit: &'static str,
    /// Rows that have it.
    pub count: u64,
    /// Their mean.
    pub mean: Option<f64>,
    /// Their standard deviation.
    pub deviation: Option<f64>,
    /// The smallest.
    pub least: Option<f64>,
    /// The smallest that at least 5, 50 and 95 % of them do not exceed, to half a percent.
    pub quantiles: [Option<f64>; 3],
    /// The largest.
    pub largest: Option<f64>,
}

impl Statistics {
    /// Of the rows of a shard, from the end of its file without the last eight bytes.
    ///
    /// # Errors
    /// If it is none, or of another sweep or shard.
    pub fn of_end(sweep: &Sweep, shard: u64, end: &[u8]) -> Result<Self, String> {
        beside_of_end(end)?.of(sweep, shard)
    }

    /// As it is told.
    pub fn told(&self, sweep: &Sweep) -> Told<'_> {
        let spread =
            |metric: &&'static Metric| Some((metric.name, self.metrics.get(metric.name)?.spread(metric)));
        Told {
            rows_there: self.rows,
            statuses: &self.statuses,
            metrics: sweep.metrics().iter().filter_map(spread).collect(),
        }
    }

    /// How many of the runs of `sweep` these are, and what became of them.
    pub fn sentence(&self, sweep: &Sweep) -> String {
        let counts = Status::ALL.iter().filter_map(|status| {
            let count = self.statuses.get(status.name()).filter(|count| **count > 0)?;
            Some(format!("{}: {count}", status.words()))
        });
        let counts = counts.collect::<Vec<_>>().join(", ");
        let counts = if counts.is_empty() { counts } else { format!("; {counts}") };
        format!("{} of {} runs are there{counts}", self.rows, sweep.rows())
    }

    /// Of no rows.
    pub fn none(sweep: &Sweep) -> Self {
        let metrics = sweep.metrics().iter().map(|metric| (metric.name.to_owned(), Figures::none()));
        Self {
            rows: 0,
            statuses: Status::ALL.iter().map(|status| (status.name().to_owned(), 0)).collect(),
            metrics: metrics.collect(),
        }
    }

    /// Of these rows.
    pub(super) fn of(sweep: &Sweep, outcomes: &[Outcome]) -> Self {
        let mut statistics = Self::none(sweep);
        for outcome in outcomes {
            statistics.rows += 1;
            *statistics.statuses.entry(outcome.status.name().to_owned()).or_default() += 1;
            for (metric, value) in sweep.metrics().iter().zip(&outcome.metrics) {
                let figures = statistics.metrics.entry(metric.name.to_owned()).or_insert_with(Figures::none);
                if let Some(value) = value {
                    figures.take(*value);
                }
            }
        }
        statistics
    }

    /// Takes in those of other rows.
    pub fn absorb(&mut self, other: &Self) {
        self.rows += other.rows;
        for (status, count) in &other.statuses {
            *self.statuses.entry(status.clone()).or_default() += count;
        }
        for (name, figures) in &other.metrics {
            self.metrics.entry(name.clone()).or_insert_with(Figures::none).absorb(figures);
        }
    }
}

impl std::fmt::Debug for Figures {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Figures")
            .field("count", &self.count)
            .field("mean", &self.mean)
            .finish_non_exhaustive()
    }
}

impl Figures {
    fn none() -> Self {
        Self { count: 0, mean: 0.0, squares: 0.0, least: None, largest: None, sketch: None }
    }

    /// Welford's step.
    fn take(&mut self, value: f64) {
        self.count += 1;
        let off = value - self.mean;
        self.mean += off / self.count as f64;
        self.squares += off * (value - self.mean);
        self.least = Some(self.least.map_or(value, |least| least.min(value)));
        self.largest = Some(self.largest.map_or(value, |largest| largest.max(value)));
        let empty = || DDSketch::new(Config::new(ACCURACY, BINS, SMALLEST));
        self.sketch.get_or_insert_with(empty).add(value);
    }

    /// Chan, Golub and LeVeque's step.
    fn absorb(&mut self, other: &Self) {
        let count = self.count + other.count;
        if other.count == 0 {
            return;
        }
        let off = other.mean - self.mean;
        let part = other.count as f64 / count as f64;
        self.squares += other.squares + off * off * self.count as f64 * part;
        self.mean += off * part;
        self.count = count;
        let both = |own: Option<f64>, other: Option<f64>, pick: fn(f64, f64) -> f64| match (own, other) {
            (Some(own), Some(other)) => Some(pick(own, other)),
            (own, other) => own.or(other),
        };
        self.least = both(self.least, other.least, f64::min);
        self.largest = both(self.largest, other.largest, f64::max);
        match (&mut self.sketch, &other.sketch) {
            (Some(own), Some(other)) => {
                // Both have the same configuration.
                let _ = own.merge(other);
            }
            (own @ None, other) => own.clone_from(other),
            (Some(_), None) => {}
        }
    }

    fn spread(&self, metric: &'static Metric) -> Spread {
        Spread {
            unit: metric.unit,
            count: self.count,
            mean: (self.count > 0).then_some(self.mean),
            deviation: self.deviation(),
            least: self.least,
            quantiles: [0.05, 0.5, 0.95].map(|part| self.quantile(part)),
            largest: self.largest,
        }
    }

    /// Standard deviation; none of fewer than two.
    pub fn deviation(&self) -> Option<f64> {
        (self.count > 1).then(|| (self.squares / (self.count - 1) as f64).sqrt())
    }

    /// The smallest of them that at least this part of them does not exceed, to half a percent; what is less than 1e-30 is 0.
    pub fn quantile(&self, part: f64) -> Option<f64> {
        let last = self.count.saturating_sub(1) as f64;
        // The sketch takes ranks from 0 to the last, rounded down.
        let rank = ((part * self.count as f64).ceil() - 1.0).clamp(0.0, last) + 0.5;
        let found = self.sketch.as_ref()?.quantile((rank / last.max(1.0)).min(1.0)).ok().flatten()?;
        Some(found.clamp(self.least?, self.largest?))
    }
}

#[cfg(test)]
mod tests {
    use super::Figures;

    fn of(values: &[f64]) -> Figures {
        let mut figures = Figures::none();
        for value in values {
            figures.take(*value);
        }
        figures
    }

    /// Parts put together are the whole, in any order, through JSON as well; quantiles are those of the sorted numbers.
    #[test]
    fn parts_are_the_whole() {
        let values: Vec<f64> = (1..=1000).map(|i| 1e-4 * f64::from(i * 7919 % 1009)).collect();
        let whole = of(&values);
        let mut parts: Vec<Figures> = values.chunks(137).map(of).collect();
        parts.reverse();
        let mut together = Figures::none();
        for part in &parts {
            let text = serde_json::to_string(part).unwrap();
            together.absorb(&serde_json::from_str(&text).unwrap());
        }
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs();
        assert!(together.count == 1000 && near(together.mean, whole.mean));
        assert!(near(together.deviation().unwrap(), whole.deviation().unwrap()));
        assert_eq!((together.least, together.largest), (whole.least, whole.largest));
        let mut sorted = values;
        sorted.sort_by(f64::total_cmp);
        for (part, i) in [(0.05, 49), (0.5, 499), (0.95, 949), (1.0, 999)] {
            let (found, truth) = (together.quantile(part).unwrap(), sorted[i]);
            assert!((found - truth).abs() <= 0.011 * truth, "{part}: {found}, not {truth}");
            assert_eq!(whole.quantile(part).map(f64::to_bits), Some(found.to_bits()));
        }
        let mean = sorted.iter().sum::<f64>() / 1000.0;
        let deviation = (sorted.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 999.0).sqrt();
        assert!(near(whole.mean, mean) && near(whole.deviation().unwrap(), deviation));
    }

    /// Errors of ideal loops and of energy balances are rounding: their quantiles are told, too.
    #[test]
    fn small_numbers_have_quantiles() {
        let small = of(&[5e-15, 1e-13, 2e-11, 1.3e-10, 4e-9]);
        for (part, truth) in [(0.05, 5e-15), (0.4, 1e-13), (0.5, 2e-11), (0.8, 1.3e-10), (0.95, 4e-9)] {
            let found = small.quantile(part).unwrap();
            assert!((found - truth).abs() <= 0.01 * truth, "{part}: {found}, not {truth}");
        }
    }

    /// Of few values, too: the largest of three is what 95 % do not exceed.
    #[test]
    fn few_values_have_their_quantiles() {
        let few = of(&[1.0, 2.0, 30.0]);
        for (part, truth) in [(0.05, 1.0), (0.5, 2.0), (0.95, 30.0)] {
            assert!((few.quantile(part).unwrap() - truth).abs() <= 0.01 * truth, "{part}");
        }
    }

    #[test]
    fn nothing_has_no_figures() {
        let mut nothing = of(&[]);
        nothing.absorb(&of(&[]));
        assert_eq!(
            (nothing.count, nothing.least, nothing.quantile(0.5), nothing.deviation()),
            (0, None, None, None)
        );
        nothing.absorb(&of(&[2.0]));
        assert_eq!((nothing.count, nothing.quantile(0.5), nothing.deviation()), (1, Some(2.0), None));
    }
}
