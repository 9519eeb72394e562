//! A certified rate once more, by the engine that knows nothing of how it was found.

use crate::files::Problems;
use crate::progress::Progress;
use crate::prove::closed_loop::over_region;
use crate::prove::engine::certificate::Certificate;
use crate::prove::engine::direct::{DirectWitness, Proved, prove_watched};
use crate::prove::engine::verdict::{Undecided, Verdict};
use crate::prove::question::Direct;
use crate::scenario::Scenario;

/// What is left of a certified rate for the direct engine to prove: the certificate's last digits are those of its own
/// rounding.
const SHARE: f64 = 1.0 - 1e-9;

/// What there is to say of a loop without a contraction rate.
const NO_RATE: &str = "no contraction rate of this loop holds at every speed";

/// What the direct engine says of a certified rate.
pub type Confirmation = Verdict<Proved, DirectWitness>;

/// Proves the contraction rate of `certificate` again, on its region, from the full inequality, looking at no more than
/// `direct.budget` boxes. What `progress` breaks off is undecided.
///
/// # Errors
/// If the robot has too many joints, or the law is not v-CBC.
pub fn confirm(
    scenario: &Scenario,
    certificate: &Certificate,
    direct: Direct,
    progress: Progress<'_>,
) -> Result<Confirmation, Problems> {
    let Some(rate) = &certificate.contraction_rate else {
        return Ok(Verdict::Undecided(Undecided { at: NO_RATE.to_owned(), spent: 0 }));
    };
    let rate = rate.bounds().lo() * SHARE;
    Ok(prove_watched(&*over_region(scenario, certificate)?, rate, direct.budget, progress))
}
