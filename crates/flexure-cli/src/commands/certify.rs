//! `flexure certify`: a proof and its certificate.

use std::path::PathBuf;

use flexure::files::{Problem, Reading, Unfinished, folder_of, prepare, spare};
use flexure::prove::documents::{FUNNEL, TUBE};
use flexure::prove::question::{Climb, Direct, Question, Region, prove_watched};
use flexure::prove::standing::{Standing, outside_of_proofs};
use flexure::prove::summary::ProofSummary;
use flexure::report::{proof_table, proof_verdict, write_certificate, write_certified, write_document};
use flexure::sampled::{not_looked_at, probe};
use flexure::scenario::{Scenario, load_scenario_with};
use serde::Serialize;

use super::print;
use crate::args::Certify;
use crate::failure::{Failure, say};
use crate::progress::Progress;

/// A summary and where the certificate is.
#[derive(Serialize)]
struct Outcome {
    #[serde(flatten)]
    summary: ProofSummary,
    /// The certificate; none if nothing was proved.
    file: Option<PathBuf>,
    /// The file of the tube of the sampled loop; not there where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    tube_file: Option<PathBuf>,
    /// The file of the funnel; not there where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    funnel_file: Option<PathBuf>,
    /// Its page and figure; not there without `--page`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pages: Vec<PathBuf>,
}

pub fn certify(options: &Certify, reading: Reading<'_>, json: bool) -> Result<(), Failure> {
    let scenario = load_scenario_with(&options.scenario, reading)?;
    say(&scenario.warnings);
    let question = question(options, &scenario)?;
    let path = options
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from(format!("out/{}.certificate.json", scenario.name)));
    // Said before minutes of proof, not after.
    spare(&path, "certificate", |text| text.contains("flexure-certificate"), &[])?;
    let (tube_path, funnel_path) = (TUBE.beside(&path), FUNNEL.beside(&path));
    let looks = question.looks_for_tube(&scenario);
    if looks {
        TUBE.spare(&tube_path)?;
    }
    let feels = question.looks_for_funnel(&scenario);
    if feels {
        FUNNEL.spare(&funnel_path)?;
    }
    prepare(folder_of(&path))?;
    options.paged.prepare(&scenario.name, "certify", 1, &[&path])?;
    let proof = {
        let progress = Progress::of_one(&scenario.name);
        prove_watched(&scenario, &question, &|fraction| progress.set(0, fraction))?
    };
    let sampled = probe(&scenario)?;
    let summary = ProofSummary::new(&scenario, &proof, sampled.clone());
    // What was looked for unasked is no part of the certificate.
    let is_whole = !proof.broken_off || (proof.climbed && question.climb == Climb::IfQuick);
    let file = match proof.verdict.proved().filter(|_| is_whole) {
        None => None,
        Some(certificate) => {
            write_certificate(&path, certificate)?;
            Some(path)
        }
    };
    let tube = proof.sampled_tube.as_ref().and_then(|found| found.as_ref().ok());
    let tube = tube.map(|tube| tube.file(&scenario)).transpose()?;
    let funnel = proof.robust.as_ref().and_then(|found| found.as_ref().ok());
    let funnel = funnel.map(|funnel| funnel.file(&scenario)).transpose()?;
    let mut stale = Vec::new();
    let mut beside = |path: PathBuf, text: Option<String>, looks: bool| match text {
        Some(text) if !proof.broken_off => write_document(&path, &text).map(|()| Some(path)),
        // What lies there without a new one is of an earlier proof.
        _ => {
            stale.extend(Some(path).filter(|old| looks && old.exists()));
            Ok(None)
        }
    };
    let tube_file = beside(tube_path, tube, looks)?;
    let funnel_file = beside(funnel_path, funnel, feels)?;
    let standing = Standing::of(&scenario, &proof, sampled.as_ref());
    let pages = match &options.paged.page {
        // Of a part of a proof a page would be taken for the whole.
        Some(folder) if !proof.broken_off => {
            let verdict = proof_verdict(&scenario, &standing, &summary, options.strict);
            let progress = Progress::of_one(&scenario.name);
            let watch = |fraction| progress.set(0, fraction);
            match write_certified(folder, &scenario, &summary, &verdict, file.as_deref(), &watch) {
                Err(Unfinished::Problems(problems)) if problems.is_interrupted() => None,
                pages => Some(pages?),
            }
        }
        _ => Some(Vec::new()),
    };
    let has_page = pages.is_some();
    let pages = pages.unwrap_or_default();
    let ended = ending(&scenario, standing, options.strict);
    if json {
        print::json(&Outcome { summary, file, tube_file, funnel_file, pages })?;
    } else {
        if proof.broken_off {
            print::line("broken off: what is here is proved, not all that was asked was looked at")?;
        }
        print::line(&proof_table(&summary, print::columns()))?;
        if let Some(line) = not_looked_at(&scenario) {
            print::line(&line)?;
        }
        print::wrote(file.as_slice())?;
        print::wrote(tube_file.as_slice())?;
        print::wrote(funnel_file.as_slice())?;
        for old in stale {
            print::line(&format!("{} is of an earlier proof", old.display()))?;
        }
        print::wrote(&pages)?;
    }
    if !has_page {
        let words = "broken off: what was proved is there, its page is not".to_owned();
        return Err(Failure::interrupted(words, "without Ctrl-C the loop is run for its picture"));
    }
    match ended {
        Err(Failure::Undecided(reports)) if proof.broken_off => Err(Failure::Interrupted(reports)),
        ended => ended,
    }
}

/// What the options ask for, if it fits the robot.
fn question(options: &Certify, scenario: &Scenario) -> Result<Question, Problem> {
    let region = match (&options.error_box, &options.initial_error) {
        (Some(largest), _) => Region::Errors(largest.clone()),
        (None, Some(start)) => Region::Start(start.clone()),
        (None, None) => Region::Chosen,
    };
    let direct = options.direct.then_some(Direct { budget: options.budget });
    let disturbance = options.disturbance.clone();
    let link_disturbance = options.link_disturbance.clone();
    let velocity_error = options.velocity_error.clone();
    let up_to_limits = options.up_to_limits;
    let sampled_tube = options.sampled_tube.clone();
    let climb = match (options.strongest, options.no_tube) {
        (true, _) => Climb::Always,
        (false, true) => Climb::Stay,
        (false, false) => Climb::IfQuick,
    };
    let (rate, slabs) = (options.rate, options.slabs);
    Question {
        region,
        rate,
        disturbance,
        link_disturbance,
        up_to_limits,
        slabs,
        velocity_error,
        sampled_tube,
        climb,
        direct,
    }
    .fitting(scenario)
}

/// The exit code: 1 for what is refuted or unstable, and if it is `strict` for what is proved of another loop than the one in the
/// file; 3 for what could not be decided.
fn ending(scenario: &Scenario, standing: Standing<'_>, strict: bool) -> Result<(), Failure> {
    let problem = match standing {
        Standing::Proved | Standing::Near => return Ok(()),
        Standing::Ideal(_) if !strict => return Ok(()),
        Standing::Ideal(conditions) => {
            let outside = outside_of_proofs(&conditions).unwrap_or_default();
            let help = "without --strict the proof of the ideal loop is enough";
            scenario.places.problem("controller", "ideal", format!("{}: {outside}", scenario.name), help)
        }
        Standing::Unstable { sampled, .. } => match sampled.problem(scenario) {
            Some(problem) => problem,
            None => return Ok(()),
        },
        Standing::Refuted(problem) => problem,
        Standing::Undecided(problem) => return Err(Failure::Undecided(vec![problem.into()])),
    };
    Err(Failure::No(vec![problem.into()]))
}
