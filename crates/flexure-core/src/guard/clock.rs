//! Time as a guard sees it: control periods.

use super::Fault;
use crate::memory::Port;

/// Counts control periods and compares them with the stamps of the instants, if they have any.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    /// Control periods from the beginning to the next instant: never less than before.
    next: u64,
    /// The last stamp.
    stamp: Option<u64>,
}

impl Clock {
    pub const START: Self = Self { next: 0, stamp: None };

    /// Control periods since the first instant.
    #[inline]
    pub fn now(&self) -> u64 {
        self.next.saturating_sub(1)
    }

    /// The next instant, with its stamp: control periods since the last one, and what is wrong where at most `allowed` instants may be
    /// missed.
    #[inline]
    pub fn tick(&mut self, stamp: Option<u64>, allowed: u32) -> (u64, Option<Fault>) {
        let passed = self.stamp.zip(stamp).map(|(last, now)| now.checked_sub(last));
        self.stamp = stamp.or(self.stamp);
        let (passed, fault) = match passed {
            Some(None | Some(0)) => (1, Some(Fault::Backwards)),
            Some(Some(passed)) if passed - 1 > u64::from(allowed) => (passed, Some(Fault::Late)),
            Some(Some(passed)) => (passed, None),
            None => (1, None),
        };
        self.next = self.next.saturating_add(passed);
        (passed, fault)
    }

    /// `next`, and the last `stamp` if there is one.
    #[inline]
    pub fn walk<S>(&mut self, port: &mut dyn Port<S>) {
        port.long("next", &mut self.next);
        port.optional("stamped", &mut self.stamp, 0, |stamp, port| port.long("stamp", stamp));
    }
}
