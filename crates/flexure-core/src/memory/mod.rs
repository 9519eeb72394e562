//! What estimators and guards remember between control instants, as plain numbers: saving, restoring and naming a loop.
//!
//! Everything with a memory walks over it by [`Memory::memory`], always in the same order, and hands each piece to a
//! [`Port`]. The same walk counts, saves, restores and names, so that these cannot disagree. [`save`] and [`restore`] are
//! ports on slices of `f64`. Settings (gains, periods, limits) are not part of it: what is restored must have been made
//! alike.
//!
//! The layout is the order of the walk, which each type documents: a number takes one `f64`, a vector one per joint, an
//! integer up to `u32` or a flag (0 or 1) one, a `u64` two (its low and its high 32 bits), what may be absent a flag and then
//! its numbers, zeros while it is absent. All of it comes back exactly.
//!
//! ```
//! use flexure_core::estimate::{Estimator, Observer};
//! use flexure_core::linalg::Vector;
//! use flexure_core::memory::{length, restore, save};
//! use flexure_core::model::{Fjr, Motion};
//! use flexure_core::robots::Pendulum;
//!
//! let one = Vector([1.0]);
//! let links = Pendulum { inertia: 1.0, weight_moment: 9.81 };
//! let robot = Fjr { links, motor_inertia: one, stiffness: one, link_damping: one, motor_damping: one };
//! let mut observer = Observer::new(&Vector([100.0]), 1e-3).unwrap();
//! observer.start(&Motion::at_rest(Vector([0.2])));
//!
//! let mut saved = [0.0; 4];
//! assert_eq!(length(&mut observer, 1), saved.len());
//! save(&mut observer, 1, &mut saved).unwrap();
//! assert_eq!(saved, [0.2, 0.2, 0.0, 0.0]);
//!
//! let mut next = || observer.update(&robot, &Vector([0.3]), &Vector([0.1]), &one);
//! let first = next();
//! next();
//! restore(&mut observer, 1, &saved).unwrap();
//! assert_eq!(observer.update(&robot, &Vector([0.3]), &Vector([0.1]), &one), first);
//! ```

mod slices;

pub use slices::{Unfit, length, restore, save};

use crate::linalg::Vector;
use crate::model::Motion;

/// Something that remembers, in numbers of type `S`.
pub trait Memory<S> {
    /// Walks over all that is remembered, always in the same order and with the same names: shows each piece to `port`,
    /// which may read or replace it.
    fn memory(&mut self, port: &mut dyn Port<S>);
}

/// What is done with each piece of a [`Memory`].
///
/// Names are those of notation.md where there is one (`q_l`, `dq_m`), units as in "N m s/rad", empty for none. More kinds of
/// pieces are methods of `dyn Port`.
pub trait Port<S> {
    /// Numbers that have nothing to do with joints.
    fn numbers(&mut self, name: &'static str, unit: &'static str, x: &mut [S]);
    /// A number per joint, phantoms included: a port may take those of the real joints only, which come first.
    fn joints(&mut self, name: &'static str, unit: &'static str, x: &mut [S]);
    /// An integer.
    fn word(&mut self, name: &'static str, x: &mut u32);
    /// Yes or no.
    fn flag(&mut self, name: &'static str, x: &mut bool);
    /// What follows belongs to the part `name`, until the [`leave`](Self::leave) to it: `observer`, then `q_l`, is
    /// `observer.q_l`.
    fn enter(&mut self, _name: &'static str) {}
    /// The end of the part that was entered last.
    fn leave(&mut self) {}
}

impl<S> dyn Port<S> + '_ {
    /// One number.
    pub fn number(&mut self, name: &'static str, unit: &'static str, x: &mut S) {
        self.numbers(name, unit, core::slice::from_mut(x));
    }

    /// A part with a memory of its own.
    pub fn part(&mut self, name: &'static str, part: &mut dyn Memory<S>) {
        self.enter(name);
        part.memory(self);
        self.leave();
    }

    /// A 64-bit integer: `name.low`, then `name.high`.
    pub fn long(&mut self, name: &'static str, x: &mut u64) {
        let [a, b, c, d, e, f, g, h] = x.to_le_bytes();
        let (mut low, mut high) = (u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h]));
        self.enter(name);
        self.word("low", &mut low);
        self.word("high", &mut high);
        self.leave();
        *x = u64::from(high) << 32 | u64::from(low);
    }

    /// Something that may be absent: the flag `name` says whether it is there, then `walk` walks over it, over `absent` where
    /// there is none.
    pub fn optional<T: Copy>(
        &mut self,
        name: &'static str,
        x: &mut Option<T>,
        absent: T,
        walk: impl FnOnce(&mut T, &mut dyn Port<S>),
    ) {
        let (mut there, mut value) = (x.is_some(), x.unwrap_or(absent));
        self.flag(name, &mut there);
        walk(&mut value, self);
        *x = there.then_some(value);
    }
}

/// `q_l`, `q_m` in rad, `dq_l`, `dq_m` [rad/s]: a number per joint each.
impl<S, const N: usize> Memory<S> for Motion<S, N> {
    fn memory(&mut self, port: &mut dyn Port<S>) {
        let Self { q_l: Vector(q_l), q_m: Vector(q_m), v_l: Vector(v_l), v_m: Vector(v_m) } = self;
        port.joints("q_l", "rad", q_l);
        port.joints("q_m", "rad", q_m);
        port.joints("dq_l", "rad/s", v_l);
        port.joints("dq_m", "rad/s", v_m);
    }
}
