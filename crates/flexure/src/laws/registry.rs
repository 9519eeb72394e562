//! What a file of a law holds, and what becomes of a line in the list of laws.

use std::fmt::Debug;
use std::marker::PhantomData;

use flexure_core::control::{DynamicLaw, Signals};
use flexure_core::linalg::Vector;
use flexure_core::scalar::Scalar;

use crate::files::field::{Field, Joints};
use crate::laws::gain::GainSet;
use crate::laws::starting::Starting;
use crate::laws::{Controller, Drive};
use crate::robot::{Robot, padded};

/// A kind of law: all that a name in `[controller]` stands for.
pub trait LawKind {
    /// The name in files.
    const NAME: &'static str;

    /// One line about it.
    const SUMMARY: &'static str;

    /// What is proved of it.
    const CLAIM: Claim;

    /// What a law with memory keeps from one instant to the next: names and units, a number per joint each.
    const MEMORY: &'static [(&'static str, &'static str)] = &[];

    /// Its gains as data: `[Vec<f64>; G]` for `G` gains with a number per joint each.
    type Gains: GainSet;

    /// Keys, units and starting values of the gains, in the order in which they are tuned.
    const GAINS: <Self::Gains as GainSet>::Shape;

    /// Why these gains are none for `robot`, if they are not.
    fn objection(_gains: &Self::Gains, _robot: &Robot) -> Option<String> {
        None
    }

    /// Why what is proved of the law is not proved with these gains for `robot`, if it is not.
    fn doubt(_gains: &Self::Gains, _robot: &Robot) -> Option<Doubt> {
        None
    }

    /// The law itself: a [`ControlLaw`](flexure_core::control::ControlLaw), or a [`DynamicLaw`] with as many parts as `MEMORY` has.
    type Core<C: Scalar, const N: usize>: Clone + Debug;

    /// The law with these gains for `robot`; `vector` makes constants of a gain.
    fn core<C: Scalar, const N: usize>(
        gains: &Self::Gains,
        robot: &Robot,
        vector: impl Fn(&Vec<f64>) -> Vector<C, N>,
    ) -> Self::Core<C, N>;
}

/// What is proved of a law, in continuous time and for the robot of its model; all else that is said of it is simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// Errors decay along moving references: an error equation or a storage function that a test takes along the closed loop.
    Tracking,
    /// The robot comes to rest at a goal that stays, likewise.
    Regulation,
    /// Errors of a part of the loop, exactly; what they make of the rest is small where gains are large.
    Errors,
    /// Nothing: stable near the reference at best.
    Nothing,
}

impl Claim {
    /// In a few words.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Tracking => "tracking",
            Self::Regulation => "regulation",
            Self::Errors => "part of the errors",
            Self::Nothing => "nothing",
        }
    }
}

/// Why a proof does not hold with some gains, and what to change.
pub struct Doubt {
    pub message: String,
    pub help: &'static str,
}

/// What is known of a kind of law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct About {
    /// What it reads of the motion of the robot.
    pub reads: Signals,
    /// What is proved of it.
    pub claim: Claim,
}

/// How the data of a kind of law come about.
#[derive(Clone, Copy)]
pub(super) struct Maker {
    /// From `[controller]`.
    pub read: fn(&Field<'_>, &Joints, &Starting<'_>) -> Option<Controller>,
    /// From what each joint has to move.
    pub start: fn(&[Drive]) -> Controller,
}

/// The most parts that any law's memory has.
pub const PARTS: usize = 17;

/// The memory of a law, a number per joint for each part; parts beyond what the law has are not used.
pub type LawMemory<T, const N: usize> = [Vector<T, N>; PARTS];

/// Registers kinds of laws, each by the path of its [`LawKind`]: static ones, then those with memory.
macro_rules! laws {
    (
        static: $($file:ident::$kind:ident),+;
        dynamic: $($dynamic_file:ident::$dynamic:ident),+ $(;)?
    ) => {
        laws! {
            @data $($file::$kind,)+ $($dynamic_file::$dynamic,)+
        }

        /// Any registered law, with gains of type `C`.
        #[derive(Clone, Debug)]
        pub enum AnyLaw<C: Scalar, const N: usize> {
            $(
                #[doc = concat!("[`", stringify!($kind), "`](flexure_core::control::", stringify!($kind), ").")]
                $kind(Box<<$file::$kind as LawKind>::Core<C, N>>),
            )+
            $(
                #[doc = concat!("[`", stringify!($dynamic), "`](flexure_core::control::", stringify!($dynamic), ").")]
                $dynamic(Box<<$dynamic_file::$dynamic as LawKind>::Core<C, N>>),
            )+
        }

        impl<C: Scalar, const N: usize> AnyLaw<C, N> {
            /// Motor torque [N m] at the motion `x`, if no memory is needed; `q_ld` is the reference of the links in rad to order 4.
            pub fn static_torque<T: Over<C>, L: Links<C, N>>(
                &self,
                robot: &Fjr<C, L, N>,
                x: &Motion<T, N>,
                q_ld: &Vector<Jet<T, 5>, N>,
            ) -> Option<Vector<T, N>> {
                match self {
                    $(Self::$kind(law) => Some(law.torque(robot, x, q_ld)),)+
                    $(Self::$dynamic(_) => None,)+
                }
            }

            /// Motor torque [N m] at the motion `x` with the memory `z`.
            pub fn torque<T: Over<C>, L: Links<C, N>>(
                &self,
                robot: &Fjr<C, L, N>,
                x: &Motion<T, N>,
                q_ld: &Vector<Jet<T, 5>, N>,
                z: &LawMemory<T, N>,
            ) -> Vector<T, N> {
                match self {
                    $(Self::$kind(law) => law.torque(robot, x, q_ld),)+
                    $(Self::$dynamic(law) => law.torque(robot, x, q_ld, first(z)),)+
                }
            }

            /// The rate of the memory, while the motors get `applied`.
            pub fn rate<T: Over<C>, L: Links<C, N>>(
                &self,
                robot: &Fjr<C, L, N>,
                x: &Motion<T, N>,
                q_ld: &Vector<Jet<T, 5>, N>,
                z: &LawMemory<T, N>,
                applied: &Applied<T, N>,
            ) -> LawMemory<T, N> {
                match self {
                    $(Self::$kind(_) => [Vector::ZERO; PARTS],)+
                    $(Self::$dynamic(law) => all(law.rate(robot, x, q_ld, first(z), applied)),)+
                }
            }

            /// The memory that a loop starts with.
            pub fn start<T: Over<C>, L: Links<C, N>>(
                &self,
                robot: &Fjr<C, L, N>,
                x: &Motion<T, N>,
                q_ld: &Vector<Jet<T, 5>, N>,
            ) -> LawMemory<T, N> {
                match self {
                    $(Self::$kind(_) => [Vector::ZERO; PARTS],)+
                    $(Self::$dynamic(law) => all(law.start(robot, x, q_ld)),)+
                }
            }

            /// The memory of a loop that has followed for long and moves as `x`.
            pub fn settled<T: Over<C>, L: Links<C, N>>(
                &self,
                robot: &Fjr<C, L, N>,
                x: &Motion<T, N>,
                q_ld: &Vector<Jet<T, 5>, N>,
            ) -> LawMemory<T, N> {
                match self {
                    $(Self::$kind(_) => [Vector::ZERO; PARTS],)+
                    $(Self::$dynamic(law) => all(law.settled(robot, x, q_ld)),)+
                }
            }

            /// The memory a `period` in s later.
            pub fn advanced<T: Over<C> + Piecewise, L: Links<C, N>>(
                &self,
                robot: &Fjr<C, L, N>,
                seen: [&Seen<T, N>; 2],
                z: &LawMemory<T, N>,
                applied: &Applied<T, N>,
                period: T,
            ) -> LawMemory<T, N> {
                match self {
                    $(Self::$kind(_) => *z,)+
                    $(Self::$dynamic(law) => {
                        all(law.advanced(robot, seen, first(z), applied, period))
                    })+
                }
            }

            /// What the law keeps from one instant to the next: names and units, a number per joint each.
            pub fn memory(&self) -> &'static [(&'static str, &'static str)] {
                match self {
                    $(Self::$kind(_) => <$file::$kind as LawKind>::MEMORY,)+
                    $(Self::$dynamic(_) => <$dynamic_file::$dynamic as LawKind>::MEMORY,)+
                }
            }
        }

        /// What is known of each kind of law, by name.
        const ABOUT: &[(&str, About)] = &[
            $((<$file::$kind as LawKind>::NAME, About {
                reads: <<$file::$kind as LawKind>::Core<f64, 1> as control::ControlLaw<f64, 1>>::READS,
                claim: <$file::$kind as LawKind>::CLAIM,
            }),)+
            $((<$dynamic_file::$dynamic as LawKind>::NAME, About {
                reads: reads(PhantomData::<<$dynamic_file::$dynamic as LawKind>::Core<f64, 1>>),
                claim: <$dynamic_file::$dynamic as LawKind>::CLAIM,
            }),)+
        ];

        /// The law that `controller` describes for `robot`, with every gain through `number`.
        pub fn any_law<C: Scalar, const N: usize>(
            controller: &Controller,
            robot: &Robot,
            number: &dyn Fn(f64) -> C,
        ) -> AnyLaw<C, N> {
            match controller {
                $(Controller::$kind(gains) => {
                    AnyLaw::$kind(Box::new(<$file::$kind as LawKind>::core(gains, robot, constants(number))))
                })+
                $(Controller::$dynamic(gains) => AnyLaw::$dynamic(Box::new(
                    <$dynamic_file::$dynamic as LawKind>::core(gains, robot, constants(number)),
                )),)+
            }
        }
    };
    (@data $($file:ident::$kind:ident,)+) => {
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

            /// What the law keeps from one instant to the next: names and units, a number per joint each; nothing if it is static.
            pub fn memory(&self) -> &'static [(&'static str, &'static str)] {
                match self {
                    $(Self::$kind(_) => <$file::$kind as LawKind>::MEMORY,)+
                }
            }

            /// The same law with the gains that tuning starts from.
            ///
            /// # Errors
            /// If the robot has more joints than this program was built for.
            pub(crate) fn restart(&self, robot: &Robot) -> Result<Self, Problems> {
                let drives = drives(robot)?;
                Ok(match self {
                    $(Self::$kind(gains) => {
                        Self::$kind(Box::new(gains.restart(&<$file::$kind as LawKind>::GAINS, &drives)))
                    })+
                })
            }

            /// Why these gains are none for `robot`, if they are not.
            pub(crate) fn objection(&self, robot: &Robot) -> Option<String> {
                match self {
                    $(Self::$kind(gains) => <$file::$kind as LawKind>::objection(gains, robot),)+
                }
            }

            /// Why what is proved of the law is not proved with these gains for `robot`, if it is not.
            pub(crate) fn doubt(&self, robot: &Robot) -> Option<Doubt> {
                match self {
                    $(Self::$kind(gains) => <$file::$kind as LawKind>::doubt(gains, robot),)+
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
                let name = if matches!(self, Self::Vcbc(_)) { "v-CBC" } else { self.kind() };
                self.phi().map_or_else(|| name.to_owned(), |phi| format!("{name} with φ = {phi}"))
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
    };
}
pub(super) use laws;

/// The parts that a law with `K` of them has.
pub(super) fn first<T, const N: usize, const K: usize>(z: &LawMemory<T, N>) -> &[Vector<T, N>; K] {
    z.first_chunk().expect("no law has more parts than PARTS")
}

/// The parts of a law among those that any law may have.
pub(super) fn all<T: Scalar, const N: usize, const K: usize>(z: [Vector<T, N>; K]) -> LawMemory<T, N> {
    std::array::from_fn(|k| z.get(k).copied().unwrap_or(Vector::ZERO))
}

/// What a law with memory reads.
pub(super) const fn reads<F: DynamicLaw<f64, 1, K>, const K: usize>(_: PhantomData<F>) -> Signals {
    F::READS
}

/// Constants of a gain in vectors of `N` joints: its numbers through `number`, and 1 for joints that only fill the vector.
pub(super) fn constants<C: Scalar, const N: usize>(
    number: &dyn Fn(f64) -> C,
) -> impl Fn(&Vec<f64>) -> Vector<C, N> {
    move |values| padded(values, 1.0).map(number)
}
