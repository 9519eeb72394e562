//! φ_1, which saturates.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::laws::shaping::registry::{Extra, ShapingKind};

/// The φ `tanh`: [`control::Tanh`].
pub struct Tanh;

impl ShapingKind for Tanh {
    const NAME: &'static str = "tanh";
    const SUMMARY: &'static str =
        "φ_1 = Λ tanh(e): bounded speed, semi-global rate, keeps the variational structure";
    const EXTRA: &'static [Extra] = &[];

    type Core<C: Scalar, const N: usize> = control::Tanh<C, N>;

    fn core<C: Scalar, const N: usize>(
        _: usize,
        gain: Vector<C, N>,
        _: &dyn Fn(&Extra) -> Vector<C, N>,
    ) -> control::Tanh<C, N> {
        control::Tanh { gain }
    }
}
