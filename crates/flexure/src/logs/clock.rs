//! The times of a log: evenly spaced, or refused.

use crate::files::Problem;
use crate::files::number::duration;
use crate::files::source::Source;

/// Longest step from one sample to the next, in median steps.
const GAP: f64 = 1.5;

/// Farthest that a step may be off the median one, in median steps.
const JITTER: f64 = 0.2;

/// Longest period of a log whose unit of time was not said \[s\].
const SLOW: f64 = 0.1;

/// What a log's times are counted from: stamps of computers are whole numbers too large for a float.
#[derive(Clone, Copy, Debug)]
enum Origin {
    Whole(i64),
    Real(f64),
}

/// The times of the samples so far, from the first on.
#[derive(Debug, Default)]
pub(super) struct Times {
    origin: Option<Origin>,
    /// In units of the file, and the line of each.
    samples: Vec<(f64, usize)>,
}

impl Times {
    /// Adds the time that `cell` says, which is the finite number `value`. If the time before is not earlier, the step from it, <= 0.
    pub fn push(&mut self, cell: &str, value: f64, line: usize) -> Result<(), f64> {
        let whole = cell.parse::<i64>().ok();
        let origin = *self.origin.get_or_insert(whole.map_or(Origin::Real(value), Origin::Whole));
        let time = match (origin, whole) {
            (Origin::Whole(first), Some(now)) => now.wrapping_sub(first) as f64,
            (Origin::Whole(first), None) => value - first as f64,
            (Origin::Real(first), _) => value - first,
        };
        if let Some((before, _)) = self.samples.last().filter(|(before, _)| *before >= time) {
            return Err(time - before);
        }
        self.samples.push((time, line));
        Ok(())
    }

    /// Number of samples so far.
    pub fn len(&self) -> usize {
        self.samples.len()
    }

    /// The period in s, if the samples of the log `name` have one; one unit of its times is `scale` s, and `said` whether that was said.
    /// There are at least two samples.
    pub fn even(&self, name: &str, scale: f64, said: bool) -> Result<f64, Problem> {
        let steps: Vec<f64> = self.samples.windows(2).map(|pair| scale * (pair[1].0 - pair[0].0)).collect();
        let mut sorted = steps.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let median = sorted[sorted.len() / 2];
        let at = |step: usize, code, what: String, help: &str| {
            let (_, line) = self.samples[step + 1];
            Err(Problem::new(code, what, help).at(&Source::part(name, "", line - 1), 0..0))
        };
        if !said && median > SLOW {
            let what = format!("samples are {median} s apart, as the times say: too slow for any joint");
            return at(0, "scale", what, "are times in ms, us or ns? --columns with t.unit = \"ms\"");
        }
        let largest =
            (0..steps.len()).fold(0, |largest, k| if steps[k] > steps[largest] { k } else { largest });
        if steps[largest] > GAP * median {
            let gaps = steps.iter().filter(|step| **step > GAP * median).count();
            let what = format!(
                "samples are missing: {} from the row before to this one, {} from row to row in general; gaps: {gaps}",
                duration(steps[largest]),
                duration(median)
            );
            return at(
                largest,
                "gap",
                what,
                "cut the log into parts without gaps, or fill them where it was logged",
            );
        }
        let off = |k: usize| (steps[k] / median - 1.0).abs();
        let worst = (0..steps.len()).fold(0, |worst, k| if off(k) > off(worst) { k } else { worst });
        if off(worst) > JITTER {
            let what = format!(
                "samples are not evenly spaced: {} from the row before to this one, {} in general; {:.0} % off, must be \
                 at most {:.0} %",
                duration(steps[worst]),
                duration(median),
                100.0 * off(worst),
                100.0 * JITTER
            );
            return at(
                worst,
                "spacing",
                what,
                "log by the clock that samples, or interpolate to an even one first",
            );
        }
        let span: f64 = self.samples.last().map_or(0.0, |(last, _)| scale * last);
        Ok(span / steps.len() as f64)
    }
}
