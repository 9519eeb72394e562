//! `flexure compare`: laws on the same bench.

use std::path::PathBuf;

use flexure::compare::{
    Leaderboard, Search, check_budget, check_seeds, compare as compared, entrants, tasks,
};
use flexure::files::{Reading, prepare};
use flexure::report::{leaderboard_table, write_leaderboard};
use flexure::scenario::Scenario;
use serde::Serialize;

use super::print;
use crate::args::Compare;
use crate::failure::{Failure, say};
use crate::interrupt;
use crate::progress::Progress;

/// What was found and where the files are.
#[derive(Serialize)]
struct Outcome<'a> {
    #[serde(flatten)]
    leaderboard: &'a Leaderboard,
    files: Vec<PathBuf>,
}

pub fn compare(options: &Compare, reading: Reading<'_>, json: bool) -> Result<(), Failure> {
    check_budget(options.budget)?;
    check_seeds(options.seeds)?;
    let entrants = entrants(&options.controllers)?;
    let tasks = tasks(&options.scenarios, reading)?;
    say(tasks.iter().flat_map(|task| &task.scenario.warnings));
    let out = &options.output.out;
    prepare(out)?;
    let leaderboard = {
        let weights = tasks.iter().flat_map(|task| vec![work(&task.scenario); entrants.len()]);
        let name = format!("{} laws on {} tasks", entrants.len(), tasks.len());
        let progress = Progress::new(&name, weights);
        let search = Search { budget: options.budget, seed: options.seed, seeds: options.seeds };
        compared(&tasks, &entrants, search, &|pair, fraction| progress.set(pair, fraction))?
    };
    if interrupt::asked() {
        return interrupted(&leaderboard, tasks.len(), json);
    }
    let files = write_leaderboard(out, &leaderboard, &tasks)?;
    if json {
        print::json(&Outcome { leaderboard: &leaderboard, files })?;
    } else {
        print::line(&leaderboard_table(&leaderboard, print::columns()))?;
        print::wrote(&files)?;
    }
    hopeless(&leaderboard)
}

/// About how long a run of a scenario takes, next to one of another: a period of seven joints takes as long as seven of two.
fn work(scenario: &Scenario) -> f64 {
    scenario.duration / scenario.control_period * (scenario.robot.joint_count() as f64).powf(1.5)
}

/// What was finished of a comparison. Nothing is written: files are of whole ones.
fn interrupted(leaderboard: &Leaderboard, tasks: usize, json: bool) -> Result<(), Failure> {
    let message =
        format!("broken off: {} of {tasks} tasks were finished by every law", leaderboard.tasks.len());
    if json {
        print::json(&Outcome { leaderboard, files: Vec::new() })?;
    } else {
        print::line(&message)?;
        print::line(&leaderboard_table(leaderboard, print::columns()))?;
    }
    Err(Failure::interrupted(message, "places are those on these tasks; no file is written"))
}

/// The answer is no if no law follows on a task.
fn hopeless(leaderboard: &Leaderboard) -> Result<(), Failure> {
    let names: Vec<&str> = leaderboard.hopeless().map(|task| task.scenario.as_str()).collect();
    if names.is_empty() {
        return Ok(());
    }
    let message = format!("no law follows the reference on {}", names.join(", "));
    let hint = "the reasons stand below the table and in compare.html: where the reference itself is beyond the robot's limits, as `flexure \
                check` says, no law can; else raise --budget, add --controllers, or shorten control_period and delay";
    Err(Failure::no("lost", message, hint))
}
