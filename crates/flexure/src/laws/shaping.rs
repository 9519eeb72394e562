//! The shaping functions φ by name.

use flexure_core::control::{CoupledTanh, Linear, Shaping, Tanh};
use flexure_core::linalg::Vector;
use flexure_core::scalar::{Over, Scalar};

use crate::files::Entry;

/// The registered shaping functions.
pub const SHAPING: &[Entry] = &[
    Entry {
        name: "tanh",
        summary: "φ_1 = Λ tanh(e): bounded speed, semi-global rate, keeps the variational structure",
    },
    Entry {
        name: "linear",
        summary: "φ_2 = Λ e: one rate everywhere, keeps the pH-like structure when Π = Λ",
    },
    Entry {
        name: "coupled-tanh",
        summary: "φ_3 = (1 + κ) e + coupling by tanh: contracts in μ_1 at min κ, whatever Λ",
    },
];

/// Any registered shaping function for `N` joints, with constants of type `C`.
#[derive(Clone, Copy, Debug)]
pub enum AnyShaping<C, const N: usize> {
    /// φ_1.
    Tanh(Tanh<C, N>),
    /// φ_2.
    Linear(Linear<C, N>),
    /// φ_3.
    CoupledTanh(CoupledTanh<C, N>),
}

impl<C: Scalar, const N: usize> AnyShaping<C, N> {
    /// The function called `name` with gain Λ and, for `coupled-tanh`, κ. None for a name that is not registered, or
    /// if κ is missing.
    pub fn new(name: &str, gain: Vector<C, N>, kappa: Option<Vector<C, N>>) -> Option<Self> {
        match name {
            "tanh" => Some(Self::Tanh(Tanh { gain })),
            "linear" => Some(Self::Linear(Linear { gain })),
            "coupled-tanh" => kappa.map(|kappa| Self::CoupledTanh(CoupledTanh::new(kappa, &gain))),
            _ => None,
        }
    }
}

impl<C: Scalar, const N: usize> Shaping<C, N> for AnyShaping<C, N> {
    #[inline]
    fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
        match self {
            Self::Tanh(phi) => phi.eval(error),
            Self::Linear(phi) => phi.eval(error),
            Self::CoupledTanh(phi) => phi.eval(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{AnyShaping, SHAPING, Shaping, Vector};

    /// Every member: built by its name, zero at zero, and contracting towards zero.
    #[test]
    fn every_shaping_function_vanishes_at_zero_and_pulls_back() {
        let gain = Vector([5.0, 2.0, 7.0]);
        for entry in SHAPING {
            let phi = AnyShaping::new(entry.name, gain, Some(Vector([3.0, 4.0, 5.0]))).expect(entry.name);
            assert_eq!(phi.eval(&Vector([0.0; 3])), Vector([0.0; 3]), "{}", entry.name);
            for e in [[0.1, -0.2, 0.3], [2.0, 1.0, -3.0], [-0.5, 0.0, 0.0]] {
                let e = Vector(e);
                assert!(phi.eval(&e).dot(&gain.diag_mul(&e)) > 0.0, "{} at {e:?}", entry.name);
            }
        }
        assert!(AnyShaping::new("coupled-tanh", gain, None).is_none());
        assert!(AnyShaping::new("cubic", gain, None).is_none());
    }
}
