//! Torque over a control period: constant, or two constants.

use flexure_core::linalg::Vector;

/// Motor torque over a control period, constant on at most two pieces of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pieces<const N: usize> {
    pub(crate) first: Vector<f64, N>,
    pub(crate) change: Option<(f64, Vector<f64, N>)>,
}

impl<const N: usize> Pieces<N> {
    /// The same torque [N m] throughout.
    pub fn constant(torque: Vector<f64, N>) -> Self {
        Self { first: torque, change: None }
    }

    /// `first`, and `then` from `offset` > 0 \[s\] after the beginning on [N m].
    pub fn changing(first: Vector<f64, N>, offset: f64, then: Vector<f64, N>) -> Self {
        Self { first, change: Some((offset, then)) }
    }

    /// Where each piece begins, from the beginning of the period \[s\], and its torque [N m].
    pub fn iter(&self) -> impl Iterator<Item = (f64, Vector<f64, N>)> {
        std::iter::once((0.0, self.first)).chain(self.change)
    }

    /// Where each piece begins and how long it lasts in a period of `period` \[s\], and its torque [N m].
    pub fn spans(&self, period: f64) -> impl Iterator<Item = (f64, f64, Vector<f64, N>)> {
        let end = self.change.map_or(period, |(offset, _)| offset);
        let rest = self.change.map(|(offset, torque)| (offset, period - offset, torque));
        std::iter::once((0.0, end, self.first)).chain(rest)
    }

    /// The same pieces with every torque through `f`.
    #[must_use]
    pub fn map(&self, f: impl Fn(Vector<f64, N>) -> Vector<f64, N>) -> Self {
        Self { first: f(self.first), change: self.change.map(|(offset, torque)| (offset, f(torque))) }
    }

    /// Torque at the end of the period [N m].
    pub fn last(&self) -> Vector<f64, N> {
        self.change.map_or(self.first, |(_, torque)| torque)
    }

    /// Mean torque over a period of `period` \[s\] [N m].
    pub fn mean(&self, period: f64) -> Vector<f64, N> {
        match self.change {
            None => self.first,
            Some((offset, then)) => self.first + (then - self.first).scaled(1.0 - offset / period),
        }
    }
}
