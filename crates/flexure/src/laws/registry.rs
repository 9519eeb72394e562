//! What a file of a law holds, and what becomes of a line in the list of laws.

use std::fmt::Debug;

use flexure_core::control::ControlLaw;
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::field::{Field, Joints};
use crate::laws::gain::GainSet;
use crate::laws::starting::Starting;
use crate::laws::{Controller, Drive};
use crate::robot::padded;

/// A kind of law: all that a name in `[controller]` stands for.
pub trait LawKind {
    /// The name in files.
    const NAME: &'static str;

    /// One line about it.
    const SUMMARY: &'static str;

    /// Its gains as data: `[Vec<f64>; G]` for `G` gains with a number per joint each.
    type Gains: GainSet;

    /// Keys, units and starting values of the gains, in the order in which they are tuned.
    const GAINS: <Self::Gains as GainSet>::Shape;

    /// The law itself.
    type Core<C: Scalar, const N: usize>: ControlLaw<C, N> + Clone + Debug;

    /// The law with these gains; `vector` makes constants of a gain.
    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N>;
}

/// How the data of a kind of law come about.
#[derive(Clone, Copy)]
pub(super) struct Maker {
    /// From `[controller]`.
    pub read: fn(&Field<'_>, &Joints, &Starting<'_>) -> Option<Controller>,
    /// From what each joint has to move.
    pub start: fn(&[Drive]) -> Controller,
}

/// Registers kinds of laws, each by the path of its [`LawKind`].
macro_rules! laws {
    ($($file:ident::$kind:ident),+ $(,)?) => {
        /// The registered controllers.
        pub const CONTROLLERS: &[Entry] = &[$(Entry {
            name: <$file::$kind as LawKind>::NAME,
            summary: <$file::$kind as LawKind>::SUMMARY,
        }),+];

        /// How the data of each kind come about, by name.
        const MAKERS: &[(&str, Maker)] = &[$((
            <$file::$kind as LawKind>::NAME,
            Maker {
                read: |field, joints, starting| {
                    let gains = ReadGains::read(&<$file::$kind as LawKind>::GAINS, field, joints, starting)?;
                    Some(Controller::$kind(Box::new(gains)))
                },
                start: |drives| {
                    Controller::$kind(Box::new(GainSet::start(&<$file::$kind as LawKind>::GAINS, drives)))
                },
            },
        )),+];

        /// A control law with its gains, as data.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Controller {
            $(
                #[doc = concat!("The kind of [`", stringify!($kind), "`](flexure_core::control::", stringify!($kind), ").")]
                $kind(Box<<$file::$kind as LawKind>::Gains>),
            )+
        }

        impl Controller {
            /// The name in files.
            pub fn kind(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => <$file::$kind as LawKind>::NAME,)+
                }
            }

            /// Shaping function φ of laws that let one choose it, as in files.
            pub fn phi(&self) -> Option<&'static str> {
                match self {
                    $(Self::$kind(gains) => gains.phi(),)+
                }
            }

            /// What the law is called in words.
            pub fn in_words(&self) -> String {
                self.phi().map_or_else(|| self.kind().to_owned(), |phi| format!("v-CBC with φ = {phi}"))
            }

            /// Every gain with its path below `[controller]`, one number per joint: `link.metric`, `stiffness`.
            pub fn gains(&self) -> Vec<(String, &[f64])> {
                match self {
                    $(Self::$kind(gains) => gains.named(&<$file::$kind as LawKind>::GAINS),)+
                }
            }

            /// By which power each gain grows with the speed of the loop, from its unit, in the order of
            /// [`gains`](Self::gains): a law that is to be twice as fast has its stiffnesses four times and its dampings
            /// twice as large.
            pub fn speed_powers(&self) -> Vec<i32> {
                match self {
                    $(Self::$kind(gains) => gains.speed_powers(&<$file::$kind as LawKind>::GAINS),)+
                }
            }

            /// The gains, to be changed.
            fn slots(&mut self) -> Vec<&mut Vec<f64>> {
                match self {
                    $(Self::$kind(gains) => gains.slots(),)+
                }
            }
        }

        /// Any registered law, with gains of type `C`.
        #[derive(Clone, Debug)]
        pub enum AnyLaw<C: Scalar, const N: usize> {
            $(
                #[doc = concat!("[`", stringify!($kind), "`](flexure_core::control::", stringify!($kind), ").")]
                $kind(Box<<$file::$kind as LawKind>::Core<C, N>>),
            )+
        }

        impl<C: Scalar, const N: usize> ControlLaw<C, N> for AnyLaw<C, N> {
            fn torque<T: Over<C>, L: Links<C, N>>(
                &self,
                robot: &Fjr<C, L, N>,
                x: &Motion<T, N>,
                q_ld: &Vector<Jet<T, 5>, N>,
            ) -> Vector<T, N> {
                match self {
                    $(Self::$kind(law) => law.torque(robot, x, q_ld),)+
                }
            }
        }

        /// The law that `controller` describes, with every gain through `number`.
        pub fn any_law<C: Scalar, const N: usize>(
            controller: &Controller,
            number: impl Fn(f64) -> C,
        ) -> AnyLaw<C, N> {
            match controller {
                $(Controller::$kind(gains) => {
                    AnyLaw::$kind(Box::new(<$file::$kind as LawKind>::core(gains, constants(&number))))
                })+
            }
        }
    };
}
pub(super) use laws;

/// Constants of a gain in vectors of `N` joints: its numbers through `number`, and 1 for joints that only fill the vector.
pub(super) fn constants<C: Scalar, const N: usize>(
    number: &impl Fn(f64) -> C,
) -> impl Fn(&Vec<f64>) -> Vector<C, N> {
    move |values| padded(values, 1.0).map(number)
}
