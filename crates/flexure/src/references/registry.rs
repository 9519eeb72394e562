//! What a file of a reference holds, and what becomes of a line in the list of references.

use std::fmt::Debug;

use flexure_core::reference;
use flexure_core::scalar::{Interval, Piecewise};

use crate::files::base::Base;
use crate::files::field::Joints;
use crate::files::table::Table;
use crate::files::{Entry, Places, Problem};
use crate::references::Reference;

/// A number that a time can be, of which it is known where it lies among floats.
pub trait Instant: Piecewise + PartialEq {}

impl<C: Piecewise + PartialEq> Instant for C {}

/// Where derivatives of a reference jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The name of the kind of motion.
    pub of: &'static str,
    /// The lowest derivative that jumps, at most the fourth: the torque has a step for 4, an impulse for less.
    pub derivative: usize,
    /// When it does so first, by the reference's own clock, in s.
    pub time: f64,
}

/// A kind of reference, as data: all that a `kind` in `[reference]` stands for but its reader.
pub trait ReferenceKind {
    /// The reference itself.
    type Core<C: Instant, const N: usize>: reference::Reference<C, N> + Clone + Debug + PartialEq;

    /// The reference with its numbers through `number`; `places` say where the keys stand.
    ///
    /// # Errors
    /// If there is no such motion.
    fn core<C: Instant, const N: usize>(
        &self,
        number: &dyn Fn(f64) -> C,
        places: &Places,
    ) -> Result<Self::Core<C, N>, Problem>;

    /// Position at t = 0 \[rad\], one number per joint.
    fn initial(&self) -> Vec<f64>;

    /// The jump that makes torques jump, if there is one within the motion.
    fn jump(&self) -> Option<Jump>;

    /// Times in s at which the fourth derivative may jump; anywhere else it is continuous.
    fn breaks<const N: usize>(core: &Self::Core<Interval, N>) -> Vec<Interval>;

    /// Times in s at which the fifth derivative may jump, beside the [`breaks`](Self::breaks).
    fn kinks<const N: usize>(core: &Self::Core<Interval, N>) -> Vec<Interval>;
}

/// What a reader of `[reference]` knows.
pub(crate) struct Context<'a> {
    pub joints: &'a Joints,
    pub base: &'a Base,
    /// End of the run by the reference's own clock in s; NaN if that is not known.
    pub end: f64,
}

/// A name in files: its entry in lists, its keys beside those of every kind, and its reader.
#[derive(Clone, Copy)]
pub(crate) struct Name {
    pub entry: Entry,
    pub keys: &'static [&'static str],
    pub read: fn(&Table<'_>, &Context<'_>) -> Option<Reference>,
}

/// The names of a kind.
pub(crate) trait Named {
    /// Each with its reader.
    const NAMES: &'static [Name];
}

/// Registers kinds of references, each by the path of its [`ReferenceKind`].
macro_rules! references {
    ($($file:ident::$kind:ident),+ $(,)?) => {
        /// Every name, in the order of the list.
        const NAMES: [Name; 0 $(+ <$file::$kind as Named>::NAMES.len())+] = {
            let kinds = [$(<$file::$kind as Named>::NAMES),+];
            let mut names = [kinds[0][0]; 0 $(+ <$file::$kind as Named>::NAMES.len())+];
            let (mut kind, mut next) = (0, 0);
            while kind < kinds.len() {
                let mut i = 0;
                while i < kinds[kind].len() {
                    names[next] = kinds[kind][i];
                    (i, next) = (i + 1, next + 1);
                }
                kind += 1;
            }
            names
        };

        /// A reference q_ld(t) as data.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Reference {
            $(
                #[doc = concat!("[`", stringify!($kind), "`].")]
                $kind($kind),
            )+
        }

        impl Reference {
            /// Position at t = 0 \[rad\], before any smooth start.
            pub fn initial(&self) -> Vec<f64> {
                match self {
                    $(Self::$kind(data) => data.initial(),)+
                }
            }

            /// The jump that makes torques jump, if there is one within the motion.
            pub fn jump(&self) -> Option<Jump> {
                match self {
                    $(Self::$kind(data) => data.jump(),)+
                }
            }
        }

        /// Any registered reference at its own speed, for `N` joints, with constants of type `C`.
        #[derive(Clone, Debug, PartialEq)]
        pub enum AnyPath<C: Instant, const N: usize> {
            $(
                #[doc = concat!("[`", stringify!($kind), "`].")]
                $kind(<$kind as ReferenceKind>::Core<C, N>),
            )+
        }

        impl<C: Instant, const N: usize> AnyPath<C, N> {
            /// The path that `data` describes, with its numbers through `number`; `places` say where the keys stand.
            ///
            /// # Errors
            /// If there is no such motion.
            pub fn new(
                data: &Reference,
                number: &dyn Fn(f64) -> C,
                places: &Places,
            ) -> Result<Self, Problem> {
                Ok(match data {
                    $(Reference::$kind(data) => Self::$kind(data.core(number, places)?),)+
                })
            }
        }

        impl<const N: usize> AnyPath<Interval, N> {
            /// Times in s at which the fourth derivative may jump; anywhere else it is continuous.
            pub fn breaks(&self) -> Vec<Interval> {
                match self {
                    $(Self::$kind(path) => <$kind as ReferenceKind>::breaks(path),)+
                }
            }

            /// Times in s at which the fifth derivative may jump, beside the [`breaks`](Self::breaks).
            pub fn kinks(&self) -> Vec<Interval> {
                match self {
                    $(Self::$kind(path) => <$kind as ReferenceKind>::kinks(path),)+
                }
            }
        }

        impl<C: Instant, const N: usize> reference::Reference<C, N> for AnyPath<C, N> {
            fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
                match self {
                    $(Self::$kind(path) => path.on(t),)+
                }
            }

            fn at<const K: usize>(&self, t: C) -> Vector<Jet<C, K>, N>
            where
                C: Over<C> + Piecewise,
            {
                match self {
                    $(Self::$kind(path) => path.at(t),)+
                }
            }
        }
    };
}
pub(super) use references;
