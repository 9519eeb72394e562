//! Progress on stderr, and only on a terminal.

use std::fmt::Write;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle, WeakProgressBar};

use crate::interrupt;

/// Steps of the bar.
const RESOLUTION: f64 = 1e4;

/// Nothing is said of the time that remains before so much of the work is done, or so much time went by.
const LEAST: f64 = 0.02;
const SOON: Duration = Duration::from_millis(500);

/// The bar that is shown, if there is one.
static SHOWN: Mutex<Option<WeakProgressBar>> = Mutex::new(None);

/// A bar that disappears when it is dropped; silent when stderr is not a terminal. Dropped after Ctrl-C, it leaves the word to
/// what its job found until then.
pub struct Progress {
    bar: ProgressBar,
    /// Thousandths of each part that are done, and what they count.
    parts: Vec<(AtomicU64, f64)>,
}

impl Progress {
    /// Of one piece of work, that `name` says.
    pub fn of_one(name: &str) -> Self {
        Self::new(name, [1.0])
    }

    /// Of pieces of work, done side by side, that `name` says; each has a weight, the time that it takes beside the others.
    pub fn new(name: &str, weights: impl IntoIterator<Item = f64>) -> Self {
        let template = "{bar:24.cyan/dim} {percent:>3}%  {clock}  {wide_msg}";
        let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
        // indicatif draws nothing if stderr is not a terminal.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a constant")]
        let bar =
            ProgressBar::with_draw_target(Some(RESOLUTION as u64), ProgressDrawTarget::stderr_with_hz(5));
        let bar = bar.with_style(style.with_key("clock", clock)).with_message(name.to_owned());
        *SHOWN.lock().unwrap_or_else(PoisonError::into_inner) = Some(bar.downgrade());
        let weights: Vec<f64> = weights.into_iter().collect();
        let total: f64 = weights.iter().sum();
        Self { bar, parts: weights.iter().map(|weight| (AtomicU64::new(0), weight / total)).collect() }
    }

    /// The fraction of a part that is done; the largest so far counts. Breaks off after Ctrl-C.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [0, 1]")]
    pub fn set(&self, part: usize, fraction: f64) -> ControlFlow<()> {
        let now = (fraction.clamp(0.0, 1.0) * RESOLUTION) as u64;
        let so_far = &self.parts[part].0;
        // Asked at every control instant of every thread: reading disturbs nobody, writing does.
        if now > so_far.load(Ordering::Relaxed) && now > so_far.fetch_max(now, Ordering::Relaxed) {
            let done: f64 =
                self.parts.iter().map(|(part, weight)| weight * part.load(Ordering::Relaxed) as f64).sum();
            self.bar.set_position(done as u64);
        }
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
        if interrupt::asked() {
            interrupt::speak();
        }
    }
}

/// Takes the bar off the terminal.
pub fn clear() {
    let shown = SHOWN.lock().unwrap_or_else(PoisonError::into_inner).take();
    if let Some(bar) = shown.and_then(|bar| bar.upgrade()) {
        bar.finish_and_clear();
    }
}

/// The time that went by, and what remains if the work goes on as it did.
fn clock(state: &ProgressState, out: &mut dyn Write) {
    let elapsed = state.elapsed();
    // Writing to the bar cannot fail.
    let _ = out.write_str(&words(elapsed, remaining(elapsed, f64::from(state.fraction()))));
}

/// The time that remains if the work goes on as it did; none as long as nobody can know.
fn remaining(elapsed: Duration, fraction: f64) -> Option<Duration> {
    let is_known = fraction >= LEAST && elapsed >= SOON;
    is_known.then(|| elapsed.mul_f64((1.0 - fraction).max(0.0) / fraction))
}

fn words(elapsed: Duration, remaining: Option<Duration>) -> String {
    let left = remaining.map_or_else(String::new, |left| format!(", {} left", rounded(left)));
    format!("{}{left}", rounded(elapsed))
}

/// Seconds up to two minutes, then minutes, then hours: no more digits than are known.
fn rounded(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    match seconds {
        ..119.5 => format!("{seconds:.0} s"),
        ..7170.0 => format!("{:.0} min", seconds / 60.0),
        _ => format!("{:.1} h", seconds / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{Progress, remaining, rounded, words};

    #[test]
    fn what_remains_is_what_went_by_at_the_same_pace() {
        let of = |seconds, fraction| remaining(Duration::from_secs(seconds), fraction);
        assert_eq!(of(30, 0.75), Some(Duration::from_secs(10)));
        assert_eq!(of(30, 1.0), Some(Duration::ZERO));
        assert_eq!((of(30, 0.0), of(30, 0.01), of(0, 0.5)), (None, None, None));
        let seconds = |n| rounded(Duration::from_secs(n));
        assert_eq!(
            [seconds(0), seconds(119), seconds(120), seconds(7200)],
            ["0 s", "119 s", "2 min", "2.0 h"]
        );
        assert_eq!(words(Duration::from_secs(3), Some(Duration::from_secs(90))), "3 s, 90 s left");
        assert_eq!(words(Duration::from_secs(3), None), "3 s");
    }

    /// Parts count by their weights, and never less than before.
    #[test]
    fn parts_weigh_what_they_take() {
        let progress = Progress::new("work", [1.0, 3.0]);
        for (part, fraction, done) in [(0, 1.0, 2500), (1, 0.5, 6250), (1, 0.25, 6250), (1, 2.0, 10_000)] {
            let _ = progress.set(part, fraction);
            assert_eq!(progress.bar.position(), done);
        }
    }
}
