//! How the list of kinds becomes everything that is asked of an imperfection of any kind.

/// From `file::Kind` lines: modules, [`Imperfection`](crate::imperfections::Imperfection), its dispatch, the list of names and
/// their readers. The order is that of the stages in a loop.
macro_rules! imperfections {
    ($($(#[$attribute:meta])* $module:ident :: $Kind:ident,)*) => {
        $($(#[$attribute])* mod $module; $(#[$attribute])* pub use $module::*;)*

        /// An imperfection as data. Vectors have one entry per joint.
        #[derive(Clone, Debug)]
        pub enum Imperfection {
            $(
                #[doc = concat!("Of the kind of [`", stringify!($Kind), "`].")]
                $(#[$attribute])*
                $Kind($Kind),
            )*
        }

        /// The registered imperfections, in the order of their stages in a loop.
        pub const IMPERFECTIONS: &[Entry] = &[$(
            $(#[$attribute])*
            Entry { name: <$Kind as Kind>::NAME, summary: <$Kind as Kind>::SUMMARY },
        )*];

        /// Each kind in three strengths.
        pub const STRENGTHS: &[(&str, Strengths)] = &[$(
            $(#[$attribute])*
            (<$Kind as Kind>::NAME, <$Kind as Kind>::STRENGTHS),
        )*];

        /// The readers of the kinds.
        const READERS: &[(&str, Reader)] = &[$(
            $(#[$attribute])*
            (<$Kind as Kind>::NAME, |table, context| entry(table, context).map(Imperfection::$Kind)),
        )*];

        impl Imperfection {
            /// The name in files.
            pub fn kind(&self) -> &'static str {
                match self {
                    $($(#[$attribute])* Self::$Kind(_) => <$Kind as Kind>::NAME,)*
                }
            }

            fn place(&self) -> Place {
                match self {
                    $($(#[$attribute])* Self::$Kind(_) => <$Kind as Kind>::PLACE,)*
                }
            }

            /// What it is about that an `earlier` one of its kind is about, too; none if both can be meant.
            pub(crate) fn overlap(&self, earlier: &Self) -> Option<Overlap> {
                match self {
                    $($(#[$attribute])* Self::$Kind(data) => data.overlap(earlier.of::<$Kind>()?),)*
                }
            }

            /// Whether it draws random numbers: runs with other seeds are other runs.
            pub fn draws(&self) -> bool {
                match self {
                    $($(#[$attribute])* Self::$Kind(data) => data.draws(),)*
                }
            }

            fn effect(&self, setup: Setup) -> Effect<'_> {
                match self {
                    $($(#[$attribute])* Self::$Kind(data) => data.effect(setup),)*
                }
            }

            fn data(&self) -> &dyn Any {
                match self {
                    $($(#[$attribute])* Self::$Kind(data) => data,)*
                }
            }

            fn data_mut(&mut self) -> &mut dyn Any {
                match self {
                    $($(#[$attribute])* Self::$Kind(data) => data,)*
                }
            }
        }
    };
}
