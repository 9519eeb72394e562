//! φ_2, the linear one.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::shaping::registry::{Extra, ShapingKind};

/// The φ `linear`: [`control::Linear`].
pub struct Linear;

impl ShapingKind for Linear {
    const NAME: &'static str = "linear";
    const SUMMARY: &'static str = "φ_2 = Λ e: one rate everywhere, keeps the pH-like structure when Π = Λ";
    const EXTRA: &'static [Extra] = &[];

    type Core<C: Scalar, const N: usize> = control::Linear<C, N>;

    fn core<C: Scalar, const N: usize>(
        _: usize,
        gain: Vector<C, N>,
        _: &dyn Fn(&Extra) -> Vector<C, N>,
    ) -> control::Linear<C, N> {
        control::Linear { gain }
    }
}
