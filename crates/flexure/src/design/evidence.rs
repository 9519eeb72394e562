//! A tuned loop with everything that speaks for it.

use serde::Serialize;

use crate::design::bench::Bench;
use crate::design::constraint::{Constraint, Kind};
use crate::design::family::{Family, Pace};
use crate::design::least::Least;
use crate::design::spec::{Rate, SpecFile};
use crate::design::specified::Specified;
use crate::design::trade::{Trade, trades};
use crate::design::{Found, Search};
use crate::files::{Problem, Problems};
use crate::laws::{Controller, drives};
use crate::margins::{Margins, margins};
use crate::progress::{Progress, unwatched};
use crate::prove::question::Proof;
use crate::prove::question::{Question, prove};
use crate::prove::standing::Standing;
use crate::sampled::{Sampled, probe};
use crate::scenario::Scenario;
use crate::simulate::Summary;

/// Gains that were tuned for a specification, and what speaks for them.
#[derive(Clone, Debug, Serialize)]
pub struct Design {
    /// Name of the scenario.
    pub name: String,
    /// Whether every constraint is kept.
    pub feasible: bool,
    /// The law with the gains that were found.
    #[serde(skip)]
    pub controller: Controller,
    /// What they were held to, with what is left of each limit.
    pub constraints: Vec<Constraint>,
    /// What each gain trades.
    pub gains: Vec<Trade>,
    /// What the loop does with them.
    pub evidence: Evidence,
    /// Where the wishes cannot be met: what can.
    pub instead: Option<Feasible>,
    /// Loops that were run in the search.
    pub runs: usize,
    /// Whether the search was broken off, and this is the best so far.
    pub interrupted: bool,
}

/// What a loop does with its gains.
#[derive(Clone, Debug, Serialize)]
pub struct Evidence {
    /// The run under each reference; none of a loop that is unstable as sampled.
    pub runs: Vec<Summary>,
    /// The sampled loop under the first reference.
    pub sampled: Option<Sampled>,
    /// The contraction rate of the ideal loop that is proved [1/s]; none if none is.
    pub rate_certified: Option<f64>,
    /// What that is worth for the loop in the file, in words; none for laws other than v-CBC.
    pub verdict: Option<&'static str>,
    /// What the loop bears; none where the search was broken off or the loop does not follow.
    pub margins: Option<Margins>,
}

/// What can be had where the wishes cannot.
#[derive(Clone, Debug, Serialize)]
pub struct Feasible {
    /// The largest rate that was found to go with everything else [1/s]; none if none was.
    pub rate: Option<f64>,
}

/// Parts of the work: the search, the search for a rate that is feasible, the margins.
const SEARCH: f64 = 0.7;

/// Tunes the gains of the scenario in `specified` to what `file` asks, with at most `budget` runs in the search.
///
/// # Errors
/// As [`run`](crate::simulate::run); and for a rate that is asked of a law without proofs.
pub fn design(
    specified: &Specified,
    file: &SpecFile,
    budget: usize,
    seed: u64,
    progress: Progress<'_>,
) -> Result<Design, Problems> {
    let scenario = &specified.scenarios[0];
    let base = base(scenario)?;
    let start = scenario.under(&base);
    if file.spec.rate.is_some() {
        file.refuse_rate_of(&start)?;
    }
    let least = if file.spec.rate.is_some() { Least::of(&start)? } else { None };
    let family = Family::new(base, least, &drives(&scenario.robot)?);
    let bench = Bench::new(&specified.scenarios, &file.spec)?;
    let outlooks = bench.outlooks()?;
    let pace = match file.spec.rate {
        None => Pace::Free,
        Some(Rate::AtLeast(rate)) => Pace::AtLeast(rate),
        Some(Rate::Largest) => Pace::Proved,
    };
    let search = Search { bench: &bench, outlooks: &outlooks, family: &family, pace };
    // Gains of the file take part, where nothing is asked that they may not know of.
    let own = (pace == Pace::Free && !scenario.has_starting_gains()).then(|| scenario.controller.clone());
    let own: Vec<Controller> = own.into_iter().collect();
    let Found { best, mut runs, mut interrupted } =
        search.run(&own, budget, seed, &|fraction| progress(SEARCH * fraction))?;
    let mut constraints = best.constraints.clone();
    if best.keeps() && !interrupted {
        constraints.extend(bench.lost_at(&best.controller)?);
    }
    let loops = bench.loops(&best.controller);
    let proof = proof(&loops[0]);
    let rate = proof.as_ref().and_then(|proof| Some(proof.verdict.proved()?.contraction_rate.approximate()));
    if let Some(Rate::AtLeast(asked)) = file.spec.rate {
        constraints.push(Constraint::rate(rate.unwrap_or(0.0), asked));
    }
    let feasible = best.keeps() && constraints.iter().all(Constraint::is_kept);
    let mut instead = None;
    if let (false, false, Some(Rate::AtLeast(_))) = (feasible, interrupted, file.spec.rate) {
        let search = Search { pace: Pace::Proved, ..search };
        let found =
            search.run(&[], budget.div_ceil(2), seed, &|fraction| progress(SEARCH + 0.2 * fraction))?;
        runs += found.runs;
        interrupted |= found.interrupted;
        let rate = found.best.keeps().then(|| found.best.cost).map(|cost| (-cost).exp());
        instead = Some(Feasible { rate });
    }
    let sampled = probe(&loops[0])?;
    let verdict = proof.as_ref().map(|proof| Standing::of(&loops[0], proof, sampled.as_ref()).words());
    let gains = trades(&bench, &outlooks, &best)?;
    let done = feasible && !interrupted && progress(0.9).is_continue();
    let margins = if done { Some(margins(&loops[0], &unwatched)?) } else { None };
    Ok(Design {
        name: scenario.name.clone(),
        feasible,
        constraints,
        gains,
        evidence: Evidence {
            runs: best.runs.iter().map(|run| run.summary.clone()).collect(),
            sampled,
            rate_certified: rate,
            verdict,
            margins,
        },
        controller: best.controller,
        instead,
        runs,
        interrupted,
    })
}

/// The law of `scenario` with its starting gains.
fn base(scenario: &Scenario) -> Result<Controller, Problems> {
    let own = &scenario.controller;
    Ok(match (Controller::default_for(own.kind(), &scenario.robot)?, own) {
        (Controller::Vcbc(start), Controller::Vcbc(gains)) => {
            Controller::Vcbc(Box::new(start.as_ref().clone().shaped_by(gains.phi)))
        }
        (start, _) => start,
    })
}

/// What is proved of the loop in continuous time; none where nothing can be.
fn proof(scenario: &Scenario) -> Option<Proof> {
    prove(scenario, &Question::default()).ok()
}

impl SpecFile {
    /// # Errors
    /// If a rate is asked of a law of which none can be proved.
    fn refuse_rate_of(&self, scenario: &Scenario) -> Result<(), Problem> {
        let refused = scenario.vcbc().err();
        refused.map_or(Ok(()), |problem| {
            let message = format!("rate is asked for: {problem}");
            let help = "leave rate out: the loop is then tuned to track well inside all limits";
            Err(self.problem("rate", "unsupported", message, help))
        })
    }
}

impl Design {
    /// The constraint that is broken most; none if all are kept.
    pub fn binding(&self) -> Option<&Constraint> {
        let broken = self.constraints.iter().filter(|constraint| !constraint.is_kept());
        broken.min_by(|a, b| a.slack.total_cmp(&b.slack))
    }

    /// What would have to change for that constraint to be kept.
    pub fn way_out(&self) -> Option<String> {
        let binding = self.binding()?;
        let joint = binding.joint.as_deref().unwrap_or_default();
        let way = match binding.kind {
            Kind::Radius => {
                "a shorter control_period, less delay or a faster filter; or ask for less margin and uncertainty in the SPEC"
            }
            Kind::Run(_) | Kind::Lost | Kind::Rate => "",
        };
        Some(if way.is_empty() {
            format!("{joint} would need {} of {} {}", binding.what, binding.value, binding.unit)
        } else {
            way.to_owned()
        })
    }
}
