//! `flexure replay`: a log over the simulation.

use std::path::PathBuf;

use flexure::files::number::{duration, short};
use flexure::files::{Reading, prepare};
use flexure::logs::read_log;
use flexure::replay::{Replay as Found, replay as laid};
use flexure::report::{replay_table, write_replay};
use flexure::scenario::load_scenario_with;
use serde::Serialize;

use super::{log, print};
use crate::args::Replay;
use crate::failure::{Failure, say};
use crate::progress::Progress;

#[derive(Serialize)]
struct Outcome<'a> {
    #[serde(flatten)]
    found: &'a Found,
    files: Vec<PathBuf>,
}

pub fn replay(options: &Replay, reading: Reading<'_>, json: bool) -> Result<(), Failure> {
    let scenario = load_scenario_with(&options.scenario, reading)?;
    say(&scenario.warnings);
    let columns = log::columns(options.columns.as_deref(), &scenario.robot)?;
    let (log, warnings) = read_log(&options.log, &columns, &scenario.robot)?;
    say(&warnings);
    prepare(&options.output.out)?;
    let found = {
        let progress = Progress::of_one(&scenario.name);
        laid(&scenario, &log, options.horizon, &|fraction| progress.set(0, fraction))?
    };
    say(&found.warnings);
    let files = write_replay(&options.output.out, &found)?;
    if json {
        return print::json(&Outcome { found: &found, files });
    }
    print::line(&replay_table(&found))?;
    print::line(&format!(
        "root mean squares of simulation − log, and their part of what the logged signal moves; {} samples, {} Hz\n\
         predicted: the simulated robot under the logged torque, from the log's own motion on, for {} at a time\n\
         loop: the closed loop of the scenario from its own start{}",
        found.samples,
        short(1.0 / found.period, 4),
        duration(found.horizon),
        found.diverged_at.map_or(String::new(), |t| format!("; it diverged at {}", duration(t)))
    ))?;
    print::wrote(&files)
}
