//! Something that pushes a link, and what is done about it.

use super::faults::Faults;
use super::{Fault, Seen};
use crate::linalg::Vector;
use crate::memory::{Memory, Port};
use crate::scalar::{Float, Piecewise};

/// A collision is a torque on a link that the momentum residual ([`DisturbanceObserver`](crate::estimate::DisturbanceObserver))
/// finds to be more than `threshold`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision<C, const N: usize> {
    /// Per joint [N m], above what friction, payload and model errors make of the residual; infinite for none.
    pub threshold: Vector<C, N>,
    /// What is done.
    pub reaction: Reaction,
}

/// How the robot answers a collision, until the law takes over again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reaction {
    /// It stops as for any other fault: gravity is held, motors are braked.
    Stop,
    /// It floats: gravity is held, and nothing else.
    Float,
    /// It gives way for so many control periods, with the torque that it felt, braked; then it stops.
    Retract(u32),
}

/// What is remembered of a collision: the torque that was felt [N m], and control periods since.
#[derive(Clone, Copy, Debug)]
pub(super) struct Felt<C, const N: usize> {
    torque: Vector<C, N>,
    since: u32,
}

impl<C: Float, const N: usize> Collision<C, N> {
    /// Adds collisions to the `faults`, where readings are good: residuals of bad ones mean nothing.
    #[inline]
    pub(super) fn find(&self, seen: &Seen<C, N>, faults: &mut Faults<N>) {
        if faults.any() {
            return;
        }
        for i in 0..N {
            if Piecewise::abs(seen.residual.link[i]) > self.threshold[i] {
                faults.link[i] = Some(Fault::Collision);
            }
        }
    }
}

impl<C: Float, const N: usize> Felt<C, N> {
    /// At the instant of the collision.
    #[inline]
    pub fn now(seen: &Seen<C, N>) -> Self {
        Self { torque: seen.residual.link, since: 0 }
    }

    /// A control period later.
    #[inline]
    pub fn later(self) -> Self {
        Self { since: self.since.saturating_add(1), ..self }
    }

    /// Torque [N m] beside what holds gravity, and whether motors are braked.
    #[inline]
    pub fn answer(&self, reaction: Reaction) -> (Vector<C, N>, bool) {
        match reaction {
            Reaction::Float => (Vector::ZERO, false),
            Reaction::Retract(periods) if self.since < periods => (self.torque, true),
            Reaction::Stop | Reaction::Retract(_) => (Vector::ZERO, true),
        }
    }

    /// None yet.
    pub const NOTHING: Self = Self { torque: Vector([C::ZERO; N]), since: 0 };
}

/// `torque` [N m] and control periods `since`.
impl<C: Float, const N: usize> Memory<C> for Felt<C, N> {
    #[inline]
    fn memory(&mut self, port: &mut dyn Port<C>) {
        port.joints("torque", "N m", &mut self.torque.0);
        port.word("since", &mut self.since);
    }
}
