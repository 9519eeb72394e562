//! What comes of an attempt to prove something.

use std::fmt::Debug;

use serde::Serialize;

/// The outcome of an attempt to prove a claim: never a bool.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict<P, W> {
    /// The claim holds: what was proved.
    Proved(P),
    /// It does not: a place where plain `f64` arithmetic sees it fail.
    Refuted(W),
    /// Neither was shown within the budget.
    Undecided(Undecided),
}

/// Where an attempt stopped, and what it had cost by then.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Undecided {
    /// The place that could not be decided, or the reason, in words with numbers.
    pub at: String,
    /// Boxes looked at before it stopped.
    pub spent: usize,
}

impl<P, W> Verdict<P, W> {
    /// What was proved, if anything was.
    pub fn proved(&self) -> Option<&P> {
        match self {
            Self::Proved(proved) => Some(proved),
            _ => None,
        }
    }

    /// The verdict in a word.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Proved(_) => "proved",
            Self::Refuted(_) => "refuted",
            Self::Undecided(_) => "undecided",
        }
    }
}
