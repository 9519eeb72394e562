//! What makes a kind of imperfection.

use crate::files::table::Table;
use crate::imperfections::document::Context;
use crate::imperfections::effect::Effect;
use crate::imperfections::side::Side;
use crate::imperfections::stages::Random;

/// A kind of `[[imperfection]]`: everything about it is in the file that implements this for its data, and a line of the list
/// in `imperfections/mod.rs` makes it known to files, loops and tests. Each item is required but `draws`, which a test watches.
pub(crate) trait Kind: Sized + 'static {
    /// The name in files.
    const NAME: &'static str;
    /// One line for `flexure list`.
    const SUMMARY: &'static str;
    /// The keys of an entry beside `kind`.
    const KEYS: &'static [&'static str];
    /// Where it is.
    const PLACE: Place;
    /// Entries of three strengths.
    const STRENGTHS: Strengths;

    /// Reads an entry; none after it has noted what is wrong.
    fn read(table: &Table<'_>, context: &Context<'_>) -> Option<Self>;

    /// What it is about that an `earlier` entry of its kind is about, too; none if both can be meant.
    fn overlap(&self, earlier: &Self) -> Option<Overlap>;

    /// Whether it draws random numbers, so that the seed matters.
    fn draws(&self) -> bool {
        false
    }

    /// What it does to a loop that is set up as `setup`.
    fn effect(&self, setup: Setup) -> Effect<'_>;
}

/// Where an imperfection is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// In sensors, computer or drives: such loops are sampled.
    Devices,
    /// In the robot and what it meets.
    Mechanics,
}

/// Entries of a scenario file, without the line of their kind, in three strengths. They are for any joint count, control
/// periods of 2 ms and torques of some N m: those of the built-in scenario `two-link-hardware`, which tests read them in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strengths {
    /// No strength: no bit of a run changes. None for what is always something.
    pub none: Option<&'static str>,
    /// A little.
    pub little: &'static str,
    /// At least twice as bad.
    pub much: &'static str,
}

/// What two entries of a kind are both about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Overlap {
    /// The same thing.
    Whole,
    /// The same thing on one side.
    On(Side),
}

impl Overlap {
    /// On the first side that `both` says they are about.
    pub fn sides(both: impl Fn(Side) -> bool) -> Option<Self> {
        Side::ALL.into_iter().find(|&side| both(side)).map(Self::On)
    }
}

/// What an imperfection is told of the loop that it is made for.
#[derive(Clone, Debug)]
pub(crate) struct Setup {
    /// How many joints the robot has.
    pub joints: usize,
    /// Control period \[s\].
    pub period: f64,
    /// Random numbers that nobody else draws from.
    pub random: Random,
}
