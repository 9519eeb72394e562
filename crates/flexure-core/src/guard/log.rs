//! What a guard keeps for those who look afterwards.

use super::{Fault, Phase, Place};
use crate::linalg::Vector;
use crate::memory::{Memory, Port};
use crate::model::Motion;
use crate::scalar::Scalar;

/// Entries that are kept.
pub(super) const ENTRIES: usize = 16;

/// Steps that are kept.
const STEPS: usize = 8;

/// Why and when a guard stopped the robot: the last [`CAPACITY`](Self::CAPACITY) stops, and the last
/// [`STEPS`](Self::STEPS) control instants up to the first one.
#[derive(Clone, Copy, Debug)]
pub struct Log<C, const N: usize> {
    /// A ring: entry `count` mod its length is the next one.
    entries: [Entry; ENTRIES],
    count: u32,
    /// A ring: that of `written` mod its length is the next one. Written until the first fault.
    steps: [Step<C, N>; STEPS],
    written: u32,
}

/// A stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Control periods since the first instant of the guard, missed ones included.
    pub time: u64,
    /// The first thing that was wrong.
    pub cause: Fault,
    /// Where.
    pub place: Place,
}

/// A control instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<C, const N: usize> {
    /// Control periods since the first instant of the guard.
    pub time: u64,
    /// What the guard did.
    pub phase: Phase,
    /// The motion that it saw.
    pub x: Motion<C, N>,
    /// The torque that left it [N m].
    pub torque: Vector<C, N>,
}

impl<C: Scalar, const N: usize> Log<C, N> {
    /// How many stops are kept.
    pub const CAPACITY: usize = ENTRIES;
    /// How many control instants are kept.
    pub const STEPS: usize = STEPS;

    pub(super) fn new() -> Self {
        let step =
            Step { time: 0, phase: Phase::Following, x: Motion::at_rest(Vector::ZERO), torque: Vector::ZERO };
        let entry = Entry { time: 0, cause: Fault::NotFinite, place: Place::Controller };
        Self { entries: [entry; ENTRIES], count: 0, steps: [step; STEPS], written: 0 }
    }

    /// How many stops there were.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// The last stops, the oldest first.
    pub fn entries(&self) -> impl Iterator<Item = Entry> + '_ {
        oldest_first(&self.entries, self.count)
    }

    /// The last control instants up to the first stop, that one included, or up to now if there was none; the oldest first.
    pub fn steps(&self) -> impl Iterator<Item = Step<C, N>> + '_ {
        oldest_first(&self.steps, self.written)
    }

    pub(super) fn enter(&mut self, entry: Entry) {
        put(&mut self.entries, &mut self.count, entry);
    }

    /// Notes a control instant unless there was a stop before it.
    #[inline]
    pub(super) fn note(&mut self, step: Step<C, N>) {
        let frozen = self.count > 1 || self.entries().any(|first| first.time < step.time);
        if !frozen {
            put(&mut self.steps, &mut self.written, step);
        }
    }

    /// Stops after the time `since`.
    pub(super) fn stops_since(&self, since: u64) -> usize {
        self.entries().filter(|entry| entry.time >= since).count()
    }
}

/// Puts `item` at its place in the ring; a count that is full starts over where the ring does.
#[inline]
fn put<T, const LENGTH: usize>(ring: &mut [T; LENGTH], count: &mut u32, item: T) {
    let length = u32::try_from(LENGTH).unwrap_or(u32::MAX);
    if let Some(slot) = ring.get_mut((*count % length) as usize) {
        *slot = item;
    }
    *count = count.checked_add(1).unwrap_or(length);
}

#[inline]
fn oldest_first<T: Copy, const LENGTH: usize>(
    ring: &[T; LENGTH],
    count: u32,
) -> impl Iterator<Item = T> + '_ {
    let length = u32::try_from(LENGTH).unwrap_or(u32::MAX);
    let first = count.saturating_sub(length);
    (first..count).filter_map(move |at| ring.get((at % length) as usize).copied())
}

/// Names of the places in a ring.
const NAMES: [&str; ENTRIES] =
    ["0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15"];

/// `stops` and `steps`, how many there were; each stop with its `time`, the numbers of its `cause` and `place`; each step with its
/// `time`, `phase`, motion and `torque`.
impl<C: Scalar, const N: usize> Memory<C> for Log<C, N> {
    #[inline]
    fn memory(&mut self, port: &mut dyn Port<C>) {
        let Self { entries, count, steps, written } = self;
        port.word("stops", count);
        port.enter("stop");
        for (name, entry) in NAMES.into_iter().zip(entries) {
            port.enter(name);
            entry.walk(port);
            port.leave();
        }
        port.leave();
        port.word("steps", written);
        port.enter("step");
        for (name, Step { time, phase, x, torque }) in NAMES.into_iter().zip(steps) {
            port.enter(name);
            port.long("time", time);
            phase.walk(port);
            x.memory(port);
            port.joints("torque", "N m", &mut torque.0);
            port.leave();
        }
        port.leave();
    }
}

impl Entry {
    #[inline]
    fn walk<S>(&mut self, port: &mut dyn Port<S>) {
        let Self { time, cause, place } = self;
        port.long("time", time);
        let mut fault = Some((*cause, *place));
        Place::walk(&mut fault, port);
        (*cause, *place) = fault.unwrap_or((*cause, *place));
    }
}
