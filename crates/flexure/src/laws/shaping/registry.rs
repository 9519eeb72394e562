//! What a file of a shaping function holds, and what becomes of a line in their list.

use std::fmt::Debug;

use flexure_core::control::Shaping;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::quantity::Quantity;

/// A gain that a shaping function has beside Λ, on each side of the law: one number per joint.
#[derive(Clone, Copy, Debug)]
pub struct Extra {
    /// Its key in `[controller.link]` and `[controller.motor]`.
    pub key: &'static str,
    pub(crate) quantity: Quantity,
    /// What to start tuning from, by Λ of the same joint.
    pub start: fn(f64) -> f64,
}

/// A shaping function φ: all that a name at `controller.phi` stands for.
pub trait ShapingKind {
    /// The name in files.
    const NAME: &'static str;

    /// One line about it.
    const SUMMARY: &'static str;

    /// What it has beside Λ. Functions may share a key if it means the same.
    const EXTRA: &'static [Extra];

    /// The function itself.
    type Core<C: Scalar, const N: usize>: Shaping<C, N> + Copy + Debug;

    /// The function for robots of `joints` joints, at most `N`, with the diagonal Λ in `gain`; `extra` gives each of
    /// [`EXTRA`](Self::EXTRA). Entries beyond the robot's joints are 1 and must come to nothing.
    fn core<C: Scalar, const N: usize>(
        joints: usize,
        gain: Vector<C, N>,
        extra: &dyn Fn(&Extra) -> Vector<C, N>,
    ) -> Self::Core<C, N>;
}

/// Registers shaping functions, each by the path of its [`ShapingKind`].
macro_rules! shaping {
    ($($file:ident::$kind:ident),+ $(,)?) => {
        /// The registered shaping functions.
        pub const SHAPING: &[Entry] = &[$(Entry {
            name: <$file::$kind as ShapingKind>::NAME,
            summary: <$file::$kind as ShapingKind>::SUMMARY,
        }),+];

        /// A shaping function φ.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Phi {
            $(
                #[doc = concat!("[`", stringify!($kind), "`](flexure_core::control::", stringify!($kind), ").")]
                $kind,
            )+
        }

        impl Phi {
            /// All of them, in the order of the registry.
            pub const ALL: &[Self] = &[$(Self::$kind),+];

            /// The name in files.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$kind => <$file::$kind as ShapingKind>::NAME,)+
                }
            }

            /// Its gains beside Λ.
            pub fn extra(self) -> &'static [Extra] {
                match self {
                    $(Self::$kind => <$file::$kind as ShapingKind>::EXTRA,)+
                }
            }
        }

        /// Any registered shaping function for up to `N` joints, with constants of type `C`.
        #[derive(Clone, Copy, Debug)]
        pub enum AnyShaping<C: Scalar, const N: usize> {
            $(
                #[doc = concat!("[`", stringify!($kind), "`](flexure_core::control::", stringify!($kind), ").")]
                $kind(<$file::$kind as ShapingKind>::Core<C, N>),
            )+
        }

        impl<C: Scalar, const N: usize> AnyShaping<C, N> {
            /// The function `phi` for robots of `joints` joints with the diagonal Λ in `gain`; `extra` is asked for each of
            /// [`Phi::extra`]. Entries beyond the robot's joints are 1.
            pub fn new(
                phi: Phi,
                joints: usize,
                gain: Vector<C, N>,
                extra: &dyn Fn(&Extra) -> Vector<C, N>,
            ) -> Self {
                match phi {
                    $(Phi::$kind => Self::$kind(<$file::$kind as ShapingKind>::core(joints, gain, extra)),)+
                }
            }
        }

        impl<C: Scalar, const N: usize> Shaping<C, N> for AnyShaping<C, N> {
            #[inline]
            fn eval<T: Over<C>>(&self, error: &Vector<T, N>) -> Vector<T, N> {
                match self {
                    $(Self::$kind(phi) => phi.eval(error),)+
                }
            }
        }
    };
}
pub(super) use shaping;
