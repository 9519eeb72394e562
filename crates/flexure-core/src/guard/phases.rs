//! Who decides: the states of a guard, and what leads from one to the next.

use super::{Latch, Settings};
use crate::memory::Port;

/// Who decides the motor torque of a control instant.
///
/// ```text
///                  reading lost, not for long           bad reading, implausible, collision,
///                 ┌──────────────────────────┐          law failed, late, time backwards
///                 │                          ▼
///            Following ◀──────────────── Coasting ─────────────┐
///              ▲   │      reading again                        │
///              │   └───────────────────────────────────┐       │
///              │                                       ▼       ▼
///           Rejoined ◀─────────────────────────────── Stopped ───────▶ Off
///                      good readings, slow, near,        │     too long  │
///                      torque continuous, not latched    └───────────────┴──▶ reset() ──▶ Stopped
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The law decides.
    Following,
    /// The law decides, on a motion that in part was predicted: a reading is late, but not yet too old.
    Coasting,
    /// The guard decides: the robot is being stopped.
    Stopped,
    /// The guard decides for the last time: from the next instant on it is the law again. Now is when the loop joins the
    /// reference smoothly from how the robot moves.
    Rejoined,
    /// No torque, until [`reset`](super::Guard::reset): the robot could not be given back to the law in time. Brakes are
    /// somebody else's.
    Off,
}

impl Phase {
    /// All of them, in the order of their codes, from 0.
    pub const ALL: [Self; 5] = [Self::Following, Self::Coasting, Self::Stopped, Self::Rejoined, Self::Off];

    /// Its number, from 0.
    #[inline]
    pub fn code(self) -> u32 {
        self as u32
    }

    /// The phase of a number, if it is one.
    #[inline]
    pub fn of_code(code: u32) -> Option<Self> {
        Self::ALL.get(usize::try_from(code).ok()?).copied()
    }

    /// In a word, as logs write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Following => "following",
            Self::Coasting => "coasting",
            Self::Stopped => "stopped",
            Self::Rejoined => "rejoined",
            Self::Off => "off",
        }
    }

    /// Whether the torque is the law's.
    #[inline]
    pub fn is_law_s(self) -> bool {
        matches!(self, Self::Following | Self::Coasting)
    }

    /// Shows its number to `port`, and takes what it becomes if that is the number of a phase.
    #[inline]
    pub fn walk<S>(&mut self, port: &mut dyn Port<S>) {
        let mut code = self.code();
        port.word("phase", &mut code);
        *self = Self::of_code(code).unwrap_or(*self);
    }
}

/// What of the past decides who decides.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    /// Whether the robot is being stopped.
    pub stopped: bool,
    /// Good readings still wanted before the law takes over.
    awaited: u32,
    /// Control periods of this stop.
    lasted: u32,
    /// Whether the stop lasts until it is reset.
    pub latched: bool,
}

impl State {
    pub const FOLLOWING: Self = Self { stopped: false, awaited: 0, lasted: 0, latched: false };

    /// Another instant of a stop, its first one included, whose readings are `good` or not. True if the law may take over when the
    /// robot is fit for it.
    #[inline]
    pub fn stop<C, const N: usize>(&mut self, settings: &Settings<C, N>, good: bool) -> bool {
        if !self.stopped {
            (self.stopped, self.lasted) = (true, 0);
        }
        self.lasted = self.lasted.saturating_add(1);
        self.awaited = if good { self.awaited.saturating_sub(1) } else { settings.rejoin.after };
        good && self.awaited == 0 && !self.latched && !self.is_off(settings)
    }

    /// Whether the stop has lasted too long.
    #[inline]
    pub fn is_off<C, const N: usize>(&self, settings: &Settings<C, N>) -> bool {
        self.stopped && settings.off_after.is_some_and(|most| self.lasted > most)
    }

    /// Latches if there were too many stops: `stops` says how many within the time.
    #[inline]
    pub fn count(&mut self, latch: Option<Latch>, stops: usize) {
        self.latched |= latch.is_some_and(|latch| stops >= latch.stops as usize);
    }

    /// The stop goes on as if it had just begun, and is over when the robot is fit for the law.
    pub fn reset<C, const N: usize>(&mut self, settings: &Settings<C, N>) {
        *self = Self { stopped: true, awaited: settings.rejoin.after, lasted: 0, latched: false };
    }

    /// `stopped`, good readings still `awaited`, control periods that the stop has `lasted`, whether it is `latched`.
    #[inline]
    pub fn walk<S>(&mut self, port: &mut dyn Port<S>, most: u32) {
        let Self { stopped, awaited, lasted, latched } = self;
        port.flag("stopped", stopped);
        port.word("awaited", awaited);
        port.word("lasted", lasted);
        port.flag("latched", latched);
        *awaited = (*awaited).min(most);
    }
}
