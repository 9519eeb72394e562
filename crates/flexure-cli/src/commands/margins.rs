//! `flexure margins`: how much a loop bears.

use std::path::PathBuf;

use flexure::compare::{Entrant, check_budget, entrants};
use flexure::files::number::{engineering, rounded_down, short, significant};
use flexure::files::{Problems, Reading};
use flexure::margins::{Margins as Found, ProvedDelay, check_tube, margins as margins_of};
use flexure::progress::{PartProgress, Progress as Progressing};
use flexure::report::{margins_table, write_margins};
use flexure::scenario::{Scenario, load_scenario_with};
use flexure::tune::tune;
use flexure::units;
use serde::Serialize;

use super::print;
use crate::args::Margins;
use crate::failure::{Failure, say};
use crate::progress::Progress;

/// Runs that the margins of a loop take about: what a search for gains is weighed against.
const RUNS: f64 = 60.0;

/// The loops that were measured.
#[derive(Serialize)]
struct Outcome {
    loops: Vec<Found>,
    /// Their page and figures; not there without `--page`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pages: Vec<PathBuf>,
}

pub fn margins(options: &Margins, reading: Reading<'_>, json: bool) -> Result<(), Failure> {
    check_budget(options.budget)?;
    let chosen = if options.controllers.is_empty() { Vec::new() } else { entrants(&options.controllers)? };
    let scenario = load_scenario_with(&options.scenario, reading)?;
    say(&scenario.warnings);
    if let Some(error) = &options.sampled_tube {
        if chosen.is_empty() {
            check_tube(&scenario, error)?;
        }
        for entrant in &chosen {
            let mut scenario = scenario.clone();
            scenario.controller = entrant.controller(&scenario.robot)?;
            check_tube(&scenario, error)?;
        }
    }
    options.paged.prepare(&scenario.name, "margins", chosen.len().max(1), &[""; 0])?;
    let (loops, is_whole) = {
        let each = [options.budget as f64, RUNS];
        let weights = if chosen.is_empty() { vec![RUNS, RUNS] } else { each.repeat(chosen.len()) };
        let progress = Progress::new(&scenario.name, weights);
        measured(&scenario, &chosen, options, &|part, fraction| progress.set(part, fraction))?
    };
    let pages = match &options.paged.page {
        Some(folder) if is_whole => write_margins(folder, &scenario, &loops)?,
        _ => Vec::new(),
    };
    let words = "broken off: as far as ≥ and ≤ say the loop was seen to hold";
    if json {
        print::json(&Outcome { loops: loops.clone(), pages })?;
    } else {
        if !is_whole {
            print::line(words)?;
        }
        print::line(&margins_table(&loops, print::columns()))?;
        loops.iter().try_for_each(show)?;
        print::wrote(&pages)?;
    }
    if !is_whole {
        let hint = options.paged.broken_off("what is not there was not measured");
        return Err(Failure::interrupted(words.to_owned(), &hint));
    }
    let objections: Vec<_> = loops.iter().filter_map(|found| found.objection(&scenario)).collect();
    if objections.is_empty() {
        return Ok(());
    }
    Err(Failure::No(objections.into_iter().map(Into::into).collect()))
}

/// With which delay there is a tube.
fn proved(found: &ProvedDelay, loop_: &Found) -> String {
    let reach = engineering(found.error.iter().copied().fold(0.0, f64::max));
    let tube = format!(
        "a tube of the sampled loop, links up to {reach} {} from its run",
        loop_.unit(units::ANGLE, "")
    );
    let why = found.at.as_ref().map_or_else(String::new, |at| format!("; with the next larger one: {at}"));
    match (found.holds, found.rate) {
        (Some(holds), Some(rate)) => {
            let part = found.part.map_or_else(String::new, |part| {
                format!(", {} % of what it bears in simulation", short(rounded_down(100.0 * part, 3), 3))
            });
            format!(
                "{tube}, is proved with {} ms of delay more, the largest of {} that were tried{part}; at {} 1/s there{why}",
                short(1e3 * holds, 4),
                found.tried,
                significant(rounded_down(rate, 4), 4)
            )
        }
        _ => format!("{tube}, was not found: {}", found.at.as_deref().unwrap_or_default()),
    }
}

/// What the table does not say.
fn show(found: &Found) -> Result<(), Failure> {
    if let Some(delay) = &found.delay_proved {
        print::line(&proved(delay, found))?;
    }
    let torque = found.unit(units::TORQUE, "");
    print::line(&format!(
        "{} holds: it follows, with an rms error of at most {} {} and torques of at most {} {torque}\n\
         that change by at most {} {torque} (rms) a control period; {} runs of {} s",
        found.law(),
        significant(1e3 * found.allowed_rms_e_l, 3),
        found.unit(units::ANGLE, "m"),
        significant(found.allowed_max_u_m, 3),
        significant(found.allowed_rms_torque_change, 3),
        found.runs,
        short(found.duration, 4)
    ))?;
    found.sampled.as_ref().map_or(Ok(()), |sampled| print::line(&sampled.line()))
}

/// The margins of the scenario's loop, or of those of `chosen`, and whether that is all of them; of what was broken off the loops
/// that were measured.
fn measured(
    scenario: &Scenario,
    chosen: &[Entrant],
    options: &Margins,
    progress: PartProgress<'_>,
) -> Result<(Vec<Found>, bool), Problems> {
    if chosen.is_empty() {
        let mut found = margins_of(scenario, &|fraction| progress(0, fraction))?;
        if let Some(error) = &options.sampled_tube {
            found.prove_delay(scenario, error, &|fraction| progress(1, fraction))?;
        }
        let is_whole = !found.broken_off;
        return Ok((vec![found], is_whole));
    }
    let mut loops = Vec::new();
    for (i, entrant) in chosen.iter().enumerate() {
        let found =
            tuned(scenario, *entrant, options, &|fraction| progress(2 * i, fraction)).and_then(|scenario| {
                let told = |fraction| progress(2 * i + 1, fraction);
                let mut found = margins_of(&scenario, &told)?;
                if let Some(error) = &options.sampled_tube {
                    found.prove_delay(&scenario, error, &told)?;
                }
                Ok(found)
            });
        match found {
            Err(problems) if problems.is_interrupted() && !loops.is_empty() => return Ok((loops, false)),
            found => loops.push(found?),
        }
        if loops.last().is_some_and(|found| found.broken_off) {
            return Ok((loops, false));
        }
    }
    Ok((loops, true))
}

/// The scenario under another law, with the gains that the search finds.
fn tuned(
    scenario: &Scenario,
    entrant: Entrant,
    options: &Margins,
    progress: Progressing<'_>,
) -> Result<Scenario, Problems> {
    let mut scenario = scenario.clone();
    scenario.controller = entrant.controller(&scenario.robot)?;
    scenario.controller = tune(&scenario, options.budget, options.seed, progress)?.controller;
    Ok(scenario)
}
