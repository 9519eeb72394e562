//! `flexure tune`: gains for a scenario.

use std::path::{Path, PathBuf};

use flexure::design::{Design, SpecFile, Specified, design, spare_out};
use flexure::feasible;
use flexure::files::number::short;
use flexure::files::{Reading, folder_of, prepare, write_atomic};
use flexure::prove::standing::outside_of_proofs;
use flexure::report::{constraints_table, gains_table, margins_table, trades_table, write_tuned};
use flexure::sampled::{Sampled, not_looked_at};
use flexure::scenario::Scenario;
use serde::Serialize;

use super::print;
use crate::args::Tune;
use crate::failure::{Failure, say};
use crate::progress::Progress;

/// What was found and where the scenario is.
#[derive(Serialize)]
struct Outcome<'a> {
    #[serde(flatten)]
    design: &'a Design,
    file: Option<&'a Path>,
    /// Its page and figures; not there without `--page`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pages: Vec<PathBuf>,
}

pub fn tune(options: &Tune, reading: Reading<'_>, json: bool) -> Result<(), Failure> {
    flexure::compare::check_budget(options.budget)?;
    let spec = options.spec.as_deref().map_or_else(|| Ok(SpecFile::usual()), SpecFile::load)?;
    let specified = Specified::load(&options.scenario, reading, &spec)?;
    let scenario = &specified.scenarios[0];
    say(specified.scenarios.iter().flat_map(|scenario| &scenario.warnings));
    for scenario in &specified.scenarios {
        say(&feasible::slowed(scenario)?);
    }
    let out = options.out.clone().unwrap_or_else(|| beside(&options.scenario, &scenario.name));
    let inputs: Vec<_> =
        std::iter::once(Path::new(&options.scenario)).chain(options.spec.as_deref()).collect();
    spare_out(&out, &inputs)?;
    specified.belongs(&out, reading.outside)?;
    prepare(folder_of(&out))?;
    options.paged.prepare(&scenario.name, "tune", 1, &[&out])?;
    let found = {
        let progress = Progress::of_one(&scenario.name);
        design(&specified, &spec, options.budget, options.seed, &|fraction| progress.set(0, fraction))?
    };
    let file = found.feasible.then_some(out.as_path());
    if let Some(file) = file {
        let text = specified.with(&found.controller, &found.comment());
        write_atomic(file, |out| out.write_all(text.as_bytes()))?;
    }
    let objection = found.objection(scenario, &spec);
    let pages = match &options.paged.page {
        Some(folder) if !found.broken_off => write_tuned(folder, scenario, &found, objection.as_ref(), file)?,
        _ => Vec::new(),
    };
    if json {
        print::json(&Outcome { design: &found, file, pages })?;
    } else {
        show(&found, scenario)?;
        print::wrote(file.as_slice())?;
        print::wrote(&pages)?;
    }
    if found.broken_off {
        let words = if found.feasible {
            "broken off: the gains are the best so far, and keep every constraint that was looked at"
        } else {
            "broken off: no gains keep every constraint so far"
        };
        let hint = options.paged.broken_off("without Ctrl-C the search goes on, and margins are measured");
        return Err(Failure::interrupted(words.to_owned(), &hint));
    }
    objection.map_or(Ok(()), |problem| Err(Failure::No(vec![problem.into()])))
}

/// `NAME-tuned.toml` in the folder of the scenario; of a built-in one, in the current folder.
fn beside(scenario: &str, name: &str) -> PathBuf {
    Path::new(scenario).with_file_name(format!("{name}-tuned.toml"))
}

fn show(found: &Design, scenario: &Scenario) -> Result<(), Failure> {
    let width = print::columns();
    let joints: Vec<String> = scenario.robot.joints.iter().map(|joint| joint.name.clone()).collect();
    print::line(&gains_table(&joints, found, width))?;
    if !found.broken_off {
        print::line(&trades_table(&found.gains, width))?;
    }
    print::line(&constraints_table(&found.constraints, width))?;
    if let Some(margins) = &found.evidence.margins {
        print::line(&margins_table(std::slice::from_ref(margins), width))?;
    }
    let evidence = &found.evidence;
    if let Some(line) = evidence.sampled.as_ref().map(Sampled::line).or(not_looked_at(scenario)) {
        print::line(&line)?;
    }
    if let (Some(verdict), Some(rate)) = (evidence.verdict, evidence.rate_certified) {
        print::line(&format!("contraction rate: {} 1/s, {verdict}", short(rate, 4)))?;
        if let Some(line) = outside_of_proofs(&scenario.beyond_ideal()) {
            print::line(&line)?;
        }
    }
    if let Some(tube) = evidence.tube {
        print::line(&format!("of the sampled loop {} is proved", tube.words()))?;
    }
    if let Some(frail) = found.frail() {
        print::line(&format!(
            "the loop is frail: with {frail} small errors grow or it does not follow; that it bears this is wished for, a SPEC can ask for it. \
             (Margins are of runs: errors that grow slowly need not show in them.)"
        ))?;
    }
    print::line(&format!("{} loops were run in the search", found.runs))
}
