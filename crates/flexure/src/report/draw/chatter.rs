//! Signals that swing faster than a figure can show: a band from the least to the largest value, and a line in its middle.

use super::decimate::{bucket_size, decimate, extremes};

/// Buckets to either side that are looked at with one.
const REACH: usize = 2;
/// Turns in those buckets from which lines are no longer told apart.
const OFTEN: usize = 4;
/// Buckets in a row that swing before they are drawn as a band, and that do not before it ends: fewer are a wiggle, or a pause.
const RUN: usize = 6;

/// A signal as a figure shows it, point by point from left to right.
#[derive(Debug, PartialEq)]
pub(crate) struct Shown {
    /// The signal as [`decimate`] has it, but in bands their middle.
    pub line: Vec<(f64, f64)>,
    /// Instant, least and largest value, band by band.
    pub bands: Vec<Vec<(f64, f64, f64)>>,
}

/// A signal that is cut into at most `buckets` runs of samples, each of which is a point of a band where it swings too fast for lines: to the
/// extremes of the buckets around it, so that slow swings have no gaps between their peaks.
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
    for (k, (t, own)) in t.chunks(size).zip(values.chunks(size)).enumerate() {
        if swings[k] {
            let middle = 0.5 * (t[0] + t[t.len() - 1]);
            let around = &values[k.saturating_sub(REACH) * size..((k + REACH + 1) * size).min(values.len())];
            let (low, high) = extremes(around);
            shown.line.push((middle, 0.5 * (around[low] + around[high])));
            if !is_open {
                shown.bands.push(Vec::new());
            }
            shown
                .bands
                .last_mut()
                .into_iter()
                .for_each(|band| band.push((middle, around[low], around[high])));
        } else {
            let (low, high) = extremes(own);
            shown.line.extend([low.min(high), low.max(high)].map(|index| (t[index], own[index])));
        }
        is_open = swings[k];
    }
    let is_line = swings.last() == Some(&false);
    shown.line.extend(t.last().copied().zip(values.last().copied()).filter(|_| is_line));
    shown.line.dedup();
    shown
}

/// Whether each run of so many samples is part of a band: whether the signal turns back often in it and in those around it.
fn swinging(values: &[f64], size: usize) -> Vec<bool> {
    if size <= 2 {
        return Vec::new();
    }
    // A signal at a limit stands still before it turns back.
    let (mut turns, mut rising): (Vec<usize>, Option<bool>) = (vec![0; values.len().div_ceil(size)], None);
    for (k, pair) in values.windows(2).enumerate().filter(|(_, pair)| pair[0].total_cmp(&pair[1]).is_ne()) {
        let is_rising = pair[1] > pair[0];
        turns[(k + 1) / size] += usize::from(rising.is_some_and(|rising| rising != is_rising));
        rising = Some(is_rising);
    }
    let count = |from: usize, to: usize| turns[from..to.min(turns.len())].iter().sum::<usize>();
    let swings_at = |k: usize| {
        let (before, after) = (count(k.saturating_sub(REACH), k + 1), count(k, k + REACH + 1));
        // Beside a swing nothing turns on one side.
        before > 0 && after > 0 && before + after - turns[k] >= OFTEN
    };
    let mut swings: Vec<bool> = (0..turns.len()).map(swings_at).collect();
    for is_band in [false, true] {
        for run in swings.chunk_by_mut(|a, b| a == b).filter(|run| run.len() < RUN && run[0] == is_band) {
            run.fill(!is_band);
        }
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

    /// A torque that goes from limit to limit, and stays there for a while each time.
    #[test]
    fn a_signal_between_limits_is_a_band_from_one_to_the_other() {
        let (t, values) = signal(|t| (400.0 * t).sin().signum());
        let shown = shown(&t, &values, 500);
        let [band] = &shown.bands[..] else { panic!("{} bands", shown.bands.len()) };
        assert!(band.len() > 490 && band.iter().all(|(_, low, high)| *low < -0.9 && *high > 0.9));
        assert!(shown.line.iter().filter(|(_, middle)| middle.abs() > 0.1).count() < 10);
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
