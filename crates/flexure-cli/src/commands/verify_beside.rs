//! `flexure verify` of what `certify` writes beside certificates: does every ellipsoid of a tube hold for a period of the loop of this scenario, and do
//! errors stay in every one of a funnel?

use std::path::Path;

use flexure::files::{Problems, Reading, read_text};
use flexure::prove::documents::{Checked, FUNNEL, Kind, LARGEST, TUBE};
use flexure::prove::standing::outside_of_proofs;
use flexure::prove::{robust, sampled_data};
use flexure::report::{funnel_asked, funnel_lines, tube_lines};
use flexure::sampled::{Sampled, not_looked_at, probe};
use flexure::scenario::{Scenario, load_scenario_with};
use flexure::verify::Rejected;
use serde::Serialize;

use super::print;
use super::verify::{Against, ending, malformed, named, rejected, shown};
use crate::failure::{Failure, say};
use crate::progress::Progress;

/// What is printed with `--json`.
#[derive(Serialize)]
struct Answer<'a, T> {
    verdict: &'static str,
    scenario: &'a str,
    #[serde(flatten)]
    found: &'a T,
}

/// The kind of the file at `path`, if it is one of these.
pub fn kind(path: &Path) -> Option<Kind> {
    [TUBE, FUNNEL].into_iter().find(|kind| kind.is_of(path))
}

/// `flexure verify` of a file of this `kind`.
pub fn verify_beside(
    kind: Kind,
    file: &Path,
    against: Option<&str>,
    reading: Reading<'_>,
    json: bool,
) -> Result<(), Failure> {
    let Some(name) = against else {
        let message = format!("{} is a {}: it is checked by following a loop", named(file), kind.name);
        let hint = "give the scenario that it is about with --against";
        return Err(Failure::input("verify", message, hint));
    };
    let text = read_text(file, LARGEST)?;
    let scenario = load_scenario_with(name, reading)?;
    say(&scenario.warnings);
    let (kinds, followed) =
        (scenario.robot.kinds(), Followed { kind, file, name, scenario: &scenario, json });
    if kind == FUNNEL {
        // What it is not about: the loop that runs.
        let sampled = probe(&scenario)?.as_ref().map(Sampled::line).or_else(|| not_looked_at(&scenario));
        let beyond = [outside_of_proofs(&scenario.beyond_ideal()), sampled].into_iter().flatten();
        let beyond: Vec<_> = beyond.collect();
        let lines = |found: &_| {
            [vec![funnel_asked(found, &kinds)], funnel_lines(found, &kinds), beyond.clone()].concat()
        };
        let about = "in the ideal loop: the law in continuous time on true states";
        return followed.said(&|progress| robust::check::check(&text, &scenario, progress), &lines, about);
    }
    let lines = |found: &_| tube_lines(found, &kinds);
    followed.said(
        &|progress| sampled_data::check::check(&text, &scenario, progress),
        &lines,
        "as sampled",
    )?;
    if !scenario.robot.tolerances.are_none() && !json {
        print::line(
            "it says nothing of the tolerances in the robot file: it is about the numbers themselves",
        )?;
    }
    Ok(())
}

/// A file that is followed.
struct Followed<'a> {
    kind: Kind,
    file: &'a Path,
    name: &'a str,
    scenario: &'a Scenario,
    json: bool,
}

/// What follows it.
type Check<'a, T> = dyn Fn(flexure::progress::Progress<'_>) -> Result<Checked<T>, Problems> + 'a;

impl Followed<'_> {
    /// Follows it and prints what came of that: `lines` of what was found, and how it is `about` the loop.
    fn said<T: Serialize>(
        &self,
        check: &Check<'_, T>,
        lines: &dyn Fn(&T) -> Vec<String>,
        about: &str,
    ) -> Result<(), Failure> {
        let checked = {
            let progress = Progress::of_one(&self.scenario.name);
            check(&|fraction| progress.set(0, fraction))?
        };
        let Self { kind, file, name, json, .. } = *self;
        match checked {
            Checked::Holds(found) if json => {
                print::json(&Answer { verdict: "verified", scenario: name, found: &*found })
            }
            Checked::Holds(found) => {
                for line in lines(&found) {
                    print::line(&line)?;
                }
                print::line(&format!("verified: it is about {}, {about}", shown(name)))
            }
            Checked::Differs(differences) => {
                let tolerances = !self.scenario.robot.tolerances.are_none();
                let against = Against { scenario: name.to_owned(), same: false, differences, tolerances };
                if json {
                    print::json(&against)?;
                }
                ending(file, &against)
            }
            Checked::Rejected(Rejected::False { claim, reason }) => rejected(file, &claim, &reason, json),
            Checked::Rejected(Rejected::Malformed { place, reason, line, column }) => {
                Err(malformed(file, kind.name, &place, &reason, (line, column)))
            }
            Checked::BrokenOff => Err(Failure::interrupted(
                "broken off: not every ellipsoid was followed".to_owned(),
                "nothing is said of the file",
            )),
        }
    }
}
