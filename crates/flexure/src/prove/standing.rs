//! What a proof is worth for the loop in the file.

use crate::files::Problem;
use serde::Serialize;

use crate::prove::question::Proof;
use crate::sampled::Sampled;
use crate::scenario::Scenario;

/// What is to be said of a scenario after a proof about its law in continuous time.
#[derive(Clone, Debug)]
pub enum Standing<'a> {
    /// Everything that was asked is proved, and nothing is left out but what the file's assumptions list.
    Proved,
    /// It is proved, and of the loop in the file, as sampled, that motions near its run stay there and come closer.
    Near,
    /// It is proved of the ideal loop; the one in the file has these too.
    Ideal(Vec<&'static str>),
    /// The loop that holds its torque for a control period is unstable, whatever is proved in continuous time.
    Unstable {
        /// That loop.
        sampled: &'a Sampled,
        /// Whether everything that was asked is proved in continuous time.
        proved: bool,
    },
    /// It is wrong.
    Refuted(Problem),
    /// It was not found.
    Undecided(Problem),
}

impl<'a> Standing<'a> {
    /// Of `proof` for `scenario`, whose sampled loop is `sampled`.
    pub fn of(scenario: &Scenario, proof: &Proof, sampled: Option<&'a Sampled>) -> Self {
        match (proof.complaint(scenario), sampled.filter(|sampled| !sampled.stable)) {
            (Some((problem, true)), _) => Self::Refuted(problem),
            (open, Some(sampled)) => {
                let of_law = Proof { sampled_tube: None, ..proof.clone() };
                let proved = open.is_none() || of_law.complaint(scenario).is_none();
                Self::Unstable { sampled, proved }
            }
            (Some((problem, false)), None) => Self::Undecided(problem),
            (None, None) if matches!(proof.sampled_tube, Some(Ok(_))) => Self::Near,
            (None, None) => match scenario.beyond_ideal() {
                nothing if nothing.is_empty() => Self::Proved,
                conditions => Self::Ideal(conditions),
            },
        }
    }

    /// In a few words: the `verdict` of `certify --json`.
    pub fn words(&self) -> &'static str {
        match self {
            Self::Proved => "proved",
            Self::Near => "proved (sampled loop, near its run)",
            Self::Ideal(_) => "proved (ideal loop)",
            Self::Unstable { proved: true, .. } => "proved for continuous time; unstable as sampled",
            Self::Unstable { proved: false, .. } => "undecided for continuous time; unstable as sampled",
            Self::Refuted(_) => "refuted",
            Self::Undecided(_) => "undecided",
        }
    }
}

/// A step of the ladder of docs/proofs.md: each is about a loop that is nearer to the one that runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Step {
    /// The law in continuous time, on exact states of the robot in the file, without limits.
    Ideal,
    /// The same under unknown torques, or of every robot within the tolerances.
    Robust,
    /// The same, with limits of torques, speeds and deflections none of which acts.
    Limited,
    /// The loop in the file: control period, delay, encoders, filters, guard and limits.
    Sampled,
}

impl Step {
    /// The highest that `proof` of `scenario` has reached; none where not even the first is proved.
    pub fn of(scenario: &Scenario, proof: &Proof) -> Option<Self> {
        if matches!(proof.sampled_tube, Some(Ok(_))) {
            return Some(Self::Sampled);
        }
        let certificate = proof.verdict.proved()?;
        let robust = proof.robust.as_ref().and_then(|found| found.as_ref().ok());
        // The tube of W under a disturbance is of the numbers of the file.
        let in_tube = certificate.tube.is_some() && scenario.robot.tolerances.are_none();
        let is_robust = robust.is_some() || matches!(proof.within, Some(Ok(_))) || in_tube;
        Some(match robust {
            Some(robust) if robust.keeps_limits() => Self::Limited,
            _ if is_robust => Self::Robust,
            _ => Self::Ideal,
        })
    }

    /// Its name, and what it is about.
    pub fn words(self) -> &'static str {
        match self {
            Self::Ideal => {
                "ideal: the law in continuous time, on exact states of the robot in the file, without limits"
            }
            Self::Robust => {
                "robust: the law in continuous time, on exact states, without limits, under the torques that were named and of every robot within the tolerances"
            }
            Self::Limited => {
                "limited: the law in continuous time, on exact states, under these torques and of every robot within the tolerances, with the robot's limits, none of which acts"
            }
            Self::Sampled => {
                "sampled: the loop in the file, its numbers as they are, with its control period and all devices, near its run"
            }
        }
    }
}

/// What a loop has that a proof of its law does not speak of, in words; nothing if it has nothing such. What has it are the
/// `conditions` of [`Standing::Ideal`].
pub fn outside_of_proofs(conditions: &[&str]) -> Option<String> {
    (!conditions.is_empty()).then(|| {
        format!(
            "proofs are of the ideal loop (true states, no delay, torque in continuous time); outside of them stand, in this \
             scenario: {}",
            conditions.join(", ").replace('_', " ")
        )
    })
}

/// Whether a certificate of the law in continuous time is about the loop of `scenario`: nothing stands between them, and the
/// sampled loop is stable.
pub fn is_about(scenario: &Scenario, sampled: Option<&Sampled>) -> bool {
    scenario.beyond_ideal().is_empty() && sampled.is_none_or(|sampled| sampled.stable)
}
