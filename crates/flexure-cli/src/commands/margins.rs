//! `flexure margins`: how much a loop bears.

use flexure::compare::{Entrant, check_budget, entrants};
use flexure::files::number::significant;
use flexure::files::{Problems, Reading};
use flexure::margins::{Margins as Found, margins as measured};
use flexure::progress::unwatched;
use flexure::report::margins_table;
use flexure::scenario::{Scenario, load_scenario_with};
use flexure::tune::tune;
use serde::Serialize;

use super::print;
use crate::args::Margins;
use crate::failure::{Failure, say};

/// The loops that were measured.
#[derive(Serialize)]
struct Outcome {
    loops: Vec<Found>,
}

pub fn margins(options: &Margins, reading: Reading<'_>, json: bool) -> Result<(), Failure> {
    check_budget(options.budget)?;
    let chosen = if options.controllers.is_empty() { Vec::new() } else { entrants(&options.controllers)? };
    let scenario = load_scenario_with(&options.scenario, reading)?;
    say(&scenario.warnings);
    let loops = if chosen.is_empty() {
        vec![measured(&scenario, &unwatched)?]
    } else {
        let tuned = |entrant: &Entrant| measured(&tuned(&scenario, *entrant, options)?, &unwatched);
        chosen.iter().map(tuned).collect::<Result<_, Problems>>()?
    };
    if json {
        print::json(&Outcome { loops: loops.clone() })?;
    } else {
        print::line(&margins_table(&loops))?;
        for found in &loops {
            print::line(&format!(
                "{} holds: it follows, with an rms error of at most {:.3} mrad and torques of at most {} N m\n\
                 that change by at most {} N m (rms) a control period; {} runs",
                found.law(),
                1e3 * found.allowed_rms_e_l,
                significant(found.allowed_max_u_m, 3),
                significant(found.allowed_rms_torque_change, 3),
                found.runs
            ))?;
            if let Some(sampled) = &found.sampled {
                print::line(&sampled.line())?;
            }
        }
    }
    let objections: Vec<_> = loops.iter().filter_map(|found| found.objection(&scenario)).collect();
    if objections.is_empty() {
        return Ok(());
    }
    Err(Failure::No(objections.into_iter().map(Into::into).collect()))
}

/// The scenario under another law, with the gains that the search finds.
fn tuned(scenario: &Scenario, entrant: Entrant, options: &Margins) -> Result<Scenario, Problems> {
    let mut scenario = scenario.clone();
    scenario.controller = entrant.controller(&scenario.robot)?;
    scenario.controller = tune(&scenario, options.budget, options.seed, &unwatched)?.controller;
    Ok(scenario)
}
