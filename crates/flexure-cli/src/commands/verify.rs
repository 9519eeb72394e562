//! `flexure verify`: do a certificate's claims hold, and is it about this scenario?

use std::path::Path;

use flexure::files::{Reading, read_text};
use flexure::prove::subject::{Difference, differences};
use flexure::scenario::load_scenario_with;
use flexure::verify::{self, CheckReport, Claim, Rejected, quoted};
use serde::Serialize;

use super::print;
use super::verify_beside::{kind, verify_beside};
use crate::failure::{Failure, Place};

/// Characters of a text of the file beyond these are not shown.
const MOST_SHOWN: usize = 1000;

/// What is printed with `--json`.
#[derive(Default, Serialize)]
struct Answer {
    verdict: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    claims: Vec<Claim>,
    /// What the file says that it is about.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    about: Vec<Claim>,
    assumptions: Vec<String>,
    contraction_rate: Option<String>,
    convergence_rate: Option<String>,
    /// The claim that does not hold.
    claim: Option<String>,
    reason: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    against: Option<Against>,
}

/// What came of comparing with a scenario.
#[derive(Serialize)]
pub(super) struct Against {
    pub scenario: String,
    pub same: bool,
    pub differences: Vec<Difference>,
    /// Whether the scenario's robot has tolerances.
    pub tolerances: bool,
}

pub fn verify(file: &Path, against: Option<&str>, reading: Reading<'_>, json: bool) -> Result<(), Failure> {
    if let Some(kind) = kind(file) {
        return verify_beside(kind, file, against, reading, json);
    }
    let text = read_text(file, verify::LARGEST)?;
    match verify::verify(&text) {
        Ok(report) => {
            let against = against.map(|scenario| compared(&text, scenario, reading)).transpose()?;
            verified(file, report, against, json)
        }
        Err(Rejected::False { claim, reason }) => rejected(file, &claim, &reason, json),
        Err(Rejected::Malformed { place, reason, line, column }) => {
            Err(malformed(file, "certificate", &place, &reason, (line, column)))
        }
    }
}

fn compared(certificate: &str, scenario: &str, reading: Reading<'_>) -> Result<Against, Failure> {
    let name = scenario.to_owned();
    let scenario = load_scenario_with(scenario, reading)?;
    let differences = differences(certificate, &scenario)?;
    let tolerances = !scenario.robot.tolerances.are_none();
    Ok(Against { scenario: name, same: differences.is_empty(), differences, tolerances })
}

fn verified(file: &Path, report: CheckReport, against: Option<Against>, json: bool) -> Result<(), Failure> {
    let ended = against.as_ref().map_or(Ok(()), |against| ending(file, against));
    if json {
        let CheckReport { name, about, assumptions, claims, contraction_rate, convergence_rate } = report;
        print::json(&Answer {
            verdict: "verified",
            name: Some(name),
            claims,
            about,
            assumptions,
            contraction_rate,
            convergence_rate: Some(convergence_rate),
            against,
            ..Answer::default()
        })?;
        return ended;
    }
    print::line("the file says that it is about:")?;
    for Claim { name, value } in &report.about {
        print::line(&format!("  {name}: {}", clipped(value)))?;
    }
    for assumption in &report.assumptions {
        print::line(&format!("  assumed: {}", clipped(&quoted(assumption))))?;
    }
    print::line("and of that these claims hold:")?;
    for Claim { name, value } in &report.claims {
        print::line(&format!("{name}: {value}"))?;
    }
    let convergence = &report.convergence_rate;
    let contraction =
        report.contraction_rate.as_ref().map_or(String::new(), |rate| format!("contraction {rate} 1/s, "));
    print::line(&format!(
        "verified: {}: {contraction}convergence {convergence} 1/s",
        clipped(&quoted(&report.name))
    ))?;
    if let Some(against) = against.filter(|against| against.same) {
        print::line(&format!("it is about {}", shown(&against.scenario)))?;
        if against.tolerances {
            print::line(
                "it says nothing of the tolerances in the robot file: its claims are about the numbers themselves",
            )?;
        }
    }
    ended
}

/// Whether the certificate is about the scenario.
pub(super) fn ending(
    file: &Path,
    Against { scenario, same, differences, .. }: &Against,
) -> Result<(), Failure> {
    if *same {
        return Ok(());
    }
    let (file, scenario) = (named(file), shown(scenario));
    if let [Difference { place, certificate, .. }] = differences.as_slice()
        && place == "subject"
        && certificate == "null"
    {
        let message = format!(
            "{file} has no hash of its scenario: robot and gains are those of {scenario}, the rest cannot be told"
        );
        return Err(Failure::no(
            "against",
            message,
            "it is of version 1 of the format; `flexure certify` writes version 2",
        ));
    }
    let told: Vec<_> =
        differences.iter().filter(|difference| !difference.place.starts_with("subject")).collect();
    let Some(first) = told.first() else {
        let which: Vec<_> =
            differences.iter().map(|difference| difference.place.trim_start_matches("subject.")).collect();
        let message = format!(
            "{file} is not about {scenario}: its {} says something else, though the robot's numbers and the gains are the same",
            which.join(" and its ")
        );
        let hint =
            "times, reference, limits, imperfections or another key that no number of the certificate tells";
        return Err(Failure::no("against", message, hint));
    };
    let Difference { place, certificate, scenario: other } = first;
    let more = if told.len() > 1 { format!(", and {} more", told.len() - 1) } else { String::new() };
    let message = format!(
        "{file} is not about {scenario}: {} is {} in the file and {} in the scenario{more}",
        shown(place),
        clipped(&shown(certificate)),
        clipped(&shown(other)),
    );
    Err(Failure::no(
        "against",
        message,
        "what it claims holds of the loop that it tells, which is another one",
    ))
}

/// The file's own text without what could command a terminal.
pub(super) fn shown(text: &str) -> String {
    let quoted = quoted(text);
    let inside = quoted.get(1..quoted.len() - 1).unwrap_or_default();
    inside.replace("\\\"", "\"")
}

/// As much of a text as is shown of it.
pub(super) fn clipped(text: &str) -> String {
    match text.char_indices().nth(MOST_SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// The name of the certificate's file, which may be somebody else's too.
pub(super) fn named(file: &Path) -> String {
    shown(&file.display().to_string())
}

pub(super) fn rejected(file: &Path, claim: &str, reason: &str, json: bool) -> Result<(), Failure> {
    let (claim, reason) = (clipped(&shown(claim)), clipped(&shown(reason)));
    let message = format!("{}: {claim} does not hold: {reason}", named(file));
    if json {
        let (claim, reason) = (Some(claim), Some(reason));
        print::json(&Answer { verdict: "rejected", claim, reason, ..Answer::default() })?;
    }
    Err(Failure::no("verify", message, "nothing else in the file is to be relied on either"))
}

/// That the file is no `what` as docs/`what`.md has it.
pub(super) fn malformed(
    file: &Path,
    what: &str,
    place: &str,
    reason: &str,
    (line, column): (Option<usize>, Option<usize>),
) -> Failure {
    let at = match (line, column) {
        (Some(line), Some(column)) => format!(":{line}:{column}"),
        _ => String::new(),
    };
    let message = format!(
        "{}{at} is not a {what}: {}: {}",
        named(file),
        clipped(&shown(place)),
        clipped(&shown(reason))
    );
    let hint = format!("the file must be a {what} as docs/{what}.md has it");
    Failure::input_at(Place { file: named(file), line, column }, "verify", message, &hint)
}
