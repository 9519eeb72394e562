//! `flexure verify`: do a certificate's claims hold?

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use flexure::verify::{self, CheckReport, Claim, Rejected};
use serde::Serialize;

use super::print;
use crate::failure::{Failure, Place};

/// One byte more than a certificate may have: enough to see that it has too many.
const ENOUGH: u64 = (4 << 20) + 1;

/// What is printed with `--json`.
#[derive(Serialize)]
struct Answer {
    verdict: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    claims: Vec<Claim>,
    assumptions: Vec<String>,
    contraction_rate: Option<String>,
    convergence_rate: Option<String>,
    /// The claim that does not hold.
    claim: Option<String>,
    reason: Option<String>,
}

pub fn verify(file: &Path, json: bool) -> Result<(), Failure> {
    let text = read(file).map_err(|error| {
        Failure::input(
            "verify",
            format!("cannot read {}: {error}", file.display()),
            "the file must be a certificate as docs/certificate.md has it",
        )
    })?;
    match verify::verify(&text) {
        Ok(report) => verified(report, json),
        Err(Rejected::False { claim, reason }) => rejected(file, &claim, &reason, json),
        Err(Rejected::Malformed { place, reason, line, column }) => {
            Err(malformed(file, &place, &reason, line, column))
        }
    }
}

/// The text, or its start if it is too long.
fn read(file: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    File::open(file)?.take(ENOUGH).read_to_end(&mut bytes)?;
    String::from_utf8(bytes).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error.utf8_error()))
}

fn verified(report: CheckReport, json: bool) -> Result<(), Failure> {
    let CheckReport { name, assumptions, claims, contraction_rate, convergence_rate } = report;
    if json {
        return print::json(&Answer {
            verdict: "verified",
            name: Some(name),
            claims,
            assumptions,
            contraction_rate: Some(contraction_rate),
            convergence_rate: Some(convergence_rate),
            claim: None,
            reason: None,
        });
    }
    for Claim { name, value } in &claims {
        print::line(&format!("{name}: {value}"))?;
    }
    for assumption in &assumptions {
        print::line(&format!("assumed: {}", shown(assumption)))?;
    }
    let name = shown(&name);
    print::line(&format!(
        "verified: {name}: contraction {contraction_rate} 1/s, convergence {convergence_rate} 1/s"
    ))
}

/// The file's own text without what could command a terminal.
fn shown(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).collect()
}

fn rejected(file: &Path, claim: &str, reason: &str, json: bool) -> Result<(), Failure> {
    let (claim, reason) = (shown(claim), shown(reason));
    let message = format!("{}: {claim} does not hold: {reason}", file.display());
    if json {
        print::json(&Answer {
            verdict: "rejected",
            name: None,
            claims: Vec::new(),
            assumptions: Vec::new(),
            contraction_rate: None,
            convergence_rate: None,
            claim: Some(claim),
            reason: Some(reason),
        })?;
    }
    Err(Failure::no("verify", message, "nothing else in the file is to be relied on either"))
}

fn malformed(file: &Path, place: &str, reason: &str, line: Option<usize>, column: Option<usize>) -> Failure {
    let at = match (line, column) {
        (Some(line), Some(column)) => format!(":{line}:{column}"),
        _ => String::new(),
    };
    let message = format!("{}{at} is not a certificate: {}: {}", file.display(), shown(place), shown(reason));
    let hint = "the file must be a certificate as docs/certificate.md has it";
    Failure::input_at(Place { file: file.display().to_string(), line, column }, "verify", message, hint)
}
