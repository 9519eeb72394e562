//! One sine a joint.

use super::{Reference, Term};
use crate::linalg::Vector;
use crate::scalar::{Over, Piecewise, Scalar};

/// offset_i + amplitude_i sin(frequency_i t + phase_i).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sine<C, const N: usize> {
    /// Mean position in rad.
    pub offset: Vector<C, N>,
    /// Amplitude in rad.
    pub amplitude: Vector<C, N>,
    /// Angular frequency in rad/s.
    pub frequency: Vector<C, N>,
    /// Phase at t = 0 in rad.
    pub phase: Vector<C, N>,
}

impl<C: Scalar, const N: usize> Sine<C, N> {
    /// At 0 for ever: for `..Sine::ZERO`, where only some fields are given.
    pub const ZERO: Self =
        Self { offset: Vector::ZERO, amplitude: Vector::ZERO, frequency: Vector::ZERO, phase: Vector::ZERO };
}

impl<C: Scalar, const N: usize> Reference<C, N> for Sine<C, N> {
    #[inline]
    fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
        let term = Term { amplitude: self.amplitude, frequency: self.frequency, phase: self.phase };
        self.offset.lift() + term.on(t)
    }
}
