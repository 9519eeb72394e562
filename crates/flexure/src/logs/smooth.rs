//! Signals without what is fast in them, and their rates.

/// Reach of a window that leaves what encoders can say of accelerations \[s\]: up to 40 Hz.
pub(crate) const REACH: f64 = 0.025;

/// The weights of a Hann window that reaches `reach` s to either side, from its middle to one side, for samples every `period` s.
pub(crate) fn window(reach: f64, period: f64) -> Vec<f64> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most a few thousand")]
    let half = (reach / period).round().clamp(2.0, 4096.0) as usize;
    let weight = |k: usize| 0.5 + 0.5 * (std::f64::consts::PI * k as f64 / (half + 1) as f64).cos();
    let sum = weight(0) + 2.0 * (1..=half).map(weight).sum::<f64>();
    (0..=half).map(|k| weight(k) / sum).collect()
}

/// Signal `i` of `stride` interleaved ones through the symmetric `window`. Samples nearer to an end than the window reaches are
/// repeated there.
pub(crate) fn smoothed(signal: &[f64], stride: usize, i: usize, window: &[f64]) -> Vec<f64> {
    let count = signal.len() / stride;
    let at = |k: usize| signal[k.min(count - 1) * stride + i];
    let half = window.len() - 1;
    (0..count)
        .map(|k| {
            let sides = (1..=half).map(|j| window[j] * (at(k.saturating_sub(j)) + at(k + j)));
            window[0] * at(k) + sides.sum::<f64>()
        })
        .collect()
}

/// Rate and second rate of a signal by central differences; zero at the ends.
pub(crate) fn rates(signal: &[f64], period: f64) -> [Vec<f64>; 2] {
    let mut rates = [vec![0.0; signal.len()], vec![0.0; signal.len()]];
    for (k, part) in signal.windows(3).enumerate() {
        rates[0][k + 1] = (part[2] - part[0]) / (2.0 * period);
        rates[1][k + 1] = (part[2] - 2.0 * part[1] + part[0]) / (period * period);
    }
    rates
}

/// Standard deviation of the white noise in signal `i` of `stride` interleaved ones, from fourth differences, which motion hardly
/// shows in.
pub(crate) fn whiteness(signal: &[f64], stride: usize, i: usize) -> f64 {
    let count = signal.len() / stride;
    let at = |k: usize| signal[k * stride + i];
    let squares = (4..count).map(|k| {
        let difference = at(k) - 4.0 * at(k - 1) + 6.0 * at(k - 2) - 4.0 * at(k - 3) + at(k - 4);
        difference * difference
    });
    // 1 + 16 + 36 + 16 + 1 times the variance.
    (squares.sum::<f64>() / (70.0 * count.saturating_sub(4).max(1) as f64)).sqrt()
}

/// Root mean square of signal `i` of `stride` interleaved ones.
pub(crate) fn rms(signal: &[f64], stride: usize, i: usize) -> f64 {
    let squares: f64 = signal.iter().skip(i).step_by(stride).map(|x| x * x).sum();
    (squares / (signal.len() / stride).max(1) as f64).sqrt()
}
