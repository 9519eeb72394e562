//! What proofs need of a shaping function: its slope, affine in bounded quantities, and which of them cover every error.
//!
//! A certified function is a file here, a line in the list below and a variant of [`CertifiedPhi`], which is the format's.

mod coupled_tanh;
mod linear;
mod tanh;

use flexure_core::scalar::{Interval, Scalar};

use crate::prove::engine::certificate::{CertifiedPhi, DecimalGains, bounds};
use crate::prove::engine::position::Ends;

/// The gains of φ on one side, enclosed, one per joint.
#[derive(Clone, Debug)]
pub struct Numbers {
    /// Diagonal of Λ.
    pub shaping: Vec<Interval>,
    /// Its square root.
    pub theta: Vec<Interval>,
    /// κ; nothing for functions without.
    pub kappa: Vec<Interval>,
}

impl Numbers {
    /// From the gains of a side.
    pub fn new(gains: &DecimalGains) -> Self {
        let shaping = bounds(&gains.shaping);
        Self {
            theta: shaping.iter().map(|x| x.sqrt()).collect(),
            shaping,
            kappa: gains.kappa.as_deref().map(bounds).unwrap_or_default(),
        }
    }
}

/// A shaping function with a certificate.
pub trait Certified: Sync {
    /// The name in files.
    fn name(&self) -> &'static str;

    /// The cases of n = `joints` slopes of tanh that cover every error: all of them for a φ that couples joints, the slowest
    /// slopes where each joint is for itself, one without slopes where these are constant.
    fn cases(&self, joints: usize) -> Vec<Ends>;

    /// How many they are.
    fn case_count(&self, joints: usize) -> usize;

    /// ∂φ_ij [1/s] with the slopes (or chords) `a` of tanh; those that do not occur may be left out.
    fn slope(&self, numbers: &Numbers, a: &[Interval], i: usize, j: usize) -> Interval;

    /// Whether ∂φ of this many joints is diagonal at every error.
    fn is_diagonal(&self, joints: usize) -> bool;

    /// Whether ∂φ is Λ at every error.
    fn is_constant(&self) -> bool;

    /// Whether some rate holds at every error, however large.
    fn has_rate_everywhere(&self) -> bool;

    /// β_q of the paper's own formula [1/s] from κ of both sides, where it is not λ_min(Π ∂φ)/λ_max(Π).
    fn paper_rate(&self, kappa: &[f64]) -> Option<f64>;
}

/// Registers functions with a certificate, each by the path of its [`Certified`].
macro_rules! certified {
    ($($file:ident::$phi:ident),+ $(,)?) => {
        impl CertifiedPhi {
            const ALL: &[Self] = &[$(Self::$phi),+];

            /// What proofs need of it.
            pub fn certified(self) -> &'static dyn Certified {
                match self {
                    $(Self::$phi => &$file::$phi,)+
                }
            }
        }
    };
}

// One line a shaping function with a certificate.
certified! {
    tanh::Tanh,
    linear::Linear,
    coupled_tanh::CoupledTanh,
}

impl CertifiedPhi {
    /// The function with this name in files, if it has a certificate.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|phi| phi.certified().name() == name)
    }

    /// The names of all that have one.
    pub fn names() -> Vec<&'static str> {
        Self::ALL.iter().map(|phi| phi.certified().name()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::CertifiedPhi;

    /// The name that a certificate writes is the one that scenario files have.
    #[test]
    fn names_are_those_of_certificates() {
        for phi in CertifiedPhi::ALL {
            assert_eq!(serde_json::to_value(phi).unwrap(), phi.certified().name());
            assert_eq!(CertifiedPhi::named(phi.certified().name()), Some(*phi));
        }
        assert_eq!(CertifiedPhi::named("root"), None);
    }
}
