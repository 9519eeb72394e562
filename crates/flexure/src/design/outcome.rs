//! A tuned loop with everything that speaks for it.

use std::fmt::Display;

use serde::Serialize;

use crate::design::bench::Bench;
use crate::design::constraint::{Constraint, FOLLOWS, Kind, NOMINAL};
use crate::design::family::{Family, Pace};
use crate::design::judged::Judged;
use crate::design::least::Least;
use crate::design::search::{Found, Search, work};
use crate::design::spec::{Rate, SpecFile};
use crate::design::specified::{Specified, TUNED};
use crate::design::trade::{Trade, trades, untraded};
use crate::design::tube::Tube;
use crate::design::watch::{Effort, Watch, side_by_side};
use crate::files::number::{rounded_down, short};
use crate::files::{Problem, Problems};
use crate::imperfections::Imperfection;
use crate::laws::{Controller, drives};
use crate::margins::{Margins, margins};
use crate::progress::Progress;
use crate::prove::sampled_data::suitable_when_sampled;
use crate::prove::standing::Standing;
use crate::sampled::{Sampled, probe};
use crate::scenario::Scenario;
use crate::simulate::{Measure, Summary};

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
    /// Whether it was broken off, and this is the best so far.
    #[serde(skip)]
    pub broken_off: bool,
}

/// What a loop does with its gains.
#[derive(Clone, Debug, Serialize)]
pub struct Evidence {
    /// The run under each reference; none of a loop that is unstable as sampled.
    pub runs: Vec<Summary>,
    /// The sampled loop under the first reference; none where the search was broken off.
    pub sampled: Option<Sampled>,
    /// The contraction rate of the ideal loop that is proved [1/s]; none if none is.
    pub rate_certified: Option<f64>,
    /// What that is worth for the loop in the file, in words; none for laws other than v-CBC.
    pub verdict: Option<&'static str>,
    /// What is proved of the sampled loop; none where a rate of it is not asked for, or not proved.
    pub tube: Option<Tube>,
    /// What the loop bears; none where the search was broken off or the loop does not follow.
    pub margins: Option<Margins>,
}

/// What can be had where the wishes cannot.
#[derive(Clone, Debug, Serialize)]
pub struct Feasible {
    /// The largest rate that was found to go with everything else [1/s]; none if none was.
    pub rate: Option<f64>,
}

/// What is proved is rounded outward: gains are for a rate that is larger by this part than the one that is asked.
const OUTWARD: f64 = 1e-6;

/// Runs that margins take about.
const MARGINS: usize = 75;

/// Tunes the gains of the scenario in `specified` to what `file` asks, with at most `budget` runs in the search. What `progress`
/// breaks off has the best so far.
///
/// # Errors
/// As [`run`](crate::simulate::run), for a rate that is asked of a law without proofs, and [`Problems::interrupted`] if it was broken
/// off before anything was tried.
pub fn design(
    specified: &Specified,
    file: &SpecFile,
    budget: usize,
    seed: u64,
    progress: Progress<'_>,
) -> Result<Design, Problems> {
    let scenario = &specified.scenarios[0];
    let start = scenario.under(&scenario.controller.restart(&scenario.robot)?);
    let spec = &file.spec;
    file.refuse_rates(&start, &specified.scenarios)?;
    let least = if spec.rate.is_some() { Least::of(&start)? } else { None };
    let family = Family::new(start.controller, least, &drives(&scenario.robot)?);
    let bench = Bench::new(&specified.scenarios, &file.spec)?;
    let outlooks = bench.outlooks()?;
    // Where each part of the work ends, in runs.
    let effort = Effort::of(scenario);
    let searched = work(&family, effort, budget);
    let tubes = spec.sampled_rate.map_or(0.0, |_| effort.tube * specified.scenarios.len() as f64);
    let proved = searched + tubes;
    let borne = proved + side_by_side(bench.corners());
    let traded = borne + effort.trial * side_by_side(scenario.controller.gains().len());
    let all = traded + side_by_side(MARGINS) / specified.scenarios.len() as f64;
    let watch = Watch::new(progress, all);
    let pace = match file.spec.rate {
        None => Pace::Free,
        Some(Rate::AtLeast(rate)) => Pace::AtLeast(rate * (1.0 + OUTWARD)),
        Some(Rate::Largest) => Pace::Proved,
    };
    let search =
        |pace| Search { bench: &bench, outlooks: &outlooks, family: &family, pace, watch: &watch, effort };
    // Gains of the file take part, where nothing is asked that they may not know of.
    let takes_part = pace == Pace::Free && !scenario.has_starting_gains();
    let own: Vec<Controller> = takes_part.then(|| scenario.controller.clone()).into_iter().collect();
    let asked = match file.spec.rate {
        Some(Rate::AtLeast(asked)) => Some(asked),
        _ => None,
    };
    let judged = |found: Found| {
        let proving = |fraction: f64| {
            watch.reach(searched + tubes * fraction);
            watch.go_on()
        };
        let runs = found.runs;
        Ok::<_, Problems>((Judged::chosen(found, &bench, asked, &watch, &proving)?, runs))
    };
    let (mut chosen, mut runs) = judged(search(pace).run(&own, budget, seed)?)?;
    watch.reach(proved);
    let mut instead = None;
    if let (Some(asked), false, false) = (asked, chosen.keeps(), chosen.broken_off) {
        // This search does not know the rate that is asked: who asks for what it finds gets the same gains.
        let other = search(Pace::Proved).run(&[], budget.div_ceil(2), seed).and_then(judged);
        match unless_interrupted(other)? {
            Some((other, more)) if other.keeps() => (chosen, runs) = (other, runs + more),
            Some((other, more)) => {
                runs += more;
                chosen.broken_off |= other.broken_off;
                let feasible = other.keeps_the_rest() && !other.broken_off;
                instead = Some(Feasible { rate: other.rate().filter(|rate| feasible && *rate < asked) });
            }
            None => chosen.broken_off = true,
        }
    }
    watch.reach(borne);
    let feasible = chosen.keeps();
    let rate = chosen.rate();
    let Judged { trial: best, tuned, proof, tube, constraints, mut broken_off } = chosen;
    // What was broken off comes back at once.
    let sampled = if broken_off { None } else { probe(&tuned)? };
    let verdict = proof.as_ref().map(|proof| Standing::of(&tuned, proof, sampled.as_ref()).words());
    let gains = if broken_off {
        untraded(&best.controller)
    } else {
        trades(&bench, &outlooks, &best, &watch, effort)?
    };
    watch.reach(traded);
    let margins = if feasible && !broken_off {
        let measured = |fraction: f64| {
            watch.reach(traded + (all - traded) * fraction);
            watch.go_on()
        };
        let found = unless_interrupted(margins(&tuned, &measured))?;
        broken_off |= found.as_ref().is_none_or(|found| found.broken_off);
        found
    } else {
        None
    };
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
            tube,
            margins,
        },
        controller: best.controller,
        instead,
        runs,
        broken_off,
    })
}

/// What was found; none if it was broken off.
fn unless_interrupted<T>(found: Result<T, Problems>) -> Result<Option<T>, Problems> {
    match found {
        Err(problems) if problems.is_interrupted() => Ok(None),
        found => found.map(Some),
    }
}

impl SpecFile {
    /// # Errors
    /// If a rate is asked that cannot be proved of such a law, that of `start`, or of such a loop as one of `scenarios`.
    fn refuse_rates(&self, start: &Scenario, scenarios: &[Scenario]) -> Result<(), Problem> {
        if self.spec.rate.is_some() {
            start.vcbc().map_err(|problem| self.refused("rate", &problem))?;
        }
        for scenario in scenarios.iter().filter(|_| self.spec.sampled_rate.is_some()) {
            let problems = suitable_when_sampled(scenario).err();
            if let Some(problem) = problems.as_ref().and_then(|problems| problems.iter().next()) {
                return Err(self.refused("sampled_rate", problem));
            }
        }
        Ok(())
    }

    /// What to say where what is asked at `key` is a rate that cannot be proved, for the reason `why`.
    fn refused(&self, key: &str, why: &dyn Display) -> Problem {
        let message = format!("{key} is asked for: {why}");
        let help = format!("leave {key} out: the loop is then tuned to track well inside all limits");
        self.problem(key, "unsupported", message, help)
    }
}

/// What is quicker besides a shorter delay.
const BESIDES: &str = "a shorter control_period, a faster velocity filter or an observer";

/// Part of the size of the reference that is no error any more.
const HALF: f64 = 0.5;

impl Design {
    /// What a scenario file with these gains says of them in its first lines.
    pub fn comment(&self) -> String {
        let rms = self.evidence.runs.iter().map(|run| run.rms_e_l).fold(0.0, f64::max);
        let rate = self.evidence.rate_certified.map_or_else(String::new, |rate| {
            format!(" Of the ideal loop a contraction rate of {} 1/s is proved.", short(rate, 4))
        });
        let tube = self
            .evidence
            .tube
            .map_or_else(String::new, |tube| format!(" Of the sampled loop {} is proved.", tube.words()));
        let passing = self.evidence.sampled.as_ref().filter(|sampled| sampled.passes());
        format!(
            "{}{}: rms error {} mrad, {} kept.{rate}{tube}{}\n\
             Gains follow from the robot, the reference and the imperfections below: tune again if they change.",
            TUNED,
            if self.broken_off { ", broken off" } else { "" },
            short(1e3 * rms, 3),
            if self.frail().is_some() { "what is asked is" } else { "every constraint is" },
            passing.map_or_else(String::new, |sampled| {
                format!(
                    " Small errors shrink on the whole way; a robot that stood still {} would not be stable.",
                    sampled.at()
                )
            }),
        )
    }

    /// What is to be said if not every constraint is kept.
    pub fn objection(&self, scenario: &Scenario, file: &SpecFile) -> Option<Problem> {
        let binding = self.binding()?;
        let Constraint { what, value, limit, unit, note, .. } = binding;
        let joint = binding.joint.as_ref().map_or_else(String::new, |joint| format!(" in joint {joint}"));
        let said = note.as_ref().map_or_else(
            || {
                let amount = |x: f64| format!("{} {unit}", short(x, 5)).trim_end().to_owned();
                format!("{} where {} is the limit", amount(*value), amount(*limit))
            },
            Clone::clone,
        );
        let message = format!(
            "{}: no gains were found that keep every constraint; what is broken most is: {what}{joint}: {said}",
            self.name
        );
        let help = self.way_out(scenario, file).unwrap_or_default();
        Some(scenario.places.problem("controller", "infeasible", message, help))
    }

    /// What is wished for and not borne, in words: the loop is frail there.
    pub fn frail(&self) -> Option<String> {
        let frail = self.constraints.iter().filter(|constraint| !constraint.asked && !constraint.is_kept());
        let mut words: Vec<&str> =
            frail.map(|constraint| constraint.what.trim_start_matches(FOLLOWS)).collect();
        words.sort_unstable();
        words.dedup();
        (!words.is_empty()).then(|| words.join(", "))
    }

    /// The constraint that is broken most of those that are asked; none if all are kept.
    pub fn binding(&self) -> Option<&Constraint> {
        let broken = self.constraints.iter().filter(|constraint| constraint.asked && !constraint.is_kept());
        broken.min_by(|a, b| a.slack.total_cmp(&b.slack))
    }

    /// Whether the loop does not follow at all, so that nobody would accept what it does: an error as large as half of the
    /// motion that is asked for.
    fn is_lost(&self) -> bool {
        let sizes = self.evidence.runs.iter().flat_map(|run| &run.following.size);
        let size = sizes.copied().fold(0.0, f64::max);
        let error = self.constraints.iter().find(|constraint| constraint.kind == Kind::Run(Measure::Error));
        error.is_some_and(|error| !error.is_kept() && error.value >= HALF * size)
    }

    /// What would have to change in `scenario` or `file` for that constraint to be kept.
    fn way_out(&self, scenario: &Scenario, file: &SpecFile) -> Option<String> {
        let binding = self.binding()?;
        let Constraint { what, value, limit, unit, .. } = binding;
        let joint = binding.joint.as_ref().map_or_else(String::new, |joint| format!(" of joint {joint}"));
        let amount = |x: f64| format!("{} {unit}", short(x, 4)).trim_end().to_owned();
        let slower = match self.instead {
            Some(Feasible { rate: Some(rate) }) => {
                format!("rate = {} is feasible; or ", rounded_down(rate, 3))
            }
            Some(Feasible { rate: None }) => "no lower rate was found to be enough; what may be: ".to_owned(),
            None => String::new(),
        };
        let way = match binding.kind {
            Kind::Radius | Kind::Whole => {
                let less = match binding.kind {
                    Kind::Whole => "; or a slower reference",
                    _ if what == NOMINAL => "",
                    _ => "; or a SPEC that asks for less margin and uncertainty",
                };
                format!("{}{less}", quicker(scenario, file))
            }
            Kind::Stopped => "a slower reference, or limits of [guard] that are farther off".to_owned(),
            Kind::Run(_) if self.is_lost() => format!(
                "the loop does not follow at all with any gains that were tried, so that no limit can be named: {}; or a slower \
                 reference",
                quicker(scenario, file)
            ),
            Kind::Run(Measure::AtLimit) => {
                "drives with larger torque limits, a slower reference ([reference.time_scaling] margin), or accept.at_limit above 0".to_owned()
            }
            Kind::Run(measure) => format!(
                "a {}{joint} of {} would have to be accepted, where {} are: by accept.{}{}; or a slower reference",
                what,
                amount(*value),
                amount(*limit),
                measure.key(),
                if measure == Measure::Error { "" } else { " or the limit in the robot file" }
            ),
            Kind::Lost => "a SPEC that asks for less uncertainty and margin, or accept.error above what it leaves".to_owned(),
            Kind::Rate => "a lower rate".to_owned(),
            Kind::SampledRate => {
                "a lower sampled_rate; or what leaves tubes more room: finer encoders, a slower reference, larger limits of torques and their rates, less delay, a shorter control_period".to_owned()
            }
        };
        Some(format!("{slower}{way}"))
    }
}

/// What lets more gains be stable: a shorter delay, if the loop has one, with where it stands; and what is quicker besides.
fn quicker(scenario: &Scenario, file: &SpecFile) -> String {
    let delays = |imperfection: &Imperfection| imperfection.kind() == "delay";
    let place = match scenario.imperfections.iter().any(delays) {
        true if file.spec.delay.is_some() => "delay of the SPEC",
        true if file.has_delay() => "[[imperfection]] delay of the SPEC",
        true => "[[imperfection]] delay",
        false => return BESIDES.to_owned(),
    };
    format!(
        "less delay ({place}, a time of its own: a shorter control_period alone leaves it), with that {BESIDES}"
    )
}
