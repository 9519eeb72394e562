//! Signals that swing faster than a figure can show: a band from the least to the largest value, and a line in its middle.

use super::decimate::{bucket_size, decimate, extremes};

/// Buckets in a row that swing before they are drawn as a band: fewer are a wiggle.
const RUN: usize = 6;

/// A signal as a figure shows it, point by point from left to right.
#[derive(Debug, PartialEq)]
pub(crate) struct Shown {
    /// The signal as [`decimate`] has it, but in bands their middle.
    pub line: Vec<(f64, f64)>,
    /// Instant, least and largest value, band by band.
    pub bands: Vec<Vec<(f64, f64, f64)>>,
}

/// A signal that is cut into at most `buckets` runs of samples, each of which is a point of a band where it turns twice or more in that time.
///
/// # Panics
/// As [`decimate`].
pub(crate) fn shown(t: &[f64], values: &[f64], buckets: usize) -> Shown {
    let size = bucket_size(values.len(), buckets);
    let swings = swinging(values, size);
    if !swings.contains(&true) {
        return Shown { line: decimate(t, values, buckets), bands: Vec::new() };
    }
    let mut shown = Shown { line: Vec::new(), bands: Vec::new() };
    shown.line.extend(t.first().copied().zip(values.first().copied()).filter(|_| !swings[0]));
    let mut is_open = false;
    for ((t, values), swings) in t.chunks(size).zip(values.chunks(size)).zip(&swings) {
        let (low, high) = extremes(values);
        if *swings {
            let middle = 0.5 * (t[0] + t[t.len() - 1]);
            shown.line.push((middle, 0.5 * (values[low] + values[high])));
            if !is_open {
                shown.bands.push(Vec::new());
            }
            shown
                .bands
                .last_mut()
                .into_iter()
                .for_each(|band| band.push((middle, values[low], values[high])));
        } else {
            shown.line.extend([low.min(high), low.max(high)].map(|index| (t[index], values[index])));
        }
        is_open = *swings;
    }
    let is_line = swings.last() == Some(&false);
    shown.line.extend(t.last().copied().zip(values.last().copied()).filter(|_| is_line));
    shown.line.dedup();
    shown
}

/// Whether each run of so many samples is part of a band.
fn swinging(values: &[f64], size: usize) -> Vec<bool> {
    if size <= 2 {
        return Vec::new();
    }
    let turns = |k: usize| {
        let around = |k: usize| values.get(k).copied();
        let (Some(before), Some(after)) = (k.checked_sub(1).and_then(around), around(k + 1)) else {
            return false;
        };
        (values[k] - before) * (after - values[k]) < 0.0
    };
    let of_bucket =
        |start: usize| (start..(start + size).min(values.len())).filter(|&k| turns(k)).count() >= 2;
    let mut swings: Vec<bool> = (0..values.len()).step_by(size).map(of_bucket).collect();
    for run in swings.chunk_by_mut(|a, b| a == b).filter(|run| run.len() < RUN) {
        run.fill(false);
    }
    swings
}

#[cfg(test)]
mod tests {
    use super::{RUN, shown};
    use crate::report::draw::decimate::decimate;

    fn signal(value: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let t: Vec<f64> = (0..20_000).map(|k| 1e-3 * f64::from(k)).collect();
        let values = t.iter().map(|&t| value(t)).collect();
        (t, values)
    }

    #[test]
    fn what_the_figure_resolves_is_a_line_as_before() {
        for smooth in [f64::sin, |t: f64| (3.0 * t).sin().abs(), |t: f64| (-t).exp(), f64::floor] {
            let (t, values) = signal(smooth);
            let shown = shown(&t, &values, 500);
            assert!(shown.bands.is_empty());
            assert_eq!(shown.line, decimate(&t, &values, 500));
        }
    }

    /// A torque that alternates from period to period between 8 s and 12 s, on a slow one.
    #[test]
    fn a_band_holds_every_sample_and_is_where_the_signal_swings() {
        let is_in = |t: f64| (8.0..12.0).contains(&t);
        let sign = |t: f64| if (1e3 * t).round() % 2.0 < 1.0 { 1.0 } else { -1.0 };
        let (t, values) = signal(|t| t.sin() + if is_in(t) { 0.2 * sign(t) } else { 0.0 });
        let shown = shown(&t, &values, 500);
        let [band] = &shown.bands[..] else { panic!("{} bands", shown.bands.len()) };
        let (from, to) = (band[0].0, band[band.len() - 1].0);
        assert!((from - 8.0).abs() < 0.1 && (to - 12.0).abs() < 0.1 && band.len() >= RUN, "{from} {to}");
        for &(at, low, high) in band {
            assert!(low <= at.sin() - 0.15 && high >= at.sin() + 0.15, "{at}: {low} {high}");
        }
        let slow = shown.line.iter().all(|(t, value)| {
            (value - t.sin()).abs() < 0.05 || (t - 8.0).abs() < 0.1 || (t - 12.0).abs() < 0.1
        });
        assert!(slow, "the line goes through the middle");
        assert!(shown.line.windows(2).all(|pair| pair[0].0 <= pair[1].0));
        assert_eq!((shown.line[0].0, shown.line[shown.line.len() - 1].0), (t[0], t[t.len() - 1]));
    }

    #[test]
    fn short_signals_and_wiggles_are_lines() {
        let (t, values) = signal(|t| if (5.0..5.05).contains(&t) { (4000.0 * t).sin() } else { 0.0 });
        assert!(shown(&t, &values, 500).bands.is_empty());
        let few = [1.0, -1.0, 1.0, -1.0];
        assert_eq!(shown(&[0.0, 1.0, 2.0, 3.0], &few, 500).line.len(), 4);
        assert!(shown(&[], &[], 500).line.is_empty());
    }
}
