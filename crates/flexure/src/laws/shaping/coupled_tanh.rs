//! φ_3, which couples the joints.

use flexure_core::control;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;
use crate::laws::shaping::registry::{Extra, ShapingKind};
use crate::units;

/// The φ `coupled-tanh`: [`control::CoupledTanh`].
pub struct CoupledTanh;

/// κ starts at Λ, which is what it contracts at where it is linear.
const KAPPA: Extra = Extra {
    key: "kappa",
    quantity: Quantity::positive("rate κ of coupled-tanh", units::RATE),
    start: |gain| gain,
};

impl ShapingKind for CoupledTanh {
    const NAME: &'static str = "coupled-tanh";
    const SUMMARY: &'static str = "φ_3 = (1 + κ) e + coupling by tanh: contracts in μ_1 at min κ, whatever Λ";
    const EXTRA: &'static [Extra] = &[KAPPA];

    type Core<C: Scalar, const N: usize> = control::CoupledTanh<C, N>;

    fn core<C: Scalar, const N: usize>(
        joints: usize,
        gain: Vector<C, N>,
        extra: &dyn Fn(&Extra) -> Vector<C, N>,
    ) -> control::CoupledTanh<C, N> {
        control::CoupledTanh::of_joints(joints, extra(&KAPPA), &gain)
    }
}
