//! Sums of sines: excitation for identification, and truncated Fourier series.

use super::Reference;
use crate::linalg::Vector;
use crate::scalar::{Over, Piecewise, Scalar};

/// offset_i + Σ_j amplitude_ij sin(frequency_ij t + phase_ij).
///
/// The terms are any slice-like collection: an array on a controller, a `Vec` offline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Multisine<C, Terms, const N: usize> {
    /// Mean position in rad.
    pub offset: Vector<C, N>,
    /// The sines: an array, a slice or a `Vec` of [`Term`].
    pub terms: Terms,
}

/// One sine a joint, without offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term<C, const N: usize> {
    /// Amplitude in rad.
    pub amplitude: Vector<C, N>,
    /// Angular frequency in rad/s.
    pub frequency: Vector<C, N>,
    /// Phase at t = 0 in rad.
    pub phase: Vector<C, N>,
}

impl<C: Scalar, const N: usize> Term<C, N> {
    /// amplitude_i sin(frequency_i t + phase_i) in rad.
    #[inline]
    pub(super) fn on<T: Over<C>>(&self, t: T) -> Vector<T, N> {
        let angle = |i| t.scale(self.frequency[i]) + T::constant(self.phase[i]);
        Vector::from_fn(|i| angle(i).sin().scale(self.amplitude[i]))
    }
}

impl<C: Scalar, Terms: AsRef<[Term<C, N>]>, const N: usize> Reference<C, N> for Multisine<C, Terms, N> {
    #[inline]
    fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
        let mut q_d = self.offset.lift();
        for term in self.terms.as_ref() {
            q_d += term.on(t);
        }
        q_d
    }
}
