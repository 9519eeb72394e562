//! What comes of checking: the claims that hold, or why not.

use std::fmt;

use serde::Serialize;

/// A claim that was checked.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// Path in the certificate, like `blocks.phi_l`.
    pub name: String,
    /// The claimed value, as the file writes it.
    pub value: String,
}

impl Claim {
    pub(super) fn new(name: impl Into<String>, value: impl Into<String>) -> Self {
        Self { name: name.into(), value: value.into() }
    }
}

/// A certificate whose claims all hold.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckReport {
    /// The scenario it is about, as the file says.
    pub name: String,
    /// What the file says that it is about: who made it, hashes of files, numbers of the robot, gains. Nothing of it is
    /// checked here; the claims are claims about these numbers.
    pub about: Vec<Claim>,
    /// What the file says was assumed. Not checked.
    pub assumptions: Vec<String>,
    /// Every claim, in the order of checking.
    pub claims: Vec<Claim>,
    /// Decay rate of √W between any two motions, in 1/s, as the file writes it; none where the metric depends on the error.
    pub contraction_rate: Option<String>,
    /// Decay rate of √W of the error, in 1/s, as the file writes it.
    pub convergence_rate: String,
}

/// Why a text is not a certificate whose claims hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Rejected {
    /// The text is no certificate.
    Malformed {
        /// Path in the certificate, like `robot.stiffness[1]`.
        place: String,
        /// Reason why it is no certificate.
        reason: String,
        /// Line, from 1, where the text is no JSON.
        line: Option<usize>,
        /// Column, from 1, where the text is no JSON.
        column: Option<usize>,
    },
    /// The text is a certificate, but a claim of it does not hold, or cannot be seen to.
    False {
        /// The claim: a path like `blocks.phi_l`.
        claim: String,
        /// What is claimed against what was found.
        reason: String,
    },
}

impl Rejected {
    /// A claim does not hold.
    pub(super) fn claim(claim: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::False { claim: claim.into(), reason: reason.into() }
    }
}

impl fmt::Display for Rejected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Malformed { place, reason, .. } => write!(f, "not a certificate: {place}: {reason}"),
            Self::False { claim, reason } => write!(f, "{claim} does not hold: {reason}"),
        }
    }
}

impl std::error::Error for Rejected {}

/// The claim holds, or this is the reason why not.
pub(super) fn ensure(
    holds: bool,
    claim: impl Into<String>,
    reason: impl FnOnce() -> String,
) -> Result<(), Rejected> {
    if holds { Ok(()) } else { Err(Rejected::claim(claim, reason())) }
}
