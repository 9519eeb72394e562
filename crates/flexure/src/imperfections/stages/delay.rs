//! Torque that comes late.

use std::collections::VecDeque;

use flexure_core::linalg::Vector;

use crate::imperfections::stages::Pieces;

/// Gives each torque a fixed time after it was commanded.
#[derive(Clone, Debug)]
pub struct Delay<const N: usize> {
    /// What the delay is beyond whole control periods \[s\].
    offset: f64,
    /// Torques on their way, the oldest, which acts at the beginning of the next period, first.
    waiting: VecDeque<Vector<f64, N>>,
}

/// A part of a control period that is not told from none.
const NEGLIGIBLE: f64 = 1e-9;

impl<const N: usize> Delay<N> {
    /// By `delay` ≥ 0 in a loop with control periods of `period` \[s\]; until the first command arrives the torque is
    /// `before` [N m].
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "delays are shorter than runs"
    )]
    pub fn new(delay: f64, period: f64, before: Vector<f64, N>) -> Self {
        let whole = (delay / period + NEGLIGIBLE).floor();
        let offset = delay - whole * period;
        let offset = if offset > NEGLIGIBLE * period { offset } else { 0.0 };
        let waiting = whole as usize + usize::from(offset > 0.0);
        Self { offset, waiting: std::iter::repeat_n(before, waiting).collect() }
    }

    /// Torque over the control period that begins now, when `torque` [N m] is commanded.
    pub fn pieces(&mut self, torque: Vector<f64, N>) -> Pieces<N> {
        self.waiting.push_back(torque);
        let first = self.waiting.pop_front().unwrap_or(torque);
        if self.offset == 0.0 {
            return Pieces::constant(first);
        }
        Pieces::changing(first, self.offset, self.waiting.front().copied().unwrap_or(torque))
    }
}
