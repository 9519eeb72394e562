//! Progress on stderr, and only on a terminal.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Steps of the bar for each part of the work.
const RESOLUTION: u64 = 1000;

/// A bar that disappears when it is dropped; silent when stderr is not a terminal.
pub struct Progress {
    bar: ProgressBar,
    parts: Vec<AtomicU64>,
}

impl Progress {
    /// Of `parts` pieces of work, done side by side, that `name` says.
    pub fn new(name: &str, parts: usize) -> Self {
        let style = ProgressStyle::with_template("{bar:32.cyan/dim} {percent:>3}%  {prefix}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        // indicatif draws nothing if stderr is not a terminal.
        let bar = ProgressBar::with_draw_target(
            Some(RESOLUTION * parts as u64),
            ProgressDrawTarget::stderr_with_hz(10),
        );
        let parts = (0..parts).map(|_| AtomicU64::new(0)).collect();
        Self { bar: bar.with_style(style).with_prefix(name.to_owned()), parts }
    }

    /// The fraction of a part that is done; it only grows. Nothing is broken off.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [0, 1]")]
    pub fn set(&self, part: usize, fraction: f64) -> ControlFlow<()> {
        let now = (fraction.clamp(0.0, 1.0) * RESOLUTION as f64) as u64;
        let before = self.parts[part].swap(now, Ordering::Relaxed);
        if now > before {
            self.bar.inc(now - before);
        }
        ControlFlow::Continue(())
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
