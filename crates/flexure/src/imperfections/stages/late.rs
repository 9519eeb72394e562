//! Torque that comes late.

use flexure_core::memory::{Memory, Port};

/// Gives each torque a fixed time after it was commanded.
#[derive(Clone, Debug, Default)]
pub(crate) struct Late {
    joints: usize,
    /// What the delay is beyond whole control periods \[s\].
    offset: f64,
    /// Torques on their way [N m], one after the other in a ring, one entry per joint each.
    ring: Vec<f64>,
    /// Where in the ring the oldest one begins, which acts at the beginning of the next period.
    oldest: usize,
}

/// A part of a control period that is not told from none.
const NEGLIGIBLE: f64 = 1e-9;

/// How many torques are on their way at the end of a control instant that are `delay` \[s\] late, in a loop with control periods of
/// `period` \[s\]; and how long into a period the next of them acts \[s\], 0 for from its beginning.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "delays are shorter than runs")]
pub(crate) fn split(delay: f64, period: f64) -> (usize, f64) {
    let whole = (delay / period + NEGLIGIBLE).floor();
    let offset = delay - whole * period;
    let offset = if offset > NEGLIGIBLE * period { offset } else { 0.0 };
    (whole as usize + usize::from(offset > 0.0), offset)
}

impl Late {
    /// By `delay` ≥ 0 in a loop with control periods of `period` \[s\]. Until it is [started](Self::start), no torque acts.
    pub fn new(joints: usize, delay: f64, period: f64) -> Self {
        let (waiting, offset) = split(delay, period);
        Self { joints, offset, ring: vec![0.0; waiting * joints], oldest: 0 }
    }

    /// Whether no torque comes late.
    pub fn is_none(&self) -> bool {
        self.ring.is_empty() && self.offset == 0.0
    }

    /// Starts with the torque [N m] that acts until the first command arrives.
    pub fn start(&mut self, torque: &[f64]) {
        for waiting in self.ring.chunks_exact_mut(self.joints.max(1)) {
            waiting.copy_from_slice(torque);
        }
    }

    /// Replaces the `torque` that is commanded by the one that acts from now on [N m], one entry per joint. If another one
    /// follows before the control period is over, that is `then`; returned is when it does, from now on \[s\].
    pub fn pass(&mut self, torque: &mut [f64], then: &mut [f64]) -> Option<f64> {
        if !self.ring.is_empty() {
            self.ring[self.oldest..][..self.joints].swap_with_slice(torque);
            self.oldest = (self.oldest + self.joints) % self.ring.len();
        }
        if self.offset == 0.0 {
            return None;
        }
        then.copy_from_slice(&self.ring[self.oldest..][..self.joints]);
        Some(self.offset)
    }
}

/// `torque` [N m] of each command on its way, the oldest first.
impl Memory<f64> for Late {
    fn memory(&mut self, port: &mut dyn Port<f64>) {
        let (newest, oldest) = self.ring.split_at_mut(self.oldest);
        for part in [oldest, newest] {
            for torque in part.chunks_exact_mut(self.joints.max(1)) {
                port.joints("torque", "N m", torque);
            }
        }
    }
}
