//! `flexure certify`: a proof and its certificate.

use std::path::PathBuf;

use flexure::files::{Reading, spare};
use flexure::prove::question::{Direct, Question, Region, SMALLEST_ERROR, prove_watched};
use flexure::prove::standing::{Standing, outside_of_proofs};
use flexure::prove::summary::ProofSummary;
use flexure::report::{proof_table, write_certificate};
use flexure::sampled::probe;
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
    let proof = {
        let progress = Progress::of_one(&scenario.name);
        prove_watched(&scenario, &question, &|fraction| progress.set(0, fraction))?
    };
    let sampled = probe(&scenario)?;
    let summary = ProofSummary::new(&scenario, &proof, sampled.clone());
    let file = match proof.verdict.proved().filter(|_| !proof.broken_off) {
        None => None,
        Some(certificate) => {
            write_certificate(&path, certificate)?;
            Some(path)
        }
    };
    let ended = ending(&scenario, Standing::of(&scenario, &proof, sampled.as_ref()), options.strict);
    if json {
        print::json(&Outcome { summary, file })?;
    } else {
        if proof.broken_off {
            print::line("broken off: what is here is proved, not all that was asked was looked at")?;
        }
        print::line(&proof_table(&summary, print::columns()))?;
        if let Some(file) = &file {
            print::line(&format!("wrote {}", file.display()))?;
        }
    }
    match ended {
        Err(Failure::Undecided(reports)) if proof.broken_off => Err(Failure::Interrupted(reports)),
        ended => ended,
    }
}

/// What the options ask for, if they fit the robot.
fn question(options: &Certify, scenario: &Scenario) -> Result<Question, Failure> {
    let n = scenario.robot.joint_count();
    let errors = |name: &str, values: &[f64]| {
        per_joint(
            name,
            values,
            2 * n,
            "one number, or one per joint of the links, then of the motors, in rad",
        )
    };
    let region = match (&options.error_box, &options.initial_error) {
        (Some(values), _) => Region::Errors(positive("--error-box", errors("--error-box", values)?)?),
        (None, Some(values)) => {
            let start = errors("--initial-error", values)?;
            let largest = start.iter().fold(0.0, |largest: f64, e| largest.max(e.abs()));
            positive("--initial-error", vec![largest])?;
            Region::Start(start.into_iter().map(f64::abs).collect())
        }
        (None, None) => Region::Chosen,
    };
    let disturbance = match &options.disturbance {
        None => None,
        Some(values) => {
            let torques = per_joint(
                "--disturbance",
                values,
                n,
                "one number, or one per motor, in N m, link side of the gear",
            )?;
            if let Some(negative) = torques.iter().find(|&&d| d < 0.0) {
                let message = format!("--disturbance is {negative} N m, must be >= 0");
                return Err(Failure::input("range", message, "the largest absolute value of the torque"));
            }
            Some(torques)
        }
    };
    if let Some(rate) = options.rate.filter(|rate| !(rate.is_finite() && *rate > 0.0 && *rate <= LARGEST)) {
        let message = format!("--rate is {rate:e} 1/s, must be > 0 and at most 1e30");
        return Err(Failure::input(
            "range",
            message,
            "decay rate of the distance of two solutions; leave it out for the largest",
        ));
    }
    let (speed, budget) = (options.speed, options.budget);
    if !(0.0..=LARGEST).contains(&speed) {
        let message = format!("--speed is {speed} rad/s, must be >= 0 and at most 1e30");
        return Err(Failure::input("range", message, "the largest speed of the links that is looked at"));
    }
    let direct = options.direct.then_some(Direct { speed, budget });
    Ok(Question { region, rate: options.rate, disturbance, direct })
}

/// Largest and smallest number that an option takes: products of a few of them stay finite.
const LARGEST: f64 = 1e30;

fn per_joint(name: &str, values: &[f64], count: usize, what: &str) -> Result<Vec<f64>, Failure> {
    if let Some(x) = values.iter().find(|x| !x.is_finite() || x.abs() > LARGEST) {
        let message = format!("{name} is {x:e}, must be of a magnitude up to 1e30");
        return Err(Failure::input("range", message, what));
    }
    match values {
        [one] => Ok(vec![*one; count]),
        many if many.len() == count => Ok(many.to_vec()),
        many => {
            let message = format!("{name}: 1 or {count} numbers expected; got {}", many.len());
            Err(Failure::input("length", message, what))
        }
    }
}

fn positive(name: &str, values: Vec<f64>) -> Result<Vec<f64>, Failure> {
    match values.iter().find(|&&x| x < SMALLEST_ERROR) {
        None => Ok(values),
        Some(x) if *x > 0.0 => {
            let message = format!("{name} is {x:e} rad, must be at least {SMALLEST_ERROR:e}");
            let hint = "so small a region cannot be represented: tanh is linear in it to rounding";
            Err(Failure::input("region", message, hint))
        }
        Some(x) => Err(empty(name, &x.to_string())),
    }
}

fn empty(name: &str, value: &str) -> Failure {
    let message = format!("{name} is {value} rad: the region is empty");
    Failure::input("region", message, "name the largest error that shall be certified, > 0")
}

/// The exit code: 1 for what is refuted or unstable, and if it is `strict` for what is proved of another loop than the one in the
/// file; 3 for what could not be decided.
fn ending(scenario: &Scenario, standing: Standing<'_>, strict: bool) -> Result<(), Failure> {
    let problem = match standing {
        Standing::Proved => return Ok(()),
        Standing::Ideal(_) if !strict => return Ok(()),
        Standing::Ideal(conditions) => {
            let outside = outside_of_proofs(&conditions).unwrap_or_default();
            let help = "without --strict the proof of the ideal loop is enough";
            scenario.places.problem("controller", "ideal", format!("{}: {outside}", scenario.name), help)
        }
        Standing::Unstable(sampled) => match sampled.problem(scenario) {
            Some(problem) => problem,
            None => return Ok(()),
        },
        Standing::Refuted(problem) => problem,
        Standing::Undecided(problem) => return Err(Failure::Undecided(vec![problem.into()])),
    };
    Err(Failure::No(vec![problem.into()]))
}
