//! `flexure verify` of a tube of the sampled loop: does every ellipsoid hold for a period of the loop of this scenario?

use std::path::Path;

use flexure::files::{Reading, read_text};
use flexure::prove::sampled_data::SampledTube;
use flexure::prove::sampled_data::check::{Checked, LARGEST, check};
use flexure::report::tube_lines;
use flexure::scenario::load_scenario_with;
use flexure::verify::Rejected;
use serde::Serialize;

use super::print;
use super::verify::{Against, ending, malformed, named, rejected, shown};
use crate::failure::{Failure, say};
use crate::progress::Progress;

/// What is printed with `--json`.
#[derive(Serialize)]
struct Answer<'a> {
    verdict: &'static str,
    scenario: &'a str,
    #[serde(flatten)]
    tube: &'a SampledTube,
}

/// `flexure verify` of such a file.
pub fn verify_tube(
    file: &Path,
    against: Option<&str>,
    reading: Reading<'_>,
    json: bool,
) -> Result<(), Failure> {
    let Some(name) = against else {
        let message = format!("{} is a tube: it is checked by following a loop", named(file));
        let hint = "give the scenario that it is about with --against";
        return Err(Failure::input("verify", message, hint));
    };
    let text = read_text(file, LARGEST)?;
    let scenario = load_scenario_with(name, reading)?;
    say(&scenario.warnings);
    let checked = {
        let progress = Progress::of_one(&scenario.name);
        check(&text, &scenario, &|fraction| progress.set(0, fraction))?
    };
    match checked {
        Checked::Holds(tube) if json => {
            print::json(&Answer { verdict: "verified", scenario: name, tube: &tube })
        }
        Checked::Holds(tube) => {
            for line in tube_lines(&tube, &scenario.robot.kinds()) {
                print::line(&line)?;
            }
            print::line(&format!("verified: it is about {}, as sampled", shown(name)))?;
            if scenario.robot.tolerances.are_none() {
                return Ok(());
            }
            print::line(
                "it says nothing of the tolerances in the robot file: it is about the numbers themselves",
            )
        }
        Checked::Differs(differences) => {
            let tolerances = !scenario.robot.tolerances.are_none();
            let against = Against { scenario: name.to_owned(), same: false, differences, tolerances };
            if json {
                print::json(&against)?;
            }
            ending(file, &against)
        }
        Checked::Rejected(Rejected::False { claim, reason }) => rejected(file, &claim, &reason, json),
        Checked::Rejected(Rejected::Malformed { place, reason, line, column }) => {
            Err(malformed(file, "tube", &place, &reason, (line, column)))
        }
        Checked::BrokenOff => Err(Failure::interrupted(
            "broken off: not every ellipsoid was followed".to_owned(),
            "nothing is said of the file",
        )),
    }
}
