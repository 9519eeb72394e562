//! Progress on stderr, and only on a terminal.

use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A set of progress bars; silent when stderr is not a terminal.
pub struct Progress {
    bars: MultiProgress,
}

impl Progress {
    pub fn new() -> Self {
        // indicatif draws nothing if stderr is not a terminal.
        Self { bars: MultiProgress::with_draw_target(ProgressDrawTarget::stderr_with_hz(10)) }
    }

    /// A bar that fills from 0 to 1.
    pub fn bar(&self, name: &str) -> Bar {
        let style = ProgressStyle::with_template("{bar:32.cyan/dim} {percent:>3}%  {prefix}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = self.bars.add(ProgressBar::new(RESOLUTION).with_style(style).with_prefix(name.to_owned()));
        Bar { bar }
    }
}

const RESOLUTION: u64 = 1000;

/// One bar; it disappears when it is done.
pub struct Bar {
    bar: ProgressBar,
}

impl Bar {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [0, 1]")]
    pub fn set(&self, fraction: f64) {
        self.bar.set_position((fraction.clamp(0.0, 1.0) * RESOLUTION as f64) as u64);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
